// What libdem throws. CaseError at its gate; PhysicsError when a run cannot go on.
#pragma once
#include <stdexcept>
#include <string>

namespace dem {

// A case that cannot be simulated: what is wrong, with value, unit and what was expected.
struct CaseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A mesh that is not a closed, outward-oriented surface, or a wall that touches another one.
struct GeometryError : CaseError {
  using CaseError::CaseError;
};

// The physics stopped the run: a NaN, a runaway overlap, a lost grain. Names grain, time and likely cause.
struct PhysicsError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace dem
