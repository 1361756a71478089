// The glue between the libraries: what libdem shows of a run, in libjam's terms.
#pragma once
#include "apps/jamscope/case_file.hpp"
#include "libdem/scene/scene.hpp"
#include "libdem/simulation/simulation.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

// "plane", "cylinder", "cone", "disc", "spheres" or "mesh", as in a snapshot file.
std::string wall_kind(const dem::WallShape& shape);

// Above which force a run follows its grains from step to step (dem::Setup::watch_force): where a jam by force ends, else the criterion's
// threshold for a grain of mean size, and for others as the square of their radius.
struct Watched {
  double force = 0, radius = 0;  // N, m
};
Watched watched(const CaseFile& file);

// Everything a snapshot file says once about its run.
jam::RunInfo run_info(const CaseFile& file, const dem::Scene& scene, const std::vector<std::string>& argv);

// One frame, rounded to the file's precision.
jam::Snapshot snapshot(const dem::View& view);

// Adds one row, with the excursions that ended in the window.
void append(jam::Series& series, const dem::Window& window);

// Those that have not ended, to the last row; nothing where there is none.
void append_open(jam::Series& series, const std::vector<dem::Excursion>& excursions);

}  // namespace jamscope
