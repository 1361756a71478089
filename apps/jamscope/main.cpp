#include "apps/jamscope/cli.hpp"

int main(int argc, char** argv) {
  return jamscope::run_command_line(argc, argv);
}
