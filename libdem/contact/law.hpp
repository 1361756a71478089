// A contact law is a composition of five parts, each a row of a table in laws.hpp: normal force, damping, friction limit,
// tangential spring, rolling resistance. Every part is written once, for every number type and every kind of contact.
//
// Which parts a run composes is a choice of rows. A Law says it: either the rows are numbers (LawChoice), and every part is
// chosen when a block of contacts is evaluated; or they are constants (FixedLaw), and the compiler makes one piece of code of
// the composition. Both run the same text and give the same bits.
#pragma once
#include <concepts>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "libdem/contact/touch.hpp"

namespace dem {

template <class T>
concept NormalLaw = requires(const double& overlap, const PairConstants<double>& c) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::adhesive } -> std::convertible_to<bool>;
  { T::form_overlap(c) } -> std::same_as<double>;
  { T::break_overlap(c) } -> std::same_as<double>;
  { T::form_energy(c) } -> std::same_as<double>;
  { T::break_energy(c) } -> std::same_as<double>;
  { T::evaluate(overlap, c) } -> std::same_as<NormalForce<double>>;
};

template <class T>
concept DampingLaw = requires(const double& overlap, const NormalForce<double>& n, const PairConstants<double>& c) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::per_root(overlap, overlap, overlap) } -> std::same_as<DampingCoefficients<double>>;
  { T::evaluate(overlap, n, c) } -> std::same_as<DampingCoefficients<double>>;
};

template <class T>
concept FrictionLimit = requires(const NormalForce<double>& n) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::needs_jkr } -> std::convertible_to<bool>;
  { T::load(n) } -> std::same_as<double>;
};

template <class T>
concept TangentialLaw = requires(const Touch<double>& t, const PairConstants<double>& c, const NormalForce<double>& n,
                                 const double& x, Springs<double>& springs) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::has_spring } -> std::convertible_to<bool>;
  { T::evaluate(t, c, n, x, x, springs, x) } -> std::same_as<TangentialForce<double>>;
};

template <class T>
concept RollingLaw = requires(const Touch<double>& t, const PairConstants<double>& c, const NormalForce<double>& n,
                              const Interval<double>& dt, Springs<double>& springs) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::has_spring } -> std::convertible_to<bool>;
  { T::objective } -> std::convertible_to<bool>;
  { T::evaluate(t, c, n, springs, dt) } -> std::same_as<RollingTorque<double>>;
};

// Calls f with the part in row `row` of a table. Row: a number, or an integral constant, for which nothing is chosen at run
// time. A row beyond the table is the last one.
template <class Table, std::size_t K = 0, class Row, class F>
decltype(auto) with_part(const Row& row, F&& f) {
  if constexpr (requires { Row::value; }) {
    return f(std::tuple_element_t<Row::value, Table>{});
  } else if constexpr (K + 1 == std::tuple_size_v<Table>) {
    return f(std::tuple_element_t<K, Table>{});
  } else {
    if (row == K) return f(std::tuple_element_t<K, Table>{});
    return with_part<Table, K + 1>(row, static_cast<F&&>(f));
  }
}

}  // namespace dem
