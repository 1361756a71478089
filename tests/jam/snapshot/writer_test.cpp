#include "libjam/snapshot/writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libjam/snapshot/reader.hpp"
#include "tests/jam/snapshot/sample_run.hpp"

namespace jam {
namespace {

using sample::difference;
using sample::error_of;
using testing::HasSubstr;

class SnapshotFile : public sample::InFolder {};

void write_sample(const std::filesystem::path& path, std::size_t frames) {
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  for (std::size_t k = 0; k < frames; ++k) writer.append(sample::frame(k), sample::series(k));
}

TEST_F(SnapshotFile, EveryFrameAndTheSeriesComeBackBitForBit) {
  write_sample(path, 7);
  const SnapshotSource source = open_jamscope_file(path);
  ASSERT_EQ(source.frames, 7U);
  EXPECT_THAT(source.warnings, testing::IsEmpty());
  for (const std::size_t k : {6, 0, 3, 1, 2, 5, 4}) EXPECT_EQ(difference(source.read(k), sample::frame(k)), "") << k;
  EXPECT_EQ(source.series.size(), 24U);
  EXPECT_EQ(difference(source.series, sample::joined(7)), "");
  EXPECT_THAT(error_of([&] { source.read(7); }), HasSubstr("run.h5:frame 7: no such frame, the file has 7"));
}

TEST_F(SnapshotFile, WhatIsKnownAboutTheRunComesBackExactly) {
  const RunInfo a = sample::info();
  SnapshotWriter::create(path, a);
  const SnapshotSource source = open_jamscope_file(path);
  EXPECT_EQ(source.frames, 0U);
  const RunInfo& b = source.info;
  EXPECT_EQ(a.creator, b.creator);
  EXPECT_EQ(a.creator_version, b.creator_version);
  EXPECT_EQ(a.commit, b.commit);
  EXPECT_EQ(a.created_utc, b.created_utc);
  EXPECT_EQ(a.case_toml, b.case_toml);
  EXPECT_EQ(a.case_sha256, b.case_sha256);
  EXPECT_EQ(a.argv, b.argv);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.dt, b.dt);
  ASSERT_EQ(b.materials.size(), 2U);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_EQ(a.materials[m].name, b.materials[m].name);
    EXPECT_EQ(a.materials[m].density, b.materials[m].density);
    EXPECT_EQ(a.materials[m].young, b.materials[m].young);
    EXPECT_EQ(a.materials[m].poisson, b.materials[m].poisson);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_EQ(a.interactions[m][n].restitution, b.interactions[m][n].restitution);
      EXPECT_EQ(a.interactions[m][n].friction, b.interactions[m][n].friction);
      EXPECT_EQ(a.interactions[m][n].rolling, b.interactions[m][n].rolling);
      EXPECT_EQ(a.interactions[m][n].work_of_adhesion, b.interactions[m][n].work_of_adhesion);
    }
  }
  ASSERT_EQ(b.walls.size(), sample::wall_count);
  for (std::size_t w = 0; w < sample::wall_count; ++w) {
    EXPECT_EQ(a.walls[w].name, b.walls[w].name);
    EXPECT_EQ(a.walls[w].kind, b.walls[w].kind);
    EXPECT_EQ(a.walls[w].role, b.walls[w].role);
    EXPECT_EQ(a.walls[w].material, b.walls[w].material);
    EXPECT_EQ(a.walls[w].point, b.walls[w].point);
    EXPECT_EQ(a.walls[w].axis, b.walls[w].axis);
    EXPECT_EQ(a.walls[w].radius, b.walls[w].radius);
    EXPECT_EQ(a.walls[w].high_radius, b.walls[w].high_radius);
    EXPECT_EQ(a.walls[w].hole_radius, b.walls[w].hole_radius);
    EXPECT_EQ(a.walls[w].low, b.walls[w].low);
    EXPECT_EQ(a.walls[w].high, b.walls[w].high);
    EXPECT_EQ(a.walls[w].free_side, b.walls[w].free_side);
    EXPECT_EQ(a.walls[w].sphere_centre, b.walls[w].sphere_centre);
    EXPECT_EQ(a.walls[w].sphere_radius, b.walls[w].sphere_radius);
    EXPECT_EQ(a.walls[w].vertices, b.walls[w].vertices);
    EXPECT_EQ(a.walls[w].triangles, b.walls[w].triangles);
    EXPECT_EQ(a.walls[w].triangle_label, b.walls[w].triangle_label);
  }
  EXPECT_EQ(a.watch_force, b.watch_force);
  EXPECT_EQ(a.watch_radius, b.watch_radius);
  EXPECT_EQ(a.watch_stride, b.watch_stride);
  EXPECT_EQ(a.gap.tip_radius, b.gap.tip_radius);
  EXPECT_EQ(a.gap.vessel_radius, b.gap.vessel_radius);
  EXPECT_EQ(a.gap.z_low, b.gap.z_low);
  EXPECT_EQ(a.gap.z_high, b.gap.z_high);
  EXPECT_TRUE(b.wall_loads_known);
}

TEST_F(SnapshotFile, ARunOfWhichNothingIsKnownIsAFileToo) {
  SnapshotWriter writer = SnapshotWriter::create(path, RunInfo{});
  Snapshot empty;
  writer.append(empty);
  Snapshot one;
  one.time = 1;
  one.step = 1;
  one.particles.id = {5};
  one.particles.position = {Vec3f(1, 2, 3)};
  one.particles.radius = {1};
  writer.append(one);
  const SnapshotSource source = open_jamscope_file(path);
  ASSERT_EQ(source.frames, 2U);
  EXPECT_EQ(source.read(0).particles.size(), 0U);
  EXPECT_EQ(difference(source.read(1), one, RunInfo{}), "");
  EXPECT_EQ(source.info.creator, "");
}

TEST_F(SnapshotFile, WhatTheSourceDoesNotKnowIsAbsentNotZero) {
  RunInfo info = sample::info();
  info.wall_loads_known = false;
  const auto bare = [](std::size_t k) {
    Snapshot s = sample::frame(k);
    s.particles.velocity.clear();
    s.particles.compressive_force.clear();
    s.pp.overlap.clear();
    s.pp.birth_step.clear();
    s.pw.normal.clear();
    return s;
  };
  SnapshotWriter writer = SnapshotWriter::create(path, info);
  for (std::size_t k = 0; k < 3; ++k) {
    Series rows = sample::series(k);
    rows.walls.clear();
    rows.jammed_count.clear();
    writer.append(bare(k), rows);
  }
  const h5::File file = h5::File::open(path);
  for (const char* name :
       {"/particles/velocity", "/particles/compressive_force", "/contacts/pp/overlap", "/contacts/pp/birth_step",
        "/contacts/pw/normal", "/series/jammed_count", "/series/walls", "/walls/blade/force", "/walls/blade/torque"}) {
    EXPECT_FALSE(file.exists(name)) << name;
  }
  const SnapshotSource source = open_jamscope_file(path);
  EXPECT_FALSE(source.info.wall_loads_known);
  EXPECT_TRUE(source.series.walls.empty());
  EXPECT_TRUE(source.series.jammed_count.empty());
  EXPECT_EQ(source.series.size(), 8U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(difference(source.read(k), bare(k), info), "");
}

TEST_F(SnapshotFile, ContactsAndParticlesMayAppearAfterTheFirstFrame) {
  const auto late = [](std::size_t k) {
    Snapshot s = sample::frame(k);
    if (k < 1) s.particles = {};
    if (k < 2) s.pp = {};
    if (k < 4 || k == 5) s.pw = {};
    return s;
  };
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  for (std::size_t k = 0; k < 7; ++k) {
    writer.append(late(k), sample::series(k));
    EXPECT_EQ(open_jamscope_file(path).frames, k + 1);
  }
  const SnapshotSource source = open_jamscope_file(path);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(difference(source.read(k), late(k)), "") << k;
}

TEST_F(SnapshotFile, EachFramesRowsStartOnAChunkSoThatNoChunkIsWrittenTwice) {
  // More contacts than the first frame's chunk holds, and fewer.
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  for (std::size_t k = 0; k < 6; ++k) writer.append(sample::frame(k, k % 2 == 0 ? 300 : 40));
  const SnapshotIndex index = read_index(path);
  const h5::File file = h5::File::open(path);
  const std::uint64_t particles = file.chunk_rows("/particles/id"), pp = file.chunk_rows("/contacts/pp/row"),
                      pw = file.chunk_rows("/contacts/pw/row");
  EXPECT_EQ(particles, 300U);
  for (std::size_t k = 1; k < 6; ++k) {
    EXPECT_EQ(index.frames[k].particle_start % particles, 0U);
    EXPECT_EQ(index.frames[k].pp_start % pp, 0U);
    EXPECT_EQ(index.frames[k].pw_start % pw, 0U);
    EXPECT_GE(index.frames[k].particle_start, index.frames[k - 1].particle_start + index.frames[k - 1].particle_count);
    EXPECT_GE(index.frames[k].pp_start, index.frames[k - 1].pp_start + index.frames[k - 1].pp_count);
    EXPECT_EQ(difference(read_frame(index, k), sample::frame(k, k % 2 == 0 ? 300 : 40)), "");
  }
}

TEST_F(SnapshotFile, TheChecksumIsCrc32cOfTheFramesBytes) {
  // A frame without particles, contacts and walls: only its row of /frames counts, 60 zero bytes but for the time.
  SnapshotWriter writer = SnapshotWriter::create(path, RunInfo{});
  Snapshot s;
  s.time = 1;
  writer.append(s);
  const double one = 1;
  std::string bytes(60, '\0');
  std::memcpy(bytes.data(), &one, 8);
  // Bitwise CRC-32C, RFC 3720 appendix B.4, reflected polynomial.
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0x82F63B78U : 0U);
  }
  EXPECT_EQ(read_index(path).commit[0], ~crc);
}

TEST_F(SnapshotFile, AFrameThatDoesNotFollowIsRefusedAndNothingIsWritten) {
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  writer.append(sample::frame(1), sample::series(1));
  EXPECT_THAT(error_of([&] { writer.append(sample::frame(1)); }), HasSubstr("run.h5:frame 1: time"));
  EXPECT_THAT(error_of([&] { writer.append(sample::frame(2), sample::series(1)); }), HasSubstr("last step 40000"));
  Snapshot bare = sample::frame(2);
  bare.particles.velocity.clear();
  EXPECT_THAT(error_of([&] { writer.append(bare); }), HasSubstr("/particles/velocity is absent"));
  Snapshot broken = sample::frame(2);
  broken.pp.normal_force[17] = NAN;
  EXPECT_THAT(error_of([&] { writer.append(broken); }),
              HasSubstr("run.h5:frame 1: /contacts/pp/normal_force row 17 is nan"));
  writer.append(sample::frame(2), sample::series(2));
  EXPECT_EQ(open_jamscope_file(path).frames, 2U);
  EXPECT_EQ(difference(open_jamscope_file(path).series, sample::joined(3)), "");
}

TEST_F(SnapshotFile, ASecondWriterIsNoticed) {
  SnapshotWriter first = SnapshotWriter::create(path, sample::info());
  first.append(sample::frame(0));
  SnapshotWriter second = SnapshotWriter::resume(path, 1000000);
  second.append(sample::frame(1));
  EXPECT_THAT(error_of([&] { first.append(sample::frame(1)); }), HasSubstr("another writer"));
  EXPECT_EQ(open_jamscope_file(path).frames, 2U);
}

TEST_F(SnapshotFile, ResumeCutsTheFutureAndContinues) {
  write_sample(path, 8);
  SnapshotWriter writer = SnapshotWriter::resume(path, 40000 * 5 - 1);
  EXPECT_EQ(writer.frames(), 5U);
  EXPECT_EQ(writer.last_step(), 160000U);
  EXPECT_EQ(difference(open_jamscope_file(path).series, sample::joined(5)), "");
  for (std::size_t k = 5; k < 10; ++k) writer.append(sample::frame(k), sample::series(k));
  const SnapshotSource source = open_jamscope_file(path);
  ASSERT_EQ(source.frames, 10U);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(difference(source.read(k), sample::frame(k)), "");
  EXPECT_EQ(difference(source.series, sample::joined(10)), "");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(SnapshotFile, ResumeBeforeTheFirstFrameLeavesAnEmptyFile) {
  write_sample(path, 2);
  SnapshotWriter cut = SnapshotWriter::resume(path, 0);
  EXPECT_EQ(cut.frames(), 1U);
  Snapshot s = sample::frame(0);
  s.step = 10;
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  writer.append(s);
  EXPECT_EQ(SnapshotWriter::resume(path, 9).frames(), 0U);
  EXPECT_EQ(open_jamscope_file(path).frames, 0U);
}

TEST_F(SnapshotFile, FilesOfOtherKindsAreToldApart) {
  EXPECT_FALSE(is_jamscope_file(path));
  h5::write_aside(path, [](h5::File& file) { file.set_attribute("/", "format", "jamscope-results"); });
  EXPECT_FALSE(is_jamscope_file(path));
  EXPECT_THAT(error_of([&] { open_jamscope_file(path); }), HasSubstr("not a snapshot file"));
  write_sample(path, 1);
  EXPECT_TRUE(is_jamscope_file(path));
  {
    h5::File file = h5::File::open_update(path);
    file.set_attribute("/", "schema_version", std::array<std::uint32_t, 2>{2, 0});
    file.close();
  }
  EXPECT_THAT(error_of([&] { open_jamscope_file(path); }), HasSubstr("/@schema_version: is 2.0, expected 1.x"));
}

TEST_F(SnapshotFile, CreatingWhereNothingCanBeWrittenNamesTheFile) {
  EXPECT_THAT(error_of([&] { SnapshotWriter::create(folder / "no" / "run.h5", sample::info()); }),
              HasSubstr("no/run.h5"));
}

}  // namespace
}  // namespace jam
