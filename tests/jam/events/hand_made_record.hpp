// Records of jammed particles drawn as pictures: one string per particle, one character per frame. '.' not jammed,
// a digit: jammed with that many tens of newtons; a letter: not jammed, but nearly, with as many newtons as it has before it in the alphabet.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "libjam/events/jam_frame.hpp"

namespace jam::hand_made {

// Rows must come in ascending order of particle. Frames are 2 ms apart, beginning at t = 0.
inline std::vector<JamFrame> record(const std::vector<std::pair<ParticleId, std::string>>& rows,
                                    double interval = 2e-3) {
  std::vector<JamFrame> frames(rows.empty() ? 0 : rows.front().second.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].time = static_cast<double>(k) * interval;
    for (const auto& [particle, picture] : rows) {
      if (picture.at(k) == '.') continue;
      JammedSample sample;
      sample.particle = particle;
      sample.position = Vec3f(static_cast<float>(particle), static_cast<float>(k), 0);
      const bool nearly = picture[k] >= 'a';
      sample.compressive_force = nearly ? double(picture[k] - 'a') : 10.0 * (picture[k] - '0');
      (nearly ? frames[k].nearly : frames[k].jammed).push_back(sample);
    }
  }
  return frames;
}

}  // namespace jam::hand_made
