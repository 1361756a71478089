#include "libjam/snapshot/inspect.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "libjam/snapshot/hdf5.hpp"
#include "libjam/snapshot/reader.hpp"
#include "libjam/snapshot/writer.hpp"
#include "tests/jam/snapshot/sample_run.hpp"

namespace jam {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Inspect : public sample::InFolder {
 protected:
  void write(std::size_t frames) const {
    SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
    for (std::size_t k = 0; k < frames; ++k) {
      Snapshot s = sample::frame(k);
      s.particles.velocity.clear();
      writer.append(s, sample::series(k));
    }
  }
};

TEST_F(Inspect, AGoodFileIsDescribed) {
  write(4);
  const FileReport r = inspect_file(path);
  EXPECT_TRUE(r.valid());
  EXPECT_EQ(r.path, path.string());
  EXPECT_EQ(r.format, "jamscope-snapshots");
  EXPECT_EQ(r.version, "1.2");
  EXPECT_EQ(r.bytes, std::filesystem::file_size(path));
  EXPECT_TRUE(r.closed);
  EXPECT_EQ(r.frames, 4U);
  EXPECT_EQ(r.frames_begun, 4U);
  EXPECT_EQ(r.time_first, 0.0);
  EXPECT_EQ(r.time_last, sample::frame(3).time);
  EXPECT_EQ(r.step_last, 120000U);
  EXPECT_NEAR(r.interval, 0.002, 1e-15);  // rounding of 0.006 / 3
  EXPECT_EQ(r.particles.min, 60U);        // 60, 61, 62, 60
  EXPECT_EQ(r.particles.max, 62U);
  EXPECT_EQ(r.particles.mean, 60.75);
  double contacts = 0;
  for (std::size_t k = 0; k < 4; ++k) contacts += static_cast<double>(sample::frame(k).pp.size());
  EXPECT_EQ(r.particle_contacts.mean, contacts / 4);
  EXPECT_EQ(r.wall_contacts.min, 30U);
  EXPECT_EQ(r.series_rows, 12U);
  EXPECT_THAT(r.absent, ElementsAre("/particles/velocity"));
  EXPECT_THAT(r.present, Contains("/walls/blade/vertices"));
  EXPECT_THAT(r.present, Contains("/series/walls/vessel side/power"));
  EXPECT_EQ(r.info.creator, "sample");
  EXPECT_THAT(r.warnings, IsEmpty());
}

TEST_F(Inspect, DamageIsListedFrameByFrame) {
  write(4);
  // Spoil one stored number of frames 1 and 2 in a way that HDF5 itself cannot notice.
  {
    const SnapshotIndex index = read_index(path);
    h5::File file = h5::File::open_update(path);
    for (const std::size_t k : {1, 2}) {
      file.write_rows("/particles/radius", index.frames[k].particle_start + 7, std::vector<float>{0.5F});
    }
    file.close();
  }
  const FileReport r = inspect_file(path);
  EXPECT_FALSE(r.valid());
  EXPECT_EQ(r.frames, 4U);
  EXPECT_THAT(r.problems, ElementsAre(HasSubstr("run.h5:frame 1: contents do not match the checksum"),
                                      HasSubstr("run.h5:frame 2: contents do not match the checksum")));
}

TEST_F(Inspect, AFileCutShortSaysHowMuchIsLeft) {
  write(6);
  // The file ends with the unused rest of a page; the last frame's chunks come before it.
  FileReport r;
  do {
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1000);
    r = inspect_file(path);
  } while (r.frames == 6);
  EXPECT_FALSE(r.valid());
  EXPECT_EQ(r.frames, 5U);
  EXPECT_EQ(r.frames_begun, 6U);
  EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("5 complete frames of 6 are used")));
  EXPECT_THAT(r.problems, ElementsAre(HasSubstr("the end of the file is missing")));
}

TEST_F(Inspect, FilesThatAreSomethingElseGetOneProblem) {
  EXPECT_THAT(inspect_file(path).problems, ElementsAre(HasSubstr("run.h5: no such file")));
  EXPECT_THAT(inspect_file(folder).problems, ElementsAre(HasSubstr("is not a file")));
  std::ofstream(path) << "ITEM: TIMESTEP\n";
  EXPECT_EQ(inspect_file(path).format, "unknown");
  EXPECT_THAT(inspect_file(path).problems, ElementsAre(HasSubstr("is not an HDF5 file")));
  h5::write_aside(path, [](h5::File& file) { file.set_attribute("/", "format", "jamscope-analysis"); });
  EXPECT_EQ(inspect_file(path).format, "jamscope-analysis");
  EXPECT_THAT(inspect_file(path).problems,
              ElementsAre(HasSubstr("'jamscope-analysis', expected 'jamscope-snapshots'")));
  h5::write_aside(path, [](h5::File&) {});
  EXPECT_EQ(inspect_file(path).format, "HDF5");
  EXPECT_FALSE(inspect_file(path).valid());
}

}  // namespace
}  // namespace jam
