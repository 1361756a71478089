// What every row of the law table must satisfy.
#include "libdem/contact/laws.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "libdem/contact/pair_constants.hpp"
#include "libdem/errors.hpp"
#include "libdem/particles/particles.hpp"
#include "tests/dem/pair_constants.hpp"

namespace dem {
namespace {

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
  Springs<double> springs;
};

// Overlaps from the adhesive neck to kilonewtons, slow and fast, sticking and sliding.
Sample sample(Random& random, const PairConstants<double>& c) {
  Sample s;
  s.touch.overlap = random.in(0, 1) < 0.3 ? random.in(-0.4, 1) * c.adhesion_length : std::pow(10, random.in(-9, -4));
  const Vec3 n = random.direction();
  s.touch.normal = triple(n);
  const double speed = std::pow(10, random.in(-4, 0));
  s.touch.velocity = triple(random.vector(speed));
  s.touch.closing = random.in(-speed, speed);
  s.touch.spin_i = triple(random.vector(speed / 1e-3));
  s.touch.spin_j = triple(random.vector(speed / 1e-3));
  s.touch.arm_i = random.in(0.3e-3, 0.6e-3);
  s.touch.arm_j = random.in(0.3e-3, 0.6e-3);
  const auto in_plane = [&](double size) {
    const Vec3 v = random.vector(size);
    return triple(v - v.dot(n) * n);
  };
  s.springs.tangential = in_plane(std::pow(10, random.in(-10, -6)));
  s.springs.rolling = in_plane(std::pow(10, random.in(-10, -6)));
  s.springs.contact_radius = std::sqrt(std::max(s.touch.overlap, c.adhesion_length) * c.effective_radius) * random.in(0.9, 1.1);
  return s;
}

// Every composition of the tables that goes together.
std::vector<LawChoice> every_law() {
  std::vector<LawChoice> all;
  const auto rows = []<class... Part>(std::type_identity<std::tuple<Part...>>) { return std::uint8_t(sizeof...(Part)); };
  for (std::uint8_t n = 0; n < rows(std::type_identity<NormalLaws>{}); ++n)
    for (std::uint8_t d = 0; d < rows(std::type_identity<DampingLaws>{}); ++d)
      for (std::uint8_t f = 0; f < rows(std::type_identity<FrictionLimits>{}); ++f)
        for (std::uint8_t t = 0; t < rows(std::type_identity<TangentialLaws>{}); ++t)
          for (std::uint8_t r = 0; r < rows(std::type_identity<RollingLaws>{}); ++r)
            if (const LawChoice law{n, d, f, t, r}; !incompatible(law)) all.push_back(law);
  return all;
}

std::string name_of(const LawChoice& law) {
  return part_names<NormalLaws>()[law.normal] + "_" + part_names<DampingLaws>()[law.damping] + "_" +
         part_names<FrictionLimits>()[law.friction] + "_" + part_names<TangentialLaws>()[law.tangential] + "_" +
         part_names<RollingLaws>()[law.rolling];
}

// Calls body(law, constants of glass grains in that law) for every composition.
template <class Body>
void for_every_law(Body body) {
  for (const LawChoice& law : every_law()) {
    SCOPED_TRACE(name_of(law));
    const MaterialTable table = make_material_table({{"glass", 2500, 63e9, 0.2}}, {{{0.9, 0.5, 0.01, 0.274}}}, law);
    const double radius = 0.4625e-3, mass = 1.0e-6;
    const BodyConstants grain{radius, mass, 0.4 * mass * radius * radius};
    body(law, pair_constants(table(0, 0), grain, grain));
    if (testing::Test::HasFailure()) return;  // the first law that fails is enough to read
  }
}

bool objective_rolling(const LawChoice& law) {
  return with_part<RollingLaws>(law.rolling, [](auto part) { return part.objective; });
}
bool rolling_spring(const LawChoice& law) {
  return with_part<RollingLaws>(law.rolling, [](auto part) { return part.has_spring; });
}

double size_of(const ContactForce<double>& f) {
  return std::abs(f.normal.elastic) + std::abs(f.damping) + vec(f.tangential.elastic).norm() + vec(f.tangential.viscous).norm();
}

TEST(Laws, AreComposedOfEveryPartThatGoesTogether) {
  // 5 normal laws, 3 dampings, 4 tangential, 4 rolling; of the 3 limits Thornton's goes with the 3 JKR laws only.
  EXPECT_EQ(every_law().size(), (3u * 3 + 2 * 2) * 3 * 4 * 4);
}

TEST(EveryLaw, TurnsWithTheFrameOfReference) {
  for_every_law([](const LawChoice& law, const PairConstants<double>& c) {
    Random random;
    for (int k = 0; k < 50; ++k) {
      const Sample s = sample(random, c);
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.in(0, 6), random.direction()).toRotationMatrix();
      const auto turned = [&](const Triple<double>& t) { return triple(turn * vec(t)); };
      Touch<double> touch = s.touch;
      for (Triple<double>* v : {&touch.normal, &touch.velocity, &touch.spin_i, &touch.spin_j}) *v = turned(*v);
      Springs<double> springs = s.springs, there = s.springs;
      there.tangential = turned(there.tangential);
      there.rolling = turned(there.rolling);
      const ContactForce<double> f = evaluate(law, s.touch, c, springs, dt), g = evaluate(law, touch, c, there, dt);
      const double size = size_of(f), torque = vec(f.rolling.on_i).norm() + vec(f.rolling.on_j).norm();
      EXPECT_NEAR(f.normal.elastic, g.normal.elastic, 1e-12 * size);
      EXPECT_NEAR(f.damping, g.damping, 1e-12 * size);
      EXPECT_NEAR((vec(turned(f.tangential.elastic)) - vec(g.tangential.elastic)).norm(), 0, 1e-12 * size);
      EXPECT_NEAR((vec(turned(f.tangential.viscous)) - vec(g.tangential.viscous)).norm(), 0, 1e-12 * size);
      EXPECT_NEAR((vec(turned(f.rolling.on_i)) - vec(g.rolling.on_i)).norm(), 0, 1e-12 * torque);
      EXPECT_NEAR((vec(turned(f.rolling.on_j)) - vec(g.rolling.on_j)).norm(), 0, 1e-12 * torque);
    }
  });
}

// Seen from j the same contact has the opposite normal, velocity and springs, and its force is the opposite one.
TEST(EveryLaw, ActsEquallyAndOppositely) {
  for_every_law([](const LawChoice& law, const PairConstants<double>& c) {
    Random random;
    for (int k = 0; k < 50; ++k) {
      const Sample s = sample(random, c);
      const auto opposite = [](const Triple<double>& t) { return triple(-vec(t)); };
      Touch<double> touch = s.touch;
      touch.normal = opposite(touch.normal);
      touch.velocity = opposite(touch.velocity);
      std::swap(touch.spin_i, touch.spin_j);
      std::swap(touch.arm_i, touch.arm_j);
      Springs<double> springs = s.springs, there = s.springs;
      there.tangential = opposite(there.tangential);
      there.rolling = opposite(there.rolling);
      const ContactForce<double> f = evaluate(law, s.touch, c, springs, dt), g = evaluate(law, touch, c, there, dt);
      EXPECT_EQ(f.normal.elastic, g.normal.elastic);
      EXPECT_NEAR(f.damping, g.damping, 1e-15 * size_of(f));
      EXPECT_NEAR((vec(f.tangential.elastic) + vec(g.tangential.elastic)).norm(), 0, 1e-15 * size_of(f));
      EXPECT_NEAR((vec(f.rolling.on_i) - vec(g.rolling.on_j)).norm(), 0, 1e-15 * vec(f.rolling.on_i).norm());
      // Angular momentum is kept by objective rolling resistance only: EDEM's works on each grain's own spin.
      if (objective_rolling(law)) {
        EXPECT_EQ((vec(f.rolling.on_i) + vec(f.rolling.on_j)).norm(), 0);
      }
    }
  });
}

TEST(EveryLaw, KeepsItsFrictionLimitAndPushesAlongTheSurface) {
  for_every_law([](const LawChoice& law, const PairConstants<double>& c) {
    Random random;
    const bool spring = with_part<TangentialLaws>(law.tangential, [](auto part) { return part.has_spring; });
    int sliding = 0;
    for (int k = 0; k < 400; ++k) {
      const Sample s = sample(random, c);
      Springs<double> springs = s.springs;
      const ContactForce<double> f = evaluate(law, s.touch, c, springs, dt);
      const double load = with_part<FrictionLimits>(law.friction, [&](auto part) { return part.load(f.normal); });
      const Vec3 friction = vec(f.tangential.elastic) + vec(f.tangential.viscous);
      EXPECT_GE(load, 0);
      EXPECT_LE(friction.norm(), c.friction * load * (1 + 1e-12));
      EXPECT_NEAR(friction.dot(vec(s.touch.normal)), 0, 1e-9 * friction.norm());
      EXPECT_NEAR(vec(springs.tangential).dot(vec(s.touch.normal)), 0, 1e-9 * vec(springs.tangential).norm());
      sliding += f.tangential.sliding ? 1 : 0;
    }
    if (spring) {
      EXPECT_GT(sliding, 40);
      EXPECT_LT(sliding, 380);
    } else {
      EXPECT_EQ(sliding, 0);
    }
  });
}

TEST(EveryLaw, TakesEnergyByDampingSlidingAndRolling) {
  for_every_law([](const LawChoice& law, const PairConstants<double>& c) {
    Random random;
    int slipped = 0;
    for (int k = 0; k < 400; ++k) {
      const Sample s = sample(random, c);
      Springs<double> springs = s.springs;
      const ContactForce<double> f = evaluate(law, s.touch, c, springs, dt);
      EXPECT_GE(f.damping * s.touch.closing, 0);
      EXPECT_LE(vec(f.tangential.viscous).dot(vec(s.touch.velocity)), 0);
      // Sliding of the spring alone, in a step short enough that it does not swing back. (With a dashpot the spring is
      // stretched to carry its share, see springs.hpp.)
      Springs<double> undamped_springs = s.springs;
      PairConstants<double> undamped = c;
      undamped.normal_damping = undamped.tangential_damping = 0;
      const ContactForce<double> slow = evaluate(law, s.touch, undamped, undamped_springs, 1e-14);
      EXPECT_GE(slow.tangential.slip_work, -1e-12 * (slow.tangential.slip_work + slow.tangential.energy));
      slipped += slow.tangential.slip_work > 1e-3 * slow.tangential.energy ? 1 : 0;
      EXPECT_GE(f.tangential.energy, 0);
      EXPECT_GE(f.rolling.energy, 0);
      // Rolling resistance slows the spin that it is made from, not so much that the spin turns around. That of a spring may
      // push back.
      const auto slows = [&](const Triple<double>& torque, const Vec3& spin) {
        EXPECT_LE(vec(torque).dot(spin), 0);
        EXPECT_LE(vec(torque).norm() * dt, 0.1000001 * c.effective_inertia * spin.norm());
      };
      const Vec3 spin_i = vec(s.touch.spin_i), spin_j = vec(s.touch.spin_j);
      if (rolling_spring(law)) continue;
      slows(f.rolling.on_i, objective_rolling(law) ? Vec3(spin_i - spin_j) : spin_i);
      slows(f.rolling.on_j, objective_rolling(law) ? Vec3(spin_j - spin_i) : spin_j);
    }
    const bool spring = with_part<TangentialLaws>(law.tangential, [](auto part) { return part.has_spring; });
    EXPECT_EQ(slipped > 40, spring);
  });
}

// The elastic force is the derivative of the energy, and energy is zero where the bodies have parted.
TEST(EveryLaw, HasANormalForceThatIsTheSlopeOfItsEnergy) {
  for_every_law([](const LawChoice& law, const PairConstants<double>& c) {
    with_part<NormalLaws>(law.normal, [&](auto part) {
      const double scale = c.adhesion_length, low = part.break_overlap(c);
      for (double x = 0.01; x < 1e4; x *= 1.5) {
        const double overlap = low + x * scale, h = 1e-4 * x * scale;
        const NormalForce<double> f = part.evaluate(overlap, c);
        const double slope = (part.evaluate(overlap + h, c).energy - part.evaluate(overlap - h, c).energy) / (2 * h);
        EXPECT_NEAR(slope, f.elastic, 1e-6 * (std::abs(f.elastic) + f.repulsive + f.pull_off)) << overlap;
        EXPECT_LE(f.surface_energy, 0);
        EXPECT_GE(f.energy - f.surface_energy, 0);  // strain energy
      }
      EXPECT_NEAR(part.evaluate(part.break_overlap(c), c).energy, part.break_energy(c), 1e-7 * std::abs(part.break_energy(c)));
      EXPECT_NEAR(part.evaluate(part.form_overlap(c), c).energy, part.form_energy(c), 1e-7 * std::abs(part.form_energy(c)));
    });
  });
}

TEST(EveryLaw, FormsAndLetsGoWhereItSays) {
  for_every_law([](const LawChoice& law, const PairConstants<double>& c) {
    const auto [form, last] =
        with_part<NormalLaws>(law.normal, [&](auto part) { return std::pair(part.form_overlap(c), part.break_overlap(c)); });
    EXPECT_LE(form, 0);
    EXPECT_LE(last, form);
    EXPECT_EQ(last_overlap(law, c), last);
    EXPECT_TRUE(holds(law, form + 1e-12, false, c));
    EXPECT_FALSE(holds(law, form - 1e-12, false, c));
    EXPECT_TRUE(holds(law, 0.999 * last, true, c));
    EXPECT_FALSE(holds(law, 1.001 * last - 1e-15, true, c));
  });
}

TEST(EveryLaw, APackGivesTheSameBitsAsSingleNumbers) {
  for_every_law([](const LawChoice& law, const PairConstants<double>& c) {
    Random random;
    const PairConstants<Pack> packed = support::constants_as<Pack>(c);
    for (int k = 0; k < 30; ++k) {
      std::vector<Sample> lanes;
      for (std::size_t l = 0; l < pack_width; ++l) lanes.push_back(sample(random, c));
      const auto pack = [&](auto get) { return Pack([&](auto l) { return get(lanes[std::size_t(l)]); }); };
      const auto triples = [&](auto get) {
        return Triple<Pack>{pack([&](const Sample& s) { return get(s).x; }), pack([&](const Sample& s) { return get(s).y; }),
                            pack([&](const Sample& s) { return get(s).z; })};
      };
      Touch<Pack> touch;
      touch.overlap = pack([](const Sample& s) { return s.touch.overlap; });
      touch.normal = triples([](const Sample& s) { return s.touch.normal; });
      touch.velocity = triples([](const Sample& s) { return s.touch.velocity; });
      touch.spin_i = triples([](const Sample& s) { return s.touch.spin_i; });
      touch.spin_j = triples([](const Sample& s) { return s.touch.spin_j; });
      touch.arm_i = pack([](const Sample& s) { return s.touch.arm_i; });
      touch.arm_j = pack([](const Sample& s) { return s.touch.arm_j; });
      touch.closing = pack([](const Sample& s) { return s.touch.closing; });
      Springs<Pack> springs{triples([](const Sample& s) { return s.springs.tangential; }),
                            triples([](const Sample& s) { return s.springs.rolling; }),
                            pack([](const Sample& s) { return s.springs.contact_radius; })};
      const ContactForce<Pack> f = evaluate(law, touch, packed, springs, Interval<Pack>(dt, 1 / dt));
      for (std::size_t l = 0; l < pack_width; ++l) {
        Springs<double> single = lanes[l].springs;
        const ContactForce<double> g = evaluate(law, lanes[l].touch, c, single, dt);
        EXPECT_EQ(double(f.normal.elastic[l]), g.normal.elastic);
        EXPECT_EQ(double(f.normal.energy[l]), g.normal.energy);
        EXPECT_EQ(double(f.damping[l]), g.damping);
        EXPECT_EQ(double(f.tangential.elastic.x[l]), g.tangential.elastic.x);
        EXPECT_EQ(double(f.tangential.viscous.y[l]), g.tangential.viscous.y);
        EXPECT_EQ(double(f.tangential.slip_work[l]), g.tangential.slip_work);
        EXPECT_EQ(double(f.rolling.on_i.z[l]), g.rolling.on_i.z);
        EXPECT_EQ(double(springs.tangential.y[l]), single.tangential.y);
        EXPECT_EQ(double(springs.rolling.y[l]), single.rolling.y);
        EXPECT_EQ(double(springs.contact_radius[l]), single.contact_radius);
        EXPECT_EQ(bool(f.tangential.sliding[l]), g.tangential.sliding);
      }
    }
  });
}

TEST(ConstantTorque, ResistsInFullUpToTheForceThatIsSaid) {
  // A grain that rolls along a plate at half of 0.25 m/s.
  const double radius = 0.4625e-3, mass = 2500 * sphere_volume(radius), speed = 0.125, step = 5e-8;
  const MaterialTable table = make_material_table({{"glass", 2500, 63e9, 0.2}}, {{{0.9, 0.5, 0.01, 0.0}}});
  const PairConstants<double> c = wall_constants(table.pair[0], {radius, mass, sphere_inertia(mass, radius)});
  const double force = rolling::full_torque_force(mass, radius, speed / radius, 0.01, step);
  EXPECT_NEAR(force, 10.4, 0.1);
  Touch<double> touch{};
  touch.normal.z = -1;
  touch.spin_i.y = speed / radius;
  const auto torque = [&](double load, double stride = 1) {
    NormalForce<double> normal{};
    normal.elastic = load;
    Springs<double> springs{};
    const Interval<double> time(stride * step, 1 / (stride * step), 1 / step);
    return vec(ConstantTorque::evaluate(touch, c, normal, springs, time).on_i).y() / (-0.01 * radius * load);
  };
  EXPECT_NEAR(torque(0.999 * force), 1, 1e-12);
  EXPECT_NEAR(torque(2 * force), 0.5, 1e-12);
  // A contact that is evaluated at every second step resists alike; of a longer stride it may take a fifth of a spin.
  EXPECT_NEAR(torque(0.999 * force, 2), 1, 1e-12);
  EXPECT_NEAR(torque(2 * force, 2), 0.5, 1e-12);
  EXPECT_NEAR(torque(2 * force, 4), 0.25, 1e-12);
}

// A composition that is compiled as one piece gives the bits of the same parts put together at run time.
TEST(FixedLaws, GiveTheBitsOfTheirParts) {
  const auto compare = [](auto fixed) {
    Random random;
    const LawChoice law = choice_of<decltype(fixed)>();
    const PairConstants<double> c = glass(0.274);
    for (int k = 0; k < 500; ++k) {
      const Sample s = sample(random, c);
      Springs<double> a = s.springs, b = s.springs;
      const ContactForce<double> f = evaluate(fixed, s.touch, c, a, dt), g = evaluate(law, s.touch, c, b, dt);
      EXPECT_EQ(f.normal.elastic, g.normal.elastic);
      EXPECT_EQ(f.damping, g.damping);
      EXPECT_EQ(vec(f.tangential.elastic), vec(g.tangential.elastic));
      EXPECT_EQ(vec(f.rolling.on_i), vec(g.rolling.on_i));
      EXPECT_EQ(vec(a.tangential), vec(b.tangential));
    }
  };
  std::apply([&](auto... fixed) { (compare(fixed), ...); }, FixedLaws{});
}

TEST(Laws, AreChosenByNameAndRefusedByName) {
  EXPECT_EQ(choose_law({}), LawChoice{});
  const LawChoice law = choose_law({"jkr_force_minimum", "tsuji", "thornton", "incremental", "elastic_plastic"});
  EXPECT_EQ(name_of(law), "jkr_force_minimum_tsuji_thornton_incremental_elastic_plastic");
  const auto message = [](const ContactModel& model) -> std::string {
    try {
      choose_law(model);
    } catch (const CaseError& e) {
      return e.what();
    }
    return "nothing thrown";
  };
  EXPECT_EQ(message({.normal = "hertz", .friction_limit = "thornton"}),
            "contact.friction_limit 'thornton' needs a JKR normal force, got normal 'hertz'");
  EXPECT_EQ(message({.rolling = "type_a"}),
            "contact.rolling 'type_a' is unknown, expected one of constant_torque, none, edem, elastic_plastic");
}

}  // namespace
}  // namespace dem
