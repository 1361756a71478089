// TABLES of the parts that a contact law is composed of. To add one: write it as a struct in a header of its room (`name` is
// what a case file calls it; the concepts in law.hpp say what else it needs), include it here and add it to its table. Case
// files, help and tests follow the tables; laws_test.cpp runs over every allowed composition.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "libdem/case/case.hpp"
#include "libdem/contact/damping/damping.hpp"
#include "libdem/contact/friction/limits.hpp"
#include "libdem/contact/law.hpp"
#include "libdem/contact/normal/dmt.hpp"
#include "libdem/contact/normal/hertz.hpp"
#include "libdem/contact/normal/jkr.hpp"
#include "libdem/contact/rolling/rolling.hpp"
#include "libdem/contact/tangential/springs.hpp"

namespace dem {

using NormalLaws = std::tuple<Jkr, JkrForceMinimum, JkrNonHysteretic, Hertz, Dmt>;
using DampingLaws = std::tuple<ContactRadiusDamping, OverlapDamping, TsujiDamping>;
using FrictionLimits = std::tuple<EdemLimit, CoulombLimit, ThorntonLimit>;
using TangentialLaws = std::tuple<TotalSpring, IncrementalSpring, IncrementalRescaledSpring, Frictionless>;
using RollingLaws = std::tuple<ConstantTorque, FreeRolling, EdemRolling, ElasticPlasticRolling>;

// Rows of the tables above; the defaults are their first rows.
struct LawChoice {
  std::uint8_t normal = 0, damping = 0, friction = 0, tangential = 0, rolling = 0;
  friend bool operator==(const LawChoice&, const LawChoice&) = default;
};

template <class Part, class Table>
struct RowOf;
template <class Part, class... Rest>
struct RowOf<Part, std::tuple<Part, Rest...>> : std::integral_constant<std::uint8_t, 0> {};
template <class Part, class First, class... Rest>
struct RowOf<Part, std::tuple<First, Rest...>>
    : std::integral_constant<std::uint8_t, 1 + RowOf<Part, std::tuple<Rest...>>::value> {};

template <class Limit, class Normal>
concept FitsTogether = !Limit::needs_jkr || std::derived_from<Normal, JkrForce>;

template <NormalLaw Normal, DampingLaw Damping, FrictionLimit Limit, TangentialLaw Tangential, RollingLaw Rolling>
  requires FitsTogether<Limit, Normal>
struct FixedLaw {
  static constexpr RowOf<Normal, NormalLaws> normal{};
  static constexpr RowOf<Damping, DampingLaws> damping{};
  static constexpr RowOf<Limit, FrictionLimits> friction{};
  static constexpr RowOf<Tangential, TangentialLaws> tangential{};
  static constexpr RowOf<Rolling, RollingLaws> rolling{};
};

// Compositions that are compiled as one piece; all others are composed block by block.
using FixedLaws = std::tuple<FixedLaw<Jkr, ContactRadiusDamping, EdemLimit, TotalSpring, ConstantTorque>,
                             FixedLaw<Hertz, ContactRadiusDamping, EdemLimit, TotalSpring, ConstantTorque>>;

template <class Fixed>
constexpr LawChoice choice_of() {
  return {Fixed::normal.value, Fixed::damping.value, Fixed::friction.value, Fixed::tangential.value, Fixed::rolling.value};
}

// Is the contact there? It forms above one overlap and lasts until the normal law lets go at another.
template <class Law, class Real>
Mask<Real> holds(const Law& law, const Real& overlap, const Mask<Real>& touched, const PairConstants<Real>& c) {
  return with_part<NormalLaws>(law.normal, [&](auto part) -> Mask<Real> {
    return (overlap > part.form_overlap(c)) || (touched && (overlap >= part.break_overlap(c)));
  });
}

// Overlap, m (<= 0), beyond which nothing of a contact is left.
template <class Law>
double last_overlap(const Law& law, const PairConstants<double>& c) {
  return with_part<NormalLaws>(law.normal, [&](auto part) { return std::min(part.form_overlap(c), part.break_overlap(c)); });
}

// Forces, and the springs advanced by dt.
template <class Law, class Real>
ContactForce<Real> evaluate(const Law& law, const Touch<Real>& touch, const PairConstants<Real>& c, Springs<Real>& springs,
                            const Interval<std::type_identity_t<Real>>& dt) {
  ContactForce<Real> f;
  f.normal = with_part<NormalLaws>(law.normal, [&](auto part) { return part.evaluate(touch.overlap, c); });
  const DampingCoefficients<Real> damping =
      with_part<DampingLaws>(law.damping, [&](auto part) { return part.evaluate(touch.overlap, f.normal, c); });
  f.damping = damping.normal * touch.closing;
  const Real load = with_part<FrictionLimits>(law.friction, [&](auto part) { return part.load(f.normal); });
  f.tangential = with_part<TangentialLaws>(
      law.tangential, [&](auto part) { return part.evaluate(touch, c, f.normal, load, damping.tangential, springs, dt.length); });
  f.rolling = with_part<RollingLaws>(law.rolling, [&](auto part) { return part.evaluate(touch, c, f.normal, springs, dt); });
  springs.contact_radius = f.normal.contact_radius();
  return f;
}

template <class Table>
std::vector<std::string> part_names() {
  return []<class... Part>(std::type_identity<std::tuple<Part...>>) {
    return std::vector<std::string>{std::string(Part::name)...};
  }(std::type_identity<Table>{});
}

// Why these parts do not make a law, or nothing where they do.
std::optional<std::string> incompatible(const LawChoice& choice);

// The rows of a case's names. Throws CaseError for a name that no table has and for parts that do not go together.
LawChoice choose_law(const ContactModel& model);

}  // namespace dem
