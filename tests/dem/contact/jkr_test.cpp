#include "libdem/contact/normal/jkr.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "libdem/contact/pair_constants.hpp"
#include "tests/support/csv.hpp"
#include "tests/dem/pair_constants.hpp"

namespace dem {
namespace {

PairConstants<double> constants(double modulus, double gamma, double radius) {
  PairConstants<double> c{};
  c.effective_modulus = modulus;
  c.work_of_adhesion = gamma;
  set_adhesion(c);
  set_effective_radius(c, radius);
  return c;
}

// Reference: 60-digit evaluation of Johnson, Kendall and Roberts' equations, 191 points from the cut-off to kilonewtons.
// Tolerance: the overlap is given as a double, so the force inherits its conditioning; a few roundings more are ours.
TEST(Jkr, ForceAndContactRadiusAgreeWithTheSixtyDigitReference) {
  const double eps = std::numeric_limits<double>::epsilon();
  int points = 0;
  for (const support::Row& row : support::read_csv(JAMSCOPE_DATA_DIR "/reference/jkr_reference.csv")) {
    const auto value = [&](const char* key) { return std::stod(row.at(key)); };
    const PairConstants<double> c = constants(value("E_star_Pa"), value("Gamma_J_m2"), value("R_star_m"));
    const NormalForce<double> f = Jkr::evaluate(value("alpha_m"), c);
    const double relative = 4 * eps * (1 + value("cond_F"));
    EXPECT_NEAR(f.elastic, value("F_N"), std::max(relative * std::abs(value("F_N")), 1e-13 * value("Fc_N")))
        << row.at("case") << " " << row.at("geometry") << " " << row.at("label");
    EXPECT_NEAR(f.contact_radius(), value("a_m"), relative * value("a_m"))
        << row.at("case") << " " << row.at("geometry") << " " << row.at("label");
    EXPECT_NEAR(jkr_stiffness(value("alpha_m"), c), value("dF_dalpha_N_m"),
                // its conditioning is about the square of the force's; absolute at the force minimum, where it is zero
                1e-14 * value("Fc_N") / c.adhesion_length +
                    std::abs(value("dF_dalpha_N_m")) * 1e-13 * (1 + 50 * value("cond_F") * value("cond_F")))
        << row.at("label");
    ++points;
  }
  EXPECT_EQ(points, 191);
}

TEST(Jkr, BreaksAtFiveNinthsOfThePullOffForce) {
  const PairConstants<double> c = constants(3.28125e10, 0.274, 2.3125e-4);
  const double pull_off = pull_off_force(0.274, 2.3125e-4);
  EXPECT_NEAR(Jkr::evaluate(Jkr::break_overlap(c), c).elastic, -5.0 / 9.0 * pull_off, 1e-7 * pull_off);  // vertical slope
  EXPECT_NEAR(Jkr::evaluate(0.0, c).elastic, -8.0 / 9.0 * pull_off, 1e-14 * pull_off);
  // Paper's case A, physics reference table 1.1.
  EXPECT_NEAR(Jkr::break_overlap(c), -4.0643951118e-9, 1e-18);
  EXPECT_NEAR(pull_off, 2.985887467696e-4, 1e-15);
}

// Pulled apart slowly a JKR contact carries F_c at most; its last force is that of the point where it lets go.
TEST(Jkr, CarriesThePullOffForceAtMost) {
  const PairConstants<double> c = constants(3.28125e10, 0.274, 2.3125e-4);
  const double pull_off = pull_off_force(0.274, 2.3125e-4);
  const auto pulled = [&](auto law) {
    double largest = 0;
    const double end = law.break_overlap(c);
    for (int k = 0; k <= 20000; ++k) largest = std::max(largest, -law.evaluate(end * k / 20000.0, c).elastic);
    EXPECT_NEAR(largest, pull_off, 1e-8 * pull_off) << law.name;
    return -law.evaluate(end, c).elastic / pull_off;
  };
  EXPECT_NEAR(pulled(Jkr{}), 5.0 / 9.0, 1e-7);
  EXPECT_NEAR(pulled(JkrNonHysteretic{}), 5.0 / 9.0, 1e-7);
  EXPECT_NEAR(pulled(JkrForceMinimum{}), 1, 1e-12);
}

// Against Newton's iteration on the quartic in extended precision. Three half units in the last place, 1.1e-16 each: the
// residual of Halley's step (four roundings, of which a quarter reaches y), the distance e from the turning point, and the
// sum y_c + e. Towards the turning point the overlap's own rounding counts by d(y)/d(delta) = 1/(4 y^3 - 1).
TEST(Jkr, TheRootIsRightToRoundingOverTwelveDecadesAndInTension) {
  const auto error = [](double delta) {
    const double y = jkr_root(delta);
    long double exact = y;
    for (int k = 0; k < 8; ++k)
      exact -= (exact * exact * exact * exact - exact - delta) / (4 * exact * exact * exact - 1);
    return std::abs(double((y - exact) / exact));
  };
  for (double exponent = -6; exponent <= 6; exponent += 0.001)
    EXPECT_LE(error(std::pow(10.0, exponent)), 3.4e-16) << exponent;
  for (double share = 0; share < 0.99999; share += 1e-4) {
    const double delta = share * jkr_break, y = jkr_root(delta);
    EXPECT_LE(error(delta), 3.4e-16 * (1 + 1 / (4 * y * y * y - 1))) << share;
  }
}

TEST(Jkr, WithoutAdhesionItIsHertz) {
  const PairConstants<double> c = constants(3.28125e10, 0, 2.3125e-4);
  for (double overlap : {1e-9, 1e-6, 1e-4}) {
    EXPECT_EQ(Jkr::evaluate(overlap, c).elastic, Hertz::evaluate(overlap, c).elastic);
    EXPECT_EQ(Jkr::evaluate(overlap, c).root_radius, Hertz::evaluate(overlap, c).root_radius);
  }
}

// J/m^2, down to what a double can hold: from some 1e-20 on no digit of the force shows it.
TEST(Jkr, WithHardlyAnyAdhesionItIsHertzToo) {
  for (const double work : {1e-20, 1e-30, 1e-38, 1e-40, 1e-60, 1e-150, 1e-300}) {
    const PairConstants<double> c = constants(3.28125e10, work, 2.3125e-4);
    for (double overlap : {1e-6, 1e-5, 1e-4}) {
      const double hertz = Hertz::evaluate(overlap, c).elastic;
      EXPECT_NEAR(Jkr::evaluate(overlap, c).elastic, hertz, 1e-14 * hertz) << work;
    }
  }
}

TEST(Jkr, APackGivesTheSameBitsAsSingleNumbers) {
  const PairConstants<double> c = constants(3.28125e10, 0.274, 2.3125e-4);
  const PairConstants<Pack> packed = support::constants_as<Pack>(c);
  for (double start = -0.47; start < 1e5; start = start * (start > 0 ? 1.7 : 0.7) + (start < 0 ? 0.05 : 0)) {
    const Pack overlap([&](auto lane) { return (start + 0.001 * double(lane)) * c.adhesion_length; });
    const NormalForce<Pack> f = Jkr::evaluate(overlap, packed);
    for (std::size_t lane = 0; lane < pack_width; ++lane) {
      const NormalForce<double> g = Jkr::evaluate(double(overlap[lane]), c);
      EXPECT_EQ(double(f.elastic[lane]), g.elastic);
      EXPECT_EQ(double(f.root_radius[lane]), g.root_radius);
    }
  }
}

}  // namespace
}  // namespace dem
