#include <unistd.h>

#include <cstdlib>

#include "apps/jamscope/cli.hpp"

namespace {

// A thread that waits for the others spins 300,000 times by default (GNU's OpenMP): 14 ms where a pause takes 140 cycles, a thousand times
// the time of a step. Where another program wants the core, its owner then spins away what the other needs. The count is read when the
// program is loaded, so it takes a second start. Measured: libdem/simulation/SPEED.md.
void wait_briefly(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  if (setenv("GOMP_SPINCOUNT", "2000", 1) != 0) return;
  execv("/proc/self/exe", argv);  // comes back only if it failed, and then all is as before
}

}  // namespace

int main(int argc, char** argv) {
  wait_briefly(argv);
  return jamscope::run_command_line(argc, argv);
}
