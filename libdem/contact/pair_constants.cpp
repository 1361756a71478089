#include "libdem/contact/pair_constants.hpp"

namespace dem {

MaterialTable make_material_table(const std::vector<Material>& materials,
                                  const std::vector<std::vector<Interaction>>& interactions, const LawChoice& choice) {
  MaterialTable table{materials.size(), {}};
  for (std::size_t a = 0; a < materials.size(); ++a) {
    for (std::size_t b = 0; b < materials.size(); ++b) {
      PairConstants<double> c{};
      const Interaction& law = interactions[a][b];
      c.effective_modulus = effective_modulus(materials[a], materials[b]);
      c.effective_shear = effective_shear_modulus(materials[a], materials[b]);
      const DampingCoefficients<double> damping = with_part<DampingLaws>(choice.damping, [&](auto part) {
        return part.per_root(law.restitution, c.effective_modulus, c.effective_shear);
      });
      c.normal_damping = damping.normal;
      c.tangential_damping = damping.tangential;
      c.friction = law.friction;
      c.rolling_friction = law.rolling_friction;
      c.rolling_damping = law.rolling_damping;
      c.work_of_adhesion = law.work_of_adhesion;
      set_adhesion(c);
      table.pair.push_back(c);
    }
  }
  return table;
}

}  // namespace dem
