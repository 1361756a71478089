// Where the energy goes: the ledger closes, and its columns are what theory says they are.
#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>

#include "libdem/contact/pair_constants.hpp"
#include "libdem/errors.hpp"
#include "libdem/geometry/twisted_blade.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/dem/stirred_pot.hpp"

namespace dem {
namespace {

State fresh(Particles grains) {
  State state;
  state.particles = std::move(grains);
  return state;
}

double spent(const Ledger& l) {
  return l.spent.normal_damping + l.spent.tangential_damping + l.spent.sliding + l.spent.rolling + l.spent.detachment;
}

// Every way of making a law, in a scene with collisions, sliding, rolling, necks, a mesh, walls at rest and in motion.
TEST(Ledger, ClosesForEveryPartOfTheLaw) {
  omp_set_num_threads(1);
  std::vector<ContactModel> models(1);
  for (const std::string& name : part_names<NormalLaws>()) models.push_back({.normal = name});
  for (const std::string& name : part_names<DampingLaws>()) models.push_back({.damping = name});
  for (const std::string& name : part_names<FrictionLimits>()) models.push_back({.friction_limit = name});
  for (const std::string& name : part_names<TangentialLaws>()) models.push_back({.tangential = name});
  for (const std::string& name : part_names<RollingLaws>()) models.push_back({.rolling = name});
  for (const ContactModel& model : models) {
    SCOPED_TRACE(model.normal + " " + model.damping + " " + model.friction_limit + " " + model.tangential + " " + model.rolling);
    Simulation sim(support::stirred_pot(model), fresh(support::grains_below_the_paddle()));
    sim.advance(20000);
    const Ledger l = sim.ledger();
    const double moved = l.work_put_in() + l.initial - l.stored.total();
    EXPECT_GT(l.work_put_in(), 1e-8);
    EXPECT_GT(spent(l), 1e-8);
    // Rounding: 20,000 steps of sums over some 600 contacts.
    EXPECT_NEAR(l.residual(), 0, 1e-11 * moved);
    EXPECT_LT(std::abs(l.spent.time_stepping), 0.01 * moved);
  }
}

// What finite steps make or lose in a collision, mean size over 40 phases of the first step within the contact, over the energy.
double numerical_error(double step, double friction) {
  const double radius = 0.4625e-3;
  dem::Setup setup = support::glass_setup(step);
  setup.gravity = Vec3::Zero();
  setup.interactions[0][0] = {0.8, friction, 0, 0};
  setup.keep_ledger = true;
  double sum = 0;
  for (int k = 0; k < 40; ++k) {
    Particles grains;
    grains.add(1, 0, radius, Vec3(-radius - 1e-6 - k * 1e-10, 0, 0), Vec3(0.1, 0.02, 0));
    grains.add(2, 0, radius, Vec3(radius, 0, 0));
    Simulation sim(setup, fresh(grains));
    sim.advance(std::uint64_t(3e-5 / step));
    EXPECT_EQ(sim.contacts(), 0u);
    const Ledger l = sim.ledger();
    EXPECT_NEAR(l.residual(), 0, 1e-14 * l.initial);
    sum += std::abs(l.spent.time_stepping) / l.initial;
  }
  return sum / 40;
}

// Of the normal motion it is of the second order; the onset and the end of sliding are located to within a step.
TEST(Ledger, NumericalErrorFallsWithTheStep) {
  omp_set_num_threads(1);
  const double smooth[] = {numerical_error(4e-8, 0), numerical_error(2e-8, 0), numerical_error(1e-8, 0)};
  EXPECT_GT(smooth[0] / smooth[1], 3);
  EXPECT_GT(smooth[1] / smooth[2], 3);
  const double sliding[] = {numerical_error(4e-8, 0.3), numerical_error(2e-8, 0.3), numerical_error(1e-8, 0.3)};
  EXPECT_GT(sliding[0] / sliding[1], 1.5);
  EXPECT_GT(sliding[1] / sliding[2], 1.5);
  EXPECT_LT(sliding[2], 1e-3);
}

// Reference: (1 - e^2) of the kinetic energy of the approach.
TEST(Ledger, ADampedImpactLosesWhatItsRestitutionSays) {
  const double radius = 0.4625e-3, speed = 0.1, restitution = 0.7;
  dem::Setup setup = support::glass_setup(2e-9);
  setup.gravity = Vec3::Zero();
  setup.interactions[0][0] = {restitution, 0.5, 0.01, 0};
  setup.keep_ledger = true;
  setup.walls = {Wall{"floor", 0, Plane{}, {}}};
  Particles grains;
  grains.add(1, 0, radius, Vec3(0, 0, radius + 1e-8), Vec3(0, 0, -speed));
  Simulation sim(setup, fresh(grains));
  sim.advance(10000);
  EXPECT_EQ(sim.contacts(), 0u);
  const Ledger l = sim.ledger();
  const double energy = 0.5 * 2500 * sphere_volume(radius) * speed * speed;
  EXPECT_NEAR(l.initial, energy, 1e-12 * energy);
  EXPECT_NEAR(l.spent.normal_damping, (1 - restitution * restitution) * energy, 1e-3 * energy);
  EXPECT_NEAR(l.kinetic, restitution * restitution * energy, 1e-3 * energy);
  EXPECT_NEAR(l.spent.sliding + l.spent.rolling + l.spent.tangential_damping + l.spent.detachment, 0, 1e-12 * energy);
}

// Reference: the energy m v0^2/7 that a sliding sphere loses until it rolls with (5/7) v0.
TEST(Ledger, ASlidingGrainLosesTwoSeventhsOfItsEnergyToSliding) {
  const double radius = 0.4625e-3, speed = 0.02;
  dem::Setup setup = support::glass_setup(2e-8);
  setup.interactions[0][0] = {0.5, 0.5, 0.0, 0.0};
  setup.keep_ledger = true;
  setup.walls = {Wall{"floor", 0, Plane{}, {}}};
  Particles grains;
  grains.add(1, 0, radius, Vec3(0, 0, radius - 6.4e-10), Vec3(speed, 0, 0));
  Simulation sim(setup, fresh(grains));
  sim.advance(200000);
  const Ledger l = sim.ledger();
  const double energy = 0.5 * 2500 * sphere_volume(radius) * speed * speed;
  EXPECT_NEAR(l.spent.sliding + l.spent.tangential_damping, 2.0 / 7.0 * energy, 2e-3 * energy);
  EXPECT_GT(l.spent.sliding, 0.28 * energy);
  EXPECT_NEAR(l.rotational / l.kinetic, 0.4, 2e-3);
  EXPECT_NEAR(l.residual(), 0, 1e-9 * energy);  // 200,000 steps whose positions are rounded to 1e-19 m
}

// Reference: W_s = 7.0922 (W^5 R*^4/E*^2)^(1/3) per contact made and broken.
TEST(Ledger, ABrokenJkrContactLosesTheWorkOfSeparation) {
  const double radius = 0.4625e-3, r = radius / 2;
  dem::Setup setup = support::glass_setup(1e-9);
  setup.gravity = Vec3::Zero();
  setup.interactions[0][0] = {1.0, 0.5, 0, 0.274};
  setup.keep_ledger = true;
  const double modulus = effective_modulus(setup.materials[0], setup.materials[0]);
  const double work = 7.0921959719 * std::cbrt(std::pow(0.274, 5) * std::pow(r, 4) / (modulus * modulus));
  Particles grains;
  grains.add(1, 0, radius, Vec3(-radius - 1e-9, 0, 0), Vec3(2.5e-3, 0, 0));
  grains.add(2, 0, radius, Vec3(radius + 1e-9, 0, 0), Vec3(-2.5e-3, 0, 0));
  Simulation sim(setup, fresh(grains));
  sim.advance(40000);
  EXPECT_EQ(sim.contacts(), 0u);
  const Ledger l = sim.ledger();
  EXPECT_NEAR(l.spent.detachment, work, 1e-9 * work);
  EXPECT_NEAR(l.spent.time_stepping, 0, 0.01 * work);
  EXPECT_EQ(l.stored.total(), 0);
}

// Walton's artefact: a spring whose force stays while the contact unloads gains energy; a rescaled one never does.
TEST(Ledger, OnlyTheIncrementalSpringGainsEnergyByUnloading) {
  omp_set_num_threads(1);
  std::map<std::string, double> gained;
  for (const std::string name : {"incremental", "incremental_rescaled"}) {
    Simulation sim(support::stirred_pot({.normal = "hertz", .tangential = name}), fresh(support::grains_below_the_paddle()));
    sim.advance(20000);
    gained[name] = sim.ledger().spent.stiffness_change;
  }
  EXPECT_LT(gained["incremental_rescaled"], 0);
  EXPECT_GT(gained["incremental"], gained["incremental_rescaled"]);
}

TEST(Ledger, IsTheSameForAnyNumberOfThreadsAndAfterARestart) {
  const Particles grains = support::packed_cube(12, 1e-7, 0.1, 7);
  dem::Setup setup = support::glass_setup(1e-7);
  setup.keep_ledger = true;
  setup.law = choose_law({.rolling = "elastic_plastic"});
  setup.walls = {Wall{"floor", 0, Plane{Vec3(0, 0, -5.6e-3), Vec3::UnitZ()}, {}},
                 Wall{"lid", 0, Plane{Vec3(0, 0, 5.6e-3), -Vec3::UnitZ()}, {Vec3::Zero(), Vec3(0, 0, -0.1), Vec3::Zero()}}};
  std::vector<Ledger> books;
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    Simulation sim(setup, fresh(grains));
    sim.advance(3000);
    books.push_back(sim.ledger());
  }
  omp_set_num_threads(1);
  Simulation first(setup, fresh(grains));
  first.advance(1234);
  Simulation second(setup, first.state());
  second.advance(3000 - 1234);
  books.push_back(second.ledger());
  for (const Ledger& l : books) {
    EXPECT_GT(l.work_put_in(), 0);
    EXPECT_EQ(l.total(), books[0].total());
    EXPECT_EQ(l.residual(), books[0].residual());
    EXPECT_EQ(spent(l), spent(books[0]));
    EXPECT_EQ(l.wall_work, books[0].wall_work);
  }
}

TEST(Ledger, IsNotKeptWithLocalDamping) {
  dem::Setup setup = support::glass_setup();
  setup.keep_ledger = true;
  setup.local_damping = 0.3;
  EXPECT_THROW(Simulation(setup, {}), CaseError);
}

}  // namespace
}  // namespace dem
