// The bed that a case begins with: from the store of settled beds, or settled now and stored for the next run.
#pragma once
#include <string>

#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/console.hpp"
#include "apps/jamscope/host.hpp"
#include "libdem/bed/bed.hpp"
#include "libdem/scene/scene.hpp"

namespace jamscope {

// Thrown where a stop signal came while the bed settled.
struct Interrupted {};

// `cache` is the folder of settled beds, or empty.
dem::SettledBed settled_bed(const CaseFile& file, const dem::Scene& scene, const std::string& cache, Console& console, const Host& host = {});

}  // namespace jamscope
