#include "apps/jamscope/scene_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "libjam/errors.hpp"
#include "libjam/snapshot/writer.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Grains on a grid of 1 mm, at rest on nothing. In some frames grain `jammed` is pressed by blade and vessel with 15 N each, and presses its
// neighbour with 3 N.
struct Made {
  std::size_t grains = 125, frames = 8;
  std::map<std::size_t, jam::ParticleId> jammed;  // by frame
  float elsewhere = 0.01f;                        // N, on every other grain, from the vessel
  jam::SnapshotSource source() const {
    jam::SnapshotSource s;
    jam::Wall blade, vessel;
    blade.name = "blade";
    blade.kind = "mesh";
    blade.role = jam::WallRole::blade;
    blade.vertices = {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}};
    blade.triangles = {{0, 1, 2}};
    vessel.name = "vessel";
    vessel.kind = "cylinder";
    vessel.role = jam::WallRole::vessel;
    vessel.radius = 12.5e-3;
    vessel.free_side = "inside";
    s.info.walls = {blade, vessel};
    s.info.gap = {11.75e-3, 12.5e-3, -3e-3, 3e-3};
    s.info.materials = {{"glass", 2500, 63e9, 0.2}};
    s.info.dt = 1e-3;
    s.frames = frames;
    s.read = [made = *this](std::size_t k) { return made.frame(k); };
    return s;
  }
  jam::Snapshot frame(std::size_t k) const {
    jam::Snapshot s;
    s.time = 2e-3 * double(k);
    s.step = 2 * k;
    const auto side = std::size_t(std::ceil(std::cbrt(double(grains))));
    std::minstd_rand shake(std::uint32_t(k + 1));  // or they would be packed too well to fill any room
    const auto about = [&](std::size_t n) { return 1e-3f * float(n) + 1e-7f * float(shake() % 1000); };
    for (std::uint32_t v = 0; v < grains; ++v) {
      s.particles.id.push_back(10 + v);
      s.particles.position.push_back({about(v % side), about(v / side % side), about(v / side / side)});
      s.particles.velocity.push_back({0.1f, 0, 0});
      s.particles.radius.push_back(4e-4f);
    }
    const auto found = jammed.find(k);
    const std::uint32_t row = found == jammed.end() ? std::uint32_t(-1) : found->second - 10;
    for (std::uint32_t v = 0; v < grains; ++v) {
      const auto touch = [&](std::uint8_t wall, float force) {
        s.pw.row.push_back(v);
        s.pw.wall.push_back(wall);
        s.pw.normal_force.push_back(force);
        s.pw.point.push_back(s.particles.position[v]);
        s.pw.normal.push_back({1, 0, 0});
      };
      if (v == row) touch(0, 15), touch(1, 15);
      else if (elsewhere > 0) touch(1, elsewhere);
    }
    if (row != std::uint32_t(-1)) {
      s.pp.row = {{row, row + 1}};
      s.pp.normal_force = {3};
    }
    s.walls.resize(2);
    s.walls[0].position = {0, 0, 1e-3 * double(k)};
    return s;
  }
};

jam::Analysis analysis_of(const jam::SnapshotSource& source, double jam_force = 20) {
  jam::Criteria criteria;
  criteria.jam_force = jam_force;
  criteria.metrics.emplace();
  jam::Pipeline pipeline(source.info, criteria);
  for (std::size_t k = 0; k < source.frames; ++k) pipeline.add(source.read(k));
  return pipeline.finish({});
}

// The arrays of a section, one after the other.
class Section {
 public:
  explicit Section(const std::string& base64) {
    static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<char> packed;
    for (std::size_t k = 0; k + 3 < base64.size(); k += 4) {
      std::uint32_t word = 0;
      for (std::size_t i = 0; i < 4; ++i) word = word << 6 | (base64[k + i] == '=' ? 0U : std::uint32_t(letters.find(base64[k + i])));
      for (std::size_t i = 0; i < 3; ++i)
        if (base64[k + i + 1] != '=') packed.push_back(char(word >> (16 - 8 * i)));
    }
    boost::iostreams::filtering_ostream out;
    out.push(boost::iostreams::zlib_decompressor());
    out.push(boost::iostreams::back_inserter(bytes_));
    out.write(packed.data(), std::streamsize(packed.size()));
    boost::iostreams::close(out);
  }
  template <class T>
  std::vector<T> take(std::size_t n) {
    std::vector<T> values(n);
    if (at_ + n * sizeof(T) > bytes_.size()) throw std::runtime_error("the section is too short");
    if (n > 0) std::memcpy(values.data(), bytes_.data() + at_, n * sizeof(T));
    at_ += n * sizeof(T);
    return values;
  }
  bool finished() const { return at_ == bytes_.size(); }

 private:
  std::vector<char> bytes_;
  std::size_t at_ = 0;
};

Section section(const SceneData& data, const json& named, const char* key = "section") {
  return Section(data.sections.at(named.at(key).get<std::size_t>()));
}
std::size_t bytes_of(const SceneData& data) {
  std::size_t sum = 0;
  for (const std::string& s : data.sections) sum += s.size();
  return sum;
}
const json& row_of(const SceneData& data, std::size_t frame) {
  for (const json& row : data.view["frames"])
    if (row["frame"] == frame) return row;
  throw std::runtime_error("the frame is not there");
}
std::vector<std::size_t> frames_of(const SceneData& data) {
  std::vector<std::size_t> frames;
  for (const json& row : data.view["frames"]) frames.push_back(row["frame"]);
  return frames;
}

TEST(LogCode, KeepsThreeDigitsAndNothingAndNotKnown) {
  for (const double v : {1.1e-12, 3.7e-9, 1.0, 20.0, 1e6}) EXPECT_NEAR(from_log_code(log_code(v)) / v, 1, 4e-4) << v;
  EXPECT_EQ(log_code(0), 0);
  EXPECT_EQ(log_code(-3), 0);
  EXPECT_EQ(from_log_code(0), 0);
  EXPECT_TRUE(std::isnan(from_log_code(log_code(std::nan("")))));
  EXPECT_NEAR(from_log_code(log_code(1e9)) / 1e6, 1, 1e-3);
}

TEST(SceneData, HoldsEveryFrameOfAShortRun) {
  Made made;
  made.jammed = {{3, 40}, {4, 40}};
  const jam::SnapshotSource source = made.source();
  const SceneData data = scene_data(source, analysis_of(source), {}, 10'000'000);
  EXPECT_EQ(data.view["why"], "");
  EXPECT_EQ(data.view["all_frames"], 8);
  ASSERT_EQ(frames_of(data), (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7}));
  const json& row = row_of(data, 3);
  EXPECT_EQ(row["jammed"], json({40}));
  EXPECT_EQ(row_of(data, 5)["jammed"], json::array());
  EXPECT_TRUE(row["whole"]);
  EXPECT_EQ(row["poses"][0][2], 3e-3);
  const jam::Snapshot s = source.read(3);
  Section frame = section(data, row);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = data.view["low"][std::size_t(axis)], high = data.view["high"][std::size_t(axis)];
    const auto codes = frame.take<std::uint16_t>(125);
    for (std::size_t v = 0; v < 125; ++v) EXPECT_NEAR(low + codes[v] / 65535.0 * (high - low), s.particles.position[v][axis], (high - low) / 65535);
  }
  EXPECT_NEAR(from_log_code(frame.take<std::uint16_t>(125)[7]), 0.1, 1e-4);
  EXPECT_NEAR(from_log_code(frame.take<std::uint16_t>(125)[30]), 33, 0.02);
  EXPECT_EQ(frame.take<std::uint8_t>(125)[30], 3);
  // Above the mean, (2 * 15 + 3 + 124 * 0.01) / 127 N, are the three contacts of the jam.
  ASSERT_EQ(row["contacts"], 1);
  ASSERT_EQ(row["wall_contacts"], 2);
  EXPECT_NEAR(row["mean_force"].get<double>(), 34.24 / 127, 1e-4);
  EXPECT_EQ(frame.take<std::uint32_t>(1)[0], 30u);
  EXPECT_EQ(frame.take<std::uint32_t>(1)[0], 31u);
  EXPECT_NEAR(from_log_code(frame.take<std::uint16_t>(1)[0]), 3, 2e-3);
  EXPECT_EQ(frame.take<std::uint32_t>(2), (std::vector<std::uint32_t>{30, 30}));
  EXPECT_EQ(frame.take<std::uint8_t>(2), (std::vector<std::uint8_t>{0, 1}));
  frame.take<std::uint16_t>(6);
  EXPECT_NEAR(from_log_code(frame.take<std::uint16_t>(2)[1]), 15, 1e-2);
  EXPECT_TRUE(frame.finished());
  Section grains = section(data, data.view, "grains_section");
  EXPECT_EQ(grains.take<std::uint32_t>(125)[5], 15u);
  EXPECT_EQ(grains.take<float>(125)[5], 4e-4f);
  Section mesh = section(data, data.view["walls"][0]);
  EXPECT_EQ(mesh.take<float>(9)[3], 1e-3f);
  EXPECT_EQ(mesh.take<std::uint32_t>(3), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(data.view["walls"][1]["free"], "inside");
}

TEST(SceneData, HoldsGluedGrainsUnlessTheyAreTooMany) {
  jam::SnapshotSource source = Made{}.source();
  const jam::Analysis analysis = analysis_of(source);
  source.info.walls[1].kind = "spheres";
  source.info.walls[1].sphere_centre = {{0, 0, 0}, {1e-3, 0, 2e-3}};
  source.info.walls[1].sphere_radius = {4e-4, 5e-4};
  const SceneData few = scene_data(source, analysis, {}, 1'000'000);
  Section spheres = section(few, few.view["walls"][1]);
  EXPECT_EQ(spheres.take<float>(8), (std::vector<float>{0, 0, 0, 4e-4f, 1e-3f, 0, 2e-3f, 5e-4f}));
  source.info.walls[1].sphere_centre.resize(100'001, {0, 0, 0});
  source.info.walls[1].sphere_radius.resize(100'001, 4e-4);
  const SceneData many = scene_data(source, analysis, {}, 1'000'000);
  EXPECT_THAT(many.view["walls"][1]["left_out"].get<std::string>(), testing::HasSubstr("too many"));
  EXPECT_FALSE(many.view["walls"][1].contains("section"));
}

TEST(SceneData, SpreadsFramesWhereTheRoomIsShortAndKeepsThoseOfJams) {
  Made made;
  made.grains = 3000;
  made.frames = 100;
  made.jammed = {{37, 700}, {38, 700}};
  const jam::SnapshotSource source = made.source();
  const jam::Analysis a = analysis_of(source);
  const std::size_t one = row_of(scene_data(source, a, {}, 50'000'000), 37).at("section").get<std::size_t>();
  const std::size_t size = scene_data(source, a, {}, 50'000'000).sections[one].size();
  const SceneData data = scene_data(source, a, {}, 14 * size);
  EXPECT_LE(bytes_of(data), 14 * size);
  const std::vector<std::size_t> frames = frames_of(data);
  EXPECT_THAT(frames, testing::IsSupersetOf({0u, 37u, 38u, 50u, 99u}));
  EXPECT_GT(frames.size(), 8u);
  EXPECT_LT(frames.size(), 14u);
  std::size_t widest = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) widest = std::max(widest, frames[k] - frames[k - 1]);
  EXPECT_LE(widest, 25u);
}

TEST(SceneData, KeepsTheSurroundingsOfJamsForWhichWholeFramesHaveNoRoom) {
  Made made;
  made.grains = 3000;
  made.frames = 100;
  for (std::size_t k = 5; k < 95; k += 5) made.jammed[k] = jam::ParticleId(500 + 7 * k);  // 18 jams of one frame each
  const jam::SnapshotSource source = made.source();
  const jam::Analysis a = analysis_of(source);
  ASSERT_EQ(a.events.size(), 18u);
  const SceneData all = scene_data(source, a, {}, 50'000'000);
  const std::size_t size = all.sections[row_of(all, 50)["section"].get<std::size_t>()].size();
  const SceneData data = scene_data(source, a, {}, 10 * size);
  EXPECT_LE(bytes_of(data), 10 * size);
  std::size_t parts = 0;
  for (const auto& [frame, particle] : made.jammed) {
    const json& row = row_of(data, frame);  // every jam is there
    EXPECT_EQ(row["jammed"], json({particle}));
    if (!row["part"]) continue;
    ++parts;
    EXPECT_FALSE(row["whole"]);
    const auto n = row["grains"].get<std::size_t>();
    EXPECT_LT(n, 200u);
    const auto rows = section(data, row).take<std::uint32_t>(n);
    EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), particle - 10));
    // Within four diameters of 0.8 mm on a grid of 1 mm.
    const jam::Snapshot s = source.read(frame);
    for (const std::uint32_t r : rows) EXPECT_LT((s.particles.position[r] - s.particles.position[particle - 10]).norm(), 3.2e-3f);
    EXPECT_EQ(row["contacts"], 1);
  }
  EXPECT_GT(parts, 5u);
}

TEST(SceneData, HoldsTheLoadedGrainsOfEveryFrameToTheBit) {
  Made made;
  made.jammed = {{3, 40}, {4, 40}};
  made.elsewhere = 0.5f;
  const jam::SnapshotSource source = made.source();
  const SceneData data = scene_data(source, analysis_of(source), {}, 10'000'000);
  ASSERT_EQ(data.samples["frames"], 8);
  EXPECT_EQ(data.samples["floor"], 0.2);  // a hundredth of the jam force
  EXPECT_EQ(data.samples["by_force"], true);
  const auto n = data.samples["samples"].get<std::size_t>();
  EXPECT_EQ(n, 8u * 125);  // the neighbour of the jammed grain carries 0.5 + 3 N
  Section s = section(data, data.samples);
  EXPECT_EQ(s.take<double>(8)[7], 2e-3 * 7);
  EXPECT_EQ(s.take<std::uint32_t>(8), std::vector<std::uint32_t>(8, 125));
  const auto particle = s.take<std::uint32_t>(n);
  const auto force = s.take<double>(n);
  EXPECT_EQ(particle[3 * 125 + 30], 40u);
  EXPECT_EQ(force[3 * 125 + 30], 33.0);
  EXPECT_EQ(force[3 * 125 + 31], 3.5);
  EXPECT_EQ(force[5], 0.5);
}

TEST(SceneData, RaisesTheFloorUntilTheSamplesAreFew) {
  Made made;
  made.grains = 1000;
  made.frames = 250;
  made.elsewhere = 1;
  jam::SnapshotSource source = made.source();
  source.read = [made](std::size_t k) {
    jam::Snapshot s = made.frame(k);
    for (std::size_t c = 0; c < s.pw.size(); ++c) s.pw.normal_force[c] = 0.3f + 0.01f * float((c * 7919 + k * 104729) % 1000);
    return s;
  };
  const SceneData data = scene_data(source, analysis_of(source), {}, 50'000'000);
  const auto n = data.samples["samples"].get<std::size_t>();
  const double floor = data.samples["floor"];
  EXPECT_LE(n, 200'000u);
  EXPECT_GT(n, 195'000u);
  std::size_t above = 0;
  for (std::size_t k = 0; k < made.frames; ++k)
    for (const float f : source.read(k).pw.normal_force) above += double{f} > floor;
  EXPECT_EQ(n, above);  // none above it is missing
}

// Two frames in the middle have another grain in place of one, so that neither the first nor the last frame nor the counts tell.
TEST(SceneData, KnowsGrainsThatOnlySomeFramesHave) {
  Made made;
  made.jammed = {{3, 40}};
  jam::SnapshotSource source = made.source();
  const auto read = source.read;
  source.read = [read](std::size_t k) {
    jam::Snapshot s = read(k);
    if (k == 3 || k == 4) s.particles.id.back() += 1000;
    return s;
  };
  const SceneData data = scene_data(source, analysis_of(source), {}, 10'000'000);
  EXPECT_EQ(data.view["why"], "");
  EXPECT_EQ(data.view["grains"], source.read(0).particles.size() + 1);
}

TEST(SceneData, FindsTheFramesOfAPartialAnalysis) {
  Made made;
  made.jammed = {{3, 40}};
  const jam::SnapshotSource source = made.source();
  jam::SnapshotSource later = source;
  later.frames = 5;
  later.read = [source](std::size_t k) { return source.read(k + 2); };
  const SceneData data = scene_data(source, analysis_of(later), {}, 1'000'000);
  EXPECT_EQ(data.view["why"], "");
  EXPECT_EQ(row_of(data, 1)["time"], 2e-3 * 3);
  EXPECT_EQ(row_of(data, 1)["jammed"], json({40}));
}

TEST(SceneData, TakesFramesOfTheCaptureForJamsThatFallBetweenFrames) {
  Made made;
  made.jammed = {{3, 40}};
  jam::SnapshotSource source = made.source();
  source.info.created_utc = "2026-01-01T00:00:00Z";
  jam::Analysis a = analysis_of(source);
  // Every step saw grain 40 in the frame at 6 ms, and grain 50 between those at 8 and 10 ms; of a third the capture has no frame.
  a.every_step.resize(3);
  const auto jam_of = [](jam::ParticleId particle, double start, double end, double peak_time, double force) {
    jam::StepJam j;
    j.start = start;
    j.end = end;
    j.peak_time = peak_time;
    j.peak_force = force;
    j.peak_particle = particle;
    j.members = {particle};
    return j;
  };
  a.every_step[1].jams = {jam_of(40, 5e-3, 7e-3, 6e-3, 33), jam_of(50, 8.5e-3, 9.5e-3, 9.2e-3, 33), jam_of(60, 10.4e-3, 10.6e-3, 10.5e-3, 40)};
  const Scratch scratch;
  const auto capture_of = [&](const jam::RunInfo& info) {
    std::filesystem::remove(scratch / "capture.h5");
    jam::SnapshotWriter writer = jam::SnapshotWriter::create(scratch / "capture.h5", info);
    Made fine = made;
    fine.jammed = {{0, 50}, {1, 50}, {2, 50}};
    for (const std::size_t k : {0, 1, 2, 3}) {
      jam::Snapshot s = fine.frame(k);
      s.time = std::vector{8.6e-3, 9.1e-3, 9.4e-3, 9.9e-3}[k];
      s.step = 100 + k;
      writer.append(s);
    }
  };
  capture_of(source.info);
  const SceneData data = scene_data(source, a, {}, 10'000'000, scratch / "run.h5");
  std::vector<json> fine;
  for (const json& row : data.view["frames"])
    if (row["fine"].get<bool>()) fine.push_back(row);
  ASSERT_EQ(fine.size(), 1u);
  EXPECT_EQ(fine[0]["time"], 9.1e-3);  // the nearest to the peak
  EXPECT_EQ(fine[0]["frame"], 4);      // it comes after that one
  EXPECT_EQ(fine[0]["jammed"], json({50}));
  EXPECT_EQ(fine[0]["bridges"], json({true}));
  ASSERT_EQ(fine[0]["loaded"].size(), 2u);  // with its neighbour
  EXPECT_EQ(fine[0]["loaded"][0][0], 50);
  EXPECT_EQ(fine[0]["loaded"][0][1], 33.0);
  double before = -1;
  for (const json& row : data.view["frames"]) {
    EXPECT_GT(row["time"], before);
    before = row["time"];
  }
  // The capture of another run is none of ours.
  jam::RunInfo other = source.info;
  other.created_utc = "2026-01-02T00:00:00Z";
  capture_of(other);
  EXPECT_EQ(scene_data(source, a, {}, 10'000'000, scratch / "run.h5").view["frames"].size(), 8u);
}

TEST(SceneData, SaysWhyThereIsNone) {
  const Made made;
  jam::SnapshotSource source = made.source();
  const jam::Analysis a = analysis_of(source);
  jam::SnapshotSource other = source;
  other.read = [made](std::size_t k) {
    jam::Snapshot s = made.frame(k);
    s.step += 1000;
    s.time += 1;
    return s;
  };
  EXPECT_THAT(scene_data(other, a, {}, 1'000'000).view["why"].get<std::string>(), HasSubstr("not those of this analysis"));
  source.read = [made](std::size_t k) -> jam::Snapshot {
    if (k == 4) throw jam::DataError("run.h5: frame 4 is damaged");
    return made.frame(k);
  };
  EXPECT_THAT(scene_data(source, a, {}, 1'000'000).view["why"].get<std::string>(), HasSubstr("run.h5: frame 4 is damaged"));
  EXPECT_THAT(scene_data(source, {}, {}, 1'000'000).view["why"].get<std::string>(), HasSubstr("no frames"));
  const SceneData tight = scene_data(made.source(), a, {}, 10);
  EXPECT_TRUE(tight.view["frames"].empty());
  EXPECT_TRUE(tight.samples.is_null());
}

}  // namespace
}  // namespace jamscope
