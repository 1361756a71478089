// The tables of network metrics: a new row of libjam/metrics/metrics.cpp is here for nothing.
#include <pybind11/stl.h>

#include "apps/jamscope/network_metrics.hpp"
#include "apps/python/arrays.hpp"
#include "apps/python/bindings.hpp"
#include "libjam/metrics/metrics.hpp"

namespace jamscope::python {
namespace {

// A row of a table, as text.
struct MetricInfo {
  std::string of, name, unit, doc, undefined;
  bool low_cost;
};

template <class Row>
MetricInfo info(const char* of, const Row& row) {
  return {of, std::string(row.name), std::string(row.unit), std::string(row.doc), std::string(row.undefined), row.cost == jam::Cost::low};
}

template <class Row>
std::vector<MetricInfo> infos(const char* of, std::span<const Row> rows) {
  std::vector<MetricInfo> all;
  for (const Row& row : rows) all.push_back(info(of, row));
  return all;
}

std::vector<MetricInfo> metric_table(const std::string& of) {
  if (of == "frames") return infos("frames", jam::metrics());
  if (of == "changes") return infos("changes", jam::change_metrics());
  if (of == "particles") return infos("particles", jam::particle_metrics());
  if (of == "contacts") return infos("contacts", jam::contact_metrics());
  throw py::value_error("of = '" + of + "', expected frames, changes, particles or contacts");
}

template <class Row>
bool has(std::span<const Row> rows, const std::string& name) {
  return std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
}

// Without the interpreter's lock: some take minutes.
template <class Row>
auto value_of(Frame& frame, const Row& row) {
  const py::gil_scoped_release unlocked;
  const std::scoped_lock lock(frame.mutex);
  return row.value(frame.network());
}

py::object metric(Frame& frame, const std::string& name, const std::string& of) {
  if (of == "particles") return owned(value_of(frame, metric_named(jam::particle_metrics(), name)));
  if (of == "contacts") return owned(value_of(frame, metric_named(jam::contact_metrics(), name)));
  if (of == "frames") return py::float_(value_of(frame, metric_named(jam::metrics(), name)));
  throw py::value_error("of = '" + of + "', expected frames, particles or contacts");
}

}  // namespace

void bind_metrics(py::module_& m) {
  py::class_<MetricInfo>(m, "MetricInfo", "What a network metric is.")
      .def_readonly("of", &MetricInfo::of, "frames, changes, particles or contacts")
      .def_readonly("name", &MetricInfo::name, "Its name.")
      .def_readonly("unit", &MetricInfo::unit, "Its unit; 1 for pure numbers.")
      .def_readonly("doc", &MetricInfo::doc, "What it is, in a line.")
      .def_readonly("undefined", &MetricInfo::undefined, "When it is NaN; empty: never.")
      .def_readonly("low_cost", &MetricInfo::low_cost, "Does it take up to a tenth of a second for 35,000 particles?")
      .def("__repr__", [](const MetricInfo& i) { return "<jamscope.MetricInfo " + i.name + " [" + i.unit + "]: " + i.doc + ">"; });
  m.def("metric_table", &metric_table, py::arg("of") = "frames", "All metrics of frames, changes, particles or contacts.");

  py::class_<Frame, std::shared_ptr<Frame>> frame = m.attr("Frame");
  frame.def(
      "metric",
      [](Frame& f, const std::string& name, const std::optional<std::string>& of) {
        if (of) return metric(f, name, *of);
        if (!has(jam::metrics(), name)) {
          const bool of_particles = has(jam::particle_metrics(), name), of_contacts = has(jam::contact_metrics(), name);
          if (of_particles && of_contacts) throw UsageError("there is a metric '" + name + "' of particles and one of contacts; say which: of=\"particles\" or of=\"contacts\"");
          if (of_particles) return metric(f, name, "particles");
          if (of_contacts) return metric(f, name, "contacts");
        }
        return metric(f, name, "frames");
      },
      py::arg("name"), py::arg("of") = py::none(),
      "A network metric by its name: a number, or [N] one for each particle, or [C] one for each contact of two particles. NaN where it is not defined. `of`, \"frames\", "
      "\"particles\" or \"contacts\", where several have one of that name. jamscope.metrics.table() says what there is.");
  frame.def(
      "metrics",
      [](Frame& f, const std::optional<std::vector<std::string>>& names, const std::string& of) {
        py::dict values;
        if (names) {
          for (const std::string& name : *names) values[name.c_str()] = metric(f, name, of);
        } else {
          for (const MetricInfo& row : metric_table(of))
            if (row.low_cost) values[row.name.c_str()] = metric(f, row.name, of);
        }
        return values;
      },
      py::arg("names") = py::none(), py::arg("of") = "frames", "Several metrics of \"frames\", \"particles\" or \"contacts\" by name; without names those that take no time.");
  frame.def(
      "change",
      [](const std::shared_ptr<Frame>& now, const std::shared_ptr<Frame>& before, const std::string& name) {
        const jam::ChangeMetric& row = metric_named(jam::change_metrics(), name);
        const py::gil_scoped_release unlocked;
        if (now == before) {
          const std::scoped_lock lock(now->mutex);
          return row.value(now->network(), now->network());
        }
        const std::scoped_lock lock(now->mutex, before->mutex);
        return row.value(before->network(), now->network());
      },
      py::arg("before"), py::arg("name"), "A metric of the change from the frame `before` to this one.");
}

}  // namespace jamscope::python
