// Constants of a contact in another number type: in all lanes of a pack, or as numbers that count.
#pragma once
#include "libdem/contact/touch.hpp"

namespace support {

template <class To>
dem::PairConstants<To> constants_as(const dem::PairConstants<double>& c) {
  dem::PairConstants<To> as;
  const auto copy = [&](const auto& to, const auto& from) {
    for (std::size_t m = 0; m < from.size(); ++m) as.*to[m] = To(c.*from[m]);
  };
  copy(dem::material_constants<To>, dem::material_constants<double>);
  copy(dem::contact_constants<To>, dem::contact_constants<double>);
  copy(dem::radius_constants<To>, dem::radius_constants<double>);
  return as;
}

}  // namespace support
