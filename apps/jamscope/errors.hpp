// What only the program can get wrong.
#pragma once
#include <stdexcept>

namespace jamscope {

// A command that cannot be carried out as given: exit code 2, like a case error.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace jamscope
