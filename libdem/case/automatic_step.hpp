// step = "auto": the steps that a case needs, from its stiffest and its softest contacts.
#pragma once
#include "libdem/case/case.hpp"

namespace dem {

struct StepChoice {
  double step = 0;          // s, of level 0
  std::uint8_t levels = 0;  // contacts that allow it are evaluated every 2^levels steps
  // What they follow from, omega h = 2 accuracy (libdem/contact/levels.hpp, (1)):
  double stiffest = 0;  // s, for a mean grain squeezed in the gap, or by 5 % of its diameter where nothing is squeezed
  double softest = 0;   // s, for a mean grain that rests on another under ten times its weight
};

// The longest steps not above these of which every interval of the case is a whole number of 2^levels. Numbers of the case must
// be positive. Throws CaseError where the bed's material is unknown.
StepChoice choose_steps(const Case& c);

}  // namespace dem
