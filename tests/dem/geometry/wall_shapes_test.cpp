#include <gtest/gtest.h>

#include <set>

#include "libdem/errors.hpp"
#include "tests/dem/geometry/wall_samples.hpp"

// What must hold for every row of WallShape, at random poses.
namespace dem {
namespace {

using namespace test;

constexpr double reach = 0.3;  // m

WallPose random_pose(std::mt19937_64& rng) {
  WallMotion motion;
  motion.start = 2 * random_direction(rng);
  motion.orientation = Eigen::AngleAxisd(uniform(rng, 0, 6), random_direction(rng));
  return pose_at(motion, 0);
}

Vec3 to_lab(const WallPose& pose, const Vec3& body) {
  return pose.position + pose.rotation * body;
}
Vec3 to_body(const WallPose& pose, const Vec3& lab) {
  return pose.rotation.transpose() * (lab - pose.position);
}

const WallTouch* same_feature(const std::vector<WallTouch>& touches, std::uint64_t feature) {
  const auto found = std::ranges::find(touches, feature, &WallTouch::feature);
  return found == touches.end() ? nullptr : &*found;
}

TEST(WallShapes, EveryRowIsSampled) {
  std::set<std::size_t> rows;
  for (const WallSample& sample : wall_samples()) rows.insert(sample.shape.index());
  EXPECT_EQ(rows.size(), std::variant_size_v<WallShape>);
}

TEST(WallShapes, TheNearestTouchIsTheNearestPointOfTheSurface) {
  std::mt19937_64 rng(1);
  for (const WallSample& sample : wall_samples()) {
    const Wall wall{sample.name, 0, sample.shape, {}};
    const int trials = sample.round ? 200 : 20;
    for (int k = 0; k < trials; ++k) {
      const WallPose pose = random_pose(rng);
      const Vec3 body = random_centre(sample, reach, rng), centre = to_lab(pose, body);
      const auto found = touches_of(wall, pose, centre, 2 * reach);
      ASSERT_FALSE(found.empty()) << sample.name;
      const WallTouch& touch = *nearest_of(found);
      EXPECT_NEAR(touch.distance, distance_to(sample, body), 1e-12) << sample.name;
      for (const WallTouch& t : found) {
        EXPECT_NEAR(t.normal.norm(), 1, 1e-14) << sample.name;
        EXPECT_NEAR((t.point - centre - t.distance * t.normal).norm(), 0, 1e-14) << sample.name;
        if (k < 20) {
          EXPECT_NEAR(distance_to(sample, to_body(pose, t.point)), 0, 1e-7) << sample.name;
        }
      }
    }
  }
}

// What is left of the parts around a point is all that a sphere can touch that has moved as far from there as was asked for.
TEST(WallShapes, PartsWithinAMoveAreAllThatIsTouchedAfterIt) {
  std::mt19937_64 rng(8);
  for (const WallSample& sample : wall_samples()) {
    const Wall wall{sample.name, 0, sample.shape, {}};
    std::size_t known = 0, kept = 0, touched = 0;
    for (int k = 0; k < 2000; ++k) {
      const WallPose pose = random_pose(rng);
      const Vec3 before = to_lab(pose, random_centre(sample, reach, rng));
      const double move = uniform(rng, 0, reach), from = uniform(rng, 0.2, 1) * reach;
      std::vector<std::uint32_t> parts, few;
      candidate_parts(wall, pose, before, 2 * reach, parts);
      few.resize(parts.size());
      few.resize(parts_within(wall, pose, before, from + move, parts, few));
      const Vec3 after = before + uniform(rng, 0, 1) * move * random_direction(rng);
      std::vector<WallTouch> of_all, of_few;
      std::vector<MeshTouch> scratch;
      nearest(wall, pose, after, from, parts, of_all, scratch);
      nearest(wall, pose, after, from, few, of_few, scratch);
      ASSERT_EQ(of_few.size(), of_all.size()) << sample.name;
      for (std::size_t t = 0; t < of_all.size(); ++t) {
        EXPECT_EQ(of_few[t].feature, of_all[t].feature) << sample.name;
        EXPECT_EQ(of_few[t].distance, of_all[t].distance) << sample.name;
        EXPECT_EQ(of_few[t].normal, of_all[t].normal) << sample.name;
      }
      known += parts.size(), kept += few.size(), touched += of_all.size();
    }
    EXPECT_GT(touched, 500u) << sample.name;
    if (known > 0) {
      EXPECT_LT(double(kept), 0.8 * double(known)) << sample.name;
    }
  }
}

// d(distance)/d(centre) = -normal: touches are extremal.
TEST(WallShapes, TheNormalIsTheGradientOfTheDistance) {
  std::mt19937_64 rng(2);
  const double h = 1e-6;
  for (const WallSample& sample : wall_samples()) {
    const Wall wall{sample.name, 0, sample.shape, {}};
    int checked = 0;
    for (int k = 0; k < 300; ++k) {
      const WallPose pose = random_pose(rng);
      const Vec3 centre = to_lab(pose, random_centre(sample, reach, rng));
      for (const WallTouch& touch : touches_of(wall, pose, centre, 2 * reach)) {
        if (std::abs(touch.distance) < 0.05 * reach) continue;
        Vec3 gradient;
        bool kept = true;
        for (int c = 0; c < 3 && kept; ++c) {
          const Vec3 step = h * Vec3::Unit(c);
          const auto up = touches_of(wall, pose, centre + step, 2 * reach);
          const auto down = touches_of(wall, pose, centre - step, 2 * reach);
          const WallTouch *a = same_feature(up, touch.feature), *b = same_feature(down, touch.feature);
          kept = a != nullptr && b != nullptr;
          if (kept) gradient[c] = (a->distance - b->distance) / (2 * h);
        }
        if (!kept) continue;
        ++checked;
        // Rounding 1e-16/h, curvature of the distance h^2/distance^2.
        EXPECT_NEAR((gradient + touch.normal).norm(), 0, 1e-8) << sample.name;
      }
    }
    EXPECT_GT(checked, 200) << sample.name;
  }
}

// The Laplacian of the distance to a surface with principal curvatures k, at distance d on the side where they are
// counted positive when hollow, is the sum of -k / (1 - k d).
TEST(WallShapes, CurvaturesAreThoseOfTheDistance) {
  std::mt19937_64 rng(3);
  const double h = 1e-5;
  for (const WallSample& sample : wall_samples()) {
    const Wall wall{sample.name, 0, sample.shape, {}};
    int checked = 0;
    for (int k = 0; k < 300; ++k) {
      const WallPose pose = random_pose(rng);
      const Vec3 centre = to_lab(pose, random_centre(sample, 0.3 * reach, rng));
      for (const WallTouch& touch : touches_of(wall, pose, centre, reach)) {
        if (touch.kind != MeshFeature::face) {
          EXPECT_EQ(touch.curvature[0], 0);
          EXPECT_EQ(touch.curvature[1], 0);
          continue;
        }
        if (std::abs(touch.distance) < 100 * h) continue;  // the far side of a sheet
        double divergence = 0;
        bool kept = true;
        for (int c = 0; c < 3 && kept; ++c) {
          const Vec3 step = h * Vec3::Unit(c);
          const auto up = touches_of(wall, pose, centre + step, reach),
                     down = touches_of(wall, pose, centre - step, reach);
          const WallTouch *a = same_feature(up, touch.feature), *b = same_feature(down, touch.feature);
          kept = a != nullptr && b != nullptr;
          if (kept) divergence += (a->normal[c] - b->normal[c]) / (2 * h);
        }
        if (!kept) continue;
        double expected = 0;
        // A hollow whose centre is close amplifies the error of the difference.
        double scale = 1;
        for (const double curvature : touch.curvature) {
          expected += curvature / (1 - curvature * touch.distance);
          scale = std::max(scale, std::abs(curvature / (1 - curvature * touch.distance)));
        }
        if (scale > 50) continue;
        ++checked;
        EXPECT_NEAR(divergence, expected, 1e-9 * scale * scale * scale + 1e-9) << sample.name;
      }
    }
    EXPECT_GT(checked, 100) << sample.name;
  }
}

// The distance to a set changes by at most as much as the centre moves; so it is continuous across faces, rims, edges
// and vertices. Where a touch passes from a face to a rim the normal is continuous too.
TEST(WallShapes, TouchesDoNotJump) {
  std::mt19937_64 rng(4);
  for (const WallSample& sample : wall_samples()) {
    const Wall wall{sample.name, 0, sample.shape, {}};
    const WallPose pose = random_pose(rng);
    const auto touch_at = [&](const Vec3& x) { return *nearest_of(touches_of(wall, pose, x, 10 * reach)); };
    int crossings = 0;
    for (int k = 0; k < 500; ++k) {
      Vec3 a = to_lab(pose, random_centre(sample, reach, rng));
      Vec3 b = a + 0.2 * random_direction(rng);
      if (sample.solid && inside_material(wall, pose, b)) continue;
      WallTouch at_a = touch_at(a), at_b = touch_at(b);
      EXPECT_LE(std::abs(at_a.distance - at_b.distance), (a - b).norm() + 1e-14) << sample.name;
      if (!sample.round || at_a.feature == at_b.feature) continue;
      while ((a - b).norm() > 1e-14) {
        const Vec3 middle = 0.5 * (a + b);
        if (middle == a || middle == b) break;
        const WallTouch at_middle = touch_at(middle);
        if (at_middle.feature == at_a.feature) {
          a = middle;
          at_a = at_middle;
        } else {
          b = middle;
          at_b = at_middle;
        }
      }
      // A path through a sheet, a rim or the axis, where the nearest place changes side, is not a roll over a rim.
      if (at_a.distance < 1e-3 || (at_a.point - at_b.point).norm() > 1e-3) continue;
      ++crossings;
      EXPECT_NEAR(at_a.distance, at_b.distance, 1e-13) << sample.name;
      EXPECT_NEAR((at_a.normal - at_b.normal).norm(), 0, 1e-10) << sample.name;
    }
    if (sample.round && !sample.solid) {
      EXPECT_GT(crossings, 20) << sample.name;
    }
  }
}

// A grain rolls from one side of a sheet over its rim to the other: always one touch, at the same distance.
TEST(WallShapes, AGrainKeepsItsTouchAllTheWayRoundARim) {
  const double distance = 0.01, radius = 0.2, height = 0.1;
  const Wall tube{"tube", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), radius, FreeSide::inside, 0, height}, {}};
  std::vector<std::uint64_t> features;
  double previous = -1;
  for (int k = 0; k <= 4000; ++k) {
    // Up along the inner face, half round the upper rim, down along the outer face.
    const double path = -0.05 + k * (0.1 + pi * distance) / 4000;
    const double angle = std::clamp(path / distance, 0.0, pi);
    const double down = path < 0 ? path : -std::max(path - pi * distance, 0.0);
    const Vec3 centre(radius - distance * std::cos(angle), 0, height + distance * std::sin(angle) + down);
    const auto found = touches_of(tube, {}, centre, 2 * distance);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].distance, distance, 1e-15);
    EXPECT_NEAR(found[0].normal.x(), std::cos(angle), 1e-13);
    if (features.empty() || features.back() != found[0].feature) features.push_back(found[0].feature);
    EXPECT_GT(path, previous);
    previous = path;
  }
  EXPECT_EQ(features, (std::vector<std::uint64_t>{0, 2, 0}));
}

TEST(WallShapes, NearIsWithinReach) {
  std::mt19937_64 rng(6);
  for (const WallSample& sample : wall_samples()) {
    const Wall wall{sample.name, 0, sample.shape, {}};
    int yes = 0;
    for (int k = 0; k < 500; ++k) {
      const WallPose pose = random_pose(rng);
      const Vec3 centre = to_lab(pose, random_centre(sample, 2 * reach, rng));
      const bool touched = !touches_of(wall, pose, centre, 0.7 * reach).empty();
      yes += touched ? 1 : 0;
      const bool found = near(wall, pose, centre, 0.7 * reach);
      const bool may_say_yes_too_often = std::holds_alternative<MeshWall>(wall.shape);
      EXPECT_TRUE(found == touched || (found && may_say_yes_too_often)) << sample.name;
    }
    EXPECT_GT(yes, 50) << sample.name;
    EXPECT_LT(yes, 450) << sample.name;
  }
}

WallMotion random_steady(std::mt19937_64& rng) {
  WallMotion motion;
  motion.start = random_direction(rng);
  motion.velocity = uniform(rng, 0, 2) * random_direction(rng);
  motion.angular_velocity = uniform(rng, 0, 5) * random_direction(rng);
  motion.pivot = uniform(rng, 0, 1) * random_direction(rng);
  motion.orientation = Eigen::AngleAxisd(uniform(rng, 0, 6), random_direction(rng));
  return motion;
}

WallMotion random_table(std::mt19937_64& rng) {
  std::vector<PoseRow> rows;
  for (int k = 0; k < 6; ++k)
    rows.push_back({0.4 * k + uniform(rng, 0, 0.3), random_direction(rng),
                    Eigen::Quaterniond(Eigen::AngleAxisd(uniform(rng, 0, 6), random_direction(rng)))});
  WallMotion motion;
  motion.table = std::make_shared<const PoseTable>(rows);
  return motion;
}

// A grain that moves along with a wall keeps its touch.
TEST(WallShapes, AGrainThatIsCarriedAlongKeepsItsTouch) {
  std::mt19937_64 rng(7);
  for (const WallSample& sample : wall_samples())
    for (int k = 0; k < 100; ++k) {
      const Wall wall{sample.name, 0, sample.shape, k % 2 ? random_steady(rng) : random_table(rng)};
      const Vec3 body = random_centre(sample, reach, rng);
      const auto still = touches_of(wall, {}, body, reach);
      const WallPose pose = pose_at(wall.motion, uniform(rng, -0.5, 3));
      const auto moved = touches_of(wall, pose, to_lab(pose, body), reach);
      ASSERT_EQ(still.size(), moved.size()) << sample.name;
      for (std::size_t t = 0; t < still.size(); ++t) {
        EXPECT_EQ(still[t].feature, moved[t].feature) << sample.name;
        EXPECT_EQ(still[t].facet, moved[t].facet) << sample.name;
        EXPECT_NEAR(still[t].distance, moved[t].distance, 1e-14) << sample.name;
        EXPECT_NEAR(still[t].curvature[0], moved[t].curvature[0], 1e-11 * (1 + std::abs(still[t].curvature[0])));
        EXPECT_NEAR((to_lab(pose, still[t].point) - moved[t].point).norm(), 0, 1e-13) << sample.name;
      }
    }
}

// How fast the distance from a fixed place changes, at the places and times where it changes fastest, is never more
// than largest_speed and not much less.
TEST(WallShapes, NoSurfaceMovesFasterThanItsLargestSpeed) {
  std::mt19937_64 rng(8);
  const double h = 1e-6;
  for (const WallSample& sample : wall_samples()) {
    const bool endless = sample.solid && (sample.round || std::holds_alternative<Plane>(sample.shape));
    double tightest = 0;
    for (int k = 0; k < 40; ++k) {
      Wall wall{sample.name, 0, sample.shape, k % 2 ? random_steady(rng) : random_table(rng)};
      if (endless) {
        EXPECT_THROW(largest_speed(wall), CaseError) << sample.name;
        // About its own direction it may turn.
        const Vec3 axis = std::holds_alternative<Plane>(sample.shape) ? std::get<Plane>(sample.shape).normal
                                                                      : std::get<Cylinder>(sample.shape).axis;
        wall.motion = random_steady(rng);
        wall.motion.angular_velocity = uniform(rng, -3, 3) * (wall.motion.orientation * axis);
      }
      const double bound = largest_speed(wall);
      for (int s = 0; s < 300; ++s) {
        const double time = uniform(rng, 0, 2.5);
        const WallPose before = pose_at(wall.motion, time - h), after = pose_at(wall.motion, time + h);
        const Vec3 x = to_lab(before, random_centre(sample, 0.2 * reach, rng));
        const double a = nearest_of(touches_of(wall, before, x, reach))->distance;
        const auto later = touches_of(wall, after, x, reach);
        if (later.empty()) {  // only front sides touch: the surface has passed the centre, which it then was near enough for
          EXPECT_LE(a, 2 * h * bound) << sample.name;
          continue;
        }
        const double speed = std::abs(nearest_of(later)->distance - a) / (2 * h);
        // Rounding 1e-15/h.
        EXPECT_LE(speed, bound * (1 + 1e-8) + 1e-8) << sample.name;
        tightest = std::max(tightest, speed / bound);
      }
    }
    EXPECT_GT(tightest, 0.7) << sample.name;
  }
}

TEST(WallShapes, WhatMapsASurfaceOnItselfDoesNotMoveIt) {
  const double inf = std::numeric_limits<double>::infinity();
  WallMotion spin;
  spin.angular_velocity = Vec3(0, 0, 7);
  const auto speed = [&](WallShape shape, const WallMotion& motion) {
    return largest_speed({"w", 0, std::move(shape), motion});
  };
  EXPECT_EQ(speed(Plane{}, spin), 0);
  EXPECT_EQ(speed(Cylinder{Vec3(0, 0, 3), Vec3::UnitZ(), 2}, spin), 0);
  EXPECT_EQ(speed(Cylinder{Vec3(0, 0, 3), Vec3::UnitZ(), 2, FreeSide::inside, 0, 1}, spin), 0);
  EXPECT_EQ(speed(Cone{Vec3(0, 0, 3), Vec3::UnitZ(), 2, 1, 1}, spin), 0);
  EXPECT_EQ(speed(Disc{Vec3(0, 0, 3), Vec3::UnitZ(), 2, 1}, spin), 0);
  // An axis that goes round another one; a belt; a screw.
  EXPECT_NEAR(speed(Cylinder{Vec3(0.1, 0, 3), Vec3::UnitZ(), 2}, spin), 0.7, 1e-14);
  WallMotion slide;
  slide.velocity = Vec3(3, 0, 0.5);
  EXPECT_NEAR(speed(Plane{}, slide), 0.5, 1e-15);
  EXPECT_NEAR(speed(Cylinder{Vec3::Zero(), Vec3::UnitX(), 2}, slide), 0.5, 1e-15);
  EXPECT_NEAR(speed(Cylinder{Vec3::Zero(), Vec3::UnitX(), 2, FreeSide::inside, -inf, 0}, slide), slide.velocity.norm(),
              1e-15);
  EXPECT_THROW(speed(Cylinder{Vec3::Zero(), Vec3::UnitX(), 2, FreeSide::inside, -inf, 0}, spin), CaseError);
}

TEST(WallShapes, MaterialIsBehindTheFreeSide) {
  const auto filled = [](WallShape shape, const Vec3& x) {
    return inside_material({"", 0, std::move(shape), {}}, {}, x);
  };
  EXPECT_TRUE(filled(Plane{}, Vec3(5, 5, -1e-9)));
  EXPECT_FALSE(filled(Plane{}, Vec3(5, 5, 1e-9)));
  const Cylinder rod{Vec3::Zero(), Vec3::UnitZ(), 1, FreeSide::outside, 0, 2};
  EXPECT_TRUE(filled(rod, Vec3(0.5, 0.5, 1)));
  EXPECT_FALSE(filled(rod, Vec3(0.5, 0.5, 2.1)));
  EXPECT_FALSE(filled(rod, Vec3(1, 1, 1)));
  const Cone hopper{Vec3(0, 0, 1), Vec3::UnitZ(), 1, 3, 2};
  EXPECT_FALSE(filled(hopper, Vec3(1.9, 0, 2)));
  EXPECT_TRUE(filled(hopper, Vec3(2.1, 0, 2)));
  EXPECT_FALSE(filled(hopper, Vec3(2.1, 0, 0.9)));
  EXPECT_FALSE(filled(Disc{Vec3::Zero(), Vec3::UnitZ(), 1, 0}, Vec3::Zero()));
  const GluedGrains glued = make_glued_grains({Vec3::Zero(), Vec3(1, 0, 0)}, {0.4, 0.3});
  EXPECT_TRUE(filled(glued, Vec3(0, 0.39, 0)));
  EXPECT_TRUE(filled(glued, Vec3(1, 0.29, 0)));
  EXPECT_FALSE(filled(glued, Vec3(1, 0.31, 0)));
}

TEST(WallShapes, NumbersThatMakeNoShapeAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const WallSample& sample : wall_samples()) EXPECT_NO_THROW(validate_wall({"w", 0, sample.shape, {}}));
  const std::vector<WallShape> bad{
      Plane{Vec3(0, nan, 0), Vec3::UnitZ()},
      Plane{Vec3::Zero(), Vec3(0, 0, 2)},
      Cylinder{Vec3::Zero(), Vec3(0, 0, 2), 1},
      Cylinder{Vec3::Zero(), Vec3::UnitZ(), 0},
      Cylinder{Vec3::Zero(), Vec3::UnitZ(), 1, FreeSide::inside, 1, 1},
      Cylinder{Vec3::Zero(), Vec3::UnitZ(), 1, FreeSide::inside, nan, 1},
      Cone{Vec3::Zero(), Vec3::UnitZ(), 0, 0, 1},
      Cone{Vec3::Zero(), Vec3::UnitZ(), -1, 1, 1},
      Cone{Vec3::Zero(), Vec3::UnitZ(), 1, 1, 0},
      Disc{Vec3::Zero(), Vec3::UnitZ(), 1, 1},
      Disc{Vec3::Zero(), Vec3::UnitZ(), 1, -1},
      GluedGrains{},
      MeshWall{},
  };
  for (std::size_t k = 0; k < bad.size(); ++k) {
    try {
      validate_wall({"odd one", 0, bad[k], {}});
      ADD_FAILURE() << "row " << k << " passed";
    } catch (const CaseError& error) {
      EXPECT_EQ(std::string(error.what()).find("wall 'odd one'"), 0u) << error.what();
    }
  }
  EXPECT_THROW(make_glued_grains({}, {}), CaseError);
  EXPECT_THROW(make_glued_grains({Vec3::Zero()}, {}), CaseError);
  EXPECT_THROW(make_glued_grains({Vec3::Zero()}, {0}), CaseError);
}

}  // namespace
}  // namespace dem
