#include "libdem/scene/scene.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>

#include "libdem/errors.hpp"
#include "libdem/geometry/simple_bodies.hpp"
#include "tests/dem/case/ft4.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

TEST(Scene, OfARheometerHasItsVesselBladeAndGap) {
  Case c = ft4('a');
  const Scene scene = make_scene(c);
  ASSERT_EQ(scene.setup.walls.size(), 3u);
  EXPECT_EQ(scene.setup.walls[0].name, "floor");
  EXPECT_EQ(scene.setup.walls[1].name, "cylinder");
  EXPECT_EQ(scene.setup.walls[2].name, "blade");
  EXPECT_EQ(scene.roles, (std::vector{WallRole::vessel, WallRole::vessel, WallRole::blade}));
  ASSERT_TRUE(scene.gap.has_value());
  EXPECT_NEAR(scene.gap->tip_radius, 11.75e-3, 1e-12);
  EXPECT_EQ(scene.gap->vessel_radius, 12.5e-3);
  EXPECT_NEAR(std::get<CylinderRegion>(scene.region).radius, 12.5e-3, 1e-15);

  // A second blade beside it.
  SceneWall more{Wall{"scraper", 1, make_mesh_wall(make_box(Vec3(1e-3, 2e-3, 3e-3))), {}}, WallRole::blade};
  more.wall.motion.start = Vec3(0, 0, 0.07);
  const Scene two = make_scene(c, {more});
  EXPECT_EQ(two.roles.back(), WallRole::blade);
  more.wall.name = "blade";
  EXPECT_THROW(make_scene(c, {more}), CaseError);
}

// A vessel is open: what a jam shoots upward flies on, v^2/(2 g) high, and comes back; nothing real is thrown at 200 m/s.
TEST(Scene, AGrainMayBeShotOutOfAVessel) {
  omp_set_num_threads(1);
  Case c = ft4('a');
  c.step = 1e-4;
  c.levels = 0;
  const auto throw_at = [&](double speed, double time) {
    State state;
    state.particles.add(0, 0, 0.4625e-3, Vec3(8e-3, 0, 0.1), Vec3(0, 0, speed), Vec3::Zero());
    Simulation sim(make_scene(c).setup, state);
    for (double t = 0; t < time; t += 0.1) sim.advance(1000);
    return sim.particles().position[0].z();
  };
  EXPECT_NEAR(throw_at(15, 1.5), 0.1 + 15 * 1.5 - 0.5 * 9.81 * 1.5 * 1.5, 0.01);
  EXPECT_NEAR(throw_at(15, 3.0), 0.1 + 15 * 3.0 - 0.5 * 9.81 * 3.0 * 3.0, 0.02);
  EXPECT_THROW(throw_at(200, 4), PhysicsError);
}

TEST(Scene, WithoutARheometerIsWhatItsWallsAre) {
  Case c = ft4('a');
  c.rheometer = false;
  c.domain_low = Vec3(-1, -2, -3);
  c.domain_high = Vec3(1, 2, 3);
  c.bed.box = BoxRegion{-1e-2, 1e-2, -2e-2, 2e-2};
  const Scene scene = make_scene(c, {SceneWall{Wall{"plate", 0, Plane{}, {}}, WallRole::vessel}});
  EXPECT_EQ(scene.setup.walls.size(), 1u);
  EXPECT_FALSE(scene.gap.has_value());
  EXPECT_EQ(scene.setup.low, c.domain_low);
  EXPECT_EQ(scene.setup.high, c.domain_high);
  EXPECT_EQ(std::get<BoxRegion>(scene.region).y_high, 2e-2);
  EXPECT_THROW(make_scene(c), CaseError);  // no walls
  EXPECT_THROW(make_scene(c, {SceneWall{Wall{"pipe", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), -1}, {}}, WallRole::vessel}}),
               CaseError);
}

// A cuboid of three edges; its volume by the divergence theorem, all triangles outward.
TEST(SimpleBodies, BoxIsClosedAndOfItsVolume) {
  const Vec3 size(1e-3, 2e-3, 5e-3);
  const TriangleMesh box = make_box(size);
  double volume = 0;
  Vec3 area = Vec3::Zero();
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const Vec3 &a = box.vertices[box.triangles[t][0]], &b = box.vertices[box.triangles[t][1]], &c = box.vertices[box.triangles[t][2]];
    volume += a.dot(b.cross(c)) / 6;
    const Vec3 normal = 0.5 * (b - a).cross(c - a);
    area += normal;
    EXPECT_GT(normal.dot(a + b + c), 0) << t;
    EXPECT_EQ(box.labels[t] == FacetLabel::tip, normal.z() < -0.5 * normal.norm()) << t;
  }
  EXPECT_NEAR(volume, size.prod(), 1e-12 * size.prod());
  EXPECT_NEAR(area.norm(), 0, 1e-18);
  EXPECT_THROW(make_box(Vec3(1, 0, 1)), CaseError);
}

TEST(SimpleBodies, RoughPlateIsAHexagonalLayerBelowItsTop) {
  RoughPlate plate{0, 20e-3, 0, 17.4e-3, 1e-3, 1e-3, 0.5, 3};
  const GluedGrains glued = make_rough_plate(plate);
  const auto centres = glued.spheres->centres();
  // 21 and 20 grains in 21 rows, 0.866 mm apart.
  EXPECT_EQ(centres.size(), 11u * 21 + 10u * 20);
  double low = 1, high = -1;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    low = std::min(low, centres[i].z());
    high = std::max(high, centres[i].z());
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT((centres[i] - centres[j]).head<2>().norm(), 1e-3 * (1 - 1e-9));
  }
  // Depths are uniform in [0, 0.5 mm]: the extremes of 431 lie within 2 % of the ends (0.98^431 = 2e-4).
  EXPECT_NEAR(high, 0.5e-3, 0.01e-3);
  EXPECT_NEAR(low, 0, 0.01e-3);
  const GluedGrains again = make_rough_plate(plate);
  EXPECT_TRUE(std::equal(centres.begin(), centres.end(), again.spheres->centres().begin()));
  plate.diameter = 0;
  EXPECT_THROW(make_rough_plate(plate), CaseError);
}

// Several blades and moving walls at once: what the walls put into the grains is what the grains gain. Leapfrog changes
// momentum by dt F and angular momentum by dt x F (x v of half a step is the same with either of its two positions), so the
// balance holds to rounding, with forces and torques about each wall's origin.
TEST(Scene, ForcesAndTorquesOfManyMovingWallsBalanceTheGrainsMomentum) {
  omp_set_num_threads(1);
  dem::Setup setup = support::glass_setup(1e-7);
  const double edge = 6.5e-3;
  std::vector<PoseRow> rows;
  for (int k = 0; k <= 10; ++k)
    rows.push_back({4e-4 * k, Vec3(0, 0, -4.0e-3 + 2e-4 * k),
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.05 * k, Vec3::UnitZ()))});
  WallMotion pushing, turning, both, table, rolling;
  pushing.start = Vec3(-5.7e-3, 0, 0);
  pushing.velocity = Vec3(1, 0, 0);
  turning.start = Vec3(7.5e-3, 0, 0);
  turning.velocity = Vec3(-0.8, 0, 0);
  turning.angular_velocity = Vec3(100, 50, -300);
  both.velocity = Vec3(0, -0.5, 0);
  both.angular_velocity = Vec3(0, 200, 0);
  both.start = Vec3(0, 6.8e-3, 0);
  both.pivot = Vec3(1e-3, 0, 0);
  table.table = std::make_shared<PoseTable>(rows);
  rolling.angular_velocity = Vec3(0, 0, 150);
  setup.walls = {
      Wall{"pusher", 0, make_mesh_wall(make_box(Vec3(3e-3, 9e-3, 9e-3))), pushing},
      Wall{"beater", 0, make_mesh_wall(make_box(Vec3(6e-3, 3e-3, 8e-3))), turning},
      Wall{"scraper", 0, make_mesh_wall(make_box(Vec3(8e-3, 5e-3, 8e-3))), both},
      Wall{"lift", 0, Disc{Vec3::Zero(), Vec3::UnitZ(), 12e-3, 0}, table},
      Wall{"drum", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), 5.6e-3}, rolling},
      Wall{"post", 0, Cylinder{Vec3(0, -5.2e-3, 0), Vec3::UnitZ(), 1e-3, FreeSide::outside, -5e-3, 5e-3}, {}},
      Wall{"grit", 0, make_glued_grains({Vec3(0, 0, 4.5e-3), Vec3(1e-3, 0, 4.5e-3)}, {0.5e-3, 0.5e-3}), {}},
  };
  State state;
  state.particles = support::cloud(120, edge, 0.8, 11);
  std::vector<double> mass;
  for (const double r : state.particles.radius) mass.push_back(2500 * sphere_volume(r));
  Simulation sim(setup, std::move(state));
  struct Momentum {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  };
  const auto momentum = [&] {
    Momentum sum;
    const Particles& p = sim.particles();
    for (std::size_t i = 0; i < p.size(); ++i) {
      sum.linear += mass[i] * p.velocity[i];
      sum.angular += mass[i] * p.position[i].cross(p.velocity[i]) + sphere_inertia(mass[i], p.radius[i]) * p.angular_velocity[i];
    }
    return sum;
  };
  const Momentum before = momentum();
  Momentum given;
  double linear_scale = 0, angular_scale = 0;
  std::vector<double> touched(setup.walls.size(), 0.0);
  for (int k = 0; k < 30000; ++k) {
    const View v = sim.view();
    for (std::size_t i = 0; i < mass.size(); ++i) {
      given.linear += setup.step * mass[i] * setup.gravity;
      given.angular += setup.step * v.position[i].cross(mass[i] * setup.gravity);
    }
    for (std::size_t w = 0; w < v.walls.size(); ++w) {
      const WallInstant& wall = v.walls[w];
      given.linear -= setup.step * wall.force;
      given.angular -= setup.step * (wall.torque + wall.pose.position.cross(wall.force));
      touched[w] += setup.step * wall.force.norm();
      linear_scale += setup.step * wall.force.norm();
      angular_scale += setup.step * (wall.torque.norm() + wall.pose.position.norm() * wall.force.norm());
      Vec3 of_labels = Vec3::Zero();
      for (const WallLoad& part : wall.load_of_label) of_labels += part.force;
      if (std::holds_alternative<MeshWall>(setup.walls[w].shape)) {
        EXPECT_LE((of_labels - wall.force).norm(), 1e-12 * wall.force.norm());
      }
    }
    sim.advance(1);
  }
  const Momentum after = momentum();
  for (std::size_t w = 0; w < touched.size(); ++w)
    EXPECT_GT(touched[w], 0) << setup.walls[w].name << " was never touched";
  EXPECT_LT((after.linear - before.linear - given.linear).norm(), 1e-11 * linear_scale);
  EXPECT_LT((after.angular - before.angular - given.angular).norm(), 1e-11 * angular_scale);
}

}  // namespace
}  // namespace dem
