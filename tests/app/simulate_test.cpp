// The whole road through the built program: case file, simulation, stored frames, analysis, results.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <thread>

#include "libjam/results_file.hpp"
#include "libjam/snapshot/reader.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

// A vessel of the size of a pea with about 130 beads: every part of the road in a second or two.
constexpr const char* pea = R"(
[case]
name = "pea"
[material.glass]
density = "2500 kg/m3"
young = "63 GPa"
poisson = 0.2
[material.steel]
density = "7800 kg/m3"
young = "210 GPa"
poisson = 0.3
[interaction.glass-glass]
restitution = 0.9
friction = 0.5
rolling_friction = 0.01
work_of_adhesion = "0.274 J/m2"
[interaction.glass-steel]
restitution = 0.9
friction = 0.3
rolling_friction = 0.01
work_of_adhesion = "0.274 J/m2"
[vessel]
material = "glass"
diameter = "8 mm"
[blade]
material = "steel"
kind = "twisted"
diameter = "6.5 mm"
height = "2 mm"
thickness = "0.8 mm"
tip_twist = "30 deg"
twist_exponent = 1.0
shaft_diameter = "1.5 mm"
tip_cut = "cylindrical"
start_height = "0.9 mm"
[motion]
tip_speed = "250 mm/s"
helix_angle = "-5 deg"
rotation = "counter-clockwise"
[bed]
material = "glass"
mean_diameter = "0.925 mm"
size_low = 0.8
size_high = 1.2
depth = "3 mm"
seed = 1
[run]
duration = "2 ms"
step = "50 ns"
[output]
frame_interval = "0.1 ms"
series_interval = "0.02 ms"
checkpoint_interval = "0.5 ms"
)";

// Rows of a table without its header; what is no number is 0.
std::vector<std::vector<double>> numbers(const std::string& csv) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line, cell;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

class SimulateProgram : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "pea.toml") << pea;
    // The bed settles once for all tests of this process.
    static Scratch beds;
    cache_ = beds / "beds";
  }
  std::string command(const std::string& out, const std::string& more = "", int threads = 1) const {
    return "simulate " + (folder_ / "pea.toml") + " -o " + (folder_ / out) + " --bed-cache " + cache_ + " -q --threads " +
           std::to_string(threads) + " " + more;
  }
  Scratch folder_;
  std::string cache_;
};

nlohmann::json summary(const std::string& folder) { return nlohmann::json::parse(text_of(folder + "/summary.json")); }

// All frames and series rows of a run as one text of bytes.
std::string numbers_of(const std::string& path) {
  const jam::SnapshotSource source = jam::open_jamscope_file(path);
  std::string bytes;
  const auto add = [&bytes](const auto& rows) {
    bytes.append(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(rows[0]));
  };
  for (std::size_t k = 0; k < source.frames; ++k) {
    const jam::Snapshot s = source.read(k);
    add(std::vector<double>{s.time});
    add(s.particles.position);
    add(s.particles.velocity);
    add(s.particles.angular_velocity);
    add(s.particles.compressive_force);
    add(s.pp.row);
    add(s.pp.normal_force);
    add(s.pp.damping_force);
    add(s.pp.tangential_force);
    add(s.pp.overlap);
    add(s.pp.birth_step);
    add(s.pw.row);
    add(s.pw.facet);
    add(s.pw.normal_force);
    add(s.pw.tangential_force);
    for (const jam::WallState& w : s.walls) add(std::vector<jam::Vec3>{w.force, w.torque});
  }
  add(source.series.time);
  add(source.series.kinetic_energy);
  add(source.series.largest_overlap);
  for (const auto& wall : source.series.walls) add(wall.force);
  return bytes;
}

TEST_F(SimulateProgram, RunsFromCaseToReportTheSameForAnyThreadsAndAgainFromItsFile) {
  const Outcome one = run_program(command("one"));
  ASSERT_EQ(one.code, 0) << one.err;
  for (const char* name : {"run.h5", "run.xdmf", "jam.h5", "events.csv", "summary.json", "report.html", "run.restart.h5"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / ("one/" + std::string(name)))) << name;
  EXPECT_EQ(jam::open_jamscope_file(folder_ / "one/run.h5").frames, 21u);
  EXPECT_EQ(jam::open_jamscope_file(folder_ / "one/run.h5").series.size(), 100u);

  // Again, with the bed from its store, and with two threads.
  ASSERT_EQ(run_program(command("two", "", 2)).code, 0);
  EXPECT_TRUE(numbers_of(folder_ / "one/run.h5") == numbers_of(folder_ / "two/run.h5"));

  const Outcome again = run_program("analyze " + (folder_ / "one/run.h5") + " -o " + (folder_ / "again"));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(text_of(folder_ / "one/events.csv"), text_of(folder_ / "again/events.csv"));
  EXPECT_EQ(summary(folder_ / "one")["analysis"].dump(), summary(folder_ / "again")["analysis"].dump());
  // Grains go with the blade that drives them, more slowly than its tip.
  const nlohmann::json flow = summary(folder_ / "one")["analysis"]["flow_pattern"]["speed_over_tip"];
  double fastest = 0;
  for (std::size_t k = 0; k < flow.size(); k += 3)
    if (!flow[k].is_null()) fastest = std::max(fastest, flow[k].get<double>());
  EXPECT_GT(fastest, 0.01);
  EXPECT_LT(fastest, 1);

  // The page of the running simulation is that of its files.
  const std::string page = text_of(folder_ / "one/report.html");
  ASSERT_EQ(run_program("report -q " + (folder_ / "one")).code, 0);
  EXPECT_TRUE(text_of(folder_ / "one/report.html") == page);
}

TEST_F(SimulateProgram, ResumesToTheSameNumbersAsAnUninterruptedRun) {
  for (const std::string step : {"", " --set run.step=auto"}) {
    SCOPED_TRACE(step);
    const std::string number = std::to_string(step.size());
    ASSERT_EQ(run_program(command("whole" + number, step)).code, 0);
    ASSERT_EQ(run_program(command("parts" + number, "--until '0.73 ms'" + step)).code, 0);
    const Outcome rest = run_program(command("parts" + number, "--resume" + step, 2));
    ASSERT_EQ(rest.code, 0) << rest.err;
    // The part that ended between two frames recorded its last instant, which the whole run did not.
    const auto whole = jam::open_jamscope_file(folder_ / ("whole" + number + "/run.h5")), parts = jam::open_jamscope_file(folder_ / ("parts" + number + "/run.h5"));
    ASSERT_EQ(parts.frames, whole.frames + 1);
    const jam::Snapshot a = whole.read(whole.frames - 1), b = parts.read(parts.frames - 1);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.particles.position, b.particles.position);
    EXPECT_EQ(a.particles.velocity, b.particles.velocity);
    EXPECT_EQ(a.pp.row, b.pp.row);
    EXPECT_EQ(a.pp.tangential_force, b.pp.tangential_force);
    EXPECT_EQ(a.walls[2].force, b.walls[2].force);
  }
}

// Jams of every step, with a threshold so low that many grains pass it: the same from the run, from its file, from its file in parts, and from a run
// that was stopped in their midst; and the fine frames hold each of them whole.
TEST_F(SimulateProgram, FollowsJamsFromStepToStepAndCapturesThem) {
  const std::string options = "--set analysis.jam_force='1 N' --set output.capture_interval='0.02 ms' --set output.capture_before='0.1 ms' --set output.capture_after='0.1 ms' ";
  ASSERT_EQ(run_program(command("whole", options)).code, 0);
  const std::string jams = text_of(folder_ / "whole/jams.csv");
  ASSERT_EQ(run_program(command("parts", options + "--until '0.73 ms'")).code, 0);
  ASSERT_EQ(run_program(command("parts", options + "--resume", 2)).code, 0);
  EXPECT_EQ(text_of(folder_ / "parts/jams.csv"), jams);

  const std::string file = folder_ / "whole/run.h5";
  ASSERT_EQ(run_program("analyze " + file + " -q -o " + (folder_ / "again")).code, 0);
  EXPECT_EQ(text_of(folder_ / "again/jams.csv"), jams);
  const char* const ranges[] = {"0:4", "4:15", "15:"};
  for (const char* range : ranges)
    ASSERT_EQ(run_program("analyze " + file + " -q --partial --frames " + range + " -o " + (folder_ / ("part" + std::string(range)))).code, 0);
  const Outcome merged = run_program("merge -q " + (folder_ / "part15:") + " " + (folder_ / "part0:4") + " " + (folder_ / "part4:15") + " -o " + (folder_ / "merged"));
  ASSERT_EQ(merged.code, 0) << merged.err;
  for (const char* name : {"events.csv", "jams.csv", "jam.h5"})
    EXPECT_TRUE(text_of(folder_ / ("merged/" + std::string(name))) == text_of(folder_ / ("again/" + std::string(name)))) << name;
  EXPECT_EQ(summary(folder_ / "merged")["analysis"].dump(), summary(folder_ / "again")["analysis"].dump());
  EXPECT_EQ(run_program("merge -q " + (folder_ / "part0:4") + " " + (folder_ / "part15:") + " -o " + (folder_ / "gap")).code, 3);
  EXPECT_EQ(run_program("analyze " + file + " --frames 5:5 -o " + (folder_ / "none")).code, 2);

  // The page takes frames of capture.h5 too, and again when it is built from the files.
  const std::string page = text_of(folder_ / "whole/report.html");
  ASSERT_EQ(run_program("report -q " + (folder_ / "whole")).code, 0);
  EXPECT_TRUE(text_of(folder_ / "whole/report.html") == page);

  const jam::SnapshotSource capture = jam::open_jamscope_file(folder_ / "whole/capture.h5");
  std::vector<double> time;
  for (std::size_t k = 0; k < capture.frames; ++k) time.push_back(capture.read(k).time);
  std::istringstream rows(jams);
  std::string line;
  std::getline(rows, line);
  int whole = 0;
  while (std::getline(rows, line)) {
    std::istringstream cells(line);
    std::string stream, start, end;
    std::getline(cells, stream, ',');
    std::getline(cells, start, ',');
    std::getline(cells, end, ',');
    const double from = std::stod(start), to = std::min(std::stod(end), 2e-3 - 0.02e-3);
    const auto first = std::upper_bound(time.begin(), time.end(), std::max(from, 0.02e-3) + 1e-12);
    ASSERT_NE(first, time.begin()) << line;  // a frame before it
    const auto last = std::lower_bound(time.begin(), time.end(), to - 1e-12);
    ASSERT_NE(last, time.end()) << line;  // and one after it
    for (auto t = first; t <= last && t != time.end(); ++t) EXPECT_LT(*t - *(t - 1), 0.0201e-3) << line;
    ++whole;
  }
  EXPECT_GT(whole, 5);

  // The way of the members of a jam: as the tracks have it where they have it, and the contacts add up to the forces.
  const jam::Analysis analysis = jam::read_results(folder_ / "whole/jam.h5");
  ASSERT_FALSE(analysis.events.empty());
  const jam::JamEvent& event = analysis.events[0];
  const std::size_t followed = std::min<std::size_t>(event.last_frame + 2, analysis.frames.size());
  const std::string follow = "follow -q " + file + " --jam 0 --set analysis.jam_force='1 N' --frames 0:" + std::to_string(followed);
  const Outcome path = run_program(follow), contacts = run_program(follow + " --of contacts");
  ASSERT_EQ(path.code, 0) << path.err;
  ASSERT_EQ(contacts.code, 0) << contacts.err;
  std::map<std::pair<int, unsigned>, std::vector<double>> way;
  for (const std::vector<double>& row : numbers(path.out)) way[{int(row[0]), unsigned(row[2])}] = row;
  EXPECT_EQ(way.size(), event.members.size() * followed);
  std::size_t points = 0;
  for (const jam::Track& track : analysis.tracks)
    for (const jam::Track::Point& point : track.points) {
      const auto at = way.find({int(point.frame), track.particle});
      if (at == way.end()) continue;
      ++points;
      const std::vector<double>& row = at->second;
      EXPECT_EQ(row[1], analysis.frames[point.frame].time);
      EXPECT_FLOAT_EQ(float(row[3]), point.position.x());
      EXPECT_FLOAT_EQ(float(row[6]), point.from_blade.x());
      EXPECT_FLOAT_EQ(float(row[12]), point.speed_over_tip);
      EXPECT_NEAR(row[18], point.compressive_force, 1e-6 * point.compressive_force);
      EXPECT_EQ(row[22], 1);
    }
  EXPECT_GT(points, 0u);
  std::map<std::pair<int, unsigned>, double> pushed;
  for (const std::vector<double>& row : numbers(contacts.out)) pushed[{int(row[0]), unsigned(row[2])}] += std::max(row[5], 0.0);
  for (const auto& [key, row] : way) EXPECT_NEAR(pushed[key], row[18], 1e-5 * row[18] + 1e-12);
  for (const auto& [key, row] : way) {
    const auto next = way.find({key.first + 1, key.second});
    if (next != way.end()) {
      EXPECT_GE(next->second[16], row[16]);
    }
  }
  EXPECT_THAT(run_program("follow -q " + file + " --particles 99999").err, HasSubstr("no grain 99999"));
  EXPECT_EQ(run_program("follow -q " + file + " --jam 99999").code, 2);
  EXPECT_EQ(run_program("follow -q " + file).code, 2);
}

TEST_F(SimulateProgram, BenchSaysHowFastAndWhereTheTimeGoes) {
  const std::string options = "bench " + (folder_ / "pea.toml") + " --bed-cache " + cache_ + " --seconds 0.3 --warm-up 0.1 -q --threads 1";
  const Outcome text = run_program(options + " --auto");
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("grain steps per second"));
  const auto of = [&](const std::string& more) { return nlohmann::json::parse(run_program(options + " --json" + more).out); };
  const nlohmann::json levels = of(" --auto"), uniform = of(" --uniform");
  EXPECT_GT(levels["levels"], 0);
  EXPECT_EQ(uniform["levels"], 0);
  EXPECT_EQ(uniform["evaluations_over_uniform"], 1.0);
  EXPECT_LT(levels["evaluations_over_uniform"], 1.0);
  EXPECT_EQ(run_program(options + " --auto --uniform").code, 2);
  for (const nlohmann::json& j : {levels, uniform}) {
    EXPECT_GT(j["particle_steps_per_second"], 0);
    EXPECT_GT(j["bytes_per_grain"], 500);  // its own rows alone
    EXPECT_NEAR(double(j["share_stepping"]) + double(j["share_lists"]) + double(j["share_rest"]), 1, 1e-9);
  }
}

TEST_F(SimulateProgram, RefusesToResumeAnotherCaseAndToOverwrite) {
  ASSERT_EQ(run_program(command("out", "--until '0.1 ms'")).code, 0);
  const Outcome over = run_program(command("out"));
  EXPECT_EQ(over.code, 2);
  EXPECT_THAT(over.err, HasSubstr("holds a run: --resume to go on with it, or --overwrite"));
  const Outcome other = run_program(command("out", "--resume --set motion.tip_speed='100 mm/s'"));
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("another case"));
  EXPECT_EQ(run_program(command("nothing", "--resume")).code, 3);
}

// A signal makes it checkpoint, close its files and stop.
TEST_F(SimulateProgram, KilledAtTwentyRandomMomentsItLeavesAFileThatCanBeReadAndResumed) {
  ASSERT_EQ(run_program(command("whole")).code, 0);
  const std::string expected = numbers_of(folder_ / "whole/run.h5");
  std::mt19937 random(2026);
  int readable = 0, resumed = 0;
  for (int round = 0; round < 20; ++round) {
    const std::string out = "killed" + std::to_string(round);
    const pid_t child = fork();
    if (child == 0) {
      const int null = open("/dev/null", O_WRONLY);
      dup2(null, 1);
      dup2(null, 2);
      execl("/bin/sh", "sh", "-c", ("exec " JAMSCOPE_PROGRAM " " + command(out)).c_str(), nullptr);
      _exit(127);
    }
    // The first frame exists once the bed is there; from then on any moment will do.
    const std::string file = folder_ / (out + "/run.h5");
    for (int wait = 0; wait < 3000 && !std::filesystem::exists(folder_ / (out + "/run.restart.h5")); ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 600000));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);

    const Outcome inspect = run_program("inspect " + file);
    EXPECT_EQ(inspect.code, 0) << inspect.err;
    const Outcome analyze = run_program("analyze " + file + " -q -o " + (folder_ / (out + "-analysis")));
    EXPECT_EQ(analyze.code, 0) << analyze.err;
    readable += inspect.code == 0 && analyze.code == 0;
    if (round % 4 == 0) {
      const Outcome rest = run_program(command(out, "--resume"));
      EXPECT_EQ(rest.code, 0) << rest.err;
      EXPECT_TRUE(numbers_of(file) == expected) << "round " << round;
      ++resumed;
    }
  }
  EXPECT_EQ(readable, 20);
  EXPECT_EQ(resumed, 5);
}

TEST_F(SimulateProgram, AnInterruptLeavesACheckpointToGoOnFrom) {
  const pid_t child = fork();
  if (child == 0) {
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, 1);
    dup2(null, 2);
    execl("/bin/sh", "sh", "-c", ("exec " JAMSCOPE_PROGRAM " " + command("out", "--set run.duration='30 ms'")).c_str(), nullptr);
    _exit(127);
  }
  for (int wait = 0; wait < 300000 && !std::filesystem::exists(folder_ / "out/run.restart.h5"); ++wait)  // its bed settles first
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/report.html"));
  EXPECT_EQ(jam::open_jamscope_file(folder_ / "out/run.h5").warnings.size(), 0u);
}

}  // namespace
}  // namespace jamscope
