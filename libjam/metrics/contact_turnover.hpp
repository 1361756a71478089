// What became of the particle contacts of one frame in a later one. A contact is the same when its two particles are, by their ids, and,
// where both frames know when their contacts formed, when it has not been open in between: then these are first losses, resolved to the
// solver's step. Where births are not known a contact may have opened and closed again: last losses. Contacts that formed and broke between
// the two frames are seen in neither.
//
//   contact_survival      C = |E_before and E_now| / |E_before|: share of the contacts of the earlier frame that still hold; NaN without any
//   contact_renewal       share of the contacts of the later frame that are new; NaN without any
//   lost_contact_age      s, mean time for which the contacts lost had held at the earlier frame; what they held after it is at most the
//                         time between the frames. NaN without any, and where births or the time step are not known
//   broken_cluster_share  share of the particles of the earlier frame in the largest cluster that lost contacts join: the giant component of the
//                         broken-link network (Herrera et al., Phys. Rev. E 83, 061303, 2011); 0 where none is lost, NaN without particles
#pragma once
#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "libjam/graph/components.hpp"

namespace jam {

// [C of the earlier frame] 1 for the contacts that are lost in the later one.
inline std::vector<std::uint8_t> lost_contacts(const Snapshot& before, const Snapshot& now) {
  const bool births = present(before.pp.birth_step, before.pp.size()) && present(now.pp.birth_step, now.pp.size());
  using Contact = std::tuple<ParticleId, ParticleId, std::uint64_t>;
  const auto contact = [&](const Snapshot& s, std::size_t c) {
    return Contact{s.particles.id[s.pp.row[c][0]], s.particles.id[s.pp.row[c][1]], births ? s.pp.birth_step[c] : 0};
  };
  // Rows ascend with ids and contacts with rows, so both frames have them in one order.
  std::vector<std::uint8_t> lost(before.pp.size(), 1);
  std::size_t there = 0;
  for (std::size_t c = 0; c < lost.size(); ++c) {
    while (there < now.pp.size() && contact(now, there) < contact(before, c)) ++there;
    lost[c] = there == now.pp.size() || contact(now, there) != contact(before, c);
  }
  return lost;
}

inline std::size_t surviving_contacts(const Snapshot& before, const Snapshot& now) {
  const std::vector<std::uint8_t> lost = lost_contacts(before, now);
  return std::size_t(std::count(lost.begin(), lost.end(), 0));
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

inline double lost_contact_age(const Snapshot& before, const Snapshot& now, double dt) {
  const std::vector<std::uint8_t> lost = lost_contacts(before, now);
  const std::vector<double> age = contact_ages(before, dt);
  double sum = 0, count = 0;
  for (std::size_t c = 0; c < age.size(); ++c)
    if (lost[c]) sum += age[c], count += 1;
  return sum / (count > 0 ? count : std::numeric_limits<double>::quiet_NaN());
}

inline double broken_cluster_share(const ContactGraph& before, const Snapshot& now) {
  if (before.vertex_count() == 0) return std::numeric_limits<double>::quiet_NaN();
  const std::uint32_t largest = connected_components(before, lost_contacts(before.snapshot(), now)).size[0];
  return largest > 1 ? double(largest) / double(before.vertex_count()) : 0;
}

}  // namespace jam
