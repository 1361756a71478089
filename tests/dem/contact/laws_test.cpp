// What every row of the law table must satisfy.
#include "libdem/contact/laws.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "libdem/contact/pair_constants.hpp"

namespace dem {
namespace {

template <class Tuple>
struct AsTypes;
template <class... Law>
struct AsTypes<std::tuple<Law...>> {
  using type = testing::Types<Law...>;
};

constexpr double dt = 5e-8;

class Random {
 public:
  double in(double low, double high) { return low + (high - low) * double(engine_() >> 11) * 0x1.0p-53; }
  Vec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = vector(1);
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }

 private:
  std::mt19937_64 engine_{20261122};
};

PairConstants<double> glass(double adhesion, double rolling = 0.01) {
  const MaterialTable table = make_material_table({{"glass", 2500, 63e9, 0.2}}, {{{0.9, 0.5, rolling, adhesion}}});
  const double radius = 0.4625e-3, mass = 1.0e-6;
  const BodyConstants body{radius, mass, 0.4 * mass * radius * radius};
  return pair_constants(table(0, 0), body, body);
}

Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vec(const Triple<double>& t) { return {t.x, t.y, t.z}; }

struct Sample {
  Touch<double> touch;
  Vec3 spring;
};

// Overlaps from the adhesive neck to kilonewtons, slow and fast, sticking and sliding.
Sample sample(Random& random, const PairConstants<double>& c) {
  Sample s;
  s.touch.overlap = random.in(0, 1) < 0.3 ? random.in(-0.4, 1) * c.adhesion_length : std::pow(10, random.in(-9, -4));
  const Vec3 n = random.direction();
  s.touch.normal = triple(n);
  const double speed = std::pow(10, random.in(-4, 0));
  s.touch.velocity = triple(random.vector(speed));
  s.touch.spin = triple(random.vector(speed / 1e-3));
  s.spring = random.vector(std::pow(10, random.in(-10, -6)));
  s.spring -= s.spring.dot(n) * n;
  return s;
}

template <class Law>
class EveryLaw : public testing::Test {};
TYPED_TEST_SUITE(EveryLaw, AsTypes<ContactLaws>::type);

TYPED_TEST(EveryLaw, TurnsWithTheFrameOfReference) {
  Random random;
  const PairConstants<double> c = glass(0.274);
  for (int k = 0; k < 2000; ++k) {
    const Sample s = sample(random, c);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.in(0, 6), random.direction()).toRotationMatrix();
    Touch<double> turned = s.touch;
    turned.normal = triple(turn * vec(s.touch.normal));
    turned.velocity = triple(turn * vec(s.touch.velocity));
    turned.spin = triple(turn * vec(s.touch.spin));
    Triple<double> spring = triple(s.spring), turned_spring = triple(turn * s.spring);
    const ContactForce<double> f = TypeParam::evaluate(s.touch, c, spring, dt);
    const ContactForce<double> g = TypeParam::evaluate(turned, c, turned_spring, dt);
    const double size = std::abs(f.elastic) + std::abs(f.damping) + vec(f.tangential).norm();
    EXPECT_NEAR(f.elastic, g.elastic, 1e-12 * size);
    EXPECT_NEAR(f.damping, g.damping, 1e-12 * size);
    EXPECT_NEAR((turn * vec(f.tangential) - vec(g.tangential)).norm(), 0, 1e-12 * size);
    EXPECT_NEAR((turn * vec(f.rolling_torque) - vec(g.rolling_torque)).norm(), 0, 1e-12 * vec(f.rolling_torque).norm());
  }
}

TYPED_TEST(EveryLaw, KeepsCoulombsLimitAndPushesAlongTheSurface) {
  Random random;
  const PairConstants<double> c = glass(0.274);
  int sliding = 0;
  for (int k = 0; k < 2000; ++k) {
    const Sample s = sample(random, c);
    Triple<double> spring = triple(s.spring);
    const ContactForce<double> f = TypeParam::evaluate(s.touch, c, spring, dt);
    const double limit = c.friction * TypeParam::Normal::evaluate(s.touch.overlap, c).friction_load;
    const double friction = vec(f.tangential).norm();
    EXPECT_LE(friction, limit * (1 + 1e-12));
    EXPECT_NEAR(vec(f.tangential).dot(vec(s.touch.normal)), 0, 1e-9 * friction);
    sliding += f.sliding ? 1 : 0;
  }
  EXPECT_GT(sliding, 200);
  EXPECT_LT(sliding, 1800);
}

TYPED_TEST(EveryLaw, DampingAndRollingFrictionTakeEnergy) {
  Random random;
  const PairConstants<double> c = glass(0.274);
  for (int k = 0; k < 2000; ++k) {
    const Sample s = sample(random, c);
    Triple<double> spring = triple(s.spring);
    const ContactForce<double> f = TypeParam::evaluate(s.touch, c, spring, dt);
    EXPECT_GE(f.damping * vec(s.touch.velocity).dot(vec(s.touch.normal)), 0);
    EXPECT_LE(vec(f.rolling_torque).dot(vec(s.touch.spin)), 0);
    // Not so much that the spin turns around.
    EXPECT_LE(vec(f.rolling_torque).norm() * dt, 0.1000001 * c.effective_inertia * vec(s.touch.spin).norm());
  }
}

TYPED_TEST(EveryLaw, FormsAtPositiveOverlapAndLetsGoWhereItSays) {
  const PairConstants<double> c = glass(0.274);
  const double last = TypeParam::Normal::break_overlap(c);
  EXPECT_LE(last, 0);
  EXPECT_TRUE((TypeParam::holds(1e-12, false, c)));
  EXPECT_FALSE((TypeParam::holds(-1e-12, false, c)));
  EXPECT_TRUE((TypeParam::holds(0.999 * last, true, c)));
  EXPECT_FALSE((TypeParam::holds(1.001 * last - 1e-15, true, c)));
}

TYPED_TEST(EveryLaw, APackGivesTheSameBitsAsSingleNumbers) {
  Random random;
  const PairConstants<double> c = glass(0.274);
  PairConstants<Pack> packed;
  packed.effective_modulus = c.effective_modulus;
  packed.effective_shear = c.effective_shear;
  packed.damping_ratio = c.damping_ratio;
  packed.friction = c.friction;
  packed.rolling_friction = c.rolling_friction;
  packed.work_of_adhesion = c.work_of_adhesion;
  packed.effective_radius = c.effective_radius;
  packed.effective_mass = c.effective_mass;
  packed.effective_inertia = c.effective_inertia;
  packed.adhesion_length = c.adhesion_length;
  for (int k = 0; k < 500; ++k) {
    std::vector<Sample> lanes;
    for (std::size_t l = 0; l < pack_width; ++l) lanes.push_back(sample(random, c));
    const auto pack = [&](auto get) { return Pack([&](auto l) { return get(lanes[std::size_t(l)]); }); };
    Touch<Pack> touch;
    touch.overlap = pack([](const Sample& s) { return s.touch.overlap; });
    touch.normal = {pack([](const Sample& s) { return s.touch.normal.x; }), pack([](const Sample& s) { return s.touch.normal.y; }),
                    pack([](const Sample& s) { return s.touch.normal.z; })};
    touch.velocity = {pack([](const Sample& s) { return s.touch.velocity.x; }), pack([](const Sample& s) { return s.touch.velocity.y; }),
                      pack([](const Sample& s) { return s.touch.velocity.z; })};
    touch.spin = {pack([](const Sample& s) { return s.touch.spin.x; }), pack([](const Sample& s) { return s.touch.spin.y; }),
                  pack([](const Sample& s) { return s.touch.spin.z; })};
    Triple<Pack> springs{pack([](const Sample& s) { return s.spring.x(); }), pack([](const Sample& s) { return s.spring.y(); }),
                         pack([](const Sample& s) { return s.spring.z(); })};
    const ContactForce<Pack> f = TypeParam::evaluate(touch, packed, springs, Pack(dt));
    for (std::size_t l = 0; l < pack_width; ++l) {
      Triple<double> spring = triple(lanes[l].spring);
      const ContactForce<double> g = TypeParam::evaluate(lanes[l].touch, c, spring, dt);
      EXPECT_EQ(double(f.elastic[l]), g.elastic);
      EXPECT_EQ(double(f.damping[l]), g.damping);
      EXPECT_EQ(double(f.tangential.x[l]), g.tangential.x);
      EXPECT_EQ(double(f.rolling_torque.z[l]), g.rolling_torque.z);
      EXPECT_EQ(double(springs.y[l]), spring.y);
      EXPECT_EQ(bool(f.sliding[l]), g.sliding);
    }
  }
}

}  // namespace
}  // namespace dem
