// Text with a unit, as written in a case file ("63 GPa", "-5 deg"), to a number in SI units.
#pragma once
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

namespace jamscope {

// What a value measures: exponents of metre, kilogram, second and radian. Angles count as a dimension of their own, so
// that an angular velocity is not taken for a frequency.
struct Dimension {
  std::string_view name;     // with its article: "a pressure"
  std::string_view unit;     // the SI unit in which the value is returned
  std::string_view example;  // how one writes such a value
  std::array<int, 4> exponents;
};

namespace dimension {
inline constexpr Dimension length{"a length", "m", "0.925 mm", {1, 0, 0, 0}};
inline constexpr Dimension time{"a time", "s", "2 ms", {0, 0, 1, 0}};
inline constexpr Dimension angle{"an angle", "rad", "-5 deg", {0, 0, 0, 1}};
inline constexpr Dimension speed{"a speed", "m/s", "250 mm/s", {1, 0, -1, 0}};
inline constexpr Dimension angular_velocity{"an angular velocity", "rad/s", "20 rad/s", {0, 0, -1, 1}};
inline constexpr Dimension acceleration{"an acceleration", "m/s2", "9.81 m/s2", {1, 0, -2, 0}};
inline constexpr Dimension pressure{"a pressure", "Pa", "63 GPa", {-1, 1, -2, 0}};
inline constexpr Dimension density{"a density", "kg/m3", "2500 kg/m3", {-3, 1, 0, 0}};
inline constexpr Dimension force{"a force", "N", "20 N", {1, 1, -2, 0}};
inline constexpr Dimension surface_energy{"an energy per area", "J/m2", "0.274 J/m2", {0, 1, -2, 0}};
}  // namespace dimension

// what() continues a sentence whose subject is the key: "wants a pressure (Pa), got '63 mm' (a length)".
struct UnitError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// `text` is a number, a space if you like, and a unit of UDUNITS-2 (or "deg", which that database lacks). Throws
// UnitError where number or unit is missing, unknown, of another dimension, not finite, or has an offset (degC). Safe
// to call from several threads.
double to_si(std::string_view text, const Dimension& expected);

}  // namespace jamscope
