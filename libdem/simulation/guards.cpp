#include "libdem/simulation/guards.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "libdem/contact/pair_blocks.hpp"
#include "libdem/errors.hpp"

namespace dem {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

std::string place(const GuardInput& in, std::size_t i) {
  const Vec3 mm = 1e3 * in.grains[i].position();
  return "grain " + std::to_string(in.id[i]) + " at (" + number(mm.x()) + ", " + number(mm.y()) + ", " +
         number(mm.z()) + ") mm, t = " + number(in.time) + " s";
}

// One acting contact of a grain, seen from it.
struct Contact {
  Vec3 normal;                                  // unit, away from the grain's centre
  double normal_stiffness, tangential_stiffness;  // N/m
  double elastic, overlap;                      // N, m
  std::string with;                             // "grain 17", "wall 'blade'"
};

// N, without damping.
double elastic_force(const GuardInput& in, const PairConstants<double>& c, double overlap) {
  return with_part<NormalLaws>(in.setup.law.normal, [&](auto part) { return part.evaluate(overlap, c).elastic; });
}

struct PairGeometry {
  std::uint32_t i, j;
  Vec3 branch;      // m, from i to j
  double distance;  // m
  double overlap;   // m
};
PairGeometry geometry(const GuardInput& in, std::size_t lane) {
  PairGeometry g{in.pairs.first(lane), in.pairs.second(lane), {}, 0, 0};
  g.branch = in.grains[g.j].position() - in.grains[g.i].position();
  g.distance = g.branch.norm();
  g.overlap = in.grains[g.i].radius() + in.grains[g.j].radius() - g.distance;
  return g;
}

PairConstants<double> constants(const GuardInput& in, std::size_t lane) {
  return constants_of(in.pairs, lane, in.grains, in.id.size(), in.materials);
}

// Looks at all contacts of the run: for the few grains that come near a limit.
template <class F>
void for_each_contact(const GuardInput& in, std::size_t i, F f) {
  const bool friction =
      with_part<TangentialLaws>(in.setup.law.tangential, [](auto part) { return part.has_spring; });
  const auto tell = [&](const PairConstants<double>& c, double radius, const Vec3& normal, double elastic, double overlap,
                        auto&& with) {
    f(Contact{normal, 2 * c.effective_modulus * radius, friction ? 8 * c.effective_shear * radius : 0, elastic, overlap,
              with()});
  };
  for (std::size_t lane = 0; lane < in.pairs.lanes(); ++lane) {
    const std::uint32_t first = in.pairs.first(lane), second = in.pairs.second(lane);
    if ((first != i && second != i) || !in.pairs.acts(lane)) continue;
    const PairGeometry g = geometry(in, lane);
    const PairConstants<double> c = constants(in, lane);
    tell(c, in.pairs.contact_radius(lane), (first == i ? g.branch : -g.branch) / g.distance, elastic_force(in, c, g.overlap),
         g.overlap, [&] { return "grain " + std::to_string(in.id[first == i ? second : first]); });
  }
  for (const WallCandidate& c : in.walls.candidate)
    for (const WallContact& w : in.walls.contacts(c))
      if (c.particle == i && w.acts())
        tell(in.materials.pair[c.material_pair], w.memory.contact_radius, w.touch.normal, w.elastic, in.grains[i].radius() - w.touch.distance, [&] { return "wall '" + in.setup.walls[c.wall].name + "'"; });
}

// "its largest force, 12 N at an overlap of 1.5 um, is with wall 'blade'"
std::string largest_contact(const GuardInput& in, std::size_t i) {
  double largest = -std::numeric_limits<double>::infinity();
  std::string text = "it touches nothing";
  for_each_contact(in, i, [&](const Contact& c) {
    if (!(c.elastic > largest)) return;
    largest = c.elastic;
    text = "its largest force, " + number(c.elastic) + " N at an overlap of " + number(1e6 * c.overlap) + " um, is with " + c.with;
  });
  return text;
}

// Stiffness over mass and inertia, 1/s^2, of the grain's translation and (scaled) rotation between its contacts.
Matrix6 dynamic_matrix(const GuardInput& in, std::size_t i) {
  Matrix6 sum = Matrix6::Zero();
  const double m = 1 / std::sqrt(in.mass[i]), turn = in.grains[i].radius() / std::sqrt(in.inertia[i]);
  for_each_contact(in, i, [&](const Contact& c) {
    // Velocity of the contact point: v + omega x (R n), in scaled coordinates.
    Eigen::Matrix<double, 3, 6> motion;
    Eigen::Matrix3d lever;
    lever << 0, c.normal.z(), -c.normal.y(), -c.normal.z(), 0, c.normal.x(), c.normal.y(), -c.normal.x(), 0;
    motion << m * Eigen::Matrix3d::Identity(), turn * lever;
    const Eigen::Matrix3d along = c.normal * c.normal.transpose();
    const Eigen::Matrix3d stiffness =
        c.normal_stiffness * along + c.tangential_stiffness * (Eigen::Matrix3d::Identity() - along);
    sum += motion.transpose() * stiffness * motion;
  });
  return sum;
}

}  // namespace

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

void check_motion(const GuardInput& in) {
  for (std::size_t i = 0; i < in.id.size(); ++i) {
    const GrainRow& grain = in.grains[i];
    if (!grain.place.allFinite() || !grain.motion.allFinite() || !grain.spin.allFinite())
      throw PhysicsError("the motion of " + place(in, i) + " is no longer a number; " + largest_contact(in, i) +
                         "; likely cause: a time step above the stable limit");
    if ((grain.position().array() < in.setup.low.array()).any() || (grain.position().array() > in.setup.high.array()).any())
      throw PhysicsError(place(in, i) + " has left the domain with speed " + number(grain.velocity().norm()) + " m/s; " +
                         largest_contact(in, i) +
                         "; likely cause: a time step above the stable limit or a gap that pinched it through a wall");
  }
}

namespace {

double largest_eigenvalue(const GuardInput& in, std::size_t i) {
  return Eigen::SelfAdjointEigenSolver<Matrix6>(dynamic_matrix(in, i), Eigen::EigenvaluesOnly).eigenvalues()[5];
}

// 1/s^2, [N], traces of the dynamic matrices: upper bounds of their largest eigenvalues.
std::vector<double> traces(const GuardInput& in) {
  const bool friction =
      with_part<TangentialLaws>(in.setup.law.tangential, [](auto part) { return part.has_spring; });
  struct Stiffness {
    double normal = 0, tangential = 0;  // N/m, sums over the contacts of a grain
  };
  std::vector<Stiffness> sum(in.id.size());
  const auto add = [&](std::size_t i, const PairConstants<double>& c, double radius) {
    sum[i].normal += 2 * c.effective_modulus * radius;
    if (friction) sum[i].tangential += 16 * c.effective_shear * radius;
  };
  for (std::size_t lane = 0; lane < in.pairs.lanes(); ++lane) {
    if (!in.pairs.acts(lane)) continue;
    const PairConstants<double>& c = in.materials.pair[in.pairs.kind[lane / PairContacts::width].material_pair];
    add(in.pairs.first(lane), c, in.pairs.contact_radius(lane));
    add(in.pairs.second(lane), c, in.pairs.contact_radius(lane));
  }
  for (const WallCandidate& c : in.walls.candidate)
    for (const WallContact& w : in.walls.contacts(c))
      if (w.acts()) add(c.particle, in.materials.pair[c.material_pair], w.memory.contact_radius);
  std::vector<double> trace(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double lever = in.grains[i].radius();
    trace[i] = (sum[i].normal + sum[i].tangential) / in.mass[i] + sum[i].tangential * lever * lever / in.inertia[i];
  }
  return trace;
}

double limit_of(double eigenvalue) {
  return eigenvalue > 0 ? 2 / std::sqrt(eigenvalue) : std::numeric_limits<double>::infinity();
}

}  // namespace

double stable_step(const GuardInput& in, std::size_t i) { return limit_of(largest_eigenvalue(in, i)); }

double stable_step(const GuardInput& in) {
  const std::vector<double> trace = traces(in);
  double largest = 0;
  for (std::size_t i = 0; i < trace.size(); ++i)
    if (trace[i] > largest) largest = std::max(largest, largest_eigenvalue(in, i));
  return limit_of(largest);
}

void check_stable_step(const GuardInput& in) {
  const std::vector<double> trace = traces(in);
  const double dt = in.setup.step;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (!(trace[i] * dt * dt > 4)) continue;  // few grains come near
    const double limit = stable_step(in, i);
    if (dt > limit)
      throw PhysicsError("the time step of " + number(dt) + " s is above the stable limit of " + number(limit) + " s of " +
                         place(in, i) + "; " + largest_contact(in, i) + "; take a step of a third of that limit");
  }
}

void stop_for_overlap(const GuardInput& in) {
  const auto text = [](double overlap, double force) {
    return "runaway overlap of " + number(overlap * 1e6) + " um at " + number(force) + " N between ";
  };
  for (std::size_t lane = 0; lane < in.pairs.lanes(); ++lane) {
    if (!in.pairs.acts(lane)) continue;
    const PairGeometry g = geometry(in, lane);
    if (!(g.overlap < runaway_overlap * std::min(in.grains[g.i].radius(), in.grains[g.j].radius())))
      throw PhysicsError(text(g.overlap, elastic_force(in, constants(in, lane), g.overlap)) + "grain " +
                         std::to_string(in.id[g.j]) + " and " + place(in, g.i) +
                         "; likely cause: a time step above the stable limit");
  }
  for (const WallCandidate& c : in.walls.candidate)
    for (const WallContact& w : in.walls.contacts(c)) {
      const double radius = in.grains[c.particle].radius(), overlap = radius - w.touch.distance;
      if (w.acts() && !(overlap < runaway_overlap * radius))
        throw PhysicsError(text(overlap, w.elastic) + "wall '" + in.setup.walls[c.wall].name + "' and " +
                           place(in, c.particle) +
                           "; likely cause: a time step above the stable limit, or a gap too narrow for the grain");
    }
  throw PhysicsError("runaway overlap at t = " + number(in.time) + " s");
}

}  // namespace dem
