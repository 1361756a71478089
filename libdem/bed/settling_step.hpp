// How large a time step a settling bed bears. The Rayleigh time knows the stiffness of the material only; a bed under its own
// weight presses its contacts so little that they are much softer than that, and steps several times larger are stable.
#pragma once
#include "libdem/case/case.hpp"

namespace dem {

// m, radius of a JKR contact that carries `force` >= 0 with the pull-off force F_c = (3/2) pi W R*:
// a^3 = 3 R*/(4 E*) (F + 2 F_c + 2 sqrt(F_c (F + F_c))) (Johnson, Kendall, Roberts, Proc. R. Soc. A 324 (1971) 301); Hertz's
// for W = 0.
double contact_radius_under(double force, double work_of_adhesion, double effective_radius, double effective_modulus);

// N/m, 2 E* a: normal stiffness of a Hertz contact of that radius and an upper bound of that of a JKR contact.
double stiffness_under(double force, double work_of_adhesion, double effective_radius, double effective_modulus);

// N, largest force of an elastic Hertz impact at relative speed v: (4/3) E* sqrt(R*) x^(3/2) with the overlap
// x = (15 m* v^2 / (16 E* sqrt(R*)))^(2/5) (Johnson, Contact Mechanics, section 11.4).
double impact_force(double speed, double effective_mass, double effective_radius, double effective_modulus);

// s, half of the critical step 2/omega of a grain of mass m in a packing whose contacts all have the normal stiffness k and
// the tangential stiffness tau k. Six contacts, spread evenly, give its translation the stiffness 2 (k + 2 tau k) and its
// rotation 4 tau k R^2 against I = (2/5) m R^2; coupled they are bounded by the sum, and a neighbour that moves the other way
// doubles it: omega^2 <= 4 (1 + 7 tau) k/m. The half leaves room for contacts that are stiffer, and for damping, which
// lowers the limit of leapfrog.
double settling_step(double mass, double normal_stiffness, double tangential_over_normal);

}  // namespace dem
