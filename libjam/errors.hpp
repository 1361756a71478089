// What libjam throws, and only at its gates: reading a file, writing a file, checking criteria.
#pragma once
#include <stdexcept>
#include <string>

namespace jam {

// A file that cannot be read or is not what it claims to be. what() reads "FILE[:PLACE]: problem, expected ...".
struct DataError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Analysis options that contradict each other or the data (a wall role that no wall has, a negative threshold).
struct CriteriaError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace jam
