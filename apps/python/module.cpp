// The compiled part of the Python module, jamscope._core. What users import is jamscope/__init__.py.
#include <omp.h>

#include <algorithm>
#include <thread>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/units.hpp"
#include "apps/jamscope/version.hpp"
#include "apps/python/bindings.hpp"
#include "libdem/errors.hpp"
#include "libjam/errors.hpp"

namespace jamscope::python {
namespace {

// The classes of exceptions live as long as the process.
struct Classes {
  PyObject *error, *data, *case_, *geometry, *criteria, *physics, *usage;
};
Classes classes{};

PyObject* exception(py::module_& m, const char* name, const char* doc, PyObject* base) {
  PyObject* const made = PyErr_NewExceptionWithDoc((std::string("jamscope.") + name).c_str(), doc, base, nullptr);
  if (made == nullptr) throw py::error_already_set();
  m.attr(name) = py::handle(made);
  return made;
}

}  // namespace

void bind_errors(py::module_& m) {
  classes.error = exception(m, "Error", "What jamscope raises.", PyExc_Exception);
  classes.data = exception(m, "DataError", "A file that cannot be read or written, or is not what it claims to be: FILE[:PLACE]: problem, expected ...", classes.error);
  classes.case_ = exception(m, "CaseError", "A case that cannot be simulated: each problem with file, line and column, value and what was expected.", classes.error);
  classes.geometry = exception(m, "GeometryError", "A mesh that is no closed surface, or a wall that touches another one.", classes.case_);
  classes.criteria = exception(m, "CriteriaError", "Options of an analysis that contradict each other or the data.", classes.error);
  classes.physics = exception(m, "PhysicsError", "The physics stopped a run: a NaN, a runaway overlap, a lost grain. What there is of it is on the disk.", classes.error);
  classes.usage = exception(m, "UsageError", "A call that cannot be carried out as given: an unknown name, a folder that holds an earlier run.", classes.error);
  py::register_exception_translator([](std::exception_ptr pointer) {
    const auto raise = [](PyObject* type, const std::exception& e) { PyErr_SetString(type, e.what()); };
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const jam::DataError& e) {
      raise(classes.data, e);
    } catch (const dem::GeometryError& e) {
      raise(classes.geometry, e);
    } catch (const dem::CaseError& e) {
      raise(classes.case_, e);
    } catch (const jam::CriteriaError& e) {
      raise(classes.criteria, e);
    } catch (const dem::PhysicsError& e) {
      raise(classes.physics, e);
    } catch (const UsageError& e) {
      raise(classes.usage, e);
    } catch (const UnitError& e) {
      raise(classes.usage, e);
    }
  });
}

Host python_host(std::optional<py::error_already_set>& raised) {
  Host host;
  host.stop = [&raised] {
    const py::gil_scoped_acquire lock;
    if (!raised && PyErr_CheckSignals() != 0) raised.emplace();
    return raised.has_value();
  };
  host.compute = [](const std::function<void()>& work) {
    const py::gil_scoped_release unlocked;
    work();
  };
  return host;
}

KeepThreads::KeepThreads() : before_(omp_get_max_threads()) {}
KeepThreads::~KeepThreads() { omp_set_num_threads(before_); }

int thread_count(int threads) {
  if (threads < 0) throw UsageError("threads = " + std::to_string(threads) + ", expected 0 (all processors) or more");
  return threads > 0 ? threads : int(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace jamscope::python

PYBIND11_MODULE(_core, m) {
  using namespace jamscope::python;
  m.doc() = "The compiled part of jamscope.";
  m.attr("__version__") = jamscope::version;
  m.attr("commit") = jamscope::commit;
  bind_errors(m);
  bind_run(m);
  bind_graph(m);
  bind_metrics(m);
  bind_statistics(m);
  bind_analysis(m);
  bind_simulate(m);
}
