#include "libjam/snapshot/xdmf.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <sstream>
#include <system_error>

#include "libjam/errors.hpp"
#include "libjam/snapshot/reader.hpp"

namespace jam {
namespace {

using schema::Item;
using schema::path_of;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

const char* number_type(h5::Type type) {
  switch (type) {
    case h5::Type::f4:
      return R"(NumberType="Float" Precision="4")";
    case h5::Type::f8:
      return R"(NumberType="Float" Precision="8")";
    case h5::Type::u4:
      return R"(NumberType="UInt" Precision="4")";
    case h5::Type::u1:
      return R"(NumberType="UChar" Precision="1")";
    default:
      return nullptr;
  }
}

struct Column {
  const Item* item;
  std::uint64_t rows;  // in the whole file
};

// The columns of an axis that the file has and XDMF can express, in the order of the table.
std::vector<Column> columns_of(const h5::File& file, schema::Axis axis) {
  std::vector<Column> columns;
  for (const Item& item : schema::table) {
    if (item.axis != axis || number_type(item.type) == nullptr) continue;
    if (const std::string path = path_of(item); file.exists(path)) columns.push_back({&item, file.layout(path).rows()});
  }
  return columns;
}

std::string dimensions(std::uint64_t rows, unsigned width) {
  std::string text = std::to_string(rows);
  if (width > 1) text.append(" ").append(std::to_string(width));
  return text;
}

// Rows [start, start + count) of a column.
void write_slab(std::ostream& out, const std::string& file, const Column& column, std::uint64_t start,
                std::uint64_t count) {
  const Item& item = *column.item;
  const bool wide = item.width > 1;
  const std::string width = std::to_string(item.width);
  out << "<DataItem ItemType=\"HyperSlab\" Dimensions=\"" << dimensions(count, item.width) << "\" "
      << number_type(item.type) << "><DataItem Dimensions=\"" << (wide ? "3 2" : "3 1")
      << "\" NumberType=\"Int\" Precision=\"8\" Format=\"XML\">" << start << (wide ? " 0" : "") << " 1"
      << (wide ? " 1 " : " ") << count << (wide ? " " : "") << (wide ? width : "")
      << "</DataItem><DataItem Dimensions=\"" << dimensions(column.rows, item.width) << "\" " << number_type(item.type)
      << " Format=\"HDF\">" << file << ':' << item.path << "</DataItem></DataItem>";
}

void write_grid(std::ostream& out, const std::string& name, const std::string& file, const std::string& topology,
                const Column& position, std::uint64_t particle_start, std::uint64_t particle_count,
                const std::vector<Column>& columns, std::uint64_t start, std::uint64_t count) {
  out << "    <Grid Name=\"" << name << "\" GridType=\"Uniform\">\n      " << topology
      << "\n      <Geometry GeometryType=\"XYZ\">";
  write_slab(out, file, position, particle_start, particle_count);
  out << "</Geometry>\n";
  const char* const center = name == "particles" ? "Node" : "Cell";
  for (const Column& column : columns) {
    const std::string path = path_of(*column.item);
    if (path == "/particles/position" || path == "/contacts/pp/row") continue;
    out << "      <Attribute Name=\"" << path.substr(path.rfind('/') + 1) << "\" AttributeType=\""
        << (column.item->width == 3 ? "Vector" : "Scalar") << "\" Center=\"" << center << "\">";
    write_slab(out, file, column, start, count);
    out << "</Attribute>\n";
  }
  out << "    </Grid>\n";
}

}  // namespace

void write_xdmf(const std::filesystem::path& xdmf, const std::filesystem::path& snapshots) {
  const SnapshotIndex index = read_index(snapshots);
  const h5::File file = h5::File::open(snapshots);
  std::error_code error;
  const auto folder = std::filesystem::absolute(xdmf).parent_path();
  const std::string name =
      escaped(std::filesystem::absolute(snapshots).lexically_normal().lexically_proximate(folder.lexically_normal()));
  const std::vector<Column> particles = columns_of(file, schema::particle), contacts = columns_of(file, schema::pp);
  const Column* position = nullptr;
  const Column* row = nullptr;
  for (const Column& c : particles) position = c.item->path == "/particles/position" ? &c : position;
  for (const Column& c : contacts) row = c.item->path == "/contacts/pp/row" ? &c : row;

  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.2\">\n<Domain>\n"
         "<Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < index.frames.size(); ++k) {
    const schema::FrameRow& f = index.frames[k];
    if (f.particle_count == 0 || position == nullptr) continue;  // nothing to draw
    out << "  <Grid Name=\"frame " << k << "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n    <Time Value=\""
        << shortest(f.time) << "\"/>\n";
    std::ostringstream points;
    points << "<Topology TopologyType=\"Polyvertex\" NodesPerElement=\"1\" NumberOfElements=\"" << f.particle_count
           << "\"/>";
    write_grid(out, "particles", name, points.str(), *position, f.particle_start, f.particle_count, particles,
               f.particle_start, f.particle_count);
    if (f.pp_count > 0 && row != nullptr) {
      std::ostringstream lines;
      lines << "<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"" << f.pp_count << "\">";
      write_slab(lines, name, *row, f.pp_start, f.pp_count);
      lines << "</Topology>";
      write_grid(out, "contacts", name, lines.str(), *position, f.particle_start, f.particle_count, contacts,
                 f.pp_start, f.pp_count);
    }
    out << "  </Grid>\n";
  }
  out << "</Grid>\n</Domain>\n</Xdmf>\n";

  const std::filesystem::path aside = h5::aside_of(xdmf);
  std::ofstream target(aside, std::ios::binary | std::ios::trunc);
  target << out.str();
  target.close();
  if (!target) {
    std::filesystem::remove(aside, error);
    throw DataError(xdmf.string() + ": cannot be written");
  }
  std::filesystem::rename(aside, xdmf, error);
  if (error) throw DataError(xdmf.string() + ": cannot put the new file in place: " + error.message());
}

}  // namespace jam
