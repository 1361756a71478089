// The normal load that friction is in proportion to, N: |F_t| <= mu * load.
#pragma once
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

// Coulomb: the elastic normal force, adhesion included; a contact under tension has no friction.
struct CoulombLimit {
  static constexpr std::string_view name = "coulomb";
  static constexpr bool needs_jkr = false;
  template <class Real>
  static Real load(const NormalForce<Real>& normal) {
    return larger(normal.elastic, Real(0.0));
  }
};

// Thornton and Yin (1991), Powder Technol. 65, 153; Thornton (2015): a JKR contact slides as if pressed by F + 2 F_c.
struct ThorntonLimit {
  static constexpr std::string_view name = "thornton";
  static constexpr bool needs_jkr = true;
  template <class Real>
  static Real load(const NormalForce<Real>& normal) {
    return larger(normal.elastic + 2.0 * normal.pull_off, Real(0.0));
  }
};

// EDEM: the repulsive part of the normal force alone, for JKR 4 E* a^3/(3 R*), which is 4 F_c where F = 0.
struct EdemLimit {
  static constexpr std::string_view name = "edem";
  static constexpr bool needs_jkr = false;
  template <class Real>
  static Real load(const NormalForce<Real>& normal) {
    return normal.repulsive;
  }
};

}  // namespace dem
