#include "libdem/simulation/force_watch.hpp"

#include <algorithm>

#include "libdem/errors.hpp"

namespace dem {
namespace {

// W, that walls put into a grain of a chunk at their contacts.
double power_of_walls(const WallContacts& walls, const std::vector<WallPose>& poses, std::size_t chunk_of_grain, std::uint32_t row) {
  double power = 0;
  for (const WallContacts::Chunk& chunk : walls.chunks_of(chunk_of_grain)) {
    const WallPose& pose = poses[chunk.wall];
    const auto begin = walls.candidate.begin() + chunk.begin, end = walls.candidate.begin() + chunk.end;
    const auto candidate = std::lower_bound(begin, end, row, [](const WallCandidate& a, std::uint32_t b) { return a.particle < b; });
    if (candidate == end || candidate->particle != row) continue;
    for (const WallContact& contact : walls.contacts(*candidate)) {
      if (!contact.acts()) continue;
      const Vec3 force = contact.tangential - (contact.elastic + contact.damping) * contact.touch.normal;
      power += force.dot(pose.velocity + pose.angular_velocity.cross(contact.touch.point - pose.position));
    }
  }
  return power;
}

}  // namespace

ForceWatch::ForceWatch(double watch_force, double watch_radius, double smallest_radius, std::vector<Excursion> open)
    : force_(watch_force), radius_(watch_radius), least_(limit(smallest_radius)) {
  for (std::size_t k = 1; k < open.size(); ++k)
    if (open[k].id <= open[k - 1].id) throw CaseError("the stored excursions are not in order of their grains");
  excursions_ = ExcursionTracker(std::move(open));
}

double ForceWatch::limit(double radius) const {
  const double scale = radius_ > 0 ? radius / radius_ : 1.0;
  return force_ * scale * scale;
}

void ForceWatch::lay_out(std::size_t chunks) { pressed_.assign(chunks, {}); }

void ForceWatch::look(std::size_t chunk, const GrainStore& grains, std::span<const std::uint32_t> rows, const ForceSheet& forces) {
  const std::size_t begin = grains.chunks().begin(chunk);
  Pressed& pressed = pressed_[chunk];
  double largest = 0;
  for (const std::uint32_t i : rows) largest = std::max(largest, forces[i - begin].force[3]);
  pressed.largest = largest;
  pressed.above.clear();
  if (!(largest > least_)) return;
  for (const std::uint32_t i : rows) {
    const GrainRow& grain = grains.rows[i];
    const double force = forces[i - begin].force[3];
    if (force > limit(grain.radius()))
      pressed.above.push_back({i, grains.id[i], force, 0, grain.velocity().norm(), grain.angular_velocity().norm(), grain.position()});
  }
}

std::size_t ForceWatch::follow(std::uint64_t step, double duration, const WallContacts& walls, const std::vector<WallPose>& poses) {
  above_.clear();
  for (std::size_t c = 0; c < pressed_.size(); ++c)
    for (WatchedGrain& grain : pressed_[c].above) {
      grain.power = power_of_walls(walls, poses, c, grain.row);
      above_.push_back(grain);
    }
  std::sort(above_.begin(), above_.end(), [](const WatchedGrain& a, const WatchedGrain& b) { return a.id < b.id; });
  excursions_.look(step, duration, above_);
  return above_.size();
}

}  // namespace dem
