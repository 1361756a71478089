#include "libjam/snapshot/validate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/jam/snapshot/sample_run.hpp"

namespace jam {
namespace {

using sample::error_of;
using testing::HasSubstr;

// The message for the sample frame 1 after `change`.
template <class F>
std::string spoilt(F&& change) {
  Snapshot s = sample::frame(1);
  change(s);
  return error_of([&] { validate(s, sample::info(), "run.h5:frame 1"); });
}

template <class F>
std::string spoilt_run(F&& change) {
  RunInfo r = sample::info();
  change(r);
  return error_of([&] { validate(r, "run.h5"); });
}

template <class F>
std::string spoilt_series(F&& change) {
  Series s = sample::series(1);
  change(s);
  return error_of([&] { validate(s, sample::info(), "run.h5"); });
}

TEST(Validate, GoodDataPass) {
  EXPECT_NO_THROW(validate(sample::info()));
  EXPECT_NO_THROW(validate(RunInfo{}));
  EXPECT_NO_THROW(validate(Snapshot{}, RunInfo{}));
  EXPECT_NO_THROW(validate(Series{}, RunInfo{}));
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NO_THROW(validate(sample::frame(k), sample::info()));
    EXPECT_NO_THROW(validate(sample::series(k), sample::info()));
  }
}

TEST(Validate, ARowOutOfRangeIsNamedWithTheContact) {
  EXPECT_EQ(spoilt([](Snapshot& s) { s.pp.row[17][1] = 5000; }),
            "run.h5:frame 1: contact 17 names particle row 5000, the frame has 61");
  EXPECT_EQ(spoilt([](Snapshot& s) { s.pw.row[3] = 61; }),
            "run.h5:frame 1: wall contact 3 names particle row 61, the frame has 61");
  EXPECT_EQ(spoilt([](Snapshot& s) { s.pw.wall[3] = 6; }),
            "run.h5:frame 1: wall contact 3 names wall 6, the run has 6");
  EXPECT_THAT(spoilt([](Snapshot& s) {
                s.pw.wall[3] = 1;
                s.pw.facet[3] = 4;
              }),
              HasSubstr("wall contact 3 names facet 4, wall 'blade' has 4"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.particles.material[2] = 2; }), HasSubstr("names material 2, the run has 2"));
}

// Every column of the schema in turn: one value, one length.
TEST(Validate, EveryColumnIsCheckedForLengthAndFiniteNumbers) {
  std::size_t lengths = 0, numbers = 0;
  const auto check_all = [&](auto visit) {
    for (std::size_t target = 0;; ++target) {
      bool found = false;
      for (const float bad : {NAN, INFINITY, -INFINITY}) {
        std::string path;
        bool real = false;
        const std::string error = spoilt([&](Snapshot& s) {
          std::size_t at = 0;
          visit(s, [&]<class V>(const schema::Item& item, std::vector<V>& values) {
            if (at++ != target) return;
            found = true;
            path = item.path;
            if constexpr (std::is_same_v<V, float>) {
              values[5] = bad;
              real = true;
            } else if constexpr (std::is_same_v<V, Vec3f>) {
              values[5][2] = bad;
              real = true;
            }
          });
        });
        if (!real) continue;
        ++numbers;
        EXPECT_THAT(error, HasSubstr("run.h5:frame 1: " + path + " row 5"));
        EXPECT_THAT(error, HasSubstr("expected a finite number"));
      }
      if (!found) return;
      std::string path;
      const std::string error = spoilt([&](Snapshot& s) {
        std::size_t at = 0;
        visit(s, [&](const schema::Item& item, auto& values) {
          if (at++ != target) return;
          path = item.path;
          values.push_back(values.back());
        });
      });
      // The first column of a group says how many rows there are, so another one is reported.
      ++lengths;
      EXPECT_THAT(error, HasSubstr(" rows, expected ")) << path;
    }
  };
  check_all([](Snapshot& s, auto f) { schema::visit_particles(s.particles, f); });
  check_all([](Snapshot& s, auto f) { schema::visit_pp(s.pp, f); });
  check_all([](Snapshot& s, auto f) { schema::visit_pw(s.pw, f); });
  EXPECT_EQ(lengths, 7U + 7U + 12U);
  EXPECT_EQ(numbers, 3U * (5 + 4 + 6));
}

TEST(Validate, OptionalColumnsMayBeAbsentAndRequiredOnesNot) {
  EXPECT_EQ(spoilt([](Snapshot& s) {
              s.particles.velocity.clear();
              s.pp.overlap.clear();
              s.pw.normal.clear();
            }),
            "no error");
  EXPECT_THAT(spoilt([](Snapshot& s) { s.particles.radius.clear(); }),
              HasSubstr("/particles/radius has 0 rows, expected 61"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.pp.normal_force.clear(); }),
              HasSubstr("/contacts/pp/normal_force has 0 rows"));
}

TEST(Validate, IdsAscendAndRadiiArePositive) {
  EXPECT_THAT(spoilt([](Snapshot& s) { s.particles.id[4] = s.particles.id[3]; }),
              HasSubstr("particle row 4 has id 10 after id 10, expected ascending unique ids"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.particles.radius[4] = 0; }), HasSubstr("has radius 0 m, expected > 0"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.particles.radius[4] = -1; }), HasSubstr("has radius -1 m"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.particles.compressive_force[4] = -1; }), HasSubstr("compressive force -1 N"));
}

TEST(Validate, ContactsAreSortedAndUniqueWithTheSmallerRowFirst) {
  EXPECT_THAT(spoilt([](Snapshot& s) { std::swap(s.pp.row[8][0], s.pp.row[8][1]); }),
              HasSubstr("contact 8 has particle rows"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.pp.row[8] = s.pp.row[7]; }), HasSubstr("expected sorted unique pairs"));
  EXPECT_THAT(spoilt([](Snapshot& s) { std::swap(s.pw.row[8], s.pw.row[9]); }),
              HasSubstr("wall contact 9 is out of order"));
}

TEST(Validate, NormalsAndQuaternionsAreUnit) {
  EXPECT_THAT(spoilt([](Snapshot& s) { s.pw.normal[6] = Vec3f(0, 2, 0); }),
              HasSubstr("wall contact 6 has a normal of length 2, expected 1"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.walls[1].orientation = Eigen::Quaterniond(2, 0, 0, 0); }),
              HasSubstr("wall 'blade': orientation quaternion of length 2, expected 1"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.walls[1].orientation.coeffs()[0] = NAN; }), HasSubstr("of length nan"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.walls[2].torque[1] = NAN; }), HasSubstr("wall 'floor': torque is nan"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.walls.pop_back(); }), HasSubstr("5 wall states, expected one per wall, 6"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.pw.feature[0] = 3; }), HasSubstr("feature 3, expected 0, 1 or 2"));
  EXPECT_THAT(spoilt([](Snapshot& s) { s.time = INFINITY; }), HasSubstr("time is inf"));
}

TEST(Validate, ARunsWallsMaterialsAndTablesFitTogether) {
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[1].name = "floor"; }), HasSubstr("the name is used twice"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[1].name = "a/b"; }), HasSubstr("wall 'a/b': expected a name"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[1].name = ""; }), HasSubstr("expected a name"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[1].kind = "sphere"; }),
              HasSubstr("expected plane, cylinder, cone, disc, spheres or mesh"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[1].material = "gold"; }), HasSubstr("names material 'gold'"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[0].radius = 0; }), HasSubstr("has radius 0"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[0].axis *= 2; }), HasSubstr("axis of length 2"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[1].triangles[2][1] = 9; }), HasSubstr("triangle 2 names vertex 9"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[1].triangle_label.pop_back(); }), HasSubstr("3 triangle labels"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.interactions.pop_back(); }), HasSubstr("1 rows of interactions"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.interactions[1].pop_back(); }), HasSubstr("has 1 entries, expected 2"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.materials[1].name = "glass"; }), HasSubstr("'glass' is used twice"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.materials[1].young = -1; }), HasSubstr("Young's modulus is -1"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.gravity[0] = NAN; }), HasSubstr("run.h5: gravity is nan"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls.resize(257, r.walls[0]); }), HasSubstr("257 walls"));
}

TEST(Validate, AWallsNumbersMakeItsShape) {
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[0].low = 0.06; }),
              HasSubstr("wall 'vessel side' has its ends at 0.06 m and 0.05 m, expected the lower first"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[0].high = NAN; }), HasSubstr("expected the lower first"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[0].free_side = "left"; }), HasSubstr("its free side 'left'"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[3].radius = r.walls[3].high_radius = 0; }),
              HasSubstr("wall 'hopper' has radius 0 at both ends"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[3].high_radius = -1; }), HasSubstr("high radius is -1"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[3].low = -INFINITY; }), HasSubstr("wall 'hopper': low is -inf"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[4].hole_radius = 0.02; }),
              HasSubstr("wall 'lid' has a hole of radius 0.02 m, expected less than its own radius, 0.015 m"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[5].sphere_radius.pop_back(); }), HasSubstr("2 centres and 1 radii"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[5].sphere_radius[1] = 0; }), HasSubstr("sphere 1 has radius 0 m"));
  EXPECT_THAT(spoilt_run([](RunInfo& r) { r.walls[5].sphere_centre[1][2] = NAN; }), HasSubstr("sphere centres row 1"));
  EXPECT_THAT(spoilt([](Snapshot& s) {
                s.pw.wall[3] = 5;
                s.pw.facet[3] = 2;
              }),
              HasSubstr("wall contact 3 names facet 2, wall 'rough plate' has 2"));
}

TEST(Validate, ASeriesGoesForwardInTimeWithColumnsOfOneLength) {
  EXPECT_THAT(spoilt_series([](Series& s) { s.time[2] = s.time[1]; }), HasSubstr("/series row 2"));
  EXPECT_THAT(spoilt_series([](Series& s) { s.step[3] = 0; }), HasSubstr("/series row 3"));
  EXPECT_THAT(spoilt_series([](Series& s) { s.step.clear(); }), HasSubstr("/series/step has 0 rows, expected 4"));
  EXPECT_THAT(spoilt_series([](Series& s) { s.kinetic_energy.pop_back(); }), HasSubstr("/series/kinetic_energy has 3"));
  EXPECT_THAT(spoilt_series([](Series& s) { s.walls[1].power[1] = NAN; }),
              HasSubstr("/series/walls/blade/power row 1 is nan"));
  EXPECT_THAT(spoilt_series([](Series& s) { s.walls.resize(7); }), HasSubstr("7 walls in the series"));
  EXPECT_EQ(spoilt_series([](Series& s) { s.walls.clear(); }), "no error");
}

}  // namespace
}  // namespace jam
