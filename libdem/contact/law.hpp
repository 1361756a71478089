// A contact law is a composition of three parts, written once for every number type and every kind of contact.
#pragma once
#include <concepts>
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

template <class T>
concept NormalLaw = requires(const double& overlap, const PairConstants<double>& c) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::break_overlap(c) } -> std::same_as<double>;
  { T::evaluate(overlap, c) } -> std::same_as<NormalForce<double>>;
};

template <class T>
concept TangentialLaw = requires(const Touch<double>& t, const PairConstants<double>& c, const NormalForce<double>& n,
                                 Triple<double>& spring, const double& dt) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::evaluate(t, c, n, spring, dt) } -> std::same_as<TangentialForce<double>>;
};

template <class T>
concept RollingLaw = requires(const Touch<double>& t, const PairConstants<double>& c, const NormalForce<double>& n,
                              const double& dt) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::evaluate(t, c, n, dt) } -> std::same_as<Triple<double>>;
};

template <NormalLaw Normal_, TangentialLaw Tangential_, RollingLaw Rolling_>
struct ContactLaw {
  using Normal = Normal_;
  using Tangential = Tangential_;
  using Rolling = Rolling_;

  // Is the contact there? It forms at positive overlap and lasts until the normal law lets go.
  template <class Real>
  static Mask<Real> holds(const Real& overlap, const Mask<Real>& touched, const PairConstants<Real>& c) {
    return (overlap > Real(0.0)) || (touched && (overlap >= Normal::break_overlap(c)));
  }

  // Forces on i, and the tangential spring [m] advanced by dt [s]. Normal damping as in EDEM's Hertz-Mindlin model:
  // F_d = 2 sqrt(5/6) beta sqrt(2 E* a m*) v_n, here with the law's own contact radius a, so that it is continuous through
  // zero overlap. Without adhesion the restitution is exactly the one that beta was made from.
  template <class Real>
  static ContactForce<Real> evaluate(const Touch<Real>& touch, const PairConstants<Real>& c, Triple<Real>& spring,
                                     const Real& dt) {
    const NormalForce<Real> normal = Normal::evaluate(touch.overlap, c);
    const Real v_n = dot(touch.velocity, touch.normal);  // > 0 closing
    const Real stiffness = 2.0 * c.effective_modulus * normal.contact_radius;
    const Real damping =
        (2 * 0.91287092917527690) * c.damping_ratio * square_root(stiffness * c.effective_mass) * v_n;
    const TangentialForce<Real> tangential = Tangential::evaluate(touch, c, normal, spring, dt);
    return {normal.elastic, damping, tangential.force, Rolling::evaluate(touch, c, normal, dt), tangential.sliding};
  }
};

}  // namespace dem
