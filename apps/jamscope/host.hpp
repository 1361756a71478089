// What the long tasks ask of the program that they run in: by default the command line's, or a language with a lock and signals of its own.
#pragma once
#include <functional>

#include "apps/jamscope/console.hpp"

namespace jamscope {

struct Host {
  // Should the task end early? Asked between steps, and while a bed settles.
  std::function<bool()> stop = stop_requested;
  // Does what it is given, the long parts of a task, which touch no file: HDF5 does one thing at a time in a process, so that a host that
  // reads files of its own holds its lock at all other times.
  std::function<void(const std::function<void()>&)> compute = [](const std::function<void()>& work) { work(); };
};

}  // namespace jamscope
