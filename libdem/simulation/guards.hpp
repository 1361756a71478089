// What stops a run: each check throws PhysicsError that names the grain, its contact, the time and the likely cause.
#pragma once
#include "libdem/contact/contact_store.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

// Overlap over radius from which no contact law here means anything any more.
inline constexpr double runaway_overlap = 0.5;

struct GuardInput {
  const Setup& setup;
  // In the order of the run's rows.
  const std::vector<std::uint32_t>& id;
  const LargeArray<GrainRow>& grains;  // and phantoms behind them
  const std::vector<double>& mass;     // [N] kg
  const std::vector<double>& inertia;  // [N] kg m^2
  const MaterialTable& materials;
  const PairContacts& pairs;
  const WallContacts& walls;
  double time;  // s
};

// Every number is finite and every grain inside the setup's box.
void check_motion(const GuardInput& in);

// No grain's step is above the limit 2/omega of the leapfrog scheme, omega the largest frequency of the grain, its six
// degrees of freedom together, between its contacts held where they are: normal stiffness 2 E* a, tangential 8 G* a. A lower
// bound of the frequencies of the whole packing, so a step that this refuses is unstable (a step that it allows may still be).
void check_stable_step(const GuardInput& in);

// s, the limit for the grain in row i, and the smallest of all grains; infinity without contacts.
double stable_step(const GuardInput& in, std::size_t i);
double stable_step(const GuardInput& in);

// Names the contact whose overlap has run away.
[[noreturn]] void stop_for_overlap(const GuardInput& in);

// "1.23" and the like for messages.
std::string number(double value);

}  // namespace dem
