#include <malloc.h>
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

// Frames come one after the other, and each takes and frees the same arrays. GNU's allocator gives large ones back to the system each time,
// which then clears their pages anew: 12 % of an analysis. Here they are kept.
void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // bytes; the most it takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace

int main(int argc, char** argv) {
  wait_briefly(argv);
  keep_freed_memory();
  return jamscope::run_command_line(argc, argv);
}
