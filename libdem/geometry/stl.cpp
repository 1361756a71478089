#include "libdem/geometry/stl.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

#include "libdem/errors.hpp"
#include "libdem/geometry/validate_mesh.hpp"

namespace dem {
namespace {

static_assert(std::endian::native == std::endian::little,
              "binary STL is little-endian; add byte swapping for this machine");

constexpr std::uintmax_t header_bytes = 84, facet_bytes = 50;
constexpr std::uintmax_t largest_file = 4'000'000'000;
constexpr std::size_t most_facets = 10'000'000;
constexpr double farthest = 1e3;               // m
constexpr double resolution = 1.2e-7;          // of a 32-bit number
constexpr std::size_t longest_quotation = 40;  // characters of a wrong word shown in a message

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw GeometryError("STL file '" + path + "': " + what);
}

std::string printable(std::string_view word) {
  std::string out;
  for (const char c : word.substr(0, longest_quotation)) out += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
  return word.size() > longest_quotation ? out + "..." : out;
}

std::string read_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) fail(path, "is not a file that can be read");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) fail(path, "has no size: " + error.message());
  if (size > largest_file) fail(path, "has " + std::to_string(size) + " bytes; expected at most 4 GB");
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, "cannot be opened");
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) fail(path, "ended while it was read");
  return bytes;
}

std::uint32_t facet_count(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

bool is_binary(const std::string& bytes) {
  return bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * facet_count(bytes);
}

bool begins_with_solid(std::string_view bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos || bytes.size() - start < 5) return false;
  return std::ranges::equal(bytes.substr(start, 5), std::string_view("solid"),
                            [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

void add_vertex(TriangleMesh& soup, const Vec3& in_file_units, double scale, const std::string& path,
                const std::string& place) {
  const Vec3 p = in_file_units * scale;
  if (!p.allFinite() || p.cwiseAbs().maxCoeff() > farthest)
    fail(path, place + ": vertex (" + std::to_string(in_file_units.x()) + ", " + std::to_string(in_file_units.y()) +
                   ", " + std::to_string(in_file_units.z()) +
                   ") in file units; expected finite coordinates within 1000 m of the origin");
  soup.vertices.push_back(p);
}

TriangleMesh read_binary(const std::string& bytes, double scale, const std::string& path) {
  const std::uint32_t count = facet_count(bytes);
  if (count > most_facets) fail(path, std::to_string(count) + " facets; expected at most 10 000 000");
  TriangleMesh soup;
  soup.vertices.reserve(std::size_t{3} * count);
  for (std::uint32_t f = 0; f < count; ++f) {
    std::array<float, 12> numbers{};  // normal, then three vertices
    std::memcpy(numbers.data(), bytes.data() + header_bytes + facet_bytes * f, sizeof numbers);
    for (std::size_t k = 3; k < 12; k += 3)
      add_vertex(soup, Vec3(numbers[k], numbers[k + 1], numbers[k + 2]), scale, path, "facet " + std::to_string(f));
  }
  return soup;
}

// Words separated by white space, with the line they stand in.
class Words {
 public:
  Words(std::string_view text, const std::string& path) : text_(text), path_(path) { advance(); }

  bool at_end() const { return word_.empty(); }
  std::string place() const { return "line " + std::to_string(line_); }

  bool is(std::string_view expected) const {
    return std::ranges::equal(word_, expected,
                              [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
  }
  void skip() { advance(); }
  void expect(std::string_view expected) {
    if (!is(expected)) wrong(std::string(expected));
    advance();
  }
  double number() {
    std::string_view digits = word_;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    // A number too small for a double is zero as far as lengths go; from_chars leaves it unset.
    const bool number = error == std::errc{} || error == std::errc::result_out_of_range;
    if (!number || digits.empty() || end != digits.data() + digits.size()) wrong("a number");
    advance();
    return value;
  }
  void skip_line() {  // the name of a solid, which may hold anything
    const std::size_t line = line_;
    while (!at_end() && line_ == line) advance();
  }
  [[noreturn]] void wrong(const std::string& expected) const {
    std::ostringstream s;
    s << place() << ": ";
    if (at_end())
      s << "the file ends";
    else
      s << "'" << printable(word_) << "'";
    s << "; expected " << expected;
    fail(path_, s.str());
  }

 private:
  void advance() {
    const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (next_ < text_.size() && is_space(text_[next_])) line_ += text_[next_++] == '\n';
    const std::size_t start = next_;
    while (next_ < text_.size() && !is_space(text_[next_])) ++next_;
    word_ = text_.substr(start, next_ - start);
  }

  std::string_view text_, word_;
  const std::string& path_;
  std::size_t next_ = 0, line_ = 1;
};

TriangleMesh read_ascii(const std::string& bytes, double scale, const std::string& path) {
  TriangleMesh soup;
  Words words(bytes, path);
  while (!words.at_end()) {
    if (!words.is("solid")) words.wrong("solid");
    words.skip_line();
    while (words.is("facet")) {
      words.skip();
      words.expect("normal");
      for (int k = 0; k < 3; ++k) words.skip();  // some programs write nan for a normal that they do not know
      words.expect("outer");
      words.expect("loop");
      for (int k = 0; k < 3; ++k) {
        const std::string place = words.place();
        words.expect("vertex");
        const double x = words.number(), y = words.number(), z = words.number();
        add_vertex(soup, Vec3(x, y, z), scale, path, place);
      }
      words.expect("endloop");
      words.expect("endfacet");
      if (soup.vertices.size() > 3 * most_facets) fail(path, "more than 10 000 000 facets");
    }
    if (!words.is("endsolid")) words.wrong("facet or endsolid");
    words.skip_line();
  }
  return soup;
}

TriangleMesh read_soup(const std::string& bytes, double scale, const std::string& path) {
  if (is_binary(bytes)) return read_binary(bytes, scale, path);
  if (begins_with_solid(bytes)) return read_ascii(bytes, scale, path);
  if (bytes.size() < header_bytes)
    fail(path, std::to_string(bytes.size()) +
                   " bytes that do not begin with 'solid'; expected an ASCII or a binary STL file");
  fail(path, "not ASCII (it does not begin with 'solid') and not binary: the count at byte 80 says " +
                 std::to_string(facet_count(bytes)) + " facets, which take " +
                 std::to_string(header_bytes + facet_bytes * facet_count(bytes)) + " bytes, but the file has " +
                 std::to_string(bytes.size()));
}

}  // namespace

StlMesh read_stl(const std::string& path, double scale) {
  if (!(scale > 0) || !std::isfinite(scale))
    fail(path, "scale " + std::to_string(scale) + "; expected a positive number");
  const std::string bytes = read_file(path);
  TriangleMesh soup = read_soup(bytes, scale, path);
  StlMesh out;
  out.binary = is_binary(bytes);
  out.facets = soup.vertices.size() / 3;
  if (out.facets == 0) fail(path, "no facets; expected at least 4");

  double largest = 0;
  for (std::uint32_t f = 0; f < out.facets; ++f) {
    soup.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    soup.labels.push_back(FacetLabel::face);
    for (std::uint32_t k = 0; k < 3; ++k) largest = std::max(largest, soup.vertices[3 * f + k].cwiseAbs().maxCoeff());
  }
  MeshRepair welded = weld_mesh(soup, resolution * largest);
  out.mesh = std::move(welded.mesh);
  out.degenerate_triangles = welded.degenerate_triangles;
  out.repeated_triangles = welded.repeated_triangles;
  if (out.mesh.triangles.empty()) fail(path, "all " + std::to_string(out.facets) + " facets are degenerate");
  return out;
}

void write_stl(const TriangleMesh& mesh, const std::string& path) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) fail(path, "too many triangles for STL");
  // Not beginning with "solid", so that no reader takes it for ASCII.
  std::string bytes = "jamscope triangle mesh, coordinates in m";
  bytes.resize(80, ' ');
  const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices.at(t[0]), &b = mesh.vertices.at(t[1]), &c = mesh.vertices.at(t[2]);
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (const Vec3* v : {&normal, &a, &b, &c})
      for (const double x : *v) append(static_cast<float>(x));
    append(std::uint16_t{0});
  }
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.flush();
  if (!out) fail(path, "cannot be written");
}

}  // namespace dem
