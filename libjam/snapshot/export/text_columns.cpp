#include "libjam/snapshot/export/text_columns.hpp"

#include <algorithm>

#include "libjam/errors.hpp"

namespace jam {
namespace {

// What the components of an item are called in a map and in a LAMMPS dump.
struct Names {
  std::string_view path;
  std::array<std::string_view, 4> field, lammps;
};

constexpr Names names[] = {
    {"/particles/position", {"x", "y", "z"}, {"x", "y", "z"}},
    {"/particles/velocity", {"vx", "vy", "vz"}, {"vx", "vy", "vz"}},
    {"/particles/angular_velocity", {"wx", "wy", "wz"}, {"omegax", "omegay", "omegaz"}},
    {"/particles/radius", {"radius"}, {"radius"}},
    {"/particles/compressive_force", {"compressive_force"}, {"compressive_force"}},
    {"/contacts/pp/normal_force", {"fn"}, {"fn"}},
    {"/contacts/pp/damping_force", {"damping"}, {"damping"}},
    {"/contacts/pp/tangential_force", {"ft_x", "ft_y", "ft_z"}, {"ftx", "fty", "ftz"}},
    {"/contacts/pp/overlap", {"overlap"}, {"overlap"}},
    {"/contacts/pp/birth_step", {"birth_step"}, {"birth_step"}},
    {"/contacts/pp/flags", {"flags"}, {"flags"}},
    {"/contacts/pw/facet", {"facet"}, {"facet"}},
    {"/contacts/pw/feature", {"feature"}, {"feature"}},
    {"/contacts/pw/point", {"px", "py", "pz"}, {"x", "y", "z"}},
    {"/contacts/pw/normal", {"nx", "ny", "nz"}, {"nx", "ny", "nz"}},
    {"/contacts/pw/normal_force", {"fn"}, {"fn"}},
    {"/contacts/pw/damping_force", {"damping"}, {"damping"}},
    {"/contacts/pw/tangential_force", {"ft_x", "ft_y", "ft_z"}, {"ftx", "fty", "ftz"}},
    {"/contacts/pw/overlap", {"overlap"}, {"overlap"}},
    {"/contacts/pw/birth_step", {"birth_step"}, {"birth_step"}},
    {"/contacts/pw/flags", {"flags"}, {"flags"}},
    {"/walls/*/pose_position", {"x", "y", "z"}, {"x", "y", "z"}},
    {"/walls/*/pose_quaternion", {"qw", "qx", "qy", "qz"}, {"qw", "qx", "qy", "qz"}},
    {"/walls/*/velocity", {"vx", "vy", "vz"}, {"vx", "vy", "vz"}},
    {"/walls/*/angular_velocity", {"wx", "wy", "wz"}, {"omegax", "omegay", "omegaz"}},
    {"/walls/*/force", {"fx", "fy", "fz"}, {"fx", "fy", "fz"}},
    {"/walls/*/torque", {"tx", "ty", "tz"}, {"tx", "ty", "tz"}},
};

// "velocity_x [m/s]"; what has no unit has no brackets.
std::string heading_with_unit(const FrameColumn& column, unsigned component) {
  std::string heading(column.name());
  const std::string_view axes = column.width() == 4 ? "wxyz" : "xyz";
  if (column.width() > 1) heading.append("_").append(1, axes[component]);
  if (column.item->unit != "1") heading.append(" [").append(column.item->unit).append("]");
  return heading;
}

}  // namespace

std::vector<TextColumn> text_columns(const std::vector<FrameColumn>& columns, std::size_t rows, Headings headings) {
  std::vector<TextColumn> result;
  for (const FrameColumn& column : columns) {
    const auto* const row =
        std::find_if(std::begin(names), std::end(names), [&](const Names& n) { return n.path == column.item->path; });
    if (row == std::end(names) || column.rows != rows) continue;
    for (unsigned c = 0; c < column.width(); ++c) {
      const std::string heading =
          headings == Headings::lammps ? std::string(row->lammps[c]) : heading_with_unit(column, c);
      result.push_back({heading, std::string(row->field[c]), column, c});
    }
  }
  return result;
}

WallColumns::WallColumns(const Snapshot& snapshot, const RunInfo& info) {
  schema::visit_wall([&](const schema::Item& item, auto member) {
    if (item.need == schema::optional && !info.wall_loads_known) return;
    std::vector<double>& values = values_.emplace_back();
    for (const WallState& state : snapshot.walls) {
      const schema::WallRow row = schema::row_of(state);
      for (unsigned c = 0; c < item.width; ++c) values.push_back((row.*member)[c]);
    }
    columns_.push_back({&item, nullptr, snapshot.walls.size()});
  });
  for (std::size_t k = 0; k < columns_.size(); ++k) columns_[k].data = values_[k].data();
}

void TableColumns::agree(const std::vector<TextColumn>& columns, std::size_t rows, std::size_t frame,
                         const std::string& table) {
  if (settled_ && rows == 0) return;
  ColumnMap fields;
  for (const TextColumn& column : columns) fields[column.field] = column.heading;
  if (settled_ && fields != fields_) {
    std::string now, before;
    for (const auto& [field, heading] : fields) now += (now.empty() ? "" : ", ") + heading;
    for (const auto& [field, heading] : fields_) before += (before.empty() ? "" : ", ") + heading;
    throw DataError(table + ": frame " + std::to_string(frame) + " has the quantities " + now +
                    ", expected those of the frames before: " + before);
  }
  fields_ = fields;
  settled_ = rows > 0;
}

ImportMap map_of_run(const RunInfo& info, const std::string& format, int first_type) {
  ImportMap map;
  map.format = format;
  map.creator = info.creator;
  map.dt = info.dt;
  map.gravity = info.gravity;
  map.one_record_a_touch = true;
  map.case_toml = info.case_toml;
  map.case_sha256 = info.case_sha256;
  map.interactions = info.interactions;
  map.gap = info.gap;
  for (std::size_t m = 0; m < info.materials.size(); ++m)
    map.materials.push_back({info.materials[m], first_type + static_cast<int>(m)});
  for (std::size_t w = 0; w < info.walls.size(); ++w) {
    ImportWall wall;
    wall.wall = info.walls[w];
    wall.mesh_id = static_cast<int>(w);
    map.walls.push_back(std::move(wall));
  }
  return map;
}

}  // namespace jam
