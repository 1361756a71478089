// How long contacts last, from every step of a run: those that ended (Series::ended_pp, ended_pw) and those that are still there.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct ContactLife {
  double from = 0, to = 0;  // s, an octave of life, [from, to)
  struct Kind {
    std::uint32_t ended = 0;  // contacts that lasted so long
    std::uint32_t alive = 0;  // contacts that are so old now, and may last longer
    double together = 0;      // share that is still there at `from`; NaN where none was born in the run
  };
  Kind particles, walls;
};

// Contacts of a snapshot by the octave of their age, as in Series::EndedContacts; all zero where the source has no births.
Series::EndedContacts ages(const std::vector<std::uint64_t>& birth_step, std::uint64_t step);

// A life table by octaves (Cutler and Ederer, J. Chronic Dis. 8, 699, 1958): of the n that are there at the beginning of an octave, e
// end in it and a are alive at an age within it, and n - a/2 count as exposed, so that the share together falls by the factor
// 1 - e/(n - a/2). Contacts that were there when the run began have no known age and do not count. dt: s, of a step. Empty where the
// series has no ended contacts; octaves after the last that holds a contact are left out.
std::vector<ContactLife> contact_life(const Series& series, const Series::EndedContacts& alive_pp, const Series::EndedContacts& alive_pw,
                                      double dt);

// s, when half of the contacts of a kind have ended, linear in the logarithm within an octave; NaN where more than half outlast the table.
double median_life(std::span<const ContactLife> life, ContactLife::Kind ContactLife::*kind);

}  // namespace jam
