// Scenes of M. Dosta et al., "Comparing open-source DEM frameworks for simulations of common bulk processes", Comput. Phys. Commun.
// 296 (2024) 109066, and the curves that LIGGGHTS and MUSEN give for them (data/reference/dosta2024_curves.csv).
#pragma once
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "libdem/contact/laws.hpp"
#include "libdem/simulation/selection.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/support/csv.hpp"

namespace support {

enum DostaMaterial : std::uint8_t { dosta_m1 = 0, dosta_steel = 1 };

// Hertz-Mindlin with Coulomb friction, neither rolling resistance nor adhesion.
inline dem::Setup dosta_setup(double step) {
  dem::Setup setup;
  setup.materials = {{"M1", 2500, 1e9, 0.2}, {"steel", 7200, 210e9, 0.2}};
  const auto pair = [](double restitution, double friction) { return dem::Interaction{restitution, friction, 0, 0}; };
  setup.interactions = {{pair(0.5, 0.3), pair(0.4, 0.2)}, {pair(0.4, 0.2), pair(0.6, 0.5)}};
  dem::ContactModel model;
  model.normal = "hertz";
  model.friction_limit = "coulomb";
  model.tangential = "incremental";
  model.rolling = "none";
  setup.law = dem::choose_law(model);
  setup.step = step;
  return setup;
}

// The grains for which keep(row) holds; step 0.
template <class Keep>
dem::State kept(const dem::State& state, Keep keep) {
  std::vector<bool> mask(state.particles.size());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = keep(i);
  dem::State result = dem::selection(state, mask);
  result.step = 0;
  return result;
}

struct Curve {
  std::vector<double> time, value;  // s, and what the curve says
  // Linear between the points; the end values beyond them.
  double at(double t) const {
    if (t <= time.front()) return value.front();
    for (std::size_t k = 1; k < time.size(); ++k)
      if (t <= time[k]) {
        const double share = (t - time[k - 1]) / (time[k] - time[k - 1]);
        return value[k - 1] + share * (value[k] - value[k - 1]);
      }
    return value.back();
  }
  // The first time at which a falling curve comes down to `level`.
  double time_of(double level) const {
    for (std::size_t k = 1; k < time.size(); ++k)
      if (value[k] <= level)
        return time[k - 1] + (time[k] - time[k - 1]) * (value[k - 1] - level) / (value[k - 1] - value[k]);
    return time.back();
  }
};

inline Curve dosta_curve(const std::string& scene, const std::string& code) {
  Curve curve;
  for (const Row& row : read_csv(JAMSCOPE_DATA_DIR "/reference/dosta2024_curves.csv"))
    if (row.at("case") == scene && row.at("code") == code) {
      curve.time.push_back(std::stod(row.at("t_s")));
      curve.value.push_back(std::stod(row.at("value")));
    }
  return curve;
}

// Where the environment variable JAMSCOPE_CURVES names a folder, the curve is written there, in the form of the reference.
inline void keep_curve(const Curve& curve, const std::string& scene, const std::string& quantity) {
  const char* folder = std::getenv("JAMSCOPE_CURVES");
  if (!folder) return;
  std::ofstream out(std::string(folder) + "/dosta2024_jamscope_" + scene + ".csv");
  out << "case,code,quantity,t_s,value\n";
  out.precision(9);
  for (std::size_t k = 0; k < curve.time.size(); ++k)
    out << scene << ",jamscope," << quantity << "," << curve.time[k] << "," << curve.value[k] << "\n";
}

}  // namespace support
