#include "apps/jamscope/simulate.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>

#include "apps/jamscope/analyze.hpp"
#include "apps/jamscope/capture.hpp"
#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/checkpoint.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/outputs.hpp"
#include "apps/jamscope/settled_bed.hpp"
#include "apps/jamscope/sha256.hpp"
#include "apps/jamscope/simulation_view.hpp"
#include "libdem/case/check_case.hpp"
#include "libdem/errors.hpp"
#include "libjam/errors.hpp"
#include "libjam/snapshot/reader.hpp"
#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/writer.hpp"
#include "libjam/snapshot/xdmf.hpp"

namespace jamscope {
namespace {

// How many steps lie between two records; at least one.
std::uint64_t steps_in(double interval, double step) {
  return std::uint64_t(std::max(1.0, std::round(interval / step)));
}

// A run from its first to its last frame: libdem steps, every frame goes into the file and into the analysis.
class Run {
 public:
  Run(const SimulateOptions& options, const CaseFile& file, Console& console, const Host& host, const OnFrame& on_frame)
      : options_(options),
        file_(file),
        console_(console),
        host_(host),
        on_frame_(on_frame),
        folder_(options.output),
        sha_(sha256_hex(file.text)),
        scene_(dem::make_scene(file.physics, file.walls)),
        info_(run_info(file, scene_, options.command_line)),
        pipeline_(info_, file.criteria) {
    scene_.setup.watch_force = info_.watch_force;
    scene_.setup.watch_radius = info_.watch_radius;
  }

  void begin() {
    dem::SettledBed bed = settled_bed(file_, scene_, options_.bed_cache, console_, host_);
    writer_.emplace(jam::SnapshotWriter::create(snapshots(), info_));
    simulation_.emplace(scene_.setup, std::move(bed.state));
    begin_capture(std::nullopt);
    record_frame();
    save();
  }

  bool can_resume() const { return std::filesystem::exists(restart()); }

  // Frames after the checkpoint are dropped; those before it go through the analysis again.
  void resume() {
    Checkpoint checkpoint = read_checkpoint(restart());
    if (checkpoint.case_sha256 != sha_)
      throw UsageError(fmt::format("{}: belongs to another case, expected case_sha256 {}, got {}", restart(), sha_,
                                   checkpoint.case_sha256));
    writer_.emplace(jam::SnapshotWriter::resume(snapshots(), checkpoint.state.step));
    begin_capture(checkpoint.state.step);
    info_ = writer_->info();
    const jam::SnapshotSource stored = jam::open_jamscope_file(snapshots());
    for (std::size_t k = 0; k < stored.frames; ++k) {
      const jam::Snapshot frame = stored.read(k);
      host_.compute([&] { pipeline_.add(frame); });
    }
    series_ = stored.series;
    pending_ = std::move(checkpoint.pending);
    jam::schema::append(series_, pending_);
    simulation_.emplace(scene_.setup, std::move(checkpoint.state));
    console_.note(fmt::format("resumed at t = {:.6g} s, step {}, with {} frames", simulation_->time(), simulation_->step(), stored.frames));
  }

  // Returns false where the host or the one who sees the frames ended it early.
  bool advance() {
    const dem::Case& c = file_.physics;
    const double end = std::min(c.duration, options_.until.value_or(c.duration));
    // All contacts meet every 2^levels steps; a run can only stop there.
    const std::uint64_t meet = std::uint64_t{1} << c.levels;
    const std::uint64_t last = (std::uint64_t(std::llround(end / c.step)) + meet - 1) / meet * meet;
    const std::uint64_t frame = steps_in(c.output.frame_interval, c.step);
    const std::uint64_t window = std::min(steps_in(c.output.series_interval, c.step), frame);
    const std::uint64_t checkpoint = steps_in(c.output.checkpoint_interval, c.step);
    const std::uint64_t fine = capture_ ? steps_in(c.output.capture.interval, c.step) : last;
    first_step_ = simulation_->step();
    begin_ = Clock::now();
    std::uint64_t next_checkpoint = (simulation_->step() / checkpoint + 1) * checkpoint;
    while (simulation_->step() < last) {
      if (!go_on_ || host_.stop()) {
        save();
        return false;
      }
      const std::uint64_t step = simulation_->step();
      const std::uint64_t target = std::min({(step / window + 1) * window, (step / frame + 1) * frame, (step / fine + 1) * fine, last});
      host_.compute([&] { simulation_->advance(target - step); });
      if (capture_ && target % fine == 0) offer_to_capture(target - std::min(target, fine));
      if (target % window != 0 && target % frame != 0 && target != last) continue;
      const dem::Window row = simulation_->take_window();
      for (const dem::Excursion& e : row.excursions) ended_since_ = std::max(ended_since_, e.last_step);
      append(pending_, row);
      append(series_, row);
      largest_overlap_ = row.largest_overlap;
      largest_force_ = row.largest_compressive_force;
      jammed_ = row.most_watched;
      if (target % frame == 0 || target == last) record_frame();
      if (target >= next_checkpoint) {
        save();
        next_checkpoint = (target / checkpoint + 1) * checkpoint;
      }
      if (console_.due()) console_.progress(progress(end));
    }
    console_.finished(progress(end));
    if (capture_ && capture_->windows() > 0) console_.note(fmt::format("{} windows around jams in {}", capture_->windows(), capture_->path().string()));
    if (capture_ && capture_->windows_left_out() > 0)
      console_.warning(fmt::format("{} jams after {} had reached output.capture_gigabytes are not in it", capture_->windows_left_out(), capture_->path().string()));
    save();
    return true;
  }

  // What the disk should hold of a run that the physics stopped: its last state where that can be written, and the results.
  void keep_what_there_is() noexcept {
    if (!simulation_ || !writer_) return;
    try {
      if (simulation_->step() > writer_->last_step()) record_frame();
    } catch (const std::exception& e) {
      console_.warning(fmt::format("the last state could not be recorded: {}", e.what()));
    }
    try {
      write_results();
    } catch (const std::exception& e) {
      console_.warning(fmt::format("the results could not be written: {}", e.what()));
    }
  }

  jam::Analysis write_results() {
    const jam::Analysis analysis = pipeline_.finish(series_);
    RunFacts facts = facts_of_this_process(options_.command_line);
    facts.name = file_.physics.name;
    facts.description = file_.physics.description;
    facts.inputs = {options_.case_path};
    facts.threads = options_.threads;
    facts.wall_seconds = seconds_since(begin_);
    facts.particle_steps_per_second = speed();
    facts.warnings = file_.warnings;
    jam::write_xdmf(folder_ / "run.xdmf", folder_ / "run.h5");
    const jam::SnapshotSource stored = jam::open_jamscope_file(snapshots());
    write_outputs(folder_.string(), info_, analysis, series_, facts, &stored, snapshots());
    return analysis;
  }

  double time() const { return simulation_->time(); }
  const jam::RunInfo& info() const { return info_; }
  std::string energy() const { return energy_text(info_, series_); }

 private:
  std::string snapshots() const { return (folder_ / "run.h5").string(); }
  std::string restart() const { return (folder_ / "run.restart.h5").string(); }

  void record_frame() {
    const auto frame = std::make_shared<const jam::Snapshot>(snapshot(simulation_->view()));
    append_open(pending_, simulation_->excursions());
    if (!pending_.excursion_count.empty()) append_open(series_, simulation_->excursions());
    writer_->append(*frame, pending_);
    pending_ = jam::Series{};
    host_.compute([&] { pipeline_.add(*frame); });
    if (on_frame_ && !on_frame_(frame, pipeline_.frames() - 1, info_)) go_on_ = false;
  }

  void begin_capture(std::optional<std::uint64_t> last_step) {
    if (file_.physics.output.capture.interval > 0) capture_.emplace(folder_ / "capture.h5", info_, file_.physics.output.capture, last_step);
  }

  // Was a grain jammed at some step after `before`?
  void offer_to_capture(std::uint64_t before) {
    const auto& ended = simulation_->ended_excursions();
    const bool jammed = !simulation_->excursions().empty() || ended_since_ > before ||
                        std::any_of(ended.begin(), ended.end(), [before](const dem::Excursion& e) { return e.last_step > before; });
    capture_->offer(snapshot(simulation_->view()), jammed);
  }

  void save() { write_checkpoint(restart(), {simulation_->state(), pending_, sha_}); }

  double speed() const {
    return double(simulation_->step() - first_step_) * double(simulation_->particles().size()) / seconds_since(begin_);
  }

  Progress progress(double end) const {
    Progress p;
    // Not assigned from literals: GCC 12 then warns of overlapping copies (its bug 105329).
    p.stage = std::string("simulate");
    p.unit = std::string("s");
    p.done = simulation_->time();
    p.total = end;
    p.step = simulation_->step();
    p.particle_steps_per_second = speed();
    p.steps_per_second = p.particle_steps_per_second / double(simulation_->particles().size());
    p.contacts = simulation_->contacts();
    p.largest_overlap = largest_overlap_;
    p.largest_force = largest_force_;
    p.jammed = jammed_;
    p.events = pipeline_.events_so_far();
    return p;
  }

  const SimulateOptions& options_;
  const CaseFile& file_;
  Console& console_;
  const Host& host_;
  const OnFrame& on_frame_;
  bool go_on_ = true;  // says the one who sees the frames
  std::filesystem::path folder_;
  std::string sha_;
  dem::Scene scene_;
  jam::RunInfo info_;
  jam::Pipeline pipeline_;
  std::optional<jam::SnapshotWriter> writer_;
  std::optional<dem::Simulation> simulation_;
  std::optional<Capture> capture_;
  std::uint64_t ended_since_ = 0;  // last step of the excursion that ended last
  jam::Series series_, pending_;  // of the whole run; since the last frame
  double largest_overlap_ = 0, largest_force_ = 0;
  std::uint32_t jammed_ = 0;
  std::uint64_t first_step_ = 0;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace

SimulateResult run_simulation(const SimulateOptions& options, const CaseFile& file, Console& console, const Host& host, const OnFrame& on_frame) {
  omp_set_num_threads(std::max(options.threads, 1));
  Run run(options, file, console, host, on_frame);
  try {
    if (options.resume) {
      run.resume();
    } else {
      if (!options.overwrite && run.can_resume())
        throw UsageError(options.output + " holds a run: --resume to go on with it, or --overwrite to begin again and lose it");
      prepare_folder(options.output, options.overwrite);
      run.begin();
    }
    const bool whole = run.advance();
    jam::Analysis analysis = run.write_results();
    return {whole, run.time(), run.info(), std::move(analysis), run.energy()};
  } catch (const dem::PhysicsError&) {
    run.keep_what_there_is();
    throw;
  }
}

int simulate(const SimulateOptions& options) {
  Console console(stderr, options.log_format, options.quiet);
  const CaseFile file = read_case_file(options.case_path, options.overrides);
  for (const std::string& warning : file.warnings) console.warning(warning);
  catch_stop_signals();
  try {
    const SimulateResult result = run_simulation(options, file, console);
    if (!options.quiet) {
      if (!result.whole)
        fmt::print("stopped at t = {:.6g} s; the same command with --resume goes on from there\n", result.time);
      fmt::print("{}{}results in {}, report in {}\n", result_text(result.analysis), result.energy, options.output,
                 (std::filesystem::path(options.output) / "report.html").string());
    }
    return 0;
  } catch (const Interrupted&) {
    console.note("interrupted while the bed was settling; nothing was simulated yet");
    return 0;
  }
}

}  // namespace jamscope
