// Every command of README.md runs as it stands there, in a folder where the files that it names are those of a case that takes a second.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "libjam/snapshot/reader.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

namespace fs = std::filesystem;

// Lines of the blocks without a language that call the program; of the others only the build and its tests speak, which the CI runs.
std::vector<std::string> commands_of(const fs::path& path) {
  std::istringstream text(text_of(path));
  std::vector<std::string> commands;
  bool inside = false, plain = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      plain = inside && line == "```";
    } else if (plain && (line.starts_with("jamscope ") || line.starts_with("build/jamscope "))) {
      commands.push_back(line);
    }
  }
  return commands;
}

class Readme : public ::testing::Test {
 protected:
  Readme() : data_(JAMSCOPE_DATA_DIR) {
    fs::create_directories(at("build"));
    fs::create_directories(at("data/cases"));
    fs::create_directories(at("bin"));
    fs::create_symlink(JAMSCOPE_PROGRAM, at("build/jamscope"));
    fs::create_symlink(JAMSCOPE_PROGRAM, at("bin/jamscope"));
    for (const char* folder : {"maps", "reference"}) fs::create_directory_symlink(data_ / folder, at("data") / folder);
    for (const fs::directory_entry& entry : fs::directory_iterator(data_ / "cases")) fs::copy_file(entry.path(), at("data/cases") / entry.path().filename());
    // The case that data/reference/networks/pea.h5 was made from, with 60 frames, in which every jam is captured.
    std::string small = jam::open_jamscope_file(data_ / "reference/networks/pea.h5").info.case_toml;
    for (const char* name : {"ft4_quick", "spreading"}) std::ofstream(at("data/cases/" + std::string(name) + ".toml")) << small;
  }
  fs::path at(const std::string& name) const { return folder_ / name; }
  // In the folder, with the program on the path and beds kept there.
  int shell(const std::string& command) const {
    return std::system(("cd " + at("") .string() + " && export XDG_CACHE_HOME=$PWD/cache PATH=$PWD/bin:$PATH && { " + command + "\n} >out.txt 2>err.txt").c_str());
  }
  // A bench goes as far as the machine is fast, and this small vessel has a floor.
  void slow_down() const {
    const std::string name = at("data/cases/ft4_quick.toml").string(), text = text_of(name);
    const std::string slow = std::regex_replace(text, std::regex("tip_speed *=[^\n]*"), "tip_speed = \"0.1 mm/s\"");
    ASSERT_NE(slow, text);
    std::ofstream(name) << slow;
  }
  void lay_out(const char* from, const std::string& to) const {
    fs::remove_all(at(to));
    fs::copy(at(from), at(to), fs::copy_options::recursive);
  }

  Scratch folder_;
  fs::path data_;
};

TEST_F(Readme, CommandsRunAsTheyStand) {
  const std::string small =
      "--set run.duration='3 ms' --set output.frame_interval='0.05 ms' --set analysis.jam_force='1 N' --set output.capture_interval='0.02 ms' "
      "--set output.capture_before='0.1 ms' --set output.capture_after='0.1 ms'";
  ASSERT_EQ(shell("jamscope simulate data/cases/ft4_quick.toml -q -o run " + small), 0) << text_of(at("err.txt"));
  for (const char* name : {"down", "up", "a_down", "a_up", "b_down", "b_up", "c_down", "c_up"}) lay_out("run", name);
  for (int seed = 1; seed <= 4; ++seed)
    for (const char* group : {"glass_", "soft_"}) lay_out("run", group + std::to_string(seed));
  fs::copy_file(at("run/run.h5"), at("run.h5"));
  for (const char* file : {"particles.dump.xz", "pair.local.xz", "wall.local.xz"}) fs::copy_file(data_ / "formats" / ("liggghts." + std::string(file)), at(file));
  for (const fs::directory_entry& entry : fs::directory_iterator(data_ / "formats/csv"))
    if (entry.is_regular_file()) fs::copy_file(entry.path(), at(entry.path().filename().string()));

  const std::vector<std::string> commands = commands_of(data_ / "../README.md");
  EXPECT_GT(commands.size(), 20u);
  for (const std::string& command : commands) {
    if (command.find(" bench ") != std::string::npos) slow_down();
    EXPECT_EQ(shell(command), 0) << command << "\n" << text_of(at("err.txt"));
  }
}

}  // namespace
}  // namespace jamscope
