#include "libdem/bed/suspension.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <tuple>

#include "libdem/case/size_distribution.hpp"
#include "libdem/errors.hpp"
#include "libdem/neighbors/pair_list.hpp"

namespace dem {
namespace {

constexpr double suspension_solid_fraction = 0.45;
// Grains are kept this far apart, over their radius, so that pushing ends in a finite number of sweeps.
constexpr double clearance = 0.01;
constexpr int most_sweeps = 5000, sweeps_between_questions = 20, most_draws = 1000;

// [0, 1) from a 64-bit generator, the same on every platform (the standard's distributions are not).
double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1.0p-53; }

// The walls, seen by one grain after the other.
class Surroundings {
 public:
  explicit Surroundings(const Setup& setup) : walls_(setup.walls) {
    for (const Wall& w : walls_) {
      poses_.push_back(pose_at(w.motion, 0));
      Eigen::AlignedBox3d box;  // of a mesh in its body frame
      if (const auto* mesh = std::get_if<MeshWall>(&w.shape))
        for (const Vec3& v : mesh->finder->mesh().vertices) box.extend(v);
      boxes_.push_back(box);
    }
  }

  // m, by what a grain must move so that `radius` is free around it; zero where it is.
  Vec3 push(const Vec3& x, double radius) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      if (!near_box(w, x, radius)) continue;
      parts_.clear();
      candidate_parts(walls_[w], poses_[w], x, radius, parts_);
      nearest(walls_[w], poses_[w], x, radius, parts_, touches_, scratch_);
      for (const WallTouch& t : touches_) sum -= std::max(radius - t.distance, 0.0) * t.normal;
    }
    return sum;
  }

  bool inside_a_wall(const Vec3& x) const {
    for (std::size_t w = 0; w < walls_.size(); ++w)
      if (near_box(w, x, 0) && inside_material(walls_[w], poses_[w], x)) return true;
    return false;
  }

 private:
  // The winding number costs a pass over the mesh, so only grains in its box are asked for it.
  bool near_box(std::size_t w, const Vec3& x, double reach) const {
    if (!std::holds_alternative<MeshWall>(walls_[w].shape)) return true;
    return boxes_[w].squaredExteriorDistance(poses_[w].rotation.transpose() * (x - poses_[w].position)) <= reach * reach;
  }

  const std::vector<Wall>& walls_;
  std::vector<WallPose> poses_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::uint32_t> parts_;
  std::vector<WallTouch> touches_;
  std::vector<MeshTouch> scratch_;
};

// The order in which grains lie layer by layer, row by row: neighbours in space are then near in memory, which halves the
// time that a bed of tens of thousands of grains takes.
std::vector<std::size_t> in_layers(const std::vector<Vec3>& x, double thickness) {
  const auto place = [&](std::size_t i) {
    return std::tuple(std::floor(x[i].z() / thickness), std::floor(x[i].y() / thickness), x[i].x(), i);
  };
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  return order;
}

}  // namespace

Particles random_suspension(const Setup& setup, const Bed& bed, std::uint8_t material, const BedRegion& region,
                            std::size_t count, const std::function<bool()>& interrupted) {
  const double largest = 0.5 * bed.size_high * bed.mean_diameter * (1 + clearance);
  if (!(clear_radius(region) > largest))
    throw CaseError("the bed is too narrow: a radius of " + std::to_string(clear_radius(region) * 1e3) +
                    " mm holds no grain of radius " + std::to_string(largest * 1e3) + " mm");
  // Sizes and places come from streams of their own: how often a place is drawn again changes no size.
  std::mt19937_64 sizes(bed.seed), places(bed.seed ^ 0x9e3779b97f4a7c15u);
  std::vector<double> radius;
  double volume = 0;
  for (std::size_t i = 0; i < count; ++i) {
    radius.push_back(0.5 * bed.mean_diameter * size_quantile(bed, uniform(sizes)));
    volume += sphere_volume(radius.back());
  }
  const double height = volume / (suspension_solid_fraction * cross_section(region)) + 2 * largest;

  Surroundings walls(setup);
  std::vector<Vec3> x;
  std::vector<double> wide;  // radii with their clearance
  for (std::size_t i = 0; i < count; ++i) {
    wide.push_back(radius[i] * (1 + clearance));
    Vec3 place;
    int draws = 0;
    do {
      if (++draws > most_draws) throw CaseError("the bed does not fit between its walls: no free place for a grain");
      const double u = uniform(places), v = uniform(places), w = uniform(places);
      place = point_inside(region, u, v, wide[i]);
      place.z() = wide[i] + w * (height - 2 * wide[i]);
    } while (walls.push(place, radius[i]) != Vec3::Zero() || walls.inside_a_wall(place));
    x.push_back(place);
  }

  // Every sweep moves all grains at once, by half of each overlap with a grain and all of that with a wall; never so far
  // that a grain could pass through a blade.
  const double skin = 0.3 * bed.mean_diameter, farthest = 0.2 * bed.size_low * bed.mean_diameter;
  std::vector<Vec3> listed, push(count);
  PairList list;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    if (sweep % sweeps_between_questions == 0 && interrupted && interrupted()) return {};
    double travel2 = 0;
    for (std::size_t i = 0; i < listed.size(); ++i) travel2 = std::max(travel2, (x[i] - listed[i]).squaredNorm());
    if (listed.empty() || 4 * travel2 > skin * skin) {
      list = build_pair_list(x, wide, skin);
      listed = x;
    }
    for (std::size_t i = 0; i < count; ++i) push[i] = walls.push(x[i], wide[i]);
    bool apart = true;
    for (std::size_t i = 0; i < count; ++i) apart &= push[i].squaredNorm() <= std::pow(clearance * radius[i], 2);
    for (std::size_t s = 0; s < list.size(); ++s) {
      const std::uint32_t i = list.first[s], j = list.second[s];
      const Vec3 branch = x[j] - x[i];
      const double distance = branch.norm(), overlap = wide[i] + wide[j] - distance;
      if (!(overlap > 0)) continue;
      apart &= distance > radius[i] + radius[j];
      const Vec3 half = distance > 0 ? Vec3(0.5 * overlap / distance * branch) : Vec3(0, 0, 0.5 * overlap);
      push[i] -= half;
      push[j] += half;
    }
    if (apart) {
      Particles grains;
      for (const std::size_t i : in_layers(x, bed.mean_diameter)) {
        if (walls.inside_a_wall(x[i])) throw CaseError("the bed does not fit between its walls: a grain is inside one");
        grains.add(std::uint32_t(grains.size() + 1), material, radius[i], x[i]);
      }
      return grains;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double length = push[i].norm();
      x[i] += length > farthest ? Vec3(push[i] * (farthest / length)) : push[i];
      x[i] = held_inside(region, x[i], wide[i]);
      x[i].z() = std::max(x[i].z(), wide[i]);
    }
  }
  throw CaseError("the bed does not fit between its walls: grains still overlap after " + std::to_string(most_sweeps) +
                  " rearrangements");
}

}  // namespace dem
