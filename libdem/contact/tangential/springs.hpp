// Mindlin (1949) no-slip stiffness on a tangential spring, with a friction limit:
//
//   F_t = -k_t xi - c_t v_t,   k_t = 8 G* a,   |F_t| <= mu * load.
//
// The spring xi turns with the normal and keeps its length; on sliding it is set back to what alone would give the limit
// (-F_t/k_t), as in the reference integration of Chung and Ooi's test 4: where the dashpot took the force to its limit, the
// spring is stretched to carry the dashpot's share, which no work has paid for; the ledger books that as negative sliding. The
// variants differ in what a change of k_t does to
// the spring, xi -> share * xi:
//
//   total                  share 1: F_t = -k_t xi of the whole displacement (Di Renzo and Di Maio 2005)
//   incremental            k_t,old/k_t: the force stays. Gains energy when the contact unloads (Walton 1993)
//   incremental_rescaled   the force stays while the contact loads, falls with k_t while it unloads (Thornton et al. 2013,
//                          Powder Technol. 233, 30): never gains energy
#pragma once
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

template <class Variant>
struct MindlinSpring {
  static constexpr bool has_spring = true;

  template <class Real>
  static TangentialForce<Real> evaluate(const Touch<Real>& touch, const PairConstants<Real>& c, const NormalForce<Real>& normal,
                                        const Real& load, const Real& damping, Springs<Real>& springs, const Real& dt) {
    const Real v_n = dot(touch.velocity, touch.normal);
    const Triple<Real> v_t = subtract_product(touch.velocity, touch.normal, v_n);

    const Triple<Real> old = springs.tangential;
    const Real length2 = dot(old, old);
    const Triple<Real> flat = subtract_product(old, touch.normal, dot(old, touch.normal));
    const Real flat2 = dot(flat, flat);
    const Real both = length2 * flat2;
    const Real radius = normal.contact_radius();
    const Real keep = select(both > Real(0.0), length2 * inverse_root(both), Real(0.0));  // sqrt(length2/flat2)
    const Triple<Real> carried = flat * (keep * Variant::share(springs.contact_radius, radius));
    const Triple<Real> trial = multiply_add(v_t, dt, carried);

    const Real k_t = 8.0 * c.effective_shear * radius;
    const Triple<Real> viscous = v_t * -damping;
    const Triple<Real> unlimited = subtract_product(viscous, trial, k_t);
    const Real limit = c.friction * load;
    const Real size2 = dot(unlimited, unlimited);
    const Mask<Real> sliding = size2 > limit * limit;
    // limit/(|F_t| k_t); 0 where there is no stiffness.
    const Real size_k2 = size2 * (k_t * k_t);
    const Real compliant = select(sliding && (size_k2 > Real(0.0)), limit * inverse_root(size_k2), Real(0.0));
    const Triple<Real> limited = unlimited * (compliant * k_t);
    springs.tangential = select(sliding, unlimited * -compliant, trial);

    TangentialForce<Real> f;
    f.elastic = select(sliding, limited, trial * -k_t);
    f.viscous = select(sliding, Triple<Real>{Real(0.0), Real(0.0), Real(0.0)}, viscous);
    f.sliding = sliding;
    const Triple<Real> slip = trial - springs.tangential;
    f.energy = 0.5 * k_t * dot(springs.tangential, springs.tangential);
    f.slip_work = 0.5 * k_t * dot(carried + springs.tangential, slip);
    f.stiffness_work =
        0.5 * k_t * dot(carried, carried) - 4.0 * c.effective_shear * springs.contact_radius * length2;
    return f;
  }
};

struct TotalSpring : MindlinSpring<TotalSpring> {
  static constexpr std::string_view name = "total";
  template <class Real>
  static Real share(const Real&, const Real&) {
    return Real(1.0);
  }
};

struct IncrementalSpring : MindlinSpring<IncrementalSpring> {
  static constexpr std::string_view name = "incremental";
  template <class Real>
  static Real share(const Real& radius_before, const Real& radius) {
    const Mask<Real> touching = radius > Real(0.0);
    return select(touching, radius_before / select(touching, radius, Real(1.0)), Real(0.0));
  }
};

struct IncrementalRescaledSpring : MindlinSpring<IncrementalRescaledSpring> {
  static constexpr std::string_view name = "incremental_rescaled";
  template <class Real>
  static Real share(const Real& radius_before, const Real& radius) {
    return smaller(IncrementalSpring::share(radius_before, radius), Real(1.0));
  }
};

// No tangential force at all.
struct Frictionless {
  static constexpr std::string_view name = "none";
  static constexpr bool has_spring = false;

  template <class Real>
  static TangentialForce<Real> evaluate(const Touch<Real>&, const PairConstants<Real>&, const NormalForce<Real>&, const Real&,
                                        const Real&, Springs<Real>&, const Real&) {
    const Real zero(0.0);
    return {{zero, zero, zero}, {zero, zero, zero}, zero > zero, zero, zero, zero};
  }
};

}  // namespace dem
