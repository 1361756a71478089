// The command line.
#pragma once

namespace jamscope {

// Runs one command. Returns the exit code: 0 done; 1 the physics stopped the run; 2 usage or case error; 3 unreadable
// or invalid data, or no memory for it. An error is one message on standard error.
int run_command_line(int argc, const char* const* argv);

}  // namespace jamscope
