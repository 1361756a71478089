// What became of the particle contacts of one frame in a later one. A contact is the same when its two particles are, by their ids, and,
// where both frames know when their contacts formed, when it has not been open in between.
//
//   contact_survival    C = |E_before and E_now| / |E_before|: share of the contacts of the earlier frame that still hold; NaN without any
//   contact_renewal     share of the contacts of the later frame that are new; NaN without any
#pragma once
#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

inline std::size_t surviving_contacts(const Snapshot& before, const Snapshot& now) {
  const bool births = present(before.pp.birth_step, before.pp.size()) && present(now.pp.birth_step, now.pp.size());
  using Contact = std::tuple<ParticleId, ParticleId, std::uint64_t>;
  const auto contacts = [&](const Snapshot& s) {
    std::vector<Contact> list;  // rows ascend with ids, contacts with rows: the list is sorted
    list.reserve(s.pp.size());
    for (std::size_t c = 0; c < s.pp.size(); ++c)
      list.emplace_back(s.particles.id[s.pp.row[c][0]], s.particles.id[s.pp.row[c][1]], births ? s.pp.birth_step[c] : 0);
    return list;
  };
  const std::vector<Contact> first = contacts(before), second = contacts(now);
  std::vector<Contact> both;
  std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(both));
  return both.size();
}

inline double contact_survival(const Snapshot& before, const Snapshot& now) {
  return double(surviving_contacts(before, now)) / (before.pp.size() > 0 ? double(before.pp.size()) : std::numeric_limits<double>::quiet_NaN());
}
inline double contact_renewal(const Snapshot& before, const Snapshot& now) {
  const double all = now.pp.size() > 0 ? double(now.pp.size()) : std::numeric_limits<double>::quiet_NaN();
  return 1 - double(surviving_contacts(before, now)) / all;
}

// s, [C] how long each contact has held; empty where the source does not know its birth or its time step.
inline std::vector<double> contact_ages(const Snapshot& s, double dt) {
  std::vector<double> age;
  if (!present(s.pp.birth_step, s.pp.size()) || !(dt > 0)) return age;
  age.reserve(s.pp.size());
  for (const std::uint64_t birth : s.pp.birth_step) age.push_back(dt * (double(s.step) - double(birth)));
  return age;
}

}  // namespace jam
