#include "libdem/contact/laws.hpp"

#include <algorithm>

#include "libdem/errors.hpp"

namespace dem {
namespace {

template <class Table>
std::uint8_t row_named(const char* kind, const std::string& name) {
  const std::vector<std::string> names = part_names<Table>();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return std::uint8_t(found - names.begin());
  std::string all;
  for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
  throw CaseError("contact." + std::string(kind) + " '" + name + "' is unknown, expected one of " + all);
}

}  // namespace

std::optional<std::string> incompatible(const LawChoice& choice) {
  const bool needs_jkr = with_part<FrictionLimits>(choice.friction, [](auto limit) { return limit.needs_jkr; });
  const bool is_jkr =
      with_part<NormalLaws>(choice.normal, [](auto normal) { return std::derived_from<decltype(normal), JkrForce>; });
  if (needs_jkr && !is_jkr)
    return "friction_limit '" + part_names<FrictionLimits>()[choice.friction] + "' needs a JKR normal force, got normal '" +
           part_names<NormalLaws>()[choice.normal] + "'";
  return std::nullopt;
}

LawChoice choose_law(const ContactModel& model) {
  const LawChoice choice{row_named<NormalLaws>("normal", model.normal), row_named<DampingLaws>("damping", model.damping),
                         row_named<FrictionLimits>("friction_limit", model.friction_limit),
                         row_named<TangentialLaws>("tangential", model.tangential),
                         row_named<RollingLaws>("rolling", model.rolling)};
  if (const auto why = incompatible(choice)) throw CaseError("contact." + *why);
  return choice;
}

}  // namespace dem
