#include "libjam/snapshot/export/vtp.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>

#include "libjam/errors.hpp"
#include "libjam/snapshot/export/columns.hpp"
#include "libjam/snapshot/export/output_file.hpp"
#include "libjam/snapshot/export/wall_surface.hpp"

namespace jam {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say byte_order=\"LittleEndian\"");

const char* type_name(h5::Type type) {
  switch (type) {
    case h5::Type::f4: return "Float32";
    case h5::Type::f8: return "Float64";
    case h5::Type::u1: return "UInt8";
    case h5::Type::u4: return "UInt32";
    case h5::Type::u8: return "UInt64";
    default: return "Int32";
  }
}

struct Array {
  std::string name;
  const char* type;
  unsigned components;
  std::string bytes;
};

template <class Value>
Array array_of(std::string name, std::span<const Value> values) {
  Array array{std::move(name), type_name(h5::Row<Value>::type), h5::Row<Value>::width, {}};
  array.bytes.assign(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return array;
}

Array array_of(const FrameColumn& column, std::size_t bytes_per_row) {
  Array array{std::string(column.name()), type_name(column.type()), column.width(), {}};
  array.bytes.assign(static_cast<const char*>(column.data), column.rows * bytes_per_row);
  return array;
}

std::size_t bytes_of(const FrameColumn& column) {
  const std::size_t one = column.type() == h5::Type::u1   ? 1
                          : column.type() == h5::Type::u8 ? 8
                          : column.type() == h5::Type::f8 ? 8
                                                          : 4;
  return one * column.width();
}

// One polygonal data set: points, and cells of one kind with the same number of corners each.
struct PolyData {
  const char* cells;  // "Verts", "Lines", "Polys"
  std::uint32_t corners;
  std::vector<Vec3f> points;
  std::vector<std::int32_t> connectivity;
  std::vector<Array> point_data, cell_data;
};

// Numbers follow as raw bytes behind the XML, each array after its length in bytes as a 64-bit number.
void write_vtp(const std::filesystem::path& path, double time, const PolyData& data) {
  const std::size_t cells = data.connectivity.size() / data.corners;
  std::vector<std::int32_t> offsets(cells);
  for (std::size_t k = 0; k < cells; ++k) offsets[k] = static_cast<std::int32_t>(data.corners * (k + 1));

  std::vector<const Array*> appended;
  std::uint64_t offset = 0;
  OutputFile file(path);
  std::string& xml = file.text();
  const auto declare = [&](const Array& array) {
    xml.append("<DataArray type=\"").append(array.type).append("\" Name=\"").append(xml_text(array.name));
    xml.append("\" NumberOfComponents=\"").append(std::to_string(array.components));
    xml.append("\" format=\"appended\" offset=\"").append(std::to_string(offset)).append("\"/>\n");
    offset += sizeof(std::uint64_t) + array.bytes.size();
    appended.push_back(&array);
  };
  const Array points = array_of<Vec3f>("Points", data.points);
  const Array connectivity = [&] {
    Array a{"connectivity", "Int32", 1, {}};
    a.bytes.assign(reinterpret_cast<const char*>(data.connectivity.data()), data.connectivity.size() * sizeof(std::int32_t));
    return a;
  }();
  const Array ends = [&] {
    Array a{"offsets", "Int32", 1, {}};
    a.bytes.assign(reinterpret_cast<const char*>(offsets.data()), offsets.size() * sizeof(std::int32_t));
    return a;
  }();

  xml +=
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"ascii\">";
  append_number(xml, time);
  xml.append("</DataArray></FieldData>\n<Piece NumberOfPoints=\"").append(std::to_string(data.points.size()));
  for (const char* kind : {"Verts", "Lines", "Strips", "Polys"}) {
    const bool ours = std::strcmp(kind, data.cells) == 0;
    xml.append("\" NumberOf").append(kind).append("=\"").append(std::to_string(ours ? cells : 0));
  }
  xml += "\">\n<PointData>\n";
  for (const Array& array : data.point_data) declare(array);
  xml += "</PointData>\n<CellData>\n";
  for (const Array& array : data.cell_data) declare(array);
  xml += "</CellData>\n<Points>\n";
  declare(points);
  xml.append("</Points>\n<").append(data.cells).append(">\n");
  declare(connectivity);
  declare(ends);
  xml.append("</").append(data.cells).append(">\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
  for (const Array* array : appended) {
    const std::uint64_t size = array->bytes.size();
    char length[sizeof size];
    std::memcpy(length, &size, sizeof size);
    file.write({length, sizeof length});
    file.write(array->bytes);
  }
  file.text() += "\n</AppendedData>\n</VTKFile>\n";
  file.finish();
}

// The files of one kind and the index of their times.
class VtpSeries {
 public:
  VtpSeries(const std::filesystem::path& folder, std::string name) : folder_(folder), name_(std::move(name)) {}

  void add(std::size_t number, double time, const PolyData& data) {
    std::string digits = std::to_string(number);
    digits.insert(0, 6 - std::min<std::size_t>(6, digits.size()), '0');
    const std::string file = "vtp/" + name_ + "_" + digits + ".vtp";
    write_vtp(folder_ / file, time, data);
    entries_ += "<DataSet timestep=\"";
    append_number(entries_, time);
    entries_.append("\" part=\"0\" file=\"").append(file).append("\"/>\n");
  }
  // The index, where there is anything in it.
  std::optional<std::filesystem::path> finish() const {
    if (entries_.empty()) return std::nullopt;
    OutputFile file(folder_ / (name_ + ".pvd"));
    file.text() = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n" +
                  entries_ + "</Collection>\n</VTKFile>\n";
    file.finish();
    return file.path();
  }

 private:
  std::filesystem::path folder_;
  std::string name_, entries_;
};

PolyData particle_points(const Snapshot& s) {
  PolyData data{"Verts", 1, s.particles.position, {}, {}, {}};
  for (std::size_t i = 0; i < s.particles.size(); ++i) data.connectivity.push_back(static_cast<std::int32_t>(i));
  for (const FrameColumn& column : particle_columns(s)) {
    if (column.rows != s.particles.size() || column.name() == "position" || column.name() == "compressive_force") continue;
    data.point_data.push_back(array_of(column, bytes_of(column)));
  }
  data.point_data.push_back(array_of<float>("compressive_force", compressive_force_of(s)));
  data.point_data.push_back(array_of<std::uint32_t>("coordination", coordination_of(s)));
  return data;
}

PolyData contact_lines(const Snapshot& s) {
  PolyData data{"Lines", 2, s.particles.position, {}, {}, {}};
  std::vector<std::uint32_t> id1, id2;
  std::vector<std::int32_t> wall;
  for (const auto& row : s.pp.row) {
    data.connectivity.insert(data.connectivity.end(), {static_cast<std::int32_t>(row[0]), static_cast<std::int32_t>(row[1])});
    id1.push_back(s.particles.id[row[0]]);
    id2.push_back(s.particles.id[row[1]]);
    wall.push_back(-1);
  }
  // Wall contacts whose place is known.
  const bool points = present(s.pw.point, s.pw.size()), normals = present(s.pw.normal, s.pw.size());
  const std::size_t walls = points || normals ? s.pw.size() : 0;
  for (std::size_t k = 0; k < walls; ++k) {
    const std::uint32_t row = s.pw.row[k];
    data.connectivity.insert(data.connectivity.end(), {static_cast<std::int32_t>(row), static_cast<std::int32_t>(data.points.size())});
    data.points.push_back(points ? s.pw.point[k] : Vec3f(s.particles.position[row] + s.particles.radius[row] * s.pw.normal[k]));
    id1.push_back(s.particles.id[row]);
    id2.push_back(s.particles.id[row]);
    wall.push_back(s.pw.wall[k]);
  }
  data.cell_data.push_back(array_of<std::uint32_t>("id1", id1));
  data.cell_data.push_back(array_of<std::uint32_t>("id2", id2));
  Array walls_of{"wall", "Int32", 1, {}};
  walls_of.bytes.assign(reinterpret_cast<const char*>(wall.data()), wall.size() * sizeof(std::int32_t));
  data.cell_data.push_back(std::move(walls_of));

  // The quantities of both kinds of contact, one kind after the other. What one of them lacks is not a number, or 0 where
  // numbers are whole.
  const std::vector<FrameColumn> pp = pair_columns(s), pw = wall_contact_columns(s);
  for (const char* name : {"normal_force", "damping_force", "tangential_force", "overlap", "birth_step", "flags"}) {
    const auto named = [&](const FrameColumn& c) { return c.name() == name; };
    const FrameColumn& a = *std::find_if(pp.begin(), pp.end(), named);
    const FrameColumn& b = *std::find_if(pw.begin(), pw.end(), named);
    const bool has_a = a.rows == s.pp.size() && a.rows > 0, has_b = b.rows == s.pw.size() && walls > 0;
    if (!has_a && !has_b && s.pp.size() + walls > 0) continue;
    const std::size_t bytes = bytes_of(a);
    Array array = array_of(a, has_a ? bytes : 0);
    const auto pad = [&](std::size_t rows) {
      if (a.type() != h5::Type::f4) {
        array.bytes.append(rows * bytes, '\0');
        return;
      }
      const float nan = std::numeric_limits<float>::quiet_NaN();
      for (std::size_t k = 0; k < rows * a.width(); ++k) array.bytes.append(reinterpret_cast<const char*>(&nan), sizeof nan);
    };
    if (!has_a) pad(s.pp.size());
    if (has_b)
      array.bytes.append(static_cast<const char*>(b.data), walls * bytes);
    else
      pad(walls);
    data.cell_data.push_back(std::move(array));
  }
  return data;
}

// The walls of a role, or all others.
PolyData wall_triangles(const Snapshot& s, const RunInfo& info, bool blade, const Eigen::AlignedBox3d& shown) {
  PolyData data{"Polys", 3, {}, {}, {}, {}};
  std::vector<std::uint8_t> wall_of, label;
  std::vector<std::uint32_t> facet;
  std::vector<float> force;
  for (std::size_t w = 0; w < info.walls.size(); ++w) {
    const Wall& wall = info.walls[w];
    if ((wall.role == WallRole::blade) != blade) continue;
    const WallState& state = s.walls[w];
    Eigen::AlignedBox3d body;
    for (int corner = 0; corner < 8; ++corner)
      body.extend(state.orientation.conjugate() *
                  (shown.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - state.position));
    const WallSurface surface = surface_of(wall, body);
    // Normal force on each triangle or glued sphere, or on the whole of an analytic wall.
    const std::size_t facets = wall.kind == "mesh" ? wall.triangles.size() : wall.kind == "spheres" ? wall.sphere_centre.size() : 1;
    std::vector<float> on_facet(facets, 0.0F);
    const bool facets_known = present(s.pw.facet, s.pw.size()) || facets == 1;
    for (std::size_t k = 0; k < s.pw.size(); ++k) {
      if (s.pw.wall[k] != w || !facets_known) continue;
      const std::size_t f = facets == 1 ? 0 : s.pw.facet[k];
      if (f < facets) on_facet[f] += s.pw.normal_force[k];
    }
    const auto first = static_cast<std::int32_t>(data.points.size());
    for (const Vec3& v : surface.vertices) data.points.push_back((state.position + state.orientation * v).cast<float>());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      for (const std::uint32_t v : surface.triangles[t]) data.connectivity.push_back(first + static_cast<std::int32_t>(v));
      wall_of.push_back(static_cast<std::uint8_t>(w));
      facet.push_back(surface.facet[t]);
      label.push_back(wall.kind == "mesh" && present(wall.triangle_label, wall.triangles.size()) ? wall.triangle_label[t] : 0);
      force.push_back(facets_known ? on_facet[surface.facet[t]] : std::numeric_limits<float>::quiet_NaN());
    }
  }
  data.cell_data.push_back(array_of<std::uint8_t>("wall", wall_of));
  data.cell_data.push_back(array_of<std::uint32_t>("facet", facet));
  data.cell_data.push_back(array_of<std::uint8_t>("label", label));
  data.cell_data.push_back(array_of<float>("normal_force", force));
  return data;
}

class VtpExporter final : public SnapshotExporter {
 public:
  VtpExporter(const RunInfo& info, const std::filesystem::path& folder)
      : info_(info), particles_(folder, "particles"), contacts_(folder, "contacts"), blade_(folder, "blade"), walls_(folder, "walls") {
    std::error_code error;
    std::filesystem::create_directories(folder / "vtp", error);
    if (error) throw DataError((folder / "vtp").string() + ": cannot be made: " + error.message());
  }

  void add(std::size_t number, const Snapshot& s) override {
    particles_.add(number, s.time, particle_points(s));
    contacts_.add(number, s.time, contact_lines(s));
    // Endless walls are shown as far as the particles of the first frame reach, so that they do not change from frame to frame.
    if (shown_.isEmpty()) {
      for (const Vec3f& x : s.particles.position) shown_.extend(x.cast<double>());
    }
    Eigen::AlignedBox3d shown = shown_;
    if (shown.isEmpty()) shown = Eigen::AlignedBox3d(Vec3::Zero(), Vec3::Ones());
    for (const bool blade : {true, false}) {
      const PolyData triangles = wall_triangles(s, info_, blade, shown);
      if (!triangles.connectivity.empty()) (blade ? blade_ : walls_).add(number, s.time, triangles);
    }
  }

  std::vector<std::filesystem::path> finish() override {
    std::vector<std::filesystem::path> files;
    for (const VtpSeries* series : {&particles_, &contacts_, &blade_, &walls_}) {
      if (const auto file = series->finish()) files.push_back(*file);
    }
    return files;
  }

 private:
  RunInfo info_;
  VtpSeries particles_, contacts_, blade_, walls_;
  Eigen::AlignedBox3d shown_;
};

}  // namespace

std::unique_ptr<SnapshotExporter> export_vtp(const RunInfo& info, const std::filesystem::path& folder) {
  return std::make_unique<VtpExporter>(info, folder);
}

}  // namespace jam
