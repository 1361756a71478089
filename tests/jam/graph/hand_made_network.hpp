// Small networks written by hand: grains by id, touches by id, walls by role. The rows, the order of the contacts and
// everything else that snapshot.hpp asks for follow by themselves, so a test shows only its physics.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam::hand_made {

// Walls of every hand-made run: their index is what WallContacts::wall holds.
enum HandMadeWall : std::uint8_t { blade_wall = 0, vessel_wall = 1, floor_wall = 2 };

// A blade whose tip turns on a circle of 10 mm about z, in a vessel of radius 11 mm; the blade is 4 mm high about its
// origin. The floor is no vessel wall: nothing bridges to it.
inline RunInfo hand_made_run() {
  RunInfo info;
  info.creator = "hand";
  info.walls.resize(3);
  const auto describe = [&info](HandMadeWall wall, const char* name, const char* kind, WallRole role) {
    info.walls[wall].name = name;
    info.walls[wall].kind = kind;
    info.walls[wall].role = role;
  };
  describe(blade_wall, "blade", "mesh", WallRole::blade);
  describe(vessel_wall, "vessel", "cylinder", WallRole::vessel);
  describe(floor_wall, "floor", "plane", WallRole::other);
  info.walls[vessel_wall].radius = 0.011;
  info.walls[floor_wall].point = Vec3(0, 0, -0.004);
  info.gap = {.tip_radius = 0.010, .vessel_radius = 0.011, .z_low = -0.002, .z_high = 0.002};
  return info;
}

class Network {
 public:
  explicit Network(double time = 0) : time_(time) {}

  Network& grain(ParticleId id, Vec3f position = Vec3f(0.0105f, 0, 0), float radius = 0.5e-3f) {
    grains_[id] = {position, radius};
    return *this;
  }
  Network& touch(ParticleId a, ParticleId b, float normal_force) {
    grains_.try_emplace(a);
    grains_.try_emplace(b);
    touches_[{std::min(a, b), std::max(a, b)}] = normal_force;
    return *this;
  }
  Network& press(ParticleId id, HandMadeWall wall, float normal_force) {
    grains_.try_emplace(id);
    presses_[{id, wall}] = normal_force;
    return *this;
  }

  Snapshot snapshot() const {
    Snapshot s;
    s.time = time_;
    s.walls.resize(3);
    std::map<ParticleId, std::uint32_t> row;
    for (const auto& [id, grain] : grains_) {
      row[id] = static_cast<std::uint32_t>(s.particles.size());
      s.particles.id.push_back(id);
      s.particles.position.push_back(grain.position);
      s.particles.radius.push_back(grain.radius);
    }
    for (const auto& [pair, force] : touches_) {
      s.pp.row.push_back({row[pair.first], row[pair.second]});
      s.pp.normal_force.push_back(force);
    }
    for (const auto& [key, force] : presses_) {
      s.pw.row.push_back(row[key.first]);
      s.pw.wall.push_back(key.second);
      s.pw.normal_force.push_back(force);
    }
    return s;
  }

 private:
  struct Grain {
    Vec3f position = Vec3f(0.0105f, 0, 0);
    float radius = 0.5e-3f;
  };
  double time_;
  std::map<ParticleId, Grain> grains_;
  std::map<std::pair<ParticleId, ParticleId>, float> touches_;
  std::map<std::pair<ParticleId, HandMadeWall>, float> presses_;
};

// A random network of `particles` grains with ids 0, 3, 6, ...: about `touches` contacts, a fifth of them adhesive, and
// contacts with all three walls. Integer newtons, so that no sum depends on its order.
inline Snapshot random_network(unsigned seed, unsigned particles, unsigned touches) {
  std::mt19937 random(seed);
  // By remainder, because standard distributions differ between libraries.
  const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
  Network network;
  for (unsigned i = 0; i < particles; ++i) {
    const auto coordinate = [&] { return static_cast<float>(below(24001)) * 1e-6f - 0.012f; };
    // Drawn one by one, because compilers evaluate the arguments of a call in different orders.
    const float x = coordinate(), y = coordinate(), z = coordinate() / 4;
    network.grain(3 * i, Vec3f(x, y, z), 0.4e-3f + 1e-6f * static_cast<float>(below(200)));
  }
  for (unsigned k = 0; k < touches && particles > 1; ++k) {
    const unsigned a = below(particles), b = below(particles);
    if (a != b) network.touch(3 * a, 3 * b, static_cast<float>(below(50)) - 10.0f);
  }
  for (unsigned k = 0; k < particles / 3; ++k) {
    const unsigned pressed = 3 * below(particles), wall = below(3);
    network.press(pressed, static_cast<HandMadeWall>(wall), static_cast<float>(below(60)) - 10.0f);
  }
  return network.snapshot();
}

// f(graph) on 50 networks of so many grains, from sparse to dense.
template <class F>
void for_random_networks(unsigned particles, F f) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Snapshot snapshot = random_network(seed, particles, seed * particles / 12);
    SCOPED_TRACE("seed " + std::to_string(seed));
    f(ContactGraph(snapshot, hand_made_run().walls));
  }
}

// The same network without any load: a frame between two jams.
inline Snapshot unloaded(Snapshot snapshot) {
  snapshot.pp.normal_force.assign(snapshot.pp.size(), 0.0f);
  snapshot.pw.normal_force.assign(snapshot.pw.size(), 0.0f);
  return snapshot;
}

// The same grains under other ids: grain of row r becomes id new_id[r]; rows and contacts are sorted again.
inline Snapshot relabelled(const Snapshot& s, const std::vector<ParticleId>& new_id) {
  const std::size_t n = s.particles.size();
  std::vector<std::uint32_t> order(n), new_row(n);
  for (std::uint32_t r = 0; r < n; ++r) order[r] = r;
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return new_id[a] < new_id[b]; });
  Snapshot t = s;
  for (std::uint32_t r = 0; r < n; ++r) {
    new_row[order[r]] = r;
    t.particles.id[r] = new_id[order[r]];
    t.particles.position[r] = s.particles.position[order[r]];
    t.particles.radius[r] = s.particles.radius[order[r]];
  }
  std::map<std::array<std::uint32_t, 2>, float> pairs;
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const std::uint32_t a = new_row[s.pp.row[c][0]], b = new_row[s.pp.row[c][1]];
    pairs[{std::min(a, b), std::max(a, b)}] = s.pp.normal_force[c];
  }
  std::map<std::array<std::uint32_t, 2>, float> presses;
  for (std::size_t c = 0; c < s.pw.size(); ++c) {
    presses[{new_row[s.pw.row[c]], s.pw.wall[c]}] = s.pw.normal_force[c];
  }
  std::size_t c = 0;
  for (const auto& [pair, force] : pairs) {
    t.pp.row[c] = pair;
    t.pp.normal_force[c++] = force;
  }
  c = 0;
  for (const auto& [key, force] : presses) {
    t.pw.row[c] = key[0];
    t.pw.wall[c] = static_cast<std::uint8_t>(key[1]);
    t.pw.normal_force[c++] = force;
  }
  return t;
}

// A permutation of 0 .. n-1 spread over ids with holes in between.
inline std::vector<ParticleId> shuffled_ids(unsigned seed, std::size_t n) {
  std::mt19937 random(seed);
  std::vector<ParticleId> ids(n);
  for (std::size_t i = 0; i < n; ++i) ids[i] = static_cast<ParticleId>(7 * i + 5);
  for (std::size_t i = n; i > 1; --i) std::swap(ids[i - 1], ids[random() % i]);
  return ids;
}

}  // namespace jam::hand_made
