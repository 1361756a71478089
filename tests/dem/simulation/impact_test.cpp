// Collisions with known outcomes: Chung and Ooi (2011), Granular Matter 13, 643, and the sticking law of JKR spheres.
#include <gtest/gtest.h>

#include <numbers>

#include "libdem/contact/pair_constants.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/support/csv.hpp"

namespace dem {
namespace {

constexpr double degree = std::numbers::pi / 180;

dem::Setup setup_of(const Material& grain, const Interaction& law, double step) {
  dem::Setup setup;
  setup.materials = {grain};
  setup.interactions = {{law}};
  setup.gravity = Vec3::Zero();
  setup.step = step;
  return setup;
}

// A wall as stiff as it can be: against it E* = E/(1-nu^2).
dem::Setup with_rigid_plane(dem::Setup setup) {
  setup.materials.push_back({"rigid", 1, 1e25, 0.3});
  const Interaction law = setup.interactions[0][0];
  setup.interactions = {{law, law}, {law, law}};
  setup.walls = {Wall{"plane", 1, Plane{}, {}}};
  return setup;
}

struct Impact {
  double peak_overlap = 0, peak_force = 0, contact_time = 0;
  Vec3 velocity, spin;
};

// Runs until the contact has come and gone.
Impact collide(const dem::Setup& setup, const Particles& grains) {
  State state;
  state.particles = grains;
  Simulation sim(setup, state);
  Impact impact;
  bool touched = false;
  for (int k = 0; k < 2000000; ++k) {
    sim.advance(1);
    const View view = sim.view();
    const bool touches = !view.pairs.empty() || !view.wall_pairs.empty();
    if (touched && !touches) break;
    touched = touched || touches;
    if (!touches) continue;
    impact.contact_time += setup.step;
    const double overlap = view.pairs.empty() ? view.wall_pairs[0].overlap : view.pairs[0].overlap;
    const double force = view.pairs.empty() ? view.wall_pairs[0].elastic : view.pairs[0].elastic;
    impact.peak_overlap = std::max(impact.peak_overlap, overlap);
    impact.peak_force = std::max(impact.peak_force, force);
  }
  impact.velocity = sim.particles().velocity[0];
  impact.spin = sim.particles().angular_velocity[0];
  return impact;
}

double reference(const std::string& test, const std::string& material, const std::string& quantity) {
  for (const support::Row& row : support::read_csv(JAMSCOPE_DATA_DIR "/reference/normal_impact_analytic.csv"))
    if (row.at("test") == test && row.at("material") == material && row.at("quantity") == quantity)
      return std::stod(row.at("value"));
  throw std::runtime_error("no reference for " + test + " " + material + " " + quantity);
}

TEST(ChungOoi, Test1TwoEqualSpheresFollowHertz) {
  for (const Material& m : {Material{"glass", 2800, 48e9, 0.2}, Material{"limestone", 2500, 20e9, 0.25}}) {
    const double contact_time = reference("test1", m.name, "t_c_s");
    Particles grains;
    grains.add(1, 0, 0.01, Vec3(-0.010001, 0, 0), Vec3(10, 0, 0));
    grains.add(2, 0, 0.01, Vec3(0.010001, 0, 0), Vec3(-10, 0, 0));
    const dem::Setup setup = setup_of(m, {1.0, 0.35, 0, 0}, contact_time / 5000);
    const Impact impact = collide(setup, grains);
    // The discretisation errs by the square of 1/5000 in the extremes and by a step in the time.
    EXPECT_NEAR(impact.peak_overlap, reference("test1", m.name, "delta_max_m"), 1e-5 * impact.peak_overlap);
    EXPECT_NEAR(impact.peak_force, reference("test1", m.name, "F_max_N"), 1e-5 * impact.peak_force);
    EXPECT_NEAR(impact.contact_time, contact_time, 2 * setup.step);
    EXPECT_NEAR(impact.velocity.x(), -10, 1e-5);
  }
}

TEST(ChungOoi, Test2SphereOnRigidPlaneFollowsHertz) {
  for (const Material& m : {Material{"aluminium_alloy", 2699, 70e9, 0.30}, Material{"magnesium_alloy", 1800, 40e9, 0.35}}) {
    const double contact_time = reference("test2", m.name, "t_c_s");
    Particles grains;
    grains.add(1, 0, 0.1, Vec3(0, 0, 0.1000001), Vec3(0, 0, -0.2));
    const dem::Setup setup = with_rigid_plane(setup_of(m, {1.0, 0, 0, 0}, contact_time / 5000));
    const Impact impact = collide(setup, grains);
    EXPECT_NEAR(impact.peak_overlap, reference("test2", m.name, "delta_max_m"), 1e-5 * impact.peak_overlap);
    EXPECT_NEAR(impact.peak_force, reference("test2", m.name, "F_max_N"), 1e-5 * impact.peak_force);
    EXPECT_NEAR(impact.contact_time, contact_time, 2 * setup.step);
    EXPECT_NEAR(impact.velocity.z(), 0.2, 0.2e-5);
  }
}

TEST(ChungOoi, Test3DampedImpactReturnsWithItsRestitution) {
  for (const Material& m : {Material{"aluminium_oxide", 4000, 380e9, 0.23}, Material{"cast_iron", 7000, 100e9, 0.25}})
    for (double restitution : {0.2, 0.4, 0.6, 0.8, 1.0}) {
      Particles grains;
      grains.add(1, 0, 2.5e-3, Vec3(0, 0, 2.5001e-3), Vec3(0, 0, -3.9));
      const dem::Setup setup = with_rigid_plane(setup_of(m, {restitution, 0, 0, 0}, 2e-9));
      // The contact ends at zero overlap, where the closed form is exactly the set value; the step is 1/7000 of the contact.
      EXPECT_NEAR(collide(setup, grains).velocity.z() / 3.9, restitution, 1e-3) << m.name;
    }
}

TEST(ChungOoi, Test4ObliqueImpactOnAPlane) {
  const std::map<std::string, Material> materials = {
      {"aluminium_oxide", {"aluminium_oxide", 4000, 380e9, 0.23}}, {"aluminium_alloy", {"aluminium_alloy", 2700, 70e9, 0.33}}};
  const double mu = 0.092, e = 0.98, radius = 2.5e-3, speed = 3.9;
  for (const support::Row& row : support::read_csv(JAMSCOPE_DATA_DIR "/reference/oblique_impact_ode.csv")) {
    const double angle = std::stod(row.at("incident_angle_deg"));
    Particles grains;
    grains.add(1, 0, radius, Vec3(0, 0, radius + 1e-7), Vec3(speed * std::sin(angle * degree), 0, -speed * std::cos(angle * degree)));
    const Impact impact =
        collide(with_rigid_plane(setup_of(materials.at(row.at("material")), {e, mu, 0, 0}, 2e-9)), grains);
    const double e_t = impact.velocity.x() / (speed * std::sin(angle * degree));
    if (angle >= 35) {  // sliding throughout: closed form
      EXPECT_NEAR(e_t, 1 - mu * (1 + e) / std::tan(angle * degree), 1e-4) << row.at("material") << " " << angle;
      // rolls forward about +y
      EXPECT_NEAR(impact.spin.y(), 2.5 * mu * (1 + e) * speed * std::cos(angle * degree) / radius,
                  2e-4 * std::abs(impact.spin.y()) + 0.02) << row.at("material") << " " << angle;
    }
    // Reference: integration of the same equations, itself converged to about 4e-4.
    EXPECT_NEAR(e_t, std::stod(row.at("e_t_total")), 1e-3) << row.at("material") << " " << angle;
    EXPECT_NEAR(impact.spin.y(), -std::stod(row.at("omega_rad_s_total")), 1e-3 * 700) << row.at("material") << " " << angle;
  }
}

// The published curves, read off their figures: within the reading accuracy of 0.02 in e_t and 5 % in spin from 10 degrees on.
TEST(ChungOoi, Test4AgreesWithThePublishedCurves) {
  const std::map<std::string, Material> materials = {
      {"aluminium_oxide_DEM", {"aluminium_oxide", 4000, 380e9, 0.23}}, {"aluminium_alloy_DEM", {"aluminium_alloy", 2700, 70e9, 0.33}}};
  const double radius = 2.5e-3, speed = 3.9;
  int compared = 0;
  for (const support::Row& row : support::read_csv(JAMSCOPE_DATA_DIR "/reference/chung_ooi_test4_digitised.csv")) {
    const auto material = materials.find(row.at("source"));
    const double angle = std::stod(row.at("incident_angle_deg"));
    if (material == materials.end() || angle < 9.9) continue;
    Particles grains;
    grains.add(1, 0, radius, Vec3(0, 0, radius + 1e-7), Vec3(speed * std::sin(angle * degree), 0, -speed * std::cos(angle * degree)));
    const Impact impact = collide(with_rigid_plane(setup_of(material->second, {0.98, 0.092, 0, 0}, 2e-9)), grains);
    const double value = std::stod(row.at("value"));
    if (row.at("quantity") == "e_t") {
      EXPECT_NEAR(impact.velocity.x() / (speed * std::sin(angle * degree)), value, 0.02) << row.at("source") << " " << angle;
      ++compared;
    } else if (row.at("quantity").find("omega") != std::string::npos) {
      EXPECT_NEAR(impact.spin.y(), std::abs(value), 0.05 * std::abs(value)) << row.at("source") << " " << angle;
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

// Case A of the paper. Without damping a JKR collision loses the energy W_s of making and breaking the contact:
// e = sqrt(1 - (V_s/V)^2), V_s = sqrt(2 W_s/m*), W_s = 7.0921959719 (W^5 R*^4/E*^2)^(1/3).
TEST(JkrImpact, LosesTheWorkOfSeparation) {
  const Material glass{"glass", 2500, 63e9, 0.2};
  const double radius = 0.4625e-3, adhesion = 0.274;
  const double r = radius / 2, modulus = effective_modulus(glass, glass);
  const double m = 2500 * sphere_volume(radius) / 2;
  const double work = 7.0921959719 * std::cbrt(std::pow(adhesion, 5) * std::pow(r, 4) / (modulus * modulus));
  const double sticking = std::sqrt(2 * work / m);
  EXPECT_NEAR(sticking, 2.0937e-3, 1e-7);
  for (double ratio : {1.05, 1.2, 1.5, 2.0, 5.0}) {
    const double speed = ratio * sticking;
    Particles grains;
    grains.add(1, 0, radius, Vec3(-radius - 1e-10, 0, 0), Vec3(speed / 2, 0, 0));
    grains.add(2, 0, radius, Vec3(radius + 1e-10, 0, 0), Vec3(-speed / 2, 0, 0));
    // The step crosses the adhesive tail of 4 nm in hundreds of steps.
    const Impact impact = collide(setup_of(glass, {1.0, 0.5, 0, adhesion}, 4e-12 / speed), grains);
    EXPECT_NEAR(-impact.velocity.x() / (speed / 2), std::sqrt(1 - 1 / (ratio * ratio)), 3e-3) << ratio;
  }
}

TEST(JkrImpact, BelowTheStickingSpeedTheGrainsStayTogether) {
  const Material glass{"glass", 2500, 63e9, 0.2};
  const double radius = 0.4625e-3, speed = 0.95 * 2.0937e-3;
  Particles grains;
  grains.add(1, 0, radius, Vec3(-radius - 1e-10, 0, 0), Vec3(speed / 2, 0, 0));
  grains.add(2, 0, radius, Vec3(radius + 1e-10, 0, 0), Vec3(-speed / 2, 0, 0));
  State state;
  state.particles = grains;
  Simulation sim(setup_of(glass, {1.0, 0.5, 0, 0.274}, 4e-9), state);
  sim.advance(20000);  // five periods of the bound pair
  EXPECT_EQ(sim.view().pairs.size(), 1u);
}

}  // namespace
}  // namespace dem
