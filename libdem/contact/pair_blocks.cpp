#include "libdem/contact/pair_blocks.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace dem {
namespace {

constexpr std::size_t width = PairContacts::width;

std::uint32_t material_pair(const GrainTable& grains, std::size_t materials, std::uint32_t i, std::uint32_t j) {
  const auto [a, b] = std::minmax(grains.material[i], grains.material[j]);
  return std::uint32_t(a * materials + b);
}

struct Pair {
  std::uint32_t kind;  // those of one kind share blocks
  std::uint32_t i, j;
  double gap;          // m, 0 where they touch
};
bool operator<(const Pair& a, const Pair& b) {
  if (a.kind != b.kind) return a.kind < b.kind;
  if (a.gap != b.gap) return a.gap < b.gap;
  return std::tie(a.i, a.j) < std::tie(b.i, b.j);
}

// In the order of the blocks: by crossing, pair of materials, whether they touch, level.
std::uint32_t kind_of(bool crosses, std::uint32_t material_pair, const std::optional<std::uint8_t>& level) {
  return std::uint32_t(crosses) << 31 | material_pair << 9 | std::uint32_t(!level) << 8 | level.value_or(0);
}

}  // namespace

Lanes order_lanes(const PairList& list, const GrainTable& grains, std::size_t materials, const LevelOf& level) {
  const RowChunks chunks(grains.size());
  std::vector<Lanes> of_chunk(chunks.count());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunks.count(); ++c) {
    std::vector<Pair> pairs;
    for (std::uint32_t s = list.begin[chunks.begin(c)]; s < list.begin[chunks.end(c)]; ++s) {
      const std::uint32_t i = list.first[s], j = list.second[s];
      const std::optional<std::uint8_t> touches = level(i, j);
      const GrainRow &a = grains.rows[i], &b = grains.rows[j];
      const double gap = touches ? 0 : (a.position() - b.position()).norm() - a.radius() - b.radius();
      pairs.push_back({kind_of(chunks.of(j) != c, material_pair(grains, materials, i, j), touches), i, j, gap});
    }
    std::sort(pairs.begin(), pairs.end());
    Lanes& lanes = of_chunk[c];
    const auto fill_up = [&] {
      while (lanes.size() % width != 0) lanes.push_back({lanes.back()[0], std::uint32_t(grains.size() + c)});
    };
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (k > 0 && pairs[k].kind != pairs[k - 1].kind) fill_up();
      lanes.push_back({pairs[k].i, pairs[k].j});
    }
    fill_up();
  }
  Lanes lanes;
  for (const Lanes& part : of_chunk) lanes.insert(lanes.end(), part.begin(), part.end());
  return lanes;
}

bool fit(const Lanes& lanes, const GrainTable& grains) {
  const std::size_t n = grains.size();
  const RowChunks chunks(n);
  if (lanes.size() % width != 0) return false;
  std::pair<std::size_t, bool> last{0, false};
  for (std::size_t b = 0; b < lanes.size(); b += width) {
    const auto [i, j] = lanes[b];
    if (!(i < j && j < n)) return false;
    const std::pair<std::size_t, bool> kind{chunks.of(i), chunks.of(j) != chunks.of(i)};
    if (kind < last) return false;
    last = kind;
    const std::uint32_t materials = material_pair(grains, 256, i, j);
    for (std::size_t k = b + 1; k < b + width; ++k) {
      const auto [x, y] = lanes[k];
      if (!(x < n && x < y && chunks.of(x) == kind.first)) return false;
      if (y == n + kind.first) continue;  // the phantom
      if (!(y < n && (chunks.of(y) != kind.first) == kind.second && material_pair(grains, 256, x, y) == materials))
        return false;
    }
  }
  return true;
}

LevelScale scale_of(const PairContacts& pairs, std::size_t number, const GrainTable& grains, const MaterialTable& materials,
                    const Resolution& resolution) {
  const PairContacts::Block& block = pairs.block[number];
  const PairConstants<double>& kind = materials.pair[pairs.kind[number].material_pair];
  constexpr float infinity = std::numeric_limits<float>::infinity();
  LevelScale least{infinity, infinity};
  for (std::size_t lane = 0; lane < width; lane += pack_width) {
    const auto first = [&](auto k) -> const GrainRow& { return grains.rows[block.first[lane + k]]; };
    const auto second = [&](auto k) -> const GrainRow& { return grains.rows[block.second[lane + k] < grains.size() ? block.second[lane + k] : block.first[lane + k]]; };
    PairConstants<Pack> c;
    c.effective_modulus = kind.effective_modulus;
    c.effective_radius = harmonic(Pack([&](auto k) { return first(k).radius(); }), Pack([&](auto k) { return second(k).radius(); }));
    set_effective_mass(c, Pack([&](auto k) { return first(k).mass(); }), Pack([&](auto k) { return second(k).mass(); }));
    const LevelScale scale = level_scale(c, resolution);
    least = {std::min(least.radius, scale.radius), std::min(least.speed, scale.speed)};
  }
  return least;
}

PairContacts make_pair_contacts(const Lanes& lanes, const GrainTable& grains, const MaterialTable& materials,
                                const Resolution& resolution, bool rolling_spring, bool keep_ledger, PairContacts pairs) {
  const std::size_t blocks = lanes.size() / width;
  const RowChunks chunks(grains.size());
  if (pairs.block.capacity() < blocks) {  // by little, as they are most of a run's memory
    pairs.block = {};
    pairs.block.reserve(blocks + blocks / 16);
  }
  pairs.block.resize(blocks);
  pairs.activity.assign(blocks, {});
  pairs.due_from.assign(blocks, 0);
  pairs.kind.assign(blocks, {});
  pairs.birth_step.assign(lanes.size(), 0);
  pairs.rolling.assign(rolling_spring ? blocks : 0, {});
  pairs.last.assign(keep_ledger ? lanes.size() : 0, {});
  pairs.chunk.assign(chunks.count(), {});

  std::size_t at = 0;
  for (std::size_t c = 0; c < chunks.count(); ++c) {
    PairContacts::Chunk& chunk = pairs.chunk[c];
    chunk.begin = chunk.inner_end = std::uint32_t(at);
    for (; at < blocks && chunks.of(lanes[at * width][0]) == c; ++at)
      if (chunks.of(lanes[at * width][1]) == c) chunk.inner_end = std::uint32_t(at + 1);
    chunk.end = std::uint32_t(at);
  }

#pragma omp parallel for schedule(static)
  for (std::size_t b = 0; b < blocks; ++b) {
    PairContacts::Block& block = pairs.block[b];
    block.spring = {};
    block.contact_radius = {};
    const std::uint32_t kind = material_pair(grains, materials.size, lanes[b * width][0], lanes[b * width][1]);
    pairs.kind[b].material_pair = kind;
    for (std::size_t k = 0; k < width; ++k) {
      const auto [i, j] = lanes[b * width + k];
      block.first[k] = i;
      block.second[k] = j;
      block.cube_root[k] = cube_root(harmonic(grains.rows[i].radius(), grains.rows[j < grains.size() ? j : i].radius()));
    }
    pairs.kind[b].scale = scale_of(pairs, b, grains, materials, resolution);
  }
  connect_chunks(pairs, grains.size());
  return pairs;
}

PairConstants<double> constants_of(const PairContacts& pairs, std::size_t lane, const LargeArray<GrainRow>& rows, std::size_t grains,
                                   const MaterialTable& materials) {
  const std::size_t b = lane / width, i = pairs.first(lane), j = pairs.second(lane);
  const auto body = [&](std::uint32_t row) {
    const double mass = rows[row].mass(), radius = rows[row].radius();
    return BodyConstants{radius, mass, sphere_inertia(mass, radius)};
  };
  return pair_constants(materials.pair[pairs.kind[b].material_pair], body(i), body(j < grains ? j : i));
}

void connect_chunks(PairContacts& pairs, std::size_t grains) {
  const RowChunks rows(grains);
  const std::size_t chunks = pairs.chunk.size();
  const auto for_each_crossing = [&](auto use) {
    for (std::uint32_t c = 0; c < chunks; ++c)
      for (std::uint32_t b = pairs.chunk[c].inner_end; b < pairs.chunk[c].end; ++b)
        for (std::uint32_t k = 0; k < width; ++k)
          if (const std::uint32_t j = pairs.block[b].second[k]; j < grains) use(c, b, k, j);
  };
  std::uint32_t crossing = 0;
  for (PairContacts::Chunk& chunk : pairs.chunk) {
    chunk.senders.clear();
    for (std::uint32_t b = chunk.inner_end; b < chunk.end; ++b, crossing += width) pairs.kind[b].crossing = crossing;
  }
  pairs.crossing.assign(crossing, {});
  std::vector<std::uint32_t> incoming(chunks + 1, 0);
  for_each_crossing([&](std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t j) { ++incoming[rows.of(j) + 1]; });
  for (std::size_t c = 0; c < chunks; ++c) {
    incoming[c + 1] += incoming[c];
    pairs.chunk[c].incoming_begin = incoming[c];
    pairs.chunk[c].incoming_end = incoming[c + 1];
  }
  pairs.incoming.resize(incoming[chunks]);
  for_each_crossing([&](std::uint32_t c, std::uint32_t b, std::uint32_t k, std::uint32_t j) {
    pairs.incoming[incoming[rows.of(j)]++] = {j, pairs.kind[b].crossing + k, b};
    std::vector<std::uint32_t>& senders = pairs.chunk[rows.of(j)].senders;
    if (senders.empty() || senders.back() != c) senders.push_back(c);
  });
}

}  // namespace dem
