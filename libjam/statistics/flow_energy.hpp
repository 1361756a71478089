// Work done by the blade. Paper, Eq. 7: integral of (torque / (R tan alpha) + force) dh; written for any motion of the
// blade as the integral of -(F . v + T . omega) dt with F and T on the wall, summed over the walls of role blade.
//
// Jams last microseconds to milliseconds, so a power sampled once per frame is a coarse quadrature of spikes. Sources,
// best first: the step-averaged power of the series; the walls' forces and torques at the frames; the recorded contacts
// of the blade at the frames.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct FlowEnergy {
  std::string source;                       // "series" (step-averaged), "frames" or "contacts" (sampled), or "none"
  std::vector<double> time, power, energy;  // s, W, J; energy[k] is the work done up to time[k]
  double total = 0;                         // J
};

// W, power that the blades put into the grains, from the forces and torques of the snapshot's WallStates.
double power_from_wall_loads(const Snapshot& snapshot, const std::vector<Wall>& walls);

// The same from the snapshot's contacts with the blades: sum of f . (v + omega x (p - x)) with f the force on the
// particle at point p and x, v, omega the wall's pose and velocities. Tangential forces are left out where they are
// absent; a missing point is taken on the particle's surface, a missing normal along the line from centre to point; NaN
// where a contact has neither point nor normal.
double power_from_wall_contacts(const Snapshot& snapshot, const std::vector<Wall>& walls);

// True where every wall of role blade has a power in every row of the series.
bool series_has_power(const Series& series, const std::vector<Wall>& walls);

// Row k adds power[k] times the length of its window; the first window, whose begin the series does not hold, is taken
// as long as the second, and a single row's as beginning at `begin`. Needs series_has_power().
FlowEnergy flow_energy_from_series(const Series& series, const std::vector<Wall>& walls, double begin);

// Trapezoid rule; energy[0] = 0. `source` is copied into the result.
FlowEnergy flow_energy_from_frames(std::span<const double> time, std::span<const double> power, std::string source);

}  // namespace jam
