#include "libjam/snapshot/schema.hpp"

#include <bit>
#include <numeric>

#include "libjam/snapshot/crc32c.hpp"

namespace jam::schema {

static_assert(std::endian::native == std::endian::little, "checksums are taken of little-endian bytes");

namespace {

template <class V>
void add(Crc32c& crc, const std::vector<V>& values) {
  crc.process_bytes(values.data(), values.size() * sizeof(V));
}

}  // namespace

std::string path_of(const Item& item, std::string_view wall) {
  std::string path(item.path);
  if (const auto star = path.find('*'); star != std::string::npos) path.replace(star, 1, wall);
  return path;
}

std::string object_of(const Item& item, std::string_view wall) {
  const std::string_view whole = item.path;
  std::string path(whole.substr(0, whole.find('@')));
  if (const auto star = path.find('*'); star != std::string::npos) path.replace(star, 1, wall);
  return path;
}

std::string attribute_of(const Item& item) {
  return std::string(item.path.substr(item.path.find('@') + 1));
}

WallRow row_of(const WallState& s) {
  const Eigen::Quaterniond& q = s.orientation;
  return {s.position, s.velocity, s.angular_velocity, s.force, s.torque, {q.w(), q.x(), q.y(), q.z()}};
}

WallState state_of(const WallRow& r) {
  WallState s;
  s.position = r.position;
  s.orientation = Eigen::Quaterniond(r.quaternion[0], r.quaternion[1], r.quaternion[2], r.quaternion[3]);
  s.velocity = r.velocity;
  s.angular_velocity = r.angular_velocity;
  s.force = r.force;
  s.torque = r.torque;
  return s;
}

namespace {

// Appends rows [first, last) of each column that visit(owner, f) shows.
template <class Owner, class Visit>
void append_rows(Owner& to, const Owner& from, std::size_t first, std::size_t last, Visit visit) {
  std::vector<void*> columns;
  visit(to, [&](const Item&, auto& values) { columns.push_back(&values); });
  std::size_t next = 0;
  visit(from, [&]<class C>(const Item&, const C& values) {
    C& target = *static_cast<C*>(columns[next++]);
    if (!values.empty())
      target.insert(target.end(), values.begin() + std::ptrdiff_t(first), values.begin() + std::ptrdiff_t(last));
  });
}

void append_rows(Series& to, const Series& from, std::size_t first, std::size_t last) {
  if (to.walls.size() < from.walls.size()) to.walls.resize(from.walls.size());
  append_rows(to, from, first, last, [](auto& s, auto f) { visit_series(s, f); });
  for (std::size_t w = 0; w < from.walls.size(); ++w)
    append_rows(to.walls[w], from.walls[w], first, last, [](auto& s, auto f) { visit_wall_series(s, f); });
  append_rows(to.excursions, from.excursions, excursion_rows(from, first), excursion_rows(from, last),
              [](auto& e, auto f) { visit_excursions(e, f); });
}

}  // namespace

std::uint64_t excursion_rows(const Series& series, std::size_t windows) {
  if (series.excursion_count.empty()) return 0;
  return std::accumulate(series.excursion_count.begin(), series.excursion_count.begin() + std::ptrdiff_t(windows), std::uint64_t{0});
}

Series rows_of(const Series& series, std::size_t first, std::size_t last) {
  Series part;
  append_rows(part, series, first, last);
  return part;
}

void append(Series& series, const Series& more) { append_rows(series, more, 0, more.size()); }

std::uint32_t checksum(const FrameRow& row, const Snapshot& snapshot, bool wall_loads, const Series& new_rows,
                       const std::vector<Wall>& walls) {
  Crc32c crc;
  visit_frame([&](const Item&, auto member) { crc.process_bytes(&(row.*member), sizeof(row.*member)); });
  for (const WallState& state : snapshot.walls) {
    const WallRow wall = row_of(state);
    visit_wall([&](const Item& i, auto member) {
      if (i.need == required || wall_loads) crc.process_bytes((wall.*member).data(), sizeof(wall.*member));
    });
  }
  const auto add_column = [&](const Item&, const auto& values) { add(crc, values); };
  visit_particles(snapshot.particles, add_column);
  visit_pp(snapshot.pp, add_column);
  visit_pw(snapshot.pw, add_column);
  visit_all_series(new_rows, walls, [&](const std::string&, const Item&, const auto& values) { add(crc, values); });
  visit_excursions(new_rows.excursions, add_column);
  return crc.checksum();
}

}  // namespace jam::schema
