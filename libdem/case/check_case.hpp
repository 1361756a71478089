// The gate of libdem: what must hold for a case to be simulated.
#pragma once
#include <string>
#include <vector>

#include "libdem/case/case.hpp"
#include "libdem/case/derived.hpp"

namespace dem {

struct CaseProblem {
  bool fatal = true;  // false: the run is possible but its result may not be what was meant
  std::string key;    // the member that is to blame, "bed.size_low"; materials and pairs as "material.glass.young" and
                      // "interaction.glass-steel.friction"
  std::string message;  // begins with a verb, the key being its subject: "must be positive, got -1 m"
};

// Everything that is wrong with the case, in the order of the struct. No exception: a caller that knows where each key
// came from can say so. tip: tip radius, m; where it is 0 (a mesh that nobody measured) the fit is not looked at.
std::vector<CaseProblem> case_problems(const Case& c, double tip);
inline std::vector<CaseProblem> case_problems(const Case& c) {
  return case_problems(c, tip_radius(c));
}

// Throws CaseError with the first fatal problem; returns the others as text.
std::vector<std::string> check_case(const Case& c);

}  // namespace dem
