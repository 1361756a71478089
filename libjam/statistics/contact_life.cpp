#include "libjam/statistics/contact_life.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace jam {
namespace {

constexpr std::size_t octaves = std::tuple_size_v<Series::EndedContacts> - 1;  // the last counts those of unknown age

Series::EndedContacts sum(const std::vector<Series::EndedContacts>& rows) {
  Series::EndedContacts all{};
  for (const Series::EndedContacts& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) all[k] += row[k];
  return all;
}

void fill(std::vector<ContactLife>& life, ContactLife::Kind ContactLife::*kind, const Series::EndedContacts& ended,
          const Series::EndedContacts& alive) {
  double exposed = 0, together = 1;
  for (std::size_t k = 0; k < octaves; ++k) exposed += double(ended[k]) + double(alive[k]);
  if (exposed == 0) together = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < life.size(); ++k) {
    life[k].*kind = {ended[k], alive[k], together};
    const double at_risk = exposed - 0.5 * double(alive[k]);
    if (at_risk > 0) together *= 1 - double(ended[k]) / at_risk;
    exposed -= double(ended[k]) + double(alive[k]);
  }
}

}  // namespace

Series::EndedContacts ages(const std::vector<std::uint64_t>& birth_step, std::uint64_t step) {
  Series::EndedContacts count{};
  for (const std::uint64_t birth : birth_step)
    ++count[birth == 0 ? octaves : std::min<std::size_t>(std::size_t(std::bit_width(step - birth + 1)) - 1, octaves - 1)];
  return count;
}

std::vector<ContactLife> contact_life(const Series& series, const Series::EndedContacts& alive_pp, const Series::EndedContacts& alive_pw,
                                      double dt) {
  if (series.ended_pp.empty() || !(dt > 0)) return {};
  const Series::EndedContacts ended_pp = sum(series.ended_pp), ended_pw = sum(series.ended_pw);
  std::size_t rows = 0;
  for (std::size_t k = 0; k < octaves; ++k)
    if (ended_pp[k] > 0 || ended_pw[k] > 0 || alive_pp[k] > 0 || alive_pw[k] > 0) rows = k + 1;
  std::vector<ContactLife> life(rows);
  for (std::size_t k = 0; k < rows; ++k) life[k].from = std::ldexp(dt, int(k)), life[k].to = 2 * life[k].from;
  fill(life, &ContactLife::particles, ended_pp, alive_pp);
  fill(life, &ContactLife::walls, ended_pw, alive_pw);
  return life;
}

double median_life(std::span<const ContactLife> life, ContactLife::Kind ContactLife::*kind) {
  for (std::size_t k = 0; k + 1 < life.size(); ++k) {
    const double before = (life[k].*kind).together, after = (life[k + 1].*kind).together;
    if (before >= 0.5 && after < 0.5) return life[k].from * std::exp2((before - 0.5) / (before - after));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jam
