// The analysis of a run and its results. Tables are structured arrays over libjam's own structs; their columns are those of result files
// (libjam/results_tables.hpp), so a new one is here for nothing.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "apps/jamscope/analyze.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/python/arrays.hpp"
#include "apps/python/bindings.hpp"
#include "libjam/errors.hpp"
#include "libjam/results_file.hpp"
#include "libjam/results_tables.hpp"

namespace jamscope::python {
namespace {

using Analysed = std::shared_ptr<AnalysedRun>;

// Unit and meaning of each column of a table.
template <class Struct>
py::dict columns() {
  py::dict all;
  jam::columns_of(static_cast<Struct*>(nullptr), [&](const char* name, auto, const char* unit, const char* doc) { all[name] = py::make_tuple(unit, doc); });
  return all;
}

py::dict columns_named(const std::string& name) {
  if (name == "frames") return columns<jam::FrameSummary>();
  if (name == "clusters") return columns<jam::Cluster>();
  if (name == "cluster_links") return columns<jam::ClusterLink>();
  if (name == "events" || name == "cluster_events") return columns<jam::JamEvent>();
  if (name == "tracks") {
    py::dict all;
    all["particle"] = py::make_tuple("1", "id of the particle");
    all.attr("update")(columns<jam::JamEvent>());
    return all;
  }
  if (name == "track_points") return columns<jam::Track::Point>();
  if (name == "step_jams") return columns<jam::StepJam>();
  if (name == "survival_classes") return columns<jam::SurvivalClass>();
  if (name == "contact_life") return columns<jam::ContactLifeRow>();
  if (name == "flow_pattern") return columns<jam::FlowBin>();
  throw py::value_error("there is no table '" + name + "', expected frames, clusters, cluster_links, events, cluster_events, tracks, track_points, step_jams, survival_classes, contact_life or flow_pattern");
}

template <class Rows>
const auto& row_of(const Rows& rows, std::ptrdiff_t row, const char* what) {
  const auto n = std::ptrdiff_t(rows.size());
  if (row < -n || row >= n) throw py::index_error(fmt::format("there is no row {} of {}: there are {}", row, what, n));
  return rows[std::size_t(row < 0 ? row + n : row)];
}

// A table, or another array, of the analysis.
template <class Get>
auto array_of(Get get) {
  return [get](const py::object& self) -> py::array { return get(self.cast<const AnalysedRun&>().analysis, self); };
}

template <class Struct>
auto members_of(std::vector<Struct> jam::Analysis::*rows, const char* what) {
  return [rows, what](const py::object& self, std::ptrdiff_t row) { return view(row_of(self.cast<const AnalysedRun&>().analysis.*rows, row, what).members, self); };
}

const std::vector<jam::Analysis::StepStream>& with_statistics(AnalysedRun& a) {
  if (!a.statistics_stored && !a.analysis.frames.empty()) {
    for (jam::Analysis::StepStream& stream : a.analysis.every_step)
      stream.statistics = jam::jam_statistics(stream.jams, a.analysis.frames.front().time, a.analysis.frames.back().time);
  }
  a.statistics_stored = true;
  return a.analysis.every_step;
}

std::size_t stream_named(const AnalysedRun& a, const std::string& name) {
  for (std::size_t s = 0; s < std::size(jam::jam_stream_names); ++s) {
    if (jam::jam_stream_names[s] != name) continue;
    if (s >= a.analysis.every_step.size()) throw UsageError("the run did not watch its particles at every step");
    return s;
  }
  throw py::value_error("stream '" + name + "', expected global, particle or site");
}

std::string measure_name(jam::CompressiveMeasure measure) {
  switch (measure) {
    case jam::CompressiveMeasure::sum: return "sum";
    case jam::CompressiveMeasure::max: return "max";
    case jam::CompressiveMeasure::signed_: break;
  }
  return "signed";
}

Analysed analyze_run(const std::shared_ptr<Run>& run, const std::vector<std::string>& overrides, const std::string& criteria_file,
                     std::optional<std::pair<std::size_t, std::size_t>> frames, int threads) {
  const jam::Criteria criteria = stored_run_criteria(*run->info, criteria_file, overrides);
  const jam::Pipeline pipeline(*run->info, criteria);
  const FrameRange range{frames ? frames->first : 0, frames ? frames->second : run->source.frames};
  if (range.last > run->source.frames || range.first >= range.last)
    throw UsageError(fmt::format("frames = ({}, {}), expected the first below the second and that at most {}, the number of frames", range.first, range.last, run->source.frames));
  const KeepThreads keep;
  auto analysed = std::make_shared<AnalysedRun>();
  {
    const py::gil_scoped_release unlocked;
    const jam::PartialAnalysis part = examine_frames(run->source, pipeline, range, thread_count(threads), [](const jam::FrameSummary&) {
      const py::gil_scoped_acquire lock;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
    analysed->analysis = jam::finish(part);
  }
  analysed->run = run->info;
  return analysed;
}

void bind_values(py::module_& m) {
  py::class_<jam::Criteria>(m, "Criteria", "Every threshold and choice of an analysis.")
      .def_property_readonly("measure", [](const jam::Criteria& c) { return measure_name(c.measure); }, "How contacts add up to a compressive force: sum, max or signed.")
      .def_readonly("criterion", &jam::Criteria::criterion, "What jammed means.")
      .def_readonly("threshold", &jam::Criteria::threshold, "Of the criterion, in its unit; None: its own. Of compressive_force it is jam_force.")
      .def_readonly("jam_force", &jam::Criteria::jam_force, "N, a particle is jammed above this compressive force")
      .def_readonly("end_force", &jam::Criteria::end_force, "N, jams last until the force falls back to it; None: jam_force")
      .def_readonly("hold_off", &jam::Criteria::hold_off, "s, pauses up to it do not end a jam")
      .def_readonly("shortest_jam", &jam::Criteria::shortest_jam, "s, shorter ones do not count")
      .def_readonly("bridge_contact_share", &jam::Criteria::bridge_contact_share, "1, of jam_force: contacts above it carry the load")
      .def_readonly("gap_margin", &jam::Criteria::gap_margin, "1, particle diameters inside the tip circle that count as gap")
      .def_readonly("survival_classes", &jam::Criteria::survival_classes, "s, upper bounds of the survival-time classes")
      .def_readonly("metrics", &jam::Criteria::metrics, "Metrics recorded for each frame; None: those of low cost.");

  py::class_<jam::FlowEnergy>(m, "FlowEnergy", "Work that the blades do on the particles.")
      .def_readonly("source", &jam::FlowEnergy::source, "series (step-averaged), frames or contacts (sampled), or none")
      .def_property_readonly("time", [](const py::object& self) { return view(self.cast<const jam::FlowEnergy&>().time, self); }, "s, end of the window, or time of the frame")
      .def_property_readonly("power", [](const py::object& self) { return view(self.cast<const jam::FlowEnergy&>().power, self); }, "W, that the blades put into the particles")
      .def_property_readonly("energy", [](const py::object& self) { return view(self.cast<const jam::FlowEnergy&>().energy, self); }, "J, work done up to this time")
      .def_readonly("total", &jam::FlowEnergy::total, "J");

  py::class_<jam::LawFit>(m, "LawFit", "A law of durations fitted to jams.")
      .def_readonly("name", &jam::LawFit::name, "See jamscope.statistics.duration_laws().")
      .def_property_readonly("parameters", [](const jam::LawFit& f) { return std::vector<double>(f.fit.parameter.begin(), f.fit.parameter.begin() + jam::find_duration_law(f.name)->parameters); }, "In the order of the law's doc.")
      .def_property_readonly("log_likelihood", [](const jam::LawFit& f) { return f.fit.log_likelihood; }, "Of the durations.")
      .def_readonly("akaike", &jam::LawFit::akaike, "2 parameters - 2 log-likelihood: smaller explains more");

  py::class_<jam::JamStatistics>(m, "JamStatistics", "What the jams of one stream say in all.")
      .def_readonly("rate", &jam::JamStatistics::rate, "1/s, of jams that began in the record, if they come independently")
      .def_readonly("jammed_time", &jam::JamStatistics::jammed_time, "s, summed durations")
      .def_readonly("at_a_time", &jam::JamStatistics::at_a_time, "jams at a time in the mean: jammed_time over the length of the record")
      .def_readonly("longest", &jam::JamStatistics::longest, "s")
      .def_readonly("survival", &jam::JamStatistics::survival, "Of those that began in the record; those still there at its end are cut off.")
      .def_readonly("median", &jam::JamStatistics::median, "s, of the survival")
      .def_readonly("fano", &jam::JamStatistics::fano, "1 where jams come independently, more in bursts; of the counts in 20 windows")
      .def_readonly("independence", &jam::JamStatistics::independence, "Are the distances of starts exponential?")
      .def_readonly("laws", &jam::JamStatistics::laws, "Laws of durations fitted to them; empty for fewer than ten jams.");
}

}  // namespace

void bind_analysis(py::module_& m) {
  bind_values(m);
  py::class_<AnalysedRun, Analysed> c(m, "Analysis",
                                      "What jammed in a run, when and how. Tables are structured NumPy arrays, read-only views of the results; Analysis.columns(TABLE) says what "
                                      "their columns are and in which units.");
  c.def_property_readonly("criteria", [](const AnalysedRun& a) -> const jam::Criteria& { return a.analysis.criteria; }, "Thresholds and choices.");
  jam::scalars_of(static_cast<jam::Analysis*>(nullptr), [&](const char* name, double jam::Analysis::*member, const char* unit, const char* doc) {
    c.def_property_readonly(name, [member](const AnalysedRun& a) { return a.analysis.*member; }, fmt::format("{}, {}", unit, doc).c_str());
  });
  c.def_property_readonly("frames", array_of([](const jam::Analysis& a, py::handle self) { return table(a.frames, self); }), "One row per frame.");
  c.def_property_readonly(
      "metrics",
      [](const py::object& self) {
        py::dict all;
        for (const jam::RecordedMetric& metric : self.cast<const AnalysedRun&>().analysis.metrics) all[metric.name.c_str()] = view(metric.values, self);
        return all;
      },
      "[F] of each network metric that was recorded, by name; NaN where it is not defined.");
  c.def_property_readonly("clusters", array_of([](const jam::Analysis& a, py::handle self) { return table(a.clusters, self); }), "Connected jammed particles, by frame, then the largest first.");
  c.def("cluster_members", members_of(&jam::Analysis::clusters, "clusters"), py::arg("row"), "Ids of the particles of a cluster, ascending.");
  c.def_property_readonly("cluster_identity", array_of([](const jam::Analysis& a, py::handle self) { return view(a.lineage.identity, self); }), "[clusters] row of `cluster_events`: clusters of one identity are one through time.");
  c.def_property_readonly("cluster_links", array_of([](const jam::Analysis& a, py::handle self) { return table(a.lineage.links, self); }), "Which cluster of a frame became which of the next.");
  c.def_property_readonly("cluster_events", array_of([](const jam::Analysis& a, py::handle self) { return table(a.cluster_events, self); }), "The cluster stream: each identity from its first to its last frame.");
  c.def("cluster_event_members", members_of(&jam::Analysis::cluster_events, "cluster_events"), py::arg("row"), "Ids of all particles that were in it.");
  c.def_property_readonly("events", array_of([](const jam::Analysis& a, py::handle self) { return table(a.events, self); }), "The global stream: uninterrupted times in which some particle is jammed, as frames see them.");
  c.def("event_members", members_of(&jam::Analysis::events, "events"), py::arg("row"), "Ids of all particles jammed during the event.");
  c.def_property_readonly(
      "tracks",
      array_of([](const jam::Analysis& a, py::handle self) {
        const jam::Track sample{};
        const auto offset = std::size_t(reinterpret_cast<const char*>(&sample.event) - reinterpret_cast<const char*>(&sample));
        return table<jam::JamEvent>(a.tracks, self, offset, [](Columns& more) { more.add("particle", &jam::Track::particle); });
      }),
      "The particle stream: each particle's own stays above the threshold, as frames see them.");
  c.def(
      "track_points",
      [](const py::object& self, std::ptrdiff_t row) { return table(row_of(self.cast<const AnalysedRun&>().analysis.tracks, row, "tracks").points, self); },
      py::arg("row"), "Frames, positions, velocities and forces along a track.");
  c.def_property_readonly(
      "step_jams",
      [](const py::object& self) {
        py::dict all;
        const auto& a = self.cast<const AnalysedRun&>();
        for (std::size_t s = 0; s < a.analysis.every_step.size(); ++s) all[py::str(std::string(jam::jam_stream_names[s]))] = table(a.analysis.every_step[s].jams, self);
        return all;
      },
      "Jams as every step of the run saw them, by stream: global, particle, site. Empty where the run did not watch its particles.");
  c.def(
      "step_jam_members",
      [](const py::object& self, const std::string& stream, std::ptrdiff_t row) {
        const auto& a = self.cast<const AnalysedRun&>();
        return view(row_of(a.analysis.every_step[stream_named(a, stream)].jams, row, "step_jams").members, self);
      },
      py::arg("stream"), py::arg("row"), "Ids of the particles of a jam.");
  c.def(
      "step_statistics", [](AnalysedRun& a, const std::string& stream) -> const jam::JamStatistics& { return with_statistics(a)[stream_named(a, stream)].statistics; }, py::arg("stream") = "global",
      py::return_value_policy::reference_internal, "Rate, survival, tests and fits of the jams of a stream of `step_jams`.");
  c.def_property_readonly("survival_classes", array_of([](const jam::Analysis& a, py::handle self) { return table(a.survival_classes, self); }), "Global events by survival time.");
  c.def_property_readonly("jammed_histogram", array_of([](const jam::Analysis& a, py::handle self) { return view(a.jammed_histogram, self); }), "[n] frames with n jammed particles");
  c.def_property_readonly(
      "contact_life",
      array_of([](const jam::Analysis& a, py::handle) {
        auto* const rows = new std::vector<jam::ContactLifeRow>(jam::rows_of(a.contact_life));
        return table(*rows, py::capsule(rows, [](void* memory) { delete static_cast<std::vector<jam::ContactLifeRow>*>(memory); }));
      }),
      "How long contacts last, by octaves; empty where the run did not count.");
  c.def_property_readonly("flow_pattern", array_of([](const jam::Analysis& a, py::handle self) { return table(a.flow_pattern, self); }),
                          "Mean velocities around the blade over that of its tip, by distance from its axis and height; empty where they are not known.");
  c.def_property_readonly("flow_energy", [](const AnalysedRun& a) -> const jam::FlowEnergy& { return a.analysis.flow_energy; }, "Work of the blades.");
  c.def_property_readonly("corrected", [](const AnalysedRun& a) -> const jam::ExponentialDurations& { return a.analysis.corrected; }, "What the global events say of all jams, those between frames too.");
  c.def_property_readonly("notes", [](const AnalysedRun& a) { return a.analysis.notes; }, "What could not be computed from this data, and why.");
  c.def("events_csv", [](const AnalysedRun& a) { return jam::events_csv(a.analysis); }, "The events as `jamscope analyze` writes them to events.csv.");
  c.def("step_jams_csv", [](const AnalysedRun& a) { return jam::step_jams_csv(a.analysis); }, "The jams of every step as in jams.csv.");
  c.def(
      "write",
      [](const AnalysedRun& a, const std::string& path) {
        if (!a.run) throw UsageError("this analysis was read from a result file, which does not say all of its run: copy that file");
        jam::write_results(path, a.analysis, *a.run);
      },
      py::arg("path"), "Writes the results as `jamscope analyze` does to jam.h5.");
  c.def_static("columns", &columns_named, py::arg("table"), "Unit and meaning of each column of a table, by name.");
  c.def("__repr__", [](const AnalysedRun& a) { return fmt::format("<jamscope.Analysis of {} frames: {} jams>", a.analysis.frames.size(), a.analysis.events.size()); });

  m.def("analyze_run", &analyze_run, py::arg("run"), py::arg("overrides"), py::arg("criteria_file") = "", py::arg("frames") = py::none(), py::arg("threads") = 0, "See jamscope.analyze.");
  m.def(
      "read_results",
      [](const std::string& path) {
        auto a = std::make_shared<AnalysedRun>();
        a->analysis = jam::read_results(path);
        a->statistics_stored = false;
        return a;
      },
      py::arg("path"), "Reads jam.h5.");
}

}  // namespace jamscope::python
