#include "libdem/simulation/contact_memory.hpp"

#include <algorithm>
#include <exception>
#include <numeric>
#include <tuple>

#include "libdem/errors.hpp"
#include "libdem/neighbors/pair_list.hpp"

namespace dem {
namespace {

// The same contact seen from the other grain.
State::Pair swapped(State::Pair c) {
  std::swap(c.i, c.j);
  c.spring = -c.spring;
  c.rolling = -c.rolling;
  return c;
}
LastForces swapped(LastForces last) {
  last.normal = -last.normal;
  std::swap(last.arm_i, last.arm_j);
  last.tangential_elastic = -last.tangential_elastic;
  last.tangential_viscous = -last.tangential_viscous;
  std::swap(last.rolling_i, last.rolling_j);
  return last;
}

// Where the pairs of each row begin; [N+1].
template <class Pairs>
std::vector<std::uint32_t> first_of_rows(const Pairs& pairs, std::size_t n) {
  std::vector<std::uint32_t> begin(n + 1, 0);
  for (const auto& c : pairs) ++begin[c.i + 1];
  for (std::size_t i = 0; i < n; ++i) begin[i + 1] += begin[i];
  return begin;
}

// Where in memory.pairs a pair of the caller's rows is.
struct PairIndex {
  std::vector<std::uint32_t> begin, larger;  // [N+1] as above, [P] the larger row of each

  explicit PairIndex(const Memory& memory, std::size_t n) : begin(first_of_rows(memory.pairs, n)) {
    for (const State::Pair& c : memory.pairs) larger.push_back(c.j);
  }
  // -1 where there is none.
  std::int64_t find(std::uint32_t i, std::uint32_t j) const {
    const auto [a, b] = std::minmax(i, j);
    for (std::uint32_t k = begin[a]; k < begin[a + 1]; ++k)
      if (larger[k] == b) return k;
    return -1;
  }
};

bool has_rolling_spring(const LawChoice& law) {
  return with_part<RollingLaws>(law.rolling, [](auto part) { return part.has_spring; });
}

}  // namespace

// What indexes must be in range and in order before anything follows them.
void check(const Memory& memory, std::size_t n, std::size_t walls) {
  const auto refuse = [](const std::string& what) { throw CaseError("the stored state has " + what); };
  for (std::size_t k = 0; k < memory.pairs.size(); ++k) {
    const State::Pair& c = memory.pairs[k];
    if (c.j >= n || c.i >= c.j) refuse("a contact between grains that it does not have");
    if (k > 0 && std::tuple(memory.pairs[k - 1].i, memory.pairs[k - 1].j) >= std::tuple(c.i, c.j))
      refuse("contacts that are not in ascending order of their grains");
    if (!(c.contact_radius > 0)) refuse("a contact without a contact radius");
    if (c.level > most_levels) refuse("a contact of a level that there is not");
  }
  for (std::size_t k = 0; k < memory.wall_pairs.size(); ++k) {
    const State::WallPair& c = memory.wall_pairs[k];
    if (c.i >= n || c.wall >= walls) refuse("a contact with a wall that is not there");
    if (k > 0 && memory.wall_pairs[k - 1].i > c.i) refuse("wall contacts that are not in ascending order of their grains");
    if (!(c.contact_radius > 0)) refuse("a wall contact without a contact radius");
    if (c.level > most_levels) refuse("a wall contact of a level that there is not");
  }
}

Lanes list_pairs(const ListInput& in, const GrainStore& grains, const Memory& memory) {
  const std::size_t n = grains.size();
  std::vector<Vec3> position(n);
  std::vector<double> radius(n);
  for (std::size_t r = 0; r < n; ++r) {
    position[r] = grains.rows[r].position();
    radius[r] = grains.rows[r].radius() + grains.listed[r][3];
  }
  const PairIndex index(memory, n);
  const auto level = [&](std::uint32_t i, std::uint32_t j) -> std::optional<std::uint8_t> {
    const std::int64_t known = index.find(grains.order[i], grains.order[j]);
    if (known < 0) return std::nullopt;
    return memory.pairs[std::size_t(known)].level;
  };
  return order_lanes(build_pair_list(position, radius, 0), grains.table(), in.materials.size, level);
}

PairContacts make_pair_contacts(const ListInput& in, const Lanes& lanes, const GrainStore& grains, const Memory& memory,
                                PairContacts used) {
  const bool rolling_spring = has_rolling_spring(in.setup.law), keep_ledger = in.setup.keep_ledger;
  const std::vector<std::uint32_t>& order = grains.order;
  const PairIndex index(memory, grains.size());
  PairContacts pairs = make_pair_contacts(lanes, grains.table(), in.materials, in.setup.resolution(), rolling_spring, keep_ledger,
                                          std::move(used));
  std::size_t remembered = 0;
#pragma omp parallel for schedule(static) reduction(+ : remembered)
  for (std::size_t b = 0; b < pairs.block.size(); ++b)
    for (std::size_t k = 0; k < PairContacts::width; ++k) {
      PairContacts::Block& block = pairs.block[b];
      if (block.second[k] >= grains.size()) continue;
      const std::int64_t known = index.find(order[block.first[k]], order[block.second[k]]);
      if (known < 0) continue;
      const State::Pair& kept = memory.pairs[std::size_t(known)];
      const bool turned = order[block.first[k]] != kept.i;
      const State::Pair c = turned ? swapped(kept) : kept;
      const std::size_t lane = PairContacts::width * b + k;
      for (std::size_t x = 0; x < 3; ++x) block.spring[x][k] = c.spring[Eigen::Index(x)];
      block.contact_radius[k] = c.contact_radius;
      pairs.birth_step[lane] = c.birth_step;
      if (rolling_spring)
        for (std::size_t x = 0; x < 3; ++x) pairs.rolling[b].torque[x][k] = c.rolling[Eigen::Index(x)];
      if (keep_ledger) {
        const LastForces& last = memory.last[std::size_t(known)];
        pairs.last[lane] = turned ? swapped(last) : last;
      }
      pairs.activity[b].acts = true;
      pairs.activity[b].asleep = false;
      pairs.activity[b].level = c.level;
      ++remembered;
    }
  if (remembered != memory.pairs.size())
    throw CaseError("the stored state has a contact between grains that are apart");
  return pairs;
}

namespace {

// Of the grains of one chunk; rows of contacts, parts and candidates count from its own first.
WallContacts wall_contacts_of_chunk(const ListInput& in, const GrainStore& grains, const Memory& memory,
                                    const std::vector<std::uint32_t>& begin, std::size_t number) {
  const Setup& setup = in.setup;
  WallContacts fresh;
  for (std::uint32_t w = 0; w < setup.walls.size(); ++w) {
    const std::uint32_t first = std::uint32_t(fresh.candidate.size());
    for (std::size_t r = grains.chunks().begin(number); r < grains.chunks().end(number); ++r) {
      const std::uint32_t i = grains.order[r];
      WallCandidate c{};
      Activity activity;
      c.contact_begin = std::uint32_t(fresh.contact.size());
      for (std::uint32_t k = begin[i]; k < begin[i + 1]; ++k) {
        const State::WallPair& kept = memory.wall_pairs[k];
        if (kept.wall != w) continue;
        if (c.size == WallCandidate::capacity) throw CaseError("the stored state has a contact with a wall that is not there");
        ++c.size;
        WallContact& contact = fresh.contact.emplace_back();
        contact.touch.feature = kept.feature;
        contact.touch.normal = kept.normal;
        contact.touch.distance = kept.distance;
        contact.touch.curvature = kept.curvature;
        contact.memory = {kept.spring, kept.contact_radius, kept.birth_step};
        contact.rolling = kept.rolling;
        if (setup.keep_ledger) fresh.last.push_back(memory.wall_last[k]);
        activity = {true, false, kept.level};
      }
      const double reach = grains.rows[r].radius() + in.skin;
      if (c.size == 0 && !near(setup.walls[w], in.poses[w], grains.rows[r].position(), reach)) continue;
      c.particle = std::uint32_t(r);
      c.wall = w;
      c.part_begin = std::uint32_t(fresh.parts.size());
      candidate_parts(setup.walls[w], in.poses[w], grains.rows[r].position(), reach, fresh.parts);
      c.part_end = std::uint32_t(fresh.parts.size());
      if (c.size == 0 && std::holds_alternative<MeshWall>(setup.walls[w].shape) && c.part_begin == c.part_end) continue;
      const std::size_t places = std::min<std::size_t>(c.part_end - c.part_begin, WallCandidate::capacity);
      c.room = std::max(c.size, std::uint16_t(std::max<std::size_t>(places, 1)));
      fresh.contact.resize(c.contact_begin + c.room);
      if (setup.keep_ledger) fresh.last.resize(fresh.contact.size());
      c.material_pair = std::uint32_t(grains.material[r] * in.materials.size + setup.walls[w].material);
      const PairConstants<double> flat =
          wall_constants(in.materials.pair[c.material_pair], {grains.rows[r].radius(), grains.mass[r], grains.inertia[r]});
      for (std::size_t m = 0; m < constants_per_contact; ++m) c.constant[m] = flat.*contact_constants<double>[m];
      c.scale = level_scale(flat, setup.resolution());
      c.last_overlap = last_overlap(setup.law, setup.wall_curvature ? most_conforming(flat) : flat);
      fresh.candidate.push_back(c);
      fresh.activity.push_back(activity);
      fresh.due_from.push_back(0);
    }
    if (first == fresh.candidate.size()) continue;
    fresh.chunk.emplace_back();
    fresh.chunk.back().wall = w;
    fresh.chunk.back().begin = first;
    fresh.chunk.back().end = std::uint32_t(fresh.candidate.size());
  }
  return fresh;
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

WallContacts make_wall_contacts(const ListInput& in, const GrainStore& grains, const Memory& memory) {
  const std::vector<std::uint32_t> begin = first_of_rows(memory.wall_pairs, grains.size());
  std::vector<WallContacts> parts(grains.chunks().count());
  std::vector<std::exception_ptr> failed(parts.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < parts.size(); ++c) try {
      parts[c] = wall_contacts_of_chunk(in, grains, memory, begin, c);
    } catch (...) {
      failed[c] = std::current_exception();
    }
  for (const std::exception_ptr& error : failed)
    if (error) std::rethrow_exception(error);

  WallContacts all;
  all.skin = in.skin;
  all.chunk_begin.assign(1, 0);
  for (const WallContacts& part : parts) {
    const std::uint32_t candidates = std::uint32_t(all.candidate.size()), contacts = std::uint32_t(all.contact.size()),
                        triangles = std::uint32_t(all.parts.size());
    for (WallCandidate c : part.candidate) {
      c.contact_begin += contacts;
      c.part_begin += triangles;
      c.part_end += triangles;
      all.candidate.push_back(c);
    }
    for (WallContacts::Chunk chunk : part.chunk) {
      chunk.begin += candidates;
      chunk.end += candidates;
      all.chunk.push_back(chunk);
    }
    append(all.activity, part.activity);
    append(all.due_from, part.due_from);
    append(all.parts, part.parts);
    append(all.contact, part.contact);
    append(all.last, part.last);
    all.chunk_begin.push_back(std::uint32_t(all.chunk.size()));
  }
  all.near_parts.resize(all.parts.size());
  return all;
}

std::vector<std::uint32_t> by_grain(const GrainStore& grains, const WallContacts& walls) {
  std::vector<std::uint32_t> sorted(walls.candidate.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  const auto key = [&](std::uint32_t q) {
    return std::tuple(grains.order[walls.candidate[q].particle], walls.candidate[q].wall);
  };
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return sorted;
}

Memory gather(const GrainStore& grains, const PairContacts& pairs, const WallContacts& walls) {
  Memory all;
  const std::vector<std::uint32_t>& order = grains.order;
  const std::size_t n = grains.size();
  const bool ledger = !pairs.last.empty(), rolling_spring = !pairs.rolling.empty();
  std::vector<std::uint32_t> begin(n + 1, 0);
  const auto first = [&](std::size_t lane) { return std::min(order[pairs.first(lane)], order[pairs.second(lane)]); };
  for (std::size_t lane = 0; lane < pairs.lanes(); ++lane)
    if (pairs.acts(lane)) ++begin[first(lane) + 1];
  for (std::size_t i = 0; i < n; ++i) begin[i + 1] += begin[i];
  std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1), lane_of(begin.back());
  for (std::size_t lane = 0; lane < pairs.lanes(); ++lane)
    if (pairs.acts(lane)) lane_of[at[first(lane)]++] = std::uint32_t(lane);
  const auto other = [&](std::uint32_t lane) { return std::max(order[pairs.first(lane)], order[pairs.second(lane)]); };
  all.pairs.resize(lane_of.size());
  if (ledger) all.last.resize(lane_of.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    std::sort(lane_of.begin() + begin[i], lane_of.begin() + begin[i + 1],
              [&](std::uint32_t a, std::uint32_t b) { return other(a) < other(b); });
    for (std::uint32_t k = begin[i]; k < begin[i + 1]; ++k) {
      const std::uint32_t lane = lane_of[k];
      const PairContacts::Block& block = pairs.block[lane / PairContacts::width];
      const std::size_t x = lane % PairContacts::width;
      State::Pair c{order[block.first[x]], order[block.second[x]], {block.spring[0][x], block.spring[1][x], block.spring[2][x]},
                    pairs.birth_step[lane], block.contact_radius[x]};
      c.level = pairs.activity[lane / PairContacts::width].level;
      if (rolling_spring) {
        const auto& rolling = pairs.rolling[lane / PairContacts::width].torque;
        c.rolling = {rolling[0][x], rolling[1][x], rolling[2][x]};
      }
      const bool turned = c.i > c.j;
      all.pairs[k] = turned ? swapped(c) : c;
      if (ledger) all.last[k] = turned ? swapped(pairs.last[lane]) : pairs.last[lane];
    }
  }
  for (const std::uint32_t q : by_grain(grains, walls)) {
    const WallCandidate& c = walls.candidate[q];
    for (std::size_t k = c.contact_begin; k < c.contact_begin + c.size; ++k) {
      const WallContact& w = walls.contact[k];
      if (!w.acts()) continue;
      all.wall_pairs.push_back({order[c.particle], c.wall, w.touch.feature, w.touch.normal, w.memory.spring, w.memory.birth_step,
                                w.memory.contact_radius, w.rolling, w.touch.distance, w.touch.curvature, walls.activity[q].level});
      if (!walls.last.empty()) all.wall_last.push_back(walls.last[k]);
    }
  }
  return all;
}

}  // namespace dem
