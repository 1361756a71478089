#include "libdem/case/check_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "libdem/errors.hpp"
#include "tests/dem/case/ft4.hpp"

namespace dem {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// The first problem as "key message".
std::string first_problem(const Case& c) {
  const auto problems = case_problems(c);
  return problems.empty() ? "none" : problems.front().key + " " + problems.front().message;
}

template <class Change>
std::string after(Change change) {
  Case c = ft4('a');
  change(c);
  return first_problem(c);
}

TEST(CheckCase, ThePaperRunsHaveNoProblems) {
  for (const char test : {'a', 'b', 'c'}) {
    EXPECT_EQ(first_problem(ft4(test)), "none") << test;
    EXPECT_TRUE(check_case(ft4(test)).empty()) << test;
  }
}

TEST(CheckCase, EverySizeMustBePositiveAndFinite) {
  EXPECT_EQ(after([](Case& c) { c.materials[0].density = 0; }), "material.glass.density must be positive, got 0 kg/m3");
  EXPECT_EQ(after([](Case& c) { c.materials[1].young = -1; }), "material.steel.young must be positive, got -1 Pa");
  EXPECT_EQ(after([](Case& c) { c.materials[0].poisson = 0.6; }),
            "material.glass.poisson must lie in [0, 0.5], got 0.6");
  EXPECT_EQ(after([](Case& c) { c.interactions[0][1].restitution = 0; }),
            "interaction.glass-steel.restitution must lie in (0, 1], got 0");
  EXPECT_EQ(after([](Case& c) { c.interactions[0][0].friction = -0.1; }),
            "interaction.glass-glass.friction must not be negative, got -0.1");
  EXPECT_EQ(after([](Case& c) { c.bed.mean_diameter = std::numeric_limits<double>::quiet_NaN(); }),
            "bed.mean_diameter must be positive, got nan m");
  EXPECT_EQ(after([](Case& c) { c.bed.depth = -1; }), "bed.depth must be positive, got -1 m");
  EXPECT_EQ(after([](Case& c) { c.vessel.diameter = 0; }), "vessel.diameter must be positive, got 0 m");
  EXPECT_EQ(after([](Case& c) { std::get<TwistedBlade>(c.blade.shape).thickness = 0; }),
            "blade.thickness must be positive, got 0 m");
  EXPECT_EQ(after([](Case& c) { c.motion.tip_speed = 0; }), "motion.tip_speed must be positive, got 0 m/s");
  EXPECT_EQ(after([](Case& c) { c.motion.helix_angle = 2; }),
            "motion.helix_angle must lie in (-90, 90) deg, got 114.592 deg");
  EXPECT_EQ(after([](Case& c) { c.duration = 0; }), "run.duration must be positive, got 0 s");
  EXPECT_EQ(after([](Case& c) { c.step = std::numeric_limits<double>::infinity(); }),
            "run.step must be positive, got inf s");
  EXPECT_EQ(after([](Case& c) { c.gravity.setZero(); }),
            "run.gravity must be positive, or the bed does not settle; got 0 m/s2");
}

TEST(CheckCase, TheBedMustHoldGrains) {
  EXPECT_EQ(after([](Case& c) { c.bed.size_high = 0.7; }),
            "bed.size_high must not be smaller than bed.size_low = 0.8, got 0.7");
  EXPECT_EQ(after([](Case& c) { c.bed.depth = 1e-3; }),
            "bed.depth leaves no bed: 0.001 m is less than one grain of 0.00111 m");
  EXPECT_THAT(after([](Case& c) { c.bed.mean_diameter = 1e-5; }), StartsWith("bed.mean_diameter would need 2.8"));
  EXPECT_THAT(after([](Case& c) { c.bed.mean_diameter = 20e-3; }),
              StartsWith("vessel.diameter must be at least two of the largest grains (0.024 m)"));
  EXPECT_THAT(after([](Case& c) { c.bed.size_high = 1.5; }),
              HasSubstr("mean_diameter is not the mean: it is 1.15 times"));
}

TEST(CheckCase, TheBladeMustFitTheVesselForTheWholeRun) {
  EXPECT_EQ(after([](Case& c) { std::get<TwistedBlade>(c.blade.shape).diameter = 25e-3; }),
            "blade.diameter must be smaller than vessel.diameter = 0.025 m, got 0.025 m");
  EXPECT_EQ(after([](Case& c) { c.blade.start_height = 20e-3; }),
            "blade.start_height = 0.02 m is too low: moving down at 0.0217889 m/s the blade reaches the floor after "
            "0.917897 s of 2 s");
  EXPECT_EQ(after([](Case& c) { c.blade.start_height = 0; }),
            "blade.start_height must be positive (0 is the vessel floor), got 0 m");
  EXPECT_THAT(after([](Case& c) { c.blade.start_height = 44e-3; }), HasSubstr("grains will be crushed there"));
  EXPECT_THAT(after([](Case& c) { c.blade.start_height = 100e-3; }), HasSubstr("keeps the blade above the bed"));
}

TEST(CheckCase, AMeshBladeIsJudgedByItsMeasuredTipRadius) {
  Case c = ft4('a');
  c.blade.shape = MeshFile{"blade.stl", 1e-3};
  EXPECT_TRUE(case_problems(c, 11.75e-3).empty());
  const auto problems = case_problems(c, 13e-3);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].key + " " + problems[0].message,
            "blade.file reaches 0.013 m from the axis, the vessel only 0.0125 m");
  EXPECT_TRUE(case_problems(c).empty());  // not measured: not judged
}

TEST(CheckCase, TheStepIsHeldAgainstTheSmallestGrainsRayleighTime) {
  // 30 % of 3.945e-7 s is 1.18e-7 s, 20 % is 7.9e-8 s.
  EXPECT_EQ(
      after([](Case& c) { c.step = 2e-7; }),
      "run.step = 2e-07 s is 50.7 % of the smallest grain's Rayleigh time (3.94537e-07 s); at most 30 % is stable, "
      "10 to 20 % is usual");
  const auto fatal = [](double step) {
    Case c = ft4('a');
    c.step = step;
    const auto problems = case_problems(c);
    return problems.empty() ? "none" : problems.front().fatal ? "refused" : "warned";
  };
  EXPECT_STREQ(fatal(1.25e-7), "refused");  // 31.7 %
  EXPECT_STREQ(fatal(1e-7), "warned");      // 25.3 %
  EXPECT_STREQ(fatal(6.25e-8), "none");     // 15.8 %
}

TEST(CheckCase, IntervalsAreWholeNumbersOfSteps) {
  EXPECT_EQ(after([](Case& c) { c.output.frame_interval = 1.23e-7; }),
            "output.frame_interval must be a whole number of steps of 5e-08 s, got 1.23e-07 s = 2.46 steps");
  EXPECT_EQ(after([](Case& c) { c.output.series_interval = 0; }), "output.series_interval must be positive, got 0 s");
  EXPECT_EQ(after([](Case& c) { c.output.checkpoint_interval = 5; }),
            "output.checkpoint_interval = 5 s is longer than the run (2 s)");
}

TEST(CheckCase, UnknownMaterialsAreNamedAndNothingElseIsTried) {
  EXPECT_EQ(after([](Case& c) { c.bed.material = "glas"; }), "bed.material is not among the materials: 'glas'");
  EXPECT_EQ(after([](Case& c) { c.interactions.clear(); }), "interaction must be given for every pair of materials");
}

TEST(CheckCase, ThrowsTheFirstFatalProblemAndReturnsTheRest) {
  Case c = ft4('a');
  c.step = 1e-7;
  ASSERT_EQ(check_case(c).size(), 1u);
  EXPECT_THAT(check_case(c)[0], StartsWith("run.step = 1e-07 s is 25.3 %"));
  c.bed.depth = 0;
  EXPECT_THROW(check_case(c), CaseError);
}

}  // namespace
}  // namespace dem
