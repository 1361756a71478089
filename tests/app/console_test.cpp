#include "apps/jamscope/console.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/program.hpp"

namespace jamscope {
namespace {

Progress sample() {
  Progress p;
  p.stage = "simulate";
  p.unit = std::string("s");  // not a plain literal: GCC bug 105651
  p.done = 0.0124;
  p.total = 2;
  p.step = 248000;
  p.particle_steps_per_second = 4.1e6;
  p.contacts = 91234;
  p.largest_overlap = 0.031;
  p.jammed = 2;
  p.events = 7;
  return p;
}

TEST(Progress, TextHasEverythingThatIsKnownAndNothingElse) {
  EXPECT_EQ(
      progress_text(sample(), 11520),
      "simulate 0.0124/2 s  left 3 h 12 min  jammed 2  events 7  4.1e+06 grain steps/s  contacts 91234  overlap 3.1 % R  "
      "step 248000");
  Progress bare;
  bare.stage = "read";
  bare.unit = "frames";
  bare.done = 3;
  bare.total = 10;
  EXPECT_EQ(progress_text(bare, std::numeric_limits<double>::quiet_NaN()), "read 3/10 frames");
}

// A narrow terminal shows whole parts, how long it takes first.
TEST(Progress, TextFitsItsColumns) {
  EXPECT_EQ(progress_text(sample(), 11520, 79), "simulate 0.0124/2 s  left 3 h 12 min  jammed 2  events 7  4.1e+06 grain steps/s");
  const std::string shortest = "simulate 0.0124/2 s  left 3 h 12 min";
  EXPECT_EQ(progress_text(sample(), 11520, shortest.size()), shortest);
  EXPECT_EQ(progress_text(sample(), 11520, shortest.size() - 1), "simulate 0.0124/2 s");  // nothing after what has no room
  EXPECT_EQ(progress_text(sample(), 11520, 8), "simulate");
}

TEST(Progress, JsonIsOneObjectOfWhatIsKnown) {
  const auto json = nlohmann::json::parse(progress_json(sample(), 10, 11520));
  EXPECT_EQ(json["log"], "progress");
  EXPECT_EQ(json["step"], 248000);
  EXPECT_EQ(json["left_s"], 11520);
  EXPECT_FALSE(json.contains("largest_force_N"));
}

TEST(Progress, DurationsReadWell) {
  EXPECT_EQ(duration_text(0.42), "0.4 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(125), "2 min 5 s");
  EXPECT_EQ(duration_text(11520), "3 h 12 min");
  EXPECT_EQ(duration_text(86400 * 16 + 36000), "16 d 10 h");
  EXPECT_EQ(duration_text(1e300), "very long");
}

TEST(Console, WritesPlainLinesWhereThereIsNoTerminal) {
  const Scratch scratch;
  const std::string path = scratch / "log";
  std::FILE* const file = std::fopen(path.c_str(), "w");
  {
    Console console(file);
    console.note("hello");
    console.warning("careful");
    console.progress(sample());  // not due yet
    console.finished(sample());
  }
  std::fclose(file);
  const std::string text = text_of(path);
  EXPECT_THAT(text, testing::StartsWith("hello\nwarning: careful\nsimulate 0.0124/2 s  jammed 2"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Console, JsonLinesAreAllJson) {
  const Scratch scratch;
  const std::string path = scratch / "log";
  std::FILE* const file = std::fopen(path.c_str(), "w");
  {
    Console console(file, LogFormat::jsonl);
    console.note("with \"quotes\" and \xff");
    console.finished(sample());
  }
  std::fclose(file);
  std::istringstream lines(text_of(path));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_TRUE(nlohmann::json::accept(line)) << line;
  EXPECT_EQ(count, 2);
}

TEST(Console, QuietKeepsWarnings) {
  const Scratch scratch;
  const std::string path = scratch / "log";
  std::FILE* const file = std::fopen(path.c_str(), "w");
  {
    Console console(file, LogFormat::text, true);
    console.note("hello");
    console.finished(sample());
    console.warning("careful");
  }
  std::fclose(file);
  EXPECT_EQ(text_of(path), "warning: careful\n");
}

TEST(StopSignals, TheFirstOneIsRemembered) {
  catch_stop_signals();
  EXPECT_FALSE(stop_requested());
  std::raise(SIGTERM);
  EXPECT_TRUE(stop_requested());
  catch_stop_signals();
  EXPECT_FALSE(stop_requested());
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace
}  // namespace jamscope
