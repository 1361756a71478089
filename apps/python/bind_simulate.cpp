// A simulation run from Python, with the very code of `jamscope simulate`.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "apps/jamscope/checkpoint.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/settled_bed.hpp"
#include "apps/jamscope/simulate.hpp"
#include "apps/jamscope/units.hpp"
#include "apps/python/arrays.hpp"
#include "apps/python/bindings.hpp"
#include "libdem/errors.hpp"

namespace jamscope::python {
namespace {

struct Simulated {
  bool finished;
  double time;
  std::string output;
  std::shared_ptr<AnalysedRun> analysis;
};

Simulated simulate_case(const std::string& case_path, const std::string& output, const py::object& callback, const std::optional<std::string>& until, int threads, bool resume,
                        bool overwrite, const std::vector<std::string>& overrides, const std::optional<std::string>& bed_cache, bool quiet, const std::vector<std::string>& command_line) {
  SimulateOptions options;
  options.case_path = case_path;
  options.output = output;
  options.threads = thread_count(threads);
  options.resume = resume;
  if (until) options.until = to_si(*until, dimension::time);
  options.overrides = overrides;
  options.bed_cache = bed_cache ? *bed_cache : default_bed_cache();
  options.quiet = quiet;
  options.overwrite = overwrite;
  options.command_line = command_line;
  const CaseFile file = read_case_file(case_path, overrides);
  for (const std::string& warning : file.warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 2) != 0) throw py::error_already_set();

  // What Python raises meanwhile stops the run as a signal would, so that the checkpoint and the results so far are written, and goes on from there.
  std::optional<py::error_already_set> raised;
  const Host host = python_host(raised);
  std::shared_ptr<const jam::RunInfo> run;
  const OnFrame on_frame = [&](const std::shared_ptr<const jam::Snapshot>& snapshot, std::size_t number, const jam::RunInfo& info) {
    if (callback.is_none() || raised) return true;
    if (!run) run = std::make_shared<const jam::RunInfo>(info);
    auto frame = std::make_shared<Frame>();
    frame->run = run;
    frame->snapshot = snapshot;
    frame->number = number;
    try {
      return !callback(std::move(frame)).is(py::handle(Py_False));
    } catch (py::error_already_set& error) {
      raised.emplace(std::move(error));
      return false;
    }
  };
  const KeepThreads keep;
  Console console(stderr, LogFormat::text, quiet);
  try {
    SimulateResult result = run_simulation(options, file, console, host, on_frame);
    if (raised) throw py::error_already_set(std::move(*raised));
    auto analysis = std::make_shared<AnalysedRun>();
    analysis->analysis = std::move(result.analysis);
    analysis->run = std::make_shared<const jam::RunInfo>(std::move(result.info));
    return {result.whole, result.time, output, std::move(analysis)};
  } catch (const Interrupted&) {
    throw py::error_already_set(std::move(raised.value()));
  }
}

}  // namespace

void bind_simulate(py::module_& m) {
  py::class_<Simulated>(m, "Simulated", "What became of a simulation.")
      .def_readonly("finished", &Simulated::finished, "Was the end, or `until`, reached? Else it was stopped, and resume=True goes on from there.")
      .def_readonly("time", &Simulated::time, "s, that was reached")
      .def_readonly("output", &Simulated::output, "Folder of all results.")
      .def_readonly("analysis", &Simulated::analysis, "The analysis of its frames and steps.")
      .def("__repr__", [](const Simulated& s) { return fmt::format("<jamscope.Simulated to {:.6g} s in {}>", s.time, s.output); });
  m.def("simulate_case", &simulate_case, py::arg("case"), py::arg("output"), py::arg("callback"), py::arg("until"), py::arg("threads"), py::arg("resume"), py::arg("overwrite"),
        py::arg("overrides"), py::arg("bed_cache"), py::arg("quiet"), py::arg("command_line"), "See jamscope.simulate.");
  m.def(
      "check_case", [](const std::string& path, const std::vector<std::string>& overrides) { return read_case_file(path, overrides).warnings; }, py::arg("path"), py::arg("overrides"),
      "See jamscope.check.");
}

}  // namespace jamscope::python
