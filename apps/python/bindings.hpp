// The parts of the module; each adds its classes and functions. To bind more: a function here, its file beside this one, a line in
// jamscope/_core.pyi (tests/python/test_stubs.py compares them).
#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <optional>

#include "apps/jamscope/host.hpp"
#include "libjam/analysis.hpp"
#include "libjam/metrics/frame_network.hpp"

namespace jamscope::python {

namespace py = pybind11;

// A frame with its network, which is made when it is first asked for, as are the numbers that several metrics need.
struct Frame {
  std::shared_ptr<const jam::RunInfo> run;
  std::shared_ptr<const jam::Snapshot> snapshot;
  std::size_t number = 0;  // in its run
  std::optional<jam::ContactGraph> made_graph;
  std::once_flag graph_once;
  std::optional<jam::FrameNetwork> made_network;
  std::mutex mutex;  // of the network; only taken without the interpreter's lock

  const jam::ContactGraph& graph();
  jam::FrameNetwork& network();  // only while `mutex` is held
};

// A stored run. Frames are read when they are asked for.
struct Run {
  jam::SnapshotSource source;
  std::shared_ptr<const jam::RunInfo> info;
};

// An analysis and what the run was.
struct AnalysedRun {
  jam::Analysis analysis;
  std::shared_ptr<const jam::RunInfo> run;  // null: of a result file
  bool statistics_stored = true;            // result files hold the jams of every step, not what they say in all
};

void bind_errors(py::module_& m);
void bind_run(py::module_& m);
void bind_graph(py::module_& m);
void bind_metrics(py::module_& m);
void bind_analysis(py::module_& m);
void bind_statistics(py::module_& m);
void bind_simulate(py::module_& m);

// Stops where Python has a signal to deal with (Ctrl-C); what its handler raised is left in `raised`. Lets go of the interpreter's lock while it
// computes.
Host python_host(std::optional<py::error_already_set>& raised);

// OpenMP's number of threads is one of the calling thread; the libraries set it, and a guest puts it back.
class KeepThreads {
 public:
  KeepThreads();
  ~KeepThreads();
  KeepThreads(const KeepThreads&) = delete;
  KeepThreads& operator=(const KeepThreads&) = delete;

 private:
  int before_;
};

// `threads`, or as many as there are processors where it is 0.
int thread_count(int threads);

}  // namespace jamscope::python
