// What a power cut, a kill, a full disk or a bad copy leaves behind: the committed frames, bit for bit, or an error
// that names the file; never a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <dlfcn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include "libjam/snapshot/reader.hpp"
#include "libjam/snapshot/writer.hpp"
#include "tests/jam/snapshot/sample_run.hpp"

// HDF5 1.10 does not free everything when it gives up on a damaged file.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5";
}  // NOLINT: the sanitizer's name

// Everything that HDF5 writes goes through these two; they take the place of the C library's and keep a log of it.
namespace {
struct DiskWrite {
  std::size_t at = 0;
  std::string bytes;
};
std::vector<DiskWrite>* disk_log = nullptr;
}  // namespace

extern "C" ssize_t pwrite(int fd, const void* data, size_t size, off_t at) {  // NOLINT: the C library's names
  static const auto real = reinterpret_cast<decltype(&pwrite)>(dlsym(RTLD_NEXT, "pwrite"));
  if (disk_log != nullptr) disk_log->push_back({std::size_t(at), {static_cast<const char*>(data), size}});
  return real(fd, data, size, at);
}

namespace jam {
namespace {

using sample::difference;
using sample::error_of;
using testing::HasSubstr;

class DamagedFile : public sample::InFolder {};

void write_sample(const std::filesystem::path& path, std::size_t frames) {
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  for (std::size_t k = 0; k < frames; ++k) writer.append(sample::frame(k), sample::series(k));
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

// Every frame that the source promises must be there and be the original. Returns how many.
std::size_t check_all(const SnapshotSource& source) {
  for (std::size_t k = 0; k < source.frames; ++k) EXPECT_EQ(difference(source.read(k), sample::frame(k)), "") << k;
  EXPECT_EQ(difference(source.series, sample::joined(source.frames)), "");
  return source.frames;
}

// A child process that does `work` and leaves without cleaning up.
template <class F>
pid_t in_child(F&& work) {
  const pid_t child = fork();
  if (child != 0) return child;
  int code = 0;
  try {
    code = work();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "child: %s\n", e.what());
    code = 99;
  }
  _exit(code);
}

int exit_code(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(DamagedFile, AKillDuringAppendLosesAtMostTheOpenFrame) {
  std::mt19937 random(7);
  std::size_t most = 0, unclosed = 0;
  for (int trial = 0; trial < 24; ++trial) {
    std::filesystem::remove(path);
    // The child reports each finished append with one byte.
    std::array<int, 2> pipe_ends{};
    ASSERT_EQ(pipe(pipe_ends.data()), 0);
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = in_child([&] {
      SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
      for (std::size_t k = 0;; ++k) {
        writer.append(sample::frame(k), sample::series(k));
        if (write(pipe_ends[1], "x", 1) != 1) return 1;
      }
    });
    close(pipe_ends[1]);
    char byte = 0;
    ASSERT_EQ(read(pipe_ends[0], &byte, 1), 1);  // the first frame is there
    // Long enough for a few more, however slow the machine: the first took `once` with the making of the file.
    const auto once = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
    const std::int64_t longest = std::max<std::int64_t>(40000, 3 * once.count());
    std::this_thread::sleep_for(std::chrono::microseconds(std::int64_t(random()) % longest));
    kill(child, SIGKILL);
    EXPECT_EQ(exit_code(child), -1);
    std::size_t reported = 1;
    while (read(pipe_ends[0], &byte, 1) == 1) ++reported;
    close(pipe_ends[0]);

    const SnapshotSource source = open_jamscope_file(path);
    const std::size_t frames = check_all(source);
    // The kill may fall between the commit and the report.
    EXPECT_GE(frames, reported);
    EXPECT_LE(frames, reported + 1);
    most = std::max(most, frames);
    if (h5::condition_of(path).unclosed) {
      ++unclosed;
      EXPECT_THAT(source.warnings, testing::Contains(HasSubstr("killed")));
    }

    // And the run goes on.
    SnapshotWriter writer = SnapshotWriter::resume(path, UINT64_MAX);
    EXPECT_EQ(writer.frames(), frames);
    writer.append(sample::frame(frames), sample::series(frames));
    const SnapshotSource repaired = open_jamscope_file(path);
    EXPECT_THAT(repaired.warnings, testing::IsEmpty());
    EXPECT_EQ(check_all(repaired), frames + 1);
  }
  EXPECT_GT(most, 1U);
  EXPECT_GT(unclosed, 0U);  // or the kills never hit an append
}

// A kill can end a frame between any two writes, and a long write between any two pages of memory. Bookkeeping that lay
// across two pages would be lost with its checksum, and with it every frame of a column.
TEST_F(DamagedFile, AKillBetweenAnyTwoPagesWrittenKeepsEveryCommittedFrame) {
  constexpr std::size_t page = 4096, committed = 5;
  write_sample(path, committed);
  SnapshotWriter writer = SnapshotWriter::resume(path, UINT64_MAX);
  std::string bytes = bytes_of(path);
  std::vector<DiskWrite> log;
  disk_log = &log;
  writer.append(sample::frame(committed), sample::series(committed));
  disk_log = nullptr;

  const std::filesystem::path killed = folder / "killed.h5";
  std::size_t states = 0;
  for (const DiskWrite& w : log) {
    if (w.bytes.size() <= page) {
      EXPECT_EQ(w.at / page, (w.at + w.bytes.size() - 1) / page) << w.bytes.size() << " bytes at " << w.at;
    }
    for (std::size_t from = 0; from < w.bytes.size();) {
      const std::size_t size = std::min(w.bytes.size() - from, page - (w.at + from) % page);
      bytes.resize(std::max(bytes.size(), w.at + from + size));
      bytes.replace(w.at + from, size, w.bytes, from, size);
      from += size;
      if (++states % 10 != 0) continue;
      put(killed, bytes);
      const SnapshotSource source = open_jamscope_file(killed);
      const std::size_t frames = check_all(source);
      EXPECT_GE(frames, committed) << "byte " << from << " of " << w.bytes.size() << " written at " << w.at;
    }
  }
  EXPECT_GT(states, 100U);
  const std::string written = bytes_of(path);
  bytes.resize(written.size());  // closing rounds the file up to whole pages
  EXPECT_TRUE(bytes == written) << "something was written by another way";
}

TEST_F(DamagedFile, ASecondProcessReadsEveryCommittedFrameWhileTheFirstAppends) {
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  const pid_t child = in_child([&] {
    std::size_t seen = 0;
    while (seen < 30) {
      const SnapshotSource source = open_jamscope_file(path);
      if (source.frames < seen) return 2;
      seen = source.frames;
      if (seen == 0) continue;
      if (!difference(source.read(seen - 1), sample::frame(seen - 1)).empty()) return 3;
      if (!difference(source.read(seen / 2), sample::frame(seen / 2)).empty()) return 4;
      if (!difference(source.series, sample::joined(seen)).empty()) return 5;
    }
    return 0;
  });
  for (std::size_t k = 0; k < 30; ++k) writer.append(sample::frame(k), sample::series(k));
  EXPECT_EQ(exit_code(child), 0);
}

TEST_F(DamagedFile, AViewerThatHoldsTheFileOpenDoesNotStopTheWriter) {
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  writer.append(sample::frame(0), sample::series(0));
  writer.append(sample::frame(1), sample::series(1));
  std::array<int, 2> to_parent{}, to_child{};
  ASSERT_EQ(pipe(to_parent.data()), 0);
  ASSERT_EQ(pipe(to_child.data()), 0);
  const pid_t child = in_child([&] {
    char byte = 0;
    const h5::File file = h5::File::open(path);
    if (write(to_parent[1], "x", 1) != 1 || read(to_child[0], &byte, 1) != 1) return 1;
    std::vector<float> radii = sample::frame(0).particles.radius;
    return file.read_rows<float>("/particles/radius", 0, radii.size()) == radii ? 0 : 2;
  });
  char byte = 0;
  ASSERT_EQ(read(to_parent[0], &byte, 1), 1);
  writer.append(sample::frame(2), sample::series(2));
  ASSERT_EQ(write(to_child[1], "x", 1), 1);
  EXPECT_EQ(exit_code(child), 0);
  EXPECT_EQ(check_all(open_jamscope_file(path)), 3U);
}

TEST_F(DamagedFile, ATruncatedFileGivesItsCompleteFramesOrAnError) {
  constexpr std::size_t frames = 24;
  write_sample(path, frames);
  const std::string whole = bytes_of(path);
  std::size_t most = 0, opened = 0;
  for (std::size_t part = 0; part < 20; ++part) {
    const std::filesystem::path cut = folder / "cut.h5";
    put(cut, whole.substr(0, whole.size() * part / 20));
    try {
      const SnapshotSource source = open_jamscope_file(cut);
      ++opened;
      most = std::max(most, check_all(source));
      EXPECT_LT(source.frames, frames);
      EXPECT_THAT(source.warnings, testing::Contains(HasSubstr("cut.h5: cut short")));
    } catch (const DataError& e) {
      EXPECT_THAT(e.what(), HasSubstr("cut.h5")) << part;
    }
  }
  // About half of so short a file are tables with room for 512 frames.
  EXPECT_GE(opened, 6U);
  EXPECT_GE(most, 4U);
}

TEST_F(DamagedFile, FlippedBitsAreFoundOrDoNoHarm) {
  write_sample(path, 4);
  const std::string whole = bytes_of(path);
  std::mt19937 random(11);
  std::size_t found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::string bytes = whole;
    // Half of the flips near the start, where most of the file's own bookkeeping lies.
    const std::size_t at = random() % (trial % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 40000));
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
    const std::filesystem::path flipped = folder / "flipped.h5";
    put(flipped, bytes);
    try {
      const SnapshotSource source = open_jamscope_file(flipped);
      check_all(source);
      if (source.frames < 4) {
        EXPECT_THAT(source.warnings, testing::Not(testing::IsEmpty()));
      }
    } catch (const DataError& e) {
      ++found;
      EXPECT_THAT(e.what(), HasSubstr("flipped.h5")) << at;
    }
  }
  EXPECT_GT(found, 40U);
}

TEST_F(DamagedFile, BlocksOfNoiseNeverCrashTheReader) {
  write_sample(path, 3);
  const std::string whole = bytes_of(path);
  std::mt19937 random(13);
  for (int trial = 0; trial < 60; ++trial) {
    std::string bytes = whole;
    const std::size_t length = 1 + random() % 512, at = random() % (bytes.size() - length);
    for (std::size_t i = at; i < at + length; ++i) bytes[i] = static_cast<char>(trial % 3 == 0 ? 0xFF : random());
    put(folder / "noise.h5", bytes);
    try {
      check_all(open_jamscope_file(folder / "noise.h5"));
    } catch (const DataError& e) {
      EXPECT_THAT(e.what(), HasSubstr("noise.h5")) << at;
    }
  }
}

TEST_F(DamagedFile, AFullDiskIsAnErrorThatLeavesTheCommittedFramesIntact) {
  write_sample(path, 3);
  const auto size = std::filesystem::file_size(path);
  for (const std::uintmax_t room : {0, 1000, 5000, 20000}) {
    const pid_t child = in_child([&] {
      std::signal(SIGXFSZ, SIG_IGN);  // then a file at its limit is a failed write, as on a full disk
      rlimit limit{size + room, RLIM_INFINITY};
      setrlimit(RLIMIT_FSIZE, &limit);
      SnapshotWriter writer = SnapshotWriter::resume(path, UINT64_MAX);
      try {
        for (std::size_t k = writer.frames(); k < 40; ++k) writer.append(sample::frame(k), sample::series(k));
      } catch (const DataError& e) {
        if (std::string(e.what()).find(path.string()) != 0) return 2;
      }
      if (writer.frames() == 40) return 3;
      // Room is made, and the same process goes on.
      limit.rlim_cur = RLIM_INFINITY;
      setrlimit(RLIMIT_FSIZE, &limit);
      const std::size_t frames = writer.frames();
      SnapshotWriter repaired = SnapshotWriter::resume(path, UINT64_MAX);
      if (repaired.frames() != frames) return 4;
      repaired.append(sample::frame(frames), sample::series(frames));
      return check_all(open_jamscope_file(path)) == frames + 1 ? 0 : 5;
    });
    EXPECT_EQ(exit_code(child), 0) << room;
    const SnapshotSource source = open_jamscope_file(path);
    EXPECT_GE(check_all(source), 4U);
    SnapshotWriter writer = SnapshotWriter::resume(path, 80000);
    EXPECT_EQ(writer.frames(), 3U);
    EXPECT_EQ(check_all(open_jamscope_file(path)), 3U);
  }
}

}  // namespace
}  // namespace jam
