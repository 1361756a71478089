// Meshes stand for the shapes they approximate: a flat mesh is a plane to rounding, a faceted cylinder is a cylinder to
// within its facets.
#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "libdem/contact/laws.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/geometry/validate_mesh.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/dem/geometry/test_meshes.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

using test::random_direction;
using test::uniform;

constexpr double radius = 0.4625e-3;  // m, of the grains
constexpr double pi = std::numbers::pi;

State fresh(Particles grains) {
  State state;
  state.particles = std::move(grains);
  return state;
}

// A frame that is aligned with nothing, so that nothing is exact by luck.
Eigen::Isometry3d tilt() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1.5).normalized()));
  motion.pretranslate(Vec3(0.3e-3, -0.2e-3, 0.1e-3));
  return motion;
}

Wall analytic_plate(const Eigen::Isometry3d& frame) {
  return {"plate", 0, Plane{frame.translation(), frame.linear() * Vec3::UnitZ()}, {}};
}
Wall mesh_plate(const Eigen::Isometry3d& frame, std::size_t cells, double half, double jitter) {
  std::mt19937_64 rng(3);
  const TriangleMesh mesh = test::moved(test::slab(cells, half, 1e-3, rng, jitter), frame);
  validate_mesh(mesh, "plate");
  return {"plate", 0, make_mesh_wall(mesh), {}};
}

// Grains that do not meet each other slide and roll on a plate, or bounce on it. The two runs differ by rounding: 1e-19
// m of a distance, which is 1e-11 of an overlap of 1e-8 m and of the forces; over a path of some radii this stays well
// below 1e-10 R for grains that keep touching. A bounce makes it larger. What it gives depends a little (1 mm/s of 100)
// on where between two steps it begins: the pull of an adhesive contact and its tangential spring set in with a whole
// step. A difference x of places, x/v of times, thus becomes one of (1 mm/s) (x/v)/dt of velocities, for v = 1 cm/s and
// the 2 ms to the next bounce one of up to about 1e3 x of places: after two or three bounces below 1e-7 R.
TEST(WallEquivalence, AMeshPlaneGivesTheTrajectoriesOfThePlane) {
  omp_set_num_threads(1);
  const Eigen::Isometry3d frame = tilt();
  dem::Setup setup = support::glass_setup(5e-8);
  setup.gravity = frame.linear() * Vec3(0, 0, -9.81);
  std::mt19937_64 rng(1);
  Particles grains;
  for (int k = 0; k < 24; ++k) {
    const bool bounces = k % 2 == 0;
    const double height = bounces ? uniform(rng, 0.01e-3, 0.2e-3) : -1e-8;
    Vec3 velocity = 0.1 * random_direction(rng);
    velocity.z() = bounces ? -std::abs(velocity.z()) : 0;
    grains.add(std::uint32_t(k + 1), 0, radius,
               frame * Vec3(2.5e-3 * (k % 5 - 2), 2.5e-3 * (k / 5 - 2), radius + height), frame.linear() * velocity,
               uniform(rng, 0, 200) * random_direction(rng));
  }
  dem::Setup with_mesh = setup;
  setup.walls = {analytic_plate(frame)};
  with_mesh.walls = {mesh_plate(frame, 40, 8e-3, 0.3)};
  Simulation plane(setup, fresh(grains)), mesh(with_mesh, fresh(grains));
  std::array<double, 2> apart{}, moved{};  // m, of grains that bounce and that do not
  for (int block = 0; block < 100; ++block) {
    plane.advance(2000);
    mesh.advance(2000);
    for (std::size_t i = 0; i < grains.size(); ++i) {
      const Vec3 &a = plane.particles().position[i], &b = mesh.particles().position[i];
      apart[i % 2] = std::max(apart[i % 2], (a - b).norm());
      moved[i % 2] = std::max(moved[i % 2], (a - grains.position[i]).norm());
    }
  }
  EXPECT_GE(plane.contacts(), grains.size() / 2);
  EXPECT_EQ(mesh.contacts(), plane.contacts());
  for (const double m : moved) EXPECT_GT(m, radius);  // several triangles
  EXPECT_LT(apart[0], 1e-7 * radius);
  EXPECT_LT(apart[1], 1e-10 * radius);
}

// Each triangle cut into four at the middles of its sides.
TriangleMesh cut_finer(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
  const auto between = [&](std::uint32_t a, std::uint32_t b) {
    const auto [place, is_new] = middle.try_emplace(std::minmax(a, b), std::uint32_t(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
    for (const std::array<std::uint32_t, 3>& t : {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
      fine.triangles.push_back(t);
  }
  fine.labels.assign(fine.triangles.size(), FacetLabel::face);
  return fine;
}

// Grains that slide along one side of an inner corner meet the other: triangles that they could not touch when those near them were
// sorted out must be there in time. As above, a bounce makes differences of rounding larger, to below 1e-7 R.
TEST(WallEquivalence, GrainsThatSlideAlongOneSideOfAFineMeshAreStoppedByTheNext) {
  omp_set_num_threads(1);
  const double far = 6e-3, thick = 1e-3, deep = 16e-3;
  TriangleMesh corner = test::prism({{0, 0}, {0, far}, {-thick, far}, {-thick, -thick}, {far, -thick}, {far, 0}},
                                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, {0, 1, 2, 3, 4, 5}, -deep, deep);
  for (int k = 0; k < 5; ++k) corner = cut_finer(corner);
  validate_mesh(corner, "corner");

  dem::Setup setup = support::glass_setup(5e-8);
  setup.gravity = Vec3(0, -9.81, 0);
  Particles grains;
  for (int k = 0; k < 24; ++k)
    grains.add(std::uint32_t(k + 1), 0, radius, Vec3(radius * (1.05 + 0.011 * k), radius - 1e-8, 1.2e-3 * (k - 11.5)), Vec3(-0.3, 0, 0),
               Vec3::Zero());
  dem::Setup with_mesh = setup;
  setup.walls = {{"floor", 0, Plane{Vec3::Zero(), Vec3::UnitY()}, {}}, {"side", 0, Plane{Vec3::Zero(), Vec3::UnitX()}, {}}};
  with_mesh.walls = {{"corner", 0, make_mesh_wall(corner), {}}};
  Simulation planes(setup, fresh(grains)), mesh(with_mesh, fresh(grains));
  double apart = 0;
  for (int block = 0; block < 60; ++block) {  // 1.2 ms
    planes.advance(400);
    mesh.advance(400);
    for (std::size_t i = 0; i < grains.size(); ++i)
      apart = std::max(apart, (planes.particles().position[i] - mesh.particles().position[i]).norm());
  }
  for (const Vec3& v : planes.particles().velocity) EXPECT_GT(v.x(), 0.1);  // all have met the side
  EXPECT_LT(apart, 1e-7 * radius);
}

// A tube of `sides` flat facets, its inner corners on a cylinder of the given radius about z, closed as a thick-walled
// body.
TriangleMesh faceted_tube(std::size_t sides, double inner, double low, double high) {
  TriangleMesh mesh;
  const auto n = std::uint32_t(sides);
  for (std::uint32_t s = 0; s < n; ++s) {
    const double angle = 2 * pi * s / n;
    const Vec3 outward(std::cos(angle), std::sin(angle), 0);
    for (const double r : {inner, 1.2 * inner})
      for (const double z : {low, high}) mesh.vertices.push_back(r * outward + Vec3(0, 0, z));
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t s = 0; s < n; ++s) {
    const std::uint32_t here = 4 * s,
                        next = 4 * ((s + 1) % n);  // + 0 inner low, 1 inner high, 2 outer low, 3 outer high
    quad(here, here + 1, next + 1, next);
    quad(here + 2, next + 2, next + 3, here + 3);
    quad(here + 1, here + 3, next + 3, next + 1);
    quad(here, next, next + 2, here + 2);
  }
  mesh.labels.assign(mesh.triangles.size(), FacetLabel::face);
  validate_mesh(mesh, "tube");
  return mesh;
}

constexpr double bore = 5e-3;  // m, radius of the cylinder

struct Difference {
  double place = 0, path = 0;  // m, largest difference of places; way of the grain in the cylinder
};

// One grain inside the cylinder and inside its faceted copy.
Difference compare(Setup setup, const Particles& grains, std::size_t sides, int blocks, std::uint64_t steps) {
  dem::Setup with_mesh = setup;
  const double half = 4e-3;
  setup.walls = {Wall{"tube", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), bore, FreeSide::inside, -half, half}, {}}};
  with_mesh.walls = {Wall{"tube", 0, make_mesh_wall(faceted_tube(sides, bore, -half, half)), {}}};
  Simulation round(setup, fresh(grains)), faceted(with_mesh, fresh(grains));
  Difference difference;
  Vec3 last = grains.position[0];
  for (int k = 0; k < blocks; ++k) {
    round.advance(steps);
    faceted.advance(steps);
    const Vec3 a = round.particles().position[0], b = faceted.particles().position[0];
    difference.place = std::max(difference.place, (a - b).norm());
    difference.path += (a - last).norm();
    last = a;
  }
  return difference;
}

// The normal of a facet is off by up to pi/n, so a bounce turns the path by up to 2 pi/n, and on the path of length L
// that is left the grain ends up to (2 pi/n) L off. k bounces evenly on the way make k/2 times that at most; here there
// are three. (That facets lie closer by up to R (1 - cos(pi/n)) is of second order.) The difference goes to zero as
// 1/n.
TEST(WallEquivalence, AFacetedCylinderBouncesAsACylinder) {
  omp_set_num_threads(1);
  dem::Setup setup = support::glass_setup(5e-8);
  setup.gravity = Vec3::Zero();
  Particles grains;
  grains.add(1, 0, radius, Vec3(1.3e-3, 0.4e-3, -1e-3), Vec3(0.9, 0.5, 0.06), Vec3(20, -30, 100));
  std::vector<double> place;
  for (const std::size_t sides : {180U, 720U}) {
    const Difference d = compare(setup, grains, sides, 200, 2000);  // 20 ms
    const double bound = 1.5 * (2 * pi / double(sides)) * d.path;
    EXPECT_GT(d.path, 30 * radius);
    EXPECT_LT(d.place, bound);
    EXPECT_GT(d.place, 0.05 * bound);
    place.push_back(d.place);
  }
  EXPECT_NEAR(place[0] / place[1], 4, 1);
}

// A grain that rolls from facet to facet loses at each edge at most the kinetic energy m (v a)^2/2 of its motion
// against the next facet, a = 2 pi/n, out of m (7/5) v^2/2. On the arc T, with T/a edges, that is (5/7) T a of its
// energy, half of that of its speed: at most (5/14) T a L of place on a path L. This holds where edges come faster than
// the contact swings by itself (here 6 kHz, edges at up to 2 pi/a v/(2 pi R) = 10 kHz and 20 kHz); slower ones build
// the swing up. The grains are soft, as in the study's case B: their overlap of a micrometre is much larger than the
// facets are deep, R (1 - cos(pi/n)) = 12 and 3 nm. The start is on an edge, where mesh and cylinder agree.
TEST(WallEquivalence, AFacetedCylinderIsRolledInAsACylinder) {
  omp_set_num_threads(1);
  dem::Setup setup = support::glass_setup(5e-7);
  setup.materials[0].young = 63e6;
  setup.gravity = Vec3(0, -9.81, 0);
  Particles grains;
  const double out = bore - radius + 1e-6, angle = -0.1 * pi, arc = 2.45;  // rad, of the half swing in 80 ms
  grains.add(1, 0, radius, Vec3(out * std::cos(angle), out * std::sin(angle), 0), Vec3::Zero(), Vec3::Zero());
  for (const std::size_t sides : {1440U, 2880U}) {
    const Difference d = compare(setup, grains, sides, 200, 800);  // 80 ms
    const double bound = 5.0 / 14.0 * arc * (2 * pi / double(sides)) * d.path;
    EXPECT_NEAR(d.path, arc * out, 0.1 * arc * out);
    EXPECT_LT(d.place, bound);
    EXPECT_GT(d.place, 1e-4 * radius);
  }
}

// --- a grain over the edges and vertices of a flat mesh ---

// Paths of the touched point over a grid of 0.25 mm cells, with triangles cut along either diagonal: along a row of
// edges and through its vertices; along diagonals; across everything.
std::vector<std::pair<Vec3, Vec3>> paths() {
  return {{Vec3(-1.2e-3, 0, 0), Vec3(1.2e-3, 0, 0)},
          {Vec3(-1.2e-3, -1.2e-3, 0), Vec3(1.2e-3, 1.2e-3, 0)},
          {Vec3(-1.2e-3, 0.31e-3, 0), Vec3(1.2e-3, -0.77e-3, 0)}};
}

// Places are prescribed: the overlap is the same everywhere, so is the force.
TEST(WallEquivalence, AGrainThatIsLedOverEdgesAndVerticesHasOneTouchAndOneForce) {
  const Eigen::Isometry3d frame = tilt();
  const Wall plate = mesh_plate(frame, 12, 1.5e-3, 0);
  const dem::Setup setup = support::glass_setup();
  const double mass = 2500 * sphere_volume(radius), overlap = 1e-6;
  const PairConstants<double> c = wall_constants(make_material_table(setup.materials, setup.interactions)(0, 0),
                                                 {radius, mass, sphere_inertia(mass, radius)});
  const double expected = Jkr::evaluate(overlap, c).elastic;
  const Vec3 down = frame.linear() * -Vec3::UnitZ();
  double worst = 0;
  std::vector<std::uint32_t> parts;
  std::vector<WallTouch> touches;
  std::vector<MeshTouch> scratch;
  for (const auto& [from, to] : paths())
    for (int k = 0; k <= 24000; ++k) {
      const Vec3 centre = frame * (from + k / 24000.0 * (to - from) + Vec3(0, 0, radius - overlap));
      parts.clear();
      candidate_parts(plate, {}, centre, 1.1 * radius, parts);
      nearest(plate, {}, centre, radius, parts, touches, scratch);
      ASSERT_EQ(touches.size(), 1u) << k;
      EXPECT_NEAR((touches[0].normal - down).norm(), 0, 1e-14);
      worst = std::max(worst, std::abs(Jkr::evaluate(radius - touches[0].distance, c).elastic / expected - 1));
    }
  EXPECT_LT(worst, 1e-9);
}

// The same with a grain that rolls by itself, pressed on by a hundred times its weight so that rounding (1e-19 m, 1e-11
// of an overlap) is 1e-10 of the force: in every step one contact, the one that it began with, and its force is that of
// a grain that rolls on a plane.
TEST(WallEquivalence, AGrainThatRollsOverEdgesAndVerticesHasOneContactAndNoJumpOfForce) {
  omp_set_num_threads(1);
  const Eigen::Isometry3d frame = tilt();
  dem::Setup setup = support::glass_setup(5e-8);
  setup.gravity = frame.linear() * Vec3(0, 0, -981);
  dem::Setup with_mesh = setup;
  setup.walls = {analytic_plate(frame)};
  with_mesh.walls = {mesh_plate(frame, 12, 1.5e-3, 0)};
  for (const auto& [from, to] : paths()) {
    const Vec3 along = (to - from).normalized();
    const double speed = 0.3;
    Particles grains;
    grains.add(1, 0, radius, frame * (from + Vec3(0, 0, radius - 2e-8)), frame.linear() * (speed * along),
               frame.linear() * Vec3(Vec3::UnitZ().cross(along) * (speed / radius)));
    Simulation plane(setup, fresh(grains)), mesh(with_mesh, fresh(grains));
    double normal = 0, tangential = 0;
    std::uint64_t birth = 0;
    for (int k = 0; k < 100000; ++k) {
      plane.advance(1);
      mesh.advance(1);
      const View a = plane.view(), b = mesh.view();
      ASSERT_EQ(a.wall_pairs.size(), 1u) << k;
      ASSERT_EQ(b.wall_pairs.size(), 1u) << k;
      const WallRecord &p = a.wall_pairs[0], &m = b.wall_pairs[0];
      if (k == 0) birth = m.birth_step;
      ASSERT_EQ(m.birth_step, birth) << k;
      const double force = p.elastic + p.damping;
      normal = std::max(normal, std::abs(m.elastic + m.damping - force) / std::abs(force));
      tangential = std::max(tangential, (m.tangential - p.tangential).norm() / std::abs(force));
    }
    const double path = (mesh.particles().position[0] - grains.position[0]).norm();
    EXPECT_GT(path, 1e-3);
    EXPECT_LT(normal, 1e-9);
    EXPECT_LT(tangential, 1e-9);
  }
}

// Over the rim of a sheet a grain that nothing rubs keeps its energy: the touch goes from the face to the rim without a
// jump. The lost height and the speed are of one size, the steps are a hundredth of a contact's swing.
TEST(WallEquivalence, AGrainThatSlidesOverARimKeepsItsEnergy) {
  omp_set_num_threads(1);
  dem::Setup setup = support::glass_setup(1e-7);
  setup.interactions[0][0] = {1, 0, 0, 0};
  const double speed = 0.05, rim = 2e-3, mass = 2500 * sphere_volume(radius);
  const std::vector<WallShape> sheets{
      Disc{Vec3::Zero(), Vec3::UnitZ(), rim, 0},                                                    // off its outer rim
      Cone{Vec3(0, 0, -1e-3), Vec3::UnitZ(), rim + 0.4e-3, rim - 0.1e-3, 1e-3, FreeSide::outside},  // off a thin edge
  };
  for (const WallShape& sheet : sheets) {
    const bool disc = std::holds_alternative<Disc>(sheet);
    setup.walls = {Wall{"sheet", 0, sheet, {}}};
    Particles grains;
    // On the flat sheet, in equilibrium there; or falling on the edge a little off it.
    const double height = disc ? radius - std::pow(mass * 9.81 / (4.0 / 3.0 * 32.8125e9 * std::sqrt(radius)), 2.0 / 3.0)
                               : radius + 0.02e-3;
    grains.add(1, 0, radius, Vec3(disc ? rim - 0.2e-3 : rim, 0, height), Vec3(disc ? speed : 0, 0, 0));
    Simulation sim(setup, fresh(grains));
    const auto energy = [&] {
      return 0.5 * sim.view().velocity[0].squaredNorm() + 9.81 * sim.particles().position[0].z();
    };
    const double before = energy();
    bool on_face = false, on_rim = false;
    for (int k = 0; k < 4000 && sim.particles().position[0].z() > -3 * radius; ++k) {
      sim.advance(100);
      for (const WallRecord& c : sim.view().wall_pairs) {
        on_face = on_face || c.feature == MeshFeature::face;
        on_rim = on_rim || c.feature == MeshFeature::edge;
      }
    }
    EXPECT_LT(sim.particles().position[0].z(), -2 * radius);
    EXPECT_EQ(sim.contacts(), 0u);
    EXPECT_TRUE(on_rim);
    EXPECT_EQ(on_face, disc);
    EXPECT_NEAR(energy(), before, 1e-6 * before);
  }
}

}  // namespace
}  // namespace dem
