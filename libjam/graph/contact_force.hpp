// The normal force of one contact, N, > 0 repulsive: the whole of it, with its damping part where the source has split
// it off. Same for contacts of two particles and with walls. Accumulated in double, whatever the precision of the file.
#pragma once
#include <algorithm>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

template <class Contacts>
double normal_force(const Contacts& contacts, std::size_t contact) {
  const double elastic = contacts.normal_force[contact];
  return present(contacts.damping_force, contacts.size()) ? elastic + double{contacts.damping_force[contact]} : elastic;
}

// What pushes: adhesion carries no load from a blade to a wall.
template <class Contacts>
double repulsive_force(const Contacts& contacts, std::size_t contact) {
  return std::max(normal_force(contacts, contact), 0.0);
}

}  // namespace jam
