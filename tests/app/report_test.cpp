#include "apps/jamscope/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <regex>

namespace jamscope {
namespace {

using nlohmann::json;
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr float nanf_ = std::numeric_limits<float>::quiet_NaN();

struct Record {
  jam::RunInfo info;
  jam::Analysis analysis;
  jam::Series series;
  ReportContext context;
  SceneData scene = no_scene("These data are made up.");
  ReportRun run() const { return {info, analysis, series, context, scene}; }
};

jam::JamEvent event(std::uint32_t first, std::uint32_t samples, double interval, double peak) {
  jam::JamEvent e;
  e.first_frame = first;
  e.last_frame = first + samples - 1;
  e.samples = samples;
  e.start = first * interval;
  e.end = e.last_frame * interval;
  e.survival_time = samples * interval;
  e.shortest = (samples - 1) * interval;
  e.longest = (samples + 1) * interval;
  e.peak_force = peak;
  e.peak_time = (first + samples / 2) * interval;
  e.peak_particle = 1000 + 37 * first;
  e.peak_in_gap = first % 9 != 0;
  e.bridged = samples > 1;
  for (std::uint32_t k = 0; k <= samples / 3; ++k) e.members.push_back(e.peak_particle + k);
  return e;
}

// A made-up run of 2 s at 500 Hz with 23 jams of 1 to 30 samples, and a series every 0.1 ms: its numbers mean nothing,
// but hang together.
Record made_up_run() {
  Record r;
  constexpr double interval = 2e-3;
  constexpr std::uint32_t frames = 1000;
  r.context.facts.name = "glass beads, gap 0.8 D90";
  r.context.facts.description = "A made-up record, to look at the report.";
  r.context.derived = {{"Gap over mean diameter", "0.81", ""}, {"Rayleigh step of the smallest grain", "0.39", "µs"}};
  r.context.facts.command_line = {"jamscope", "report", "out dir"};
  r.context.facts.machine = "2 threads";
  r.context.facts.created_utc = "2025-01-01T00:00:00Z";
  r.context.facts.wall_seconds = 5321;
  r.context.facts.particle_steps_per_second = 4.2e6;
  r.context.facts.warnings = {"12 trailing bytes of an uncommitted frame ignored"};

  r.info.creator = "jamscope";
  r.info.creator_version = "0.1.0";
  r.info.commit = "c78a2e3";
  r.info.created_utc = "2025-01-01T00:00:00Z";
  r.info.case_toml = "name = \"glass\"\n[materials.glass]\nyoung = \"63 GPa\"\n";
  r.info.case_sha256 = "0123456789abcdef";
  r.info.argv = {"jamscope", "simulate", "glass.toml", "-o", "out"};
  r.info.seed = 18446744073709551615u;
  r.info.dt = 5e-8;
  r.info.materials = {{"glass", 2500, 63e9, 0.2}, {"steel", 7850, 210e9, 0.3}};
  r.info.interactions = {{{0.9, 0.3, 0.01, 0.02}, {0.8, 0.2, 0.01, 0.02}}, {{0.8, 0.2, 0.01, 0.02}, {0.7, 0.2, 0, 0}}};
  r.info.gap = {11.75e-3, 12.5e-3, -3e-3, 3e-3};
  jam::Wall vessel;
  vessel.name = "vessel";
  vessel.kind = "cylinder";
  vessel.role = jam::WallRole::vessel;
  vessel.material = "steel";
  vessel.radius = 12.5e-3;
  jam::Wall blade;
  blade.name = "blade";
  blade.kind = "mesh";
  blade.role = jam::WallRole::blade;
  blade.material = "steel";
  r.info.walls = {vessel, blade};

  auto& a = r.analysis;
  a.sampling_interval = interval;
  a.observed_time = frames * interval;
  for (std::uint32_t k = 0; k < 23; ++k) {
    const std::uint32_t samples = 1 + (k * k * 7) % 11 + (k % 7 == 3 ? 18 : 0);
    a.events.push_back(event(12 + 42 * k, samples, interval, 25.0 + 19.0 * ((k * 13) % 23)));
    a.jammed_time += samples * interval;
  }
  a.events.back().open_at_end = true;
  a.events.back().longest = inf;
  a.jam_frequency = 23 / a.observed_time;
  a.jammed_in_gap_share = 0.964;
  for (const auto& e : a.events) {
    jam::Track t;
    t.particle = e.peak_particle;
    t.event = e;
    t.event.members = {t.particle};
    for (std::uint32_t f = e.first_frame; f <= e.last_frame; ++f) {
      const double angle = 0.04 * f, radius = 12.03e-3 + 2e-5 * (f % 17);
      jam::Track::Point point;
      point.frame = f;
      point.position = {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)), static_cast<float>(0.03 - 2e-5 * f)};
      point.velocity = {static_cast<float>(0.01 * (f % 23)), 0, 0};
      point.compressive_force = e.peak_force * (f == (e.first_frame + e.last_frame) / 2 ? 1 : 0.7);
      t.points.push_back(point);
    }
    a.tracks.push_back(t);
  }
  const std::vector<double> bounds{0, 0.01, 0.02, 0.03, 0.04, 0.05, inf};
  for (std::size_t c = 0; c + 1 < bounds.size(); ++c) {
    jam::SurvivalClass s{bounds[c], bounds[c + 1], 0, 0, 0};
    for (const auto& e : a.events)
      if (e.survival_time >= s.low && e.survival_time < s.high) {
        ++s.events;
        s.share_of_jam_time += e.survival_time / a.jammed_time;
      }
    s.frequency = s.events / a.observed_time;
    a.survival_classes.push_back(s);
  }
  a.jammed_histogram.assign(5, 0);
  const auto during = [&](double time) -> const jam::JamEvent* {
    for (const auto& e : a.events)
      if (time > e.start - interval / 2 && time < e.end + interval / 2) return &e;
    return nullptr;
  };
  for (std::uint32_t f = 0; f < frames; ++f) {
    jam::FrameSummary s;
    s.time = f * interval;
    s.particles = 35000;
    s.coordination = 4.1 + 0.2 * std::sin(0.01 * f);
    s.coordination_with_walls = s.coordination + 0.3;
    s.mean_compressive_force = 2e-3 * (1 + 2 * s.time);
    s.largest_compressive_force = 0.4 * (1 + 3 * s.time) * (1.3 + std::sin(1.7 * f));
    if (const auto* e = during(s.time)) {
      s.largest_compressive_force = e->peak_force * (0.6 + 0.4 * std::abs(std::cos(0.9 * f)));
      s.jammed = 1 + (f % 5 == 0) + (f % 11 == 0) + (f % 31 == 0);
      s.jammed_in_gap = 1;
      s.bridges = e->bridged;
    }
    ++a.jammed_histogram[s.jammed];
    a.frames.push_back(s);
  }
  r.series.walls.resize(2);
  auto& w = r.series.walls[1];
  a.flow_energy.source = "series";
  for (std::uint32_t k = 1; k <= 20000; ++k) {
    const double t = k * 1e-4, base = 0.2 + 1.1 * t * t;
    const auto* e = during(t);
    const double pulse = e == nullptr ? 0 : 0.15 * e->peak_force * std::abs(std::sin(0.05 * k));
    const double f = base * (1 + 0.2 * std::sin(0.7 * k)) + pulse, torque = 2e-3 * f + 0.012 * pulse;
    r.series.time.push_back(t);
    r.series.step.push_back(2000ull * k);
    r.series.largest_compressive_force.push_back(static_cast<float>(e == nullptr ? 0.9 + t : e->peak_force * 1.1));
    r.series.jammed_count.push_back(e == nullptr ? 0 : 1 + k % 3);
    r.series.kinetic_energy.push_back(1e-5 * (1 + 0.1 * std::sin(0.01 * k)));
    r.series.largest_overlap.push_back(e == nullptr ? 2e-3 : 0.02);
    w.force.push_back({0, 0, f});
    w.force_min.push_back({-1, -1, f - 0.3 - 0.4 * pulse});
    w.force_max.push_back({1, 1, f + 0.5 + 1.5 * pulse});
    w.torque.push_back({0, 0, torque});
    w.torque_min.push_back({0, 0, 0.5 * torque});
    w.torque_max.push_back({0, 0, 2 * torque});
    w.power.push_back(20 * torque);
    a.flow_energy.total += 20 * torque * 1e-4;
    a.flow_energy.time.push_back(t);
    a.flow_energy.power.push_back(w.power.back());
    a.flow_energy.energy.push_back(a.flow_energy.total);
  }
  return r;
}

// What a record of another program may come down to: frames, no series, no wall loads, no case.
Record foreign_run() {
  Record r = made_up_run();
  r.series = {};
  r.info.case_toml.clear();
  r.info.creator = "LIGGGHTS dump";
  r.info.materials.clear();
  r.info.interactions.clear();
  r.info.gap = {};
  r.info.dt = 0;
  r.analysis.jammed_in_gap_share = std::numeric_limits<double>::quiet_NaN();
  r.analysis.flow_energy = {};
  r.analysis.flow_energy.source = "none";
  r.analysis.notes = {"flow energy: the wall loads were not recorded"};
  for (auto& t : r.analysis.tracks)
    for (auto& p : t.points) p.velocity.setConstant(nanf_);
  return r;
}

Record quiet_run() {
  Record r = made_up_run();
  auto& a = r.analysis;
  a.events.clear();
  a.tracks.clear();
  a.jammed_time = a.jam_frequency = 0;
  a.jammed_in_gap_share = std::numeric_limits<double>::quiet_NaN();
  a.jammed_histogram = {1000};
  for (auto& c : a.survival_classes) c.events = 0, c.frequency = c.share_of_jam_time = 0;
  for (auto& f : a.frames) f.jammed = f.jammed_in_gap = f.bridges = 0, f.largest_compressive_force = 0.5 + 0.5 * f.time;
  for (auto& f : r.series.largest_compressive_force) f = 3;
  for (auto& n : r.series.jammed_count) n = 0;
  return r;
}

std::string html(const Record& r) {
  return report_html({r.run()});
}

std::string island(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const auto from = page.find(open);
  if (from == std::string::npos) return "";
  return page.substr(from + open.size(), page.find("</script>", from) - from - open.size());
}

json data(const Record& r) {
  return json::parse(island(html(r)))["runs"][0];
}

TEST(Report, HoldsTheNumbersOfTheAnalysis) {
  const Record r = made_up_run();
  const json d = data(r);
  EXPECT_EQ(d["name"], "glass beads, gap 0.8 D90");
  EXPECT_EQ(d["headline"]["events"], 23);
  EXPECT_EQ(d["headline"]["censored"], 1);
  EXPECT_DOUBLE_EQ(d["headline"]["jam_frequency"], 11.5);
  // 6 digits are written
  EXPECT_NEAR(d["headline"]["jammed_share"], r.analysis.jammed_time / 2.0, 1e-6);
  EXPECT_DOUBLE_EQ(d["headline"]["jammed_in_gap_share"], 0.964);
  EXPECT_EQ(d["headline"]["particles"], 35000);
  EXPECT_EQ(d["events"].size(), 23u);
  EXPECT_DOUBLE_EQ(d["events"][3]["start"], r.analysis.events[3].start);
  EXPECT_DOUBLE_EQ(d["events"][3]["survival_time"], r.analysis.events[3].survival_time);
  EXPECT_EQ(d["events"][3]["members"].size(), r.analysis.events[3].members.size());
  EXPECT_EQ(d["survival_classes"].size(), 6u);
  EXPECT_EQ(d["survival_classes"][0]["events"], r.analysis.survival_classes[0].events);
  EXPECT_EQ(d["jammed_histogram"].get<std::vector<std::uint32_t>>(), r.analysis.jammed_histogram);
  EXPECT_EQ(d["run"]["case_toml"], r.info.case_toml);
  EXPECT_EQ(d["report"]["command_line"], json({"jamscope", "report", "out dir"}));
}

TEST(Report, TakesTheLargestForceFromTheSeriesBecauseItSawEveryStep) {
  const Record r = made_up_run();
  double largest = 0;
  for (const auto& e : r.analysis.events) largest = std::max(largest, e.peak_force);
  const json h = data(r)["headline"];
  EXPECT_EQ(h["largest_force_source"], "series");
  EXPECT_NEAR(h["largest_force"], 1.1 * largest, 1e-3);  // stored as float, written with 6 digits
  EXPECT_EQ(data(foreign_run())["headline"]["largest_force_source"], "frames");
}

TEST(Report, SaysAboveWhichForceTheRunCountedItsGrains) {
  Record r = made_up_run();
  r.info.watch_force = 12;
  EXPECT_EQ(data(r)["series"]["watch_force"], 12);
  r.info.watch_radius = 5e-4;  // of each grain another
  EXPECT_TRUE(data(r)["series"]["watch_force"].is_null());
}

TEST(Report, WritesASeedTooLargeForJavaScriptAsText) {
  EXPECT_EQ(data(made_up_run())["run"]["seed"], "18446744073709551615");
}

TEST(Report, GivesTheBladeTheZComponentsOfItsLoads) {
  const Record r = made_up_run();
  const json b = data(r)["series"]["blades"];
  ASSERT_EQ(b.size(), 1u);
  EXPECT_EQ(b[0]["name"], "blade");
  EXPECT_NEAR(b[0]["force_mean"][499], r.series.walls[1].force[499].z(), 1e-4);
  EXPECT_NEAR(b[0]["torque_high"][499], r.series.walls[1].torque_max[499].z(), 1e-6);
}

TEST(Report, GivesTheRadiusAndSpeedOfAJammedGrainAtItsPeak) {
  const Record r = made_up_run();
  const auto& track = r.analysis.tracks[3];
  const jam::Track::Point* peak = &track.points[0];
  double speed = 0;
  for (const auto& p : track.points) {
    if (p.compressive_force > peak->compressive_force) peak = &p;
    speed += p.velocity.x() / static_cast<double>(track.points.size());
  }
  const json t = data(r)["tracks"][3];
  EXPECT_NEAR(t["radius"], std::hypot(peak->position.x(), peak->position.y()), 1e-7);
  EXPECT_NEAR(t["height"], peak->position.z(), 1e-7);
  EXPECT_NEAR(t["mean_speed"], speed, 1e-6);
}

TEST(Report, ThinsALongSeriesWithoutLosingAPeak) {
  Record r = made_up_run();
  r.series.largest_compressive_force[12345] = 4321;
  r.series.walls[1].force_max[12345].z() = 987;
  r.series.walls[1].force_min[777].z() = -987;
  const json d = json::parse(report_json({r.run()}, 300))["runs"][0];
  const json& s = d["series"];
  EXPECT_EQ(s["rows"], 20000);
  EXPECT_EQ(s["every"], 67);  // 20000 / 300 rounded up
  EXPECT_EQ(s["time"].size(), 299u);
  EXPECT_EQ(s["largest_force"][12345 / 67], 4321);
  EXPECT_EQ(s["blades"][0]["force_high"][12345 / 67], 987);
  EXPECT_EQ(s["blades"][0]["force_low"][777 / 67], -987);
  EXPECT_DOUBLE_EQ(s["time"].back(), 2.0);
  double mean = 0;
  for (std::size_t k = 67; k < 134; ++k) mean += r.series.walls[1].force[k].z() / 67;
  EXPECT_NEAR(s["blades"][0]["force_mean"][1], mean, 1e-5);
}

TEST(Report, KeepsTheStrongestEventsWhenThereAreTooMany) {
  Record r = made_up_run();
  r.analysis.events.clear();
  for (std::uint32_t k = 0; k < 1000; ++k) r.analysis.events.push_back(event(5 * k, 2, 2e-3, 20 + (k * 7919) % 1000));
  const json d = json::parse(report_json({r.run()}, 500))["runs"][0];
  EXPECT_EQ(d["headline"]["events"], 1000);
  ASSERT_EQ(d["events"].size(), 100u);
  double last = -1;
  for (const auto& e : d["events"]) {
    EXPECT_GE(e["peak_force"], 920);  // forces are 20 to 1019, all different
    EXPECT_GT(e["start"], last);
    last = e["start"];
  }
}

TEST(Report, StaysBelowItsLargestSizeForALongRun) {
  Record r = made_up_run();
  r.series.walls.resize(r.info.walls.size());
  for (auto* column : {&r.series.walls[1].force, &r.series.walls[1].force_min, &r.series.walls[1].force_max,
                       &r.series.walls[1].torque, &r.series.walls[1].torque_min, &r.series.walls[1].torque_max})
    column->assign(200000, jam::Vec3::Constant(-std::numbers::pi * 1e-7));
  r.series.time.clear();
  for (int k = 0; k < 200000; ++k) r.series.time.push_back(k * 1e-5 * std::numbers::pi);
  r.series.largest_compressive_force.assign(200000, 1.2345678e-9f);
  r.series.kinetic_energy.assign(200000, 1.2345678e-9);
  for (int k = 0; k < 20000; ++k) {
    r.analysis.tracks.push_back(r.analysis.tracks[3]);
    r.analysis.events.push_back(r.analysis.events[3]);
    r.analysis.events.back().members.assign(500, 4000000000u);
  }
  r.info.case_toml = std::string(3'000'000, '<');
  const std::string page = html(r);
  EXPECT_LT(page.size(), largest_report);
  EXPECT_GT(island(page).size(), 1'250'000u);  // and uses the room it has
  EXPECT_LT(island(page).size(), 5'000'000u);
}

TEST(Report, EscapesWhateverANameHolds) {
  Record r = made_up_run();
  const std::string name = "</script><script>alert(1)</script><!-- \xE2\x80\xA8 \xE2\x80\xA9 \" \\ & \x01";
  r.context.facts.name = name;
  r.info.walls[1].name = name;
  const std::string page = html(r), inner = island(page);
  EXPECT_EQ(inner.find('<'), std::string::npos);
  EXPECT_EQ(inner.find("\xE2\x80\xA8"), std::string::npos);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(json::parse(inner)["runs"][0]["name"], name);
}

TEST(Report, ReplacesBytesThatAreNotUtf8) {
  Record r = made_up_run();
  r.info.materials[0].name = "gl\xFFss";
  EXPECT_EQ(data(r)["run"]["materials"][0]["name"], "gl\xEF\xBF\xBDss");
}

TEST(Report, WritesWhatIsNotANumberAsNull) {
  Record r = made_up_run();
  r.analysis.frames[7].largest_compressive_force = inf;
  r.analysis.frames[8].mean_compressive_force = std::numeric_limits<double>::quiet_NaN();
  const json d = data(r);
  EXPECT_TRUE(d["frames"]["largest_force"][7].is_null());
  EXPECT_TRUE(d["frames"]["mean_force"][8].is_null());
  EXPECT_TRUE(d["survival_classes"].back()["high"].is_null());
  EXPECT_TRUE(d["events"].back()["longest"].is_null());
}

TEST(Report, LeavesOutWhatTheDataDoesNotKnow) {
  const json d = data(foreign_run());
  EXPECT_TRUE(d["series"].is_null());
  EXPECT_TRUE(d["flow_energy"]["total"].is_null());
  EXPECT_TRUE(d["flow_energy"]["time"].empty());
  EXPECT_TRUE(d["headline"]["jammed_in_gap_share"].is_null());
  EXPECT_TRUE(d["run"]["gap"]["tip_radius"].is_null());
  EXPECT_TRUE(d["tracks"][0]["mean_speed"].is_null());
  EXPECT_FALSE(d["tracks"][0]["radius"].is_null());
  Record partial = made_up_run();
  partial.series.walls[1].force_min.clear();
  partial.series.kinetic_energy.clear();
  const json s = data(partial)["series"];
  EXPECT_TRUE(s["blades"][0]["force_low"].empty());
  EXPECT_TRUE(s["kinetic_energy"].empty());
  EXPECT_EQ(s["blades"][0]["force_mean"].size(), 20000u);
}

TEST(Report, OfNothingAtAllIsStillAPage) {
  const json d = data({});
  EXPECT_EQ(d["headline"]["events"], 0);
  EXPECT_TRUE(d["headline"]["observed_time"].is_null());
  EXPECT_TRUE(d["headline"]["jammed_share"].is_null());
  EXPECT_TRUE(d["headline"]["largest_force"].is_null());
  EXPECT_TRUE(d["series"].is_null());
  EXPECT_TRUE(d["frames"]["time"].empty());
}

TEST(Report, LoadsNothingFromANetwork) {
  const std::string page = html(quiet_run());
  EXPECT_FALSE(std::regex_search(page, std::regex(R"re((src|href)\s*=\s*["']?\s*(https?:)?//)re", std::regex::icase)));
  EXPECT_FALSE(std::regex_search(
      page, std::regex(R"re((url\(|@import|import\()\s*["'`]?\s*(https?:)?//)re", std::regex::icase)));
  EXPECT_FALSE(std::regex_search(page, std::regex(R"re(fetch\(|XMLHttpRequest|WebSocket|sendBeacon)re")));
  // and the browser is told to refuse if it did
  EXPECT_NE(page.find("content=\"default-src 'none'; script-src 'unsafe-inline'"), std::string::npos);
}

TEST(Report, CarriesTheLicenceOfWhatItContains) {
  const std::string page = html(quiet_run());
  EXPECT_NE(page.find("Copyright (c) 2022 Leon Sorokin"), std::string::npos);
  EXPECT_NE(page.find("three.js authors"), std::string::npos);
}

TEST(Report, IsTheSameForTheSameInput) {
  EXPECT_EQ(html(made_up_run()), html(made_up_run()));
}

// Opens the page in a browser, where there is one, and returns the document it drew.
class ReportInABrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium >/dev/null 2>&1 && command -v timeout >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "no chromium on this machine";
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("report_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
               std::to_string(std::random_device{}()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  std::string drawn(const std::string& page) const {
    const auto file = folder_ / "report.html", out = folder_ / "dom.html";
    std::ofstream(file) << page;
    const std::string command =
        "timeout -k 5 120 chromium --headless --no-sandbox --disable-gpu --disable-background-networking "
        "--window-size=1300,900 --user-data-dir='" +
        (folder_ / "profile").string() + "' --virtual-time-budget=3000 --dump-dom 'file://" + file.string() + "' >'" +
        out.string() + "' 2>/dev/null";
    if (std::system(command.c_str()) != 0) return "chromium failed";
    std::ifstream in(out);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::filesystem::path folder_;
};

TEST_F(ReportInABrowser, DrawsEveryPlotAndTheHeadline) {
  const std::string dom = drawn(html(made_up_run()));
  EXPECT_NE(dom.find("data-state=\"ready\""), std::string::npos) << dom.substr(0, 2000);
  EXPECT_NE(dom.find("<title>glass beads, gap 0.8 D90 · jamscope report</title>"), std::string::npos);
  EXPECT_NE(dom.find("95 % interval 7.29 … 17.3"), std::string::npos);
  std::size_t plots = 0;
  for (auto at = dom.find("<canvas"); at != std::string::npos; at = dom.find("<canvas", at + 1)) ++plots;
  EXPECT_EQ(plots, 11u);
}

TEST_F(ReportInABrowser, SaysThatNothingJammed) {
  const std::string dom = drawn(html(quiet_run()));
  EXPECT_NE(dom.find("data-state=\"ready\""), std::string::npos) << dom.substr(0, 2000);
  EXPECT_NE(dom.find("No jam above 20 N in this record."), std::string::npos);
  EXPECT_NE(dom.find("below 1.84 Hz (95 %)"), std::string::npos);  // -ln(0.025) / 2 s
}

TEST_F(ReportInABrowser, ShowsAnErrorWhenTheDataIsBroken) {
  std::string page = html(made_up_run());
  page.replace(page.find("\"format\":\"jamscope-report\""), 8, "\"fxrmat\"");
  const std::string dom = drawn(page);
  EXPECT_NE(dom.find("data-state=\"error\""), std::string::npos) << dom.substr(0, 2000);
  EXPECT_NE(dom.find("This report cannot be shown"), std::string::npos);
}

}  // namespace
}  // namespace jamscope
