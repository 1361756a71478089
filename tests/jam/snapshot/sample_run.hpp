// A small made-up run in which every item of the schema has a value that no other place has: frame k of it is always
// the same, whatever was made before.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include "libjam/errors.hpp"
#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam::sample {

inline constexpr std::size_t wall_count = 6;

inline RunInfo info() {
  RunInfo r;
  r.creator = "sample";
  r.creator_version = "0.1";
  r.commit = "abc123";
  r.created_utc = "2025-01-01T00:00:00Z";
  r.case_toml = "name = \"sample\"\n# käse\n";
  r.case_sha256 = std::string(64, 'a');
  r.argv = {"jamscope", "simulate", "", "case.toml"};
  r.seed = 18446744073709551557ULL;
  r.gravity = {0.1, -0.2, -9.81};
  r.dt = 5e-8;
  r.materials = {{"glass", 2500, 63e9, 0.2}, {"steel", 7800, 200e9, 0.3}};
  r.interactions = {{{0.9, 0.5, 0.01, 0.05}, {0.8, 0.4, 0.02, 0}}, {{0.8, 0.4, 0.02, 0}, {0.7, 0.3, 0.03, 0.1}}};
  Wall blade;
  blade.name = "blade";
  blade.kind = "mesh";
  blade.role = WallRole::blade;
  blade.material = "steel";
  blade.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}};
  blade.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  blade.triangle_label = {0, 1, 2, 3};
  Wall vessel;
  vessel.name = "vessel side";
  vessel.kind = "cylinder";
  vessel.role = WallRole::vessel;
  vessel.point = {0.001, 0.002, 0.003};
  vessel.radius = 0.025;
  vessel.low = -0.001;
  vessel.high = 0.05;
  vessel.free_side = "inside";
  Wall floor;
  floor.name = "floor";
  floor.kind = "plane";
  floor.material = "glass";
  floor.axis = {0, 0.6, 0.8};
  Wall hopper;
  hopper.name = "hopper";
  hopper.kind = "cone";
  hopper.point = {0.004, 0.005, 0.006};
  hopper.axis = {0.8, 0, 0.6};
  hopper.radius = 0.011;
  hopper.high_radius = 0.012;
  hopper.low = -0.013;
  hopper.high = 0.014;
  hopper.free_side = "outside";
  Wall lid;
  lid.name = "lid";
  lid.kind = "disc";
  lid.point = {0.007, 0.008, 0.009};
  lid.radius = 0.015;
  lid.hole_radius = 0.002;
  Wall plate;
  plate.name = "rough plate";
  plate.kind = "spheres";
  plate.sphere_centre = {{0, 0, 0}, {0.001, 0.002, 0}};
  plate.sphere_radius = {0.0005, 0.0006};
  r.walls = {vessel, blade, floor, hopper, lid, plate};  // not in the order of their names
  r.watch_force = 12.5;
  r.watch_radius = 5e-4;
  r.watch_stride = 8;
  r.gap = {0.0235, 0.025, -0.003, 0.003};
  return r;
}

// Frame k of a run with about `particles` particles.
inline Snapshot frame(std::size_t k, std::size_t particles = 60) {
  std::mt19937 random(static_cast<unsigned>(1000 + k));
  const auto real = [&] { return static_cast<float>(random() % 100000) / 100000.0F - 0.5F; };
  const auto vec = [&] { return Vec3f(real(), real(), real()); };
  Snapshot s;
  s.time = 0.002 * static_cast<double>(k);
  s.step = 40000 * k;
  const std::size_t n = particles + k % 3;
  for (std::size_t i = 0; i < n; ++i) {
    s.particles.id.push_back(static_cast<ParticleId>(3 * i + k % 2));
    s.particles.position.push_back(vec());
    s.particles.velocity.push_back(vec());
    s.particles.angular_velocity.push_back(vec());
    s.particles.radius.push_back(0.001F + 0.001F * std::abs(real()));
    s.particles.material.push_back(static_cast<std::uint8_t>(random() % 2));
    s.particles.compressive_force.push_back(std::abs(real()));
  }
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; ++j) {
      if (random() % 20 != 0) continue;
      s.pp.row.push_back({i, j});
      s.pp.normal_force.push_back(real());
      s.pp.damping_force.push_back(real());
      s.pp.tangential_force.push_back(vec());
      s.pp.overlap.push_back(1e-6F * real());
      s.pp.birth_step.push_back((std::uint64_t{1} << 40) + random());
      s.pp.flags.push_back(static_cast<std::uint8_t>(random() % 16));
    }
  }
  for (std::uint32_t i = 0; i < n; i += 2) {
    s.pw.row.push_back(i);
    s.pw.wall.push_back(static_cast<std::uint8_t>(random() % wall_count));
    s.pw.facet.push_back(random() % 2);
    s.pw.feature.push_back(static_cast<std::uint8_t>(random() % 3));
    s.pw.point.push_back(vec());
    s.pw.normal.push_back((vec() + Vec3f(1, 0, 0)).normalized());
    s.pw.normal_force.push_back(real());
    s.pw.damping_force.push_back(real());
    s.pw.tangential_force.push_back(vec());
    s.pw.overlap.push_back(1e-6F * real());
    s.pw.birth_step.push_back(random());
    s.pw.flags.push_back(static_cast<std::uint8_t>(random() % 16));
  }
  for (std::size_t w = 0; w < wall_count; ++w) {
    const auto big = [&] { return vec().cast<double>().eval(); };
    WallState state;
    state.position = big();
    state.orientation = Eigen::Quaterniond(1, real(), real(), real()).normalized();
    state.velocity = big();
    state.angular_velocity = big();
    state.force = big();
    state.torque = big();
    s.walls.push_back(state);
  }
  return s;
}

// Four windows between frame k - 1 and frame k; none before frame 0.
inline Series series(std::size_t k) {
  Series s;
  if (k == 0) return s;
  std::mt19937 random(static_cast<unsigned>(2000 + k));
  const auto real = [&] { return static_cast<double>(random()) / 4294967296.0; };
  s.walls.resize(wall_count);
  for (std::size_t r = 1; r <= 4; ++r) {
    const auto fill = [&]<class V>(const schema::Item&, std::vector<V>& values) {
      V value{};
      if constexpr (std::is_arithmetic_v<V>) {
        value = static_cast<V>(100 * real());
      } else {
        for (auto& x : value) x = static_cast<std::decay_t<decltype(x)>>(100 * real());
      }
      values.push_back(value);
    };
    schema::visit_series(s, fill);
    for (auto& w : s.walls) schema::visit_wall_series(w, fill);
    // None, one or two excursions; not in the first window.
    s.excursion_count.back() = std::uint32_t(r % 3);
    for (std::uint32_t e = 0; e < s.excursion_count.back(); ++e) {
      schema::visit_excursions(s.excursions, fill);
      s.excursions.first_step.back() = 40000 * (k - 1) + 10 * r;
      s.excursions.peak_step.back() = s.excursions.first_step.back() + e;
      s.excursions.last_step.back() = s.excursions.first_step.back() + 5;
      s.excursions.open.back() = std::uint8_t(e);
    }
    s.step.back() = 40000 * (k - 1) + 10000 * r;
    s.time.back() = 5e-8 * static_cast<double>(s.step.back());
  }
  return s;
}

// A folder of its own for each test, removed afterwards.
class InFolder : public testing::Test {
 protected:
  InFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::path(testing::TempDir()) / (std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    path = folder / "run.h5";
  }
  ~InFolder() override { std::filesystem::remove_all(folder); }
  std::filesystem::path folder, path;
};

template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const DataError& e) {
    return e.what();
  }
  return "no error";
}

// The first item in which two values differ, or "". Compares bits.
inline std::string difference(const Snapshot& a, const Snapshot& b, const RunInfo& run = info()) {
  if (a.time != b.time || a.step != b.step) return "time or step";
  std::string first;
  const auto same_column = [&](const schema::Item& item, const auto& x, const auto& y) {
    const bool same =
        x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
    if (!same && first.empty()) first = item.path;
  };
  const auto compare = [&](auto visit) {
    std::vector<std::function<void(const void*)>> checks;
    visit(a, [&]<class C>(const schema::Item& item, const C& x) {
      checks.push_back([&item, &x, &same_column](const void* y) { same_column(item, x, *static_cast<const C*>(y)); });
    });
    std::size_t at = 0;
    visit(b, [&](const schema::Item&, const auto& y) { checks[at++](&y); });
  };
  compare([](const Snapshot& s, auto f) { schema::visit_particles(s.particles, f); });
  compare([](const Snapshot& s, auto f) { schema::visit_pp(s.pp, f); });
  compare([](const Snapshot& s, auto f) { schema::visit_pw(s.pw, f); });
  if (a.walls.size() != b.walls.size()) return "number of walls";
  for (std::size_t w = 0; w < a.walls.size(); ++w) {
    const schema::WallRow x = schema::row_of(a.walls[w]), y = schema::row_of(b.walls[w]);
    schema::visit_wall([&](const schema::Item& item, auto member) {
      if (item.need == schema::optional && !run.wall_loads_known) return;
      if (std::memcmp((x.*member).data(), (y.*member).data(), sizeof(x.*member)) != 0 && first.empty()) {
        first = item.path;
      }
    });
  }
  return first;
}

inline std::string difference(const Series& a, const Series& b, const RunInfo& run = info()) {
  if (a.walls.size() != b.walls.size()) return "number of walls";
  std::vector<std::string> x, y;
  const auto bytes = [](std::vector<std::string>& out) {
    return [&out](const std::string& path, const schema::Item&, const auto& values) {
      out.push_back(path);
      if (!values.empty())
        out.back().append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
    };
  };
  schema::visit_all_series(a, run.walls, bytes(x));
  schema::visit_all_series(b, run.walls, bytes(y));
  const auto of_excursions = [&](std::vector<std::string>& out) {
    return [&](const schema::Item& item, const auto& values) { bytes(out)(schema::path_of(item), item, values); };
  };
  schema::visit_excursions(a.excursions, of_excursions(x));
  schema::visit_excursions(b.excursions, of_excursions(y));
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] != y[i]) return x[i].substr(0, 40);
  }
  return "";
}

inline Series joined(std::size_t frames) {
  Series all = series(1);
  for (std::size_t k = 2; k < frames; ++k) {
    schema::append(all, series(k));
  }
  return frames < 2 ? Series{} : all;
}

}  // namespace jam::sample
