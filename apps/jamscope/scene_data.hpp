// What the report's 3D view and its threshold slider are made of: a bounded choice of frames, and of every frame the grains under load.
//
// Which frames: first, of each jam the frame in which its force was largest, strongest jam first, then its first and its last frame, then the
// peaks of the stays of single grains; then, of jams that only every step saw, the frame of capture.h5 nearest to the peak, where there is one within
// the jam; then frames evenly spread over the record. They are taken in this order until the room is used. Jams get whole frames while
// these take no more than half of the room; after that only the grains near jammed ones are kept (`part_reach`).
//
// Where they stand: each frame is a section of the page of its own, zlib's deflate in base64, so that the page unpacks what it shows and nothing else.
// Numbers are little-endian, each array whole before the next:
//
//   grains      uint32 id[n]; float32 radius[n], m
//   mesh        float32 x y z [vertices], m, in the body frame; uint32 a b c [triangles]
//   frame       uint16 x[n], y[n], z[n] over the box; uint16 speed[n], force[n] as codes; uint8 contacts[n];
//               uint32 a[c], b[c] rows of the frame, uint16 force[c] of contacts of two grains;
//               uint32 grain[w], uint8 wall[w], uint16 x y z [w] of the point, uint16 force[w] of those with walls.
//               Contacts are those above the mean of all that press, and those of jammed grains.
//               A part frame begins with uint32 row[n] of `grains`; a whole one has them all, in order
//   samples     float64 time[F]; uint32 count[F]; uint32 particle[S]; float64 force[S], N; uint16 x y z [S]; uint16 speed[S]; uint8 in_gap[S]
//   stays       uint32 particle[E]; float64 first_step[E], last_step[E], peak_step[E]; float32 force[E], N; uint8 site[E]; uint8 open[E]
//
// A code is 0 for nothing, 65535 for not known, else 1 + round((log10(v) + 12) 65533 / 18): 1e-12 to 1e6 with 0.03 %.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "libjam/analysis.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

struct SceneData {
  nlohmann::json view;     // `scene` of the data island; where there are no frames, `why`
  nlohmann::json samples;  // `samples`, or null
  nlohmann::json stays;    // `stays`, or null
  std::vector<std::string> sections;  // base64; the rows that the three name
};

// Frames of `source` that the analysis is of. `room`: bytes that the sections may take. `file`: where they are stored, for the capture.h5 beside it; or
// empty. Where a frame cannot be read, the view says why.
SceneData scene_data(const jam::SnapshotSource& source, const jam::Analysis& analysis, const jam::Series& series, std::size_t room,
                     const std::filesystem::path& file = {});
// The number in `source` of the first frame of the analysis; nothing where they do not belong together.
std::optional<std::size_t> first_frame(const jam::SnapshotSource& source, const jam::Analysis& analysis);
// Of data whose snapshots are not at hand.
SceneData no_scene(const std::string& why);

std::uint16_t log_code(double value);
double from_log_code(std::uint16_t code);  // NaN where not known

}  // namespace jamscope
