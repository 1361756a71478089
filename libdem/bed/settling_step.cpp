#include "libdem/bed/settling_step.hpp"

#include <cmath>
#include <numbers>

#include "libdem/contact/pair_constants.hpp"

namespace dem {

double contact_radius_under(double force, double work_of_adhesion, double effective_radius, double effective_modulus) {
  const double pull = pull_off_force(work_of_adhesion, effective_radius);
  const double equivalent = force + 2 * pull + 2 * std::sqrt(pull * (force + pull));
  return std::cbrt(0.75 * effective_radius / effective_modulus * equivalent);
}

double stiffness_under(double force, double work_of_adhesion, double effective_radius, double effective_modulus) {
  return 2 * effective_modulus * contact_radius_under(force, work_of_adhesion, effective_radius, effective_modulus);
}

double impact_force(double speed, double effective_mass, double effective_radius, double effective_modulus) {
  const double c = effective_modulus * std::sqrt(effective_radius);
  return 4.0 / 3.0 * c * std::pow(15.0 / 16.0 * effective_mass * speed * speed / c, 0.6);
}

double settling_step(double mass, double normal_stiffness, double tangential_over_normal) {
  return std::sqrt(mass / (4 * (1 + 7 * tangential_over_normal) * normal_stiffness));
}

}  // namespace dem
