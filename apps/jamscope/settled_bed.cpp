#include "apps/jamscope/settled_bed.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "apps/jamscope/checkpoint.hpp"
#include "libjam/errors.hpp"

namespace jamscope {
namespace {

std::string overlaps_text(const dem::Overlaps& o) {
  std::string text = fmt::format("largest overlap {:.2g} R", o.largest);
  if (o.squeezed > 0)
    text += fmt::format(" ({} squeezed between walls: {:.2g} R)", o.squeezed == 1 ? "1 grain" : fmt::format("{} grains", o.squeezed),
                        o.largest_squeezed);
  return text;
}

std::string bed_text(const dem::BedReport& r) {
  return fmt::format(
      "{} grains, solid fraction {:.3f}, coordination {:.2f} ({:.2f} with walls and without {} rattlers), {}, "
      "top at {:.2f} mm; at rest: set free for {:.2g} ms, {} grains are unsupported, none moved by more than {:.2g} um "
      "(free fall: {:.2g} um), kinetic energy {:.2g} J (rest: below {:.2g} J)",
      r.grains, r.solid_fraction, r.coordination, r.mechanical_coordination, r.rattlers, overlaps_text(r.overlaps), 1e3 * r.top,
      1e3 * r.probe_interval, r.unsupported, 1e6 * r.largest_displacement, 1e6 * r.free_fall, r.kinetic_energy, r.rest_scale);
}

}  // namespace

dem::SettledBed settled_bed(const CaseFile& file, const dem::Scene& scene, const std::string& cache,
                            Console& console, const Host& host) {
  const dem::Case& c = file.physics;
  const std::string key = bed_key(scene.setup, c.bed, scene.region);
  const std::string path = cache.empty() ? "" : (std::filesystem::path(cache) / ("bed-" + key.substr(0, 16) + ".h5")).string();
  if (!path.empty()) {
    try {
      if (auto bed = read_bed(path, key)) {
        console.note(fmt::format("settled bed from {}: {}", path, bed_text(bed->report)));
        return *bed;
      }
    } catch (const jam::DataError& e) {
      console.warning(fmt::format("stored bed not used, settling again: {}", e.what()));
    }
  }
  const auto begin = Clock::now();
  Progress progress;
  progress.unit = "s";
  progress.at_most = true;  // stages end when the grains are at rest
  const auto report = [&](const dem::BedProgress& p) {
    if (!console.due()) return;
    progress.stage = "bed: " + p.stage;
    progress.done = p.time;
    progress.step = p.steps;
    progress.total = p.end;
    console.progress(progress);
  };
  dem::SettledBed bed;
  try {
    host.compute([&] {
      bed = dem::make_bed(scene.setup, c.bed, std::uint8_t(dem::material_index(c, c.bed.material)), scene.region, report, host.stop);
    });
  } catch (const dem::BedInterrupted&) {
    throw Interrupted{};
  }
  console.note(fmt::format("bed settled in {}, {:.2g} grain steps: {}", duration_text(seconds_since(begin)),
                           bed.report.grain_steps, bed_text(bed.report)));
  if (!path.empty()) {
    try {
      write_bed(path, bed, key);
    } catch (const jam::DataError& e) {
      console.warning(fmt::format("the settled bed could not be stored for the next run: {}", e.what()));
    }
  }
  return bed;
}

}  // namespace jamscope
