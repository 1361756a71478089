// TABLE of the contact laws that a run can choose from. To add one: write its part as a header in normal/, tangential/ or
// rolling/ (a struct with `name` and `evaluate`, checked by the concepts in law.hpp), include it here and add a row. The law
// tests run over the rows.
#pragma once
#include <tuple>

#include "libdem/contact/law.hpp"
#include "libdem/contact/normal/hertz.hpp"
#include "libdem/contact/normal/jkr.hpp"
#include "libdem/contact/rolling/constant_torque.hpp"
#include "libdem/contact/tangential/mindlin.hpp"

namespace dem {

using ContactLaws = std::tuple<                     //
    ContactLaw<Jkr, Mindlin, ConstantTorque>,       //
    ContactLaw<Hertz, Mindlin, ConstantTorque>>;

}  // namespace dem
