#include "libdem/contact/regroup.hpp"

#include <omp.h>

#include <algorithm>

#include "libdem/contact/chunk_shares.hpp"

namespace dem {
namespace {

constexpr std::size_t width = PairContacts::width;

// Blocks whose pairs may change places: of one chunk, of one pair of materials, crossing or not.
struct Range {
  std::uint32_t begin, end;
  std::uint32_t blocks() const { return end - begin; }
};

template <class Use>
void for_each_range(const PairContacts& pairs, const PairContacts::Chunk& chunk, Use use) {
  for (std::uint32_t b = chunk.begin; b < chunk.end;) {
    const std::uint32_t begin = b, limit = b < chunk.inner_end ? chunk.inner_end : chunk.end;
    while (b < limit && pairs.kind[b].material_pair == pairs.kind[begin].material_pair) ++b;
    use(Range{begin, b});
  }
}

// What stands in the blocks of a range, while they are filled anew.
struct Contents {
  std::vector<PairContacts::Block> block;
  std::vector<Activity> activity;
  std::vector<PairContacts::RollingSprings> rolling;
  std::vector<std::uint64_t> birth_step;
  std::vector<LastForces> last;

  void take(const PairContacts& pairs, const Range& range) {
    const auto copy = [&](const auto& from, auto& to, std::size_t each) {
      if (!from.empty()) to.assign(from.begin() + std::ptrdiff_t(range.begin * each), from.begin() + std::ptrdiff_t(range.end * each));
    };
    copy(pairs.block, block, 1);
    copy(pairs.activity, activity, 1);
    copy(pairs.rolling, rolling, 1);
    copy(pairs.birth_step, birth_step, width);
    copy(pairs.last, last, width);
  }

  void put(std::size_t from, PairContacts& pairs, std::size_t to) const {
    const std::size_t b = to / width, k = to % width, x = from % width;
    const PairContacts::Block& source = block[from / width];
    PairContacts::Block& target = pairs.block[b];
    target.first[k] = source.first[x];
    target.second[k] = source.second[x];
    for (std::size_t c = 0; c < 3; ++c) target.spring[c][k] = source.spring[c][x];
    target.contact_radius[k] = source.contact_radius[x];
    target.cube_root[k] = source.cube_root[x];
    pairs.birth_step[to] = birth_step[from];
    if (!pairs.rolling.empty())
      for (std::size_t c = 0; c < 3; ++c) pairs.rolling[b].torque[c][k] = rolling[from / width].torque[c][x];
    if (!pairs.last.empty()) pairs.last[to] = last[from];
  }
};

// Working space of one thread.
struct Space {
  Contents old;
  std::array<std::vector<std::uint32_t>, most_levels + 1> touching;  // lanes of the range
  std::vector<std::pair<double, std::uint32_t>> near;  // m, gaps of pairs that are apart and stood among contacts or awake
  std::vector<std::uint32_t> asleep, apart, phantoms, order;
};

// The lanes of a range in the order that they should have, or nothing where little would be gained.
bool find_order(const PairContacts& pairs, const Range& range, const GrainTable& grains, Space& space) {
  for (auto& lanes : space.touching) lanes.clear();
  space.near.clear();
  space.asleep.clear();
  space.phantoms.clear();
  std::size_t acting = 0;
  for (std::uint32_t b = range.begin; b < range.end; ++b) {
    const PairContacts::Block& block = pairs.block[b];
    const Activity& activity = pairs.activity[b];
    acting += activity.acts;
    for (std::uint32_t k = 0; k < width; ++k) {
      const std::uint32_t lane = std::uint32_t(width * (b - range.begin) + k);
      if (block.contact_radius[k] > 0)
        space.touching[activity.level].push_back(lane);
      else if (block.second[k] >= grains.size())
        space.phantoms.push_back(lane);
      else if (activity.asleep && !activity.acts)
        space.asleep.push_back(lane);
      else
        space.near.emplace_back(0, lane);
    }
  }
  std::size_t needed = 0;
  for (const auto& lanes : space.touching) needed += (lanes.size() + width - 1) / width;
  if (8 * acting <= 9 * needed) return false;  // little to gain

  for (auto& [gap, lane] : space.near) {
    const PairContacts::Block& block = pairs.block[range.begin + lane / width];
    const GrainRow &i = grains.rows[block.first[lane % width]], &j = grains.rows[block.second[lane % width]];
    gap = (i.position() - j.position()).norm() - i.radius() - j.radius();
  }
  std::sort(space.near.begin(), space.near.end());
  space.apart.clear();
  for (const auto& [gap, lane] : space.near) space.apart.push_back(lane);
  space.apart.insert(space.apart.end(), space.asleep.begin(), space.asleep.end());

  // Blocks of contacts are filled up with pairs that are apart; each other block begins with one.
  auto phantom = space.phantoms.begin();
  auto apart = space.apart.begin();
  space.order.clear();
  for (const auto& lanes : space.touching) {
    space.order.insert(space.order.end(), lanes.begin(), lanes.end());
    while (space.order.size() % width != 0) space.order.push_back(apart != space.apart.end() ? *apart++ : *phantom++);
  }
  const std::size_t blocks = range.blocks() - space.order.size() / width, pairs_left = std::size_t(space.apart.end() - apart);
  if (pairs_left < blocks) return false;
  std::size_t spare = pairs_left - blocks;  // beyond one for each block
  for (std::size_t b = 0; b < blocks; ++b) {
    space.order.push_back(*apart++);
    for (std::size_t k = 1; k < width; ++k) space.order.push_back(spare > 0 ? (--spare, *apart++) : *phantom++);
  }
  return true;
}

void fill(PairContacts& pairs, const Range& range, const GrainTable& grains, const MaterialTable& materials, const Resolution& resolution,
          Space& space) {
  space.old.take(pairs, range);
  for (std::uint32_t b = range.begin; b < range.end; ++b) {
    const std::uint32_t* const lanes = &space.order[width * (b - range.begin)];
    Activity now;
    now.wake = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < width; ++k) {
      space.old.put(lanes[k], pairs, width * b + k);
      const Activity& before = space.old.activity[lanes[k] / width];
      if (pairs.block[b].contact_radius[k] > 0) {
        now.acts = true;
        now.asleep = false;
        now.level = before.level;
      }
      now.wake = std::min(now.wake, before.asleep && !before.acts ? before.wake : -std::numeric_limits<double>::infinity());
    }
    pairs.activity[b] = now;
    pairs.kind[b].scale = scale_of(pairs, b, grains, materials, resolution);
  }
}

}  // namespace

void regroup(PairContacts& pairs, const GrainTable& grains, const MaterialTable& materials, const Resolution& resolution) {
  bool crossing_moved = false;
  const std::size_t chunks = pairs.chunk.size(), threads = std::size_t(omp_get_max_threads());
  ChunkShares shares(threads, [&](std::size_t thread) { return chunks * thread / threads; });  // as those who evaluate them
#pragma omp parallel num_threads(int(threads)) reduction(|| : crossing_moved)
  {
    Space space;
    shares.take(std::size_t(omp_get_thread_num()), [&](std::uint32_t c) {
      for_each_range(pairs, pairs.chunk[c], [&](const Range& range) {
        if (!find_order(pairs, range, grains, space)) return;
        fill(pairs, range, grains, materials, resolution, space);
        crossing_moved |= range.begin >= pairs.chunk[c].inner_end;
      });
    });
  }
  if (crossing_moved) connect_chunks(pairs, grains.size());
}

}  // namespace dem
