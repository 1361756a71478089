#include "libdem/case/case.hpp"

#include "libdem/errors.hpp"

namespace dem {

std::size_t material_index(const Case& c, const std::string& name) {
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    if (c.materials[m].name == name) return m;
  throw CaseError("no material is named '" + name + "'");
}

}  // namespace dem
