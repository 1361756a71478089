#include "apps/jamscope/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>

namespace jamscope {
namespace {

// Known by name when a value has the wrong dimension; the first match wins.
constexpr Dimension named[] = {
    dimension::length,
    dimension::time,
    dimension::angle,
    dimension::speed,
    dimension::angular_velocity,
    dimension::acceleration,
    dimension::pressure,
    dimension::density,
    dimension::force,
    dimension::surface_energy,
    {"a mass", "kg", "", {0, 1, 0, 0}},
    {"an area", "m2", "", {2, 0, 0, 0}},
    {"a volume", "m3", "", {3, 0, 0, 0}},
    {"an energy or torque", "J", "", {2, 1, -2, 0}},
    {"a power", "W", "", {2, 1, -3, 0}},
    {"a frequency", "Hz", "", {0, 0, -1, 0}},
    {"an angular velocity", "rad/s", "", {0, 0, -1, 1}},
    {"a viscosity", "Pa s", "", {-1, 1, -1, 0}},
    {"a number without dimension", "1", "", {0, 0, 0, 0}},
};

struct Unit {
  double scale = 1;  // SI value of one such unit
  std::array<int, 4> exponents{};
  bool plain = true;  // a product of metre, kilogram, second and radian, without offset or logarithm
};

constexpr std::array<std::string_view, 4> base_names{"meter", "kilogram", "second", "radian"};

void multiply_base(Unit& unit, const ut_unit* base, int power) {
  const char* name = ut_get_name(base, UT_ASCII);
  for (std::size_t b = 0; b < base_names.size(); ++b)
    if (name && base_names[b] == name) {
      unit.exponents[b] += power;
      return;
    }
  unit.plain = false;  // kelvin, ampere, candela, mole
}

// ut_are_convertible() cannot be used: it takes seconds for hertz (reciprocals) and radians for plain numbers.
ut_status visit_basic(const ut_unit* base, void* out) {
  multiply_base(*static_cast<Unit*>(out), base, 1);
  return UT_SUCCESS;
}
ut_status visit_product(const ut_unit*, int count, const ut_unit* const* bases, const int* powers, void* out) {
  for (int b = 0; b < count; ++b) multiply_base(*static_cast<Unit*>(out), bases[b], powers[b]);
  return UT_SUCCESS;
}
ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* inner, double offset, void* out);
ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void* out) {
  static_cast<Unit*>(out)->plain = false;
  return UT_SUCCESS;
}
ut_status visit_logarithmic(const ut_unit*, double, const ut_unit*, void* out) {
  static_cast<Unit*>(out)->plain = false;
  return UT_SUCCESS;
}
constexpr ut_visitor visitor{visit_basic, visit_product, visit_galilean, visit_timestamp, visit_logarithmic};

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* inner, double offset, void* out) {
  auto& unit = *static_cast<Unit*>(out);
  unit.scale *= scale;
  if (offset != 0) unit.plain = false;
  return ut_accept_visitor(inner, &visitor, out);
}

// The database is read once; UDUNITS keeps its parser state in globals, hence the lock around every call.
std::mutex& library_lock() {
  static std::mutex lock;
  return lock;
}
ut_system* library() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);  // it would write to stderr
    ut_system* const read = ut_read_xml(nullptr);
    if (!read) throw UnitError("cannot be read: the unit database of UDUNITS-2 is missing (package libudunits2-data)");
    if (ut_unit* degree = ut_parse(read, "degree", UT_ASCII)) {
      ut_map_symbol_to_unit("deg", UT_ASCII, degree);
      ut_free(degree);
    }
    return read;
  }();
  return system;
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// name[^][-][digit] { (space | / | * | .) name[^][-][digit] }. Asked before UDUNITS is, because that accepts more than
// it understands: "m)" is a metre to it, "m 5" five metres, "mm @ 3" an origin.
bool well_formed(std::string_view text) {
  std::size_t k = 0;
  while (true) {
    const std::size_t name = k;
    while (k < text.size() && is_letter(text[k])) ++k;
    if (k == name) return false;
    if (k < text.size() && text[k] == '^') ++k;
    if (k + 1 < text.size() && text[k] == '-' && is_digit(text[k + 1])) ++k;
    if (k < text.size() && is_digit(text[k])) ++k;
    if (k == text.size()) return true;
    const std::size_t separator = k;
    while (k < text.size() && text[k] == ' ') ++k;
    if (k < text.size() && (text[k] == '/' || text[k] == '*' || text[k] == '.')) ++k;
    while (k < text.size() && text[k] == ' ') ++k;
    if (k == separator) return false;
  }
}

std::optional<Unit> parse_unit(std::string_view text) {
  if (!well_formed(text)) return {};
  const std::lock_guard guard(library_lock());
  ut_system* const system = library();
  const std::unique_ptr<ut_unit, decltype(&ut_free)> parsed(ut_parse(system, std::string(text).c_str(), UT_UTF8),
                                                            &ut_free);
  if (!parsed) return {};
  Unit unit;
  if (ut_accept_visitor(parsed.get(), &visitor, &unit) != UT_SUCCESS) return {};
  return unit;
}

std::string describe(const Unit& unit) {
  if (!unit.plain) return "a unit that has no place here";
  for (const Dimension& d : named)
    if (d.exponents == unit.exponents) return std::string(d.name);
  constexpr std::array<std::string_view, 4> symbols{"m", "kg", "s", "rad"};
  std::string out;
  for (std::size_t b = 0; b < symbols.size(); ++b)
    if (unit.exponents[b] != 0) {
      if (!out.empty()) out += ' ';
      out += symbols[b];
      if (unit.exponents[b] != 1) out += std::to_string(unit.exponents[b]);
    }
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

double to_si(std::string_view text, const Dimension& expected) {
  const std::string wants = fmt::format("wants {} ({}), ", expected.name, expected.unit);
  std::string_view rest = trimmed(text);
  if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error == std::errc::result_out_of_range)
    throw UnitError(fmt::format("{}got '{}', which is out of range", wants, text));
  if (error != std::errc() || !std::isfinite(number))
    throw UnitError(fmt::format("{}for example \"{}\"; got '{}', which does not begin with a number", wants,
                                expected.example, text));
  const std::string_view unit_text = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (unit_text.empty())
    throw UnitError(fmt::format("{}for example \"{}\"; got '{}' without a unit", wants, expected.example, text));

  const std::optional<Unit> unit = parse_unit(unit_text);
  if (!unit) throw UnitError(fmt::format("{}got '{}': unknown unit '{}'", wants, text, unit_text));
  if (!unit->plain || unit->exponents != expected.exponents)
    throw UnitError(fmt::format("{}got '{}' ({})", wants, text, describe(*unit)));

  // 0.001 has no exact double, 1000 has: dividing gives "0.9 mm" the same bits as 0.9e-3.
  const double inverse = std::round(1 / unit->scale);
  const bool exact_inverse = inverse > 1 && inverse < 1e15 && std::abs(inverse * unit->scale - 1) < 1e-15;
  const double value = exact_inverse ? number / inverse : number * unit->scale;
  if (!std::isfinite(value)) throw UnitError(fmt::format("{}got '{}', which is out of range", wants, text));
  return value;
}

}  // namespace jamscope
