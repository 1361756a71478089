#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

// Runs a script with a shell; its output, or "FAILED" with what it said.
std::string run_shell(const std::string& shell, const std::string& script) {
  const Scratch scratch;
  std::ofstream(scratch / "script") << script;
  const int status = std::system((shell + " " + scratch / "script" + " >" + scratch / "out" + " 2>" + scratch / "err").c_str());
  return status == 0 ? text_of(scratch / "out") : "FAILED " + text_of(scratch / "err");
}

// What bash offers after these words, the last of which is being typed.
std::set<std::string> completions(const std::string& words) {
  const std::string out = run_shell("bash", "source <(" JAMSCOPE_PROGRAM " completion bash)\nCOMP_WORDS=(jamscope " + words +
                                                ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_jamscope\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
  std::istringstream lines(out);
  std::set<std::string> found;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) found.insert(line);
  }
  return found;
}

std::vector<std::string> subcommands() {
  std::istringstream help(run_program("--help").out);
  std::vector<std::string> names;
  std::string line;
  while (std::getline(help, line) && line != "Subcommands:") {
  }
  while (std::getline(help, line) && !line.empty()) {
    std::string name;
    std::istringstream(line) >> name;
    names.push_back(name);
  }
  return names;
}

TEST(Completion, BashKnowsEveryCommandOfTheHelp) {
  const std::set<std::string> offered = completions("\"\"");
  const std::vector<std::string> names = subcommands();
  ASSERT_GT(names.size(), 5U);
  for (const std::string& name : names) EXPECT_TRUE(offered.count(name)) << name;
  EXPECT_EQ(offered.size(), names.size() + 2);  // and --help, --version
  EXPECT_EQ(completions("exp"), std::set<std::string>{"export"});
}

TEST(Completion, BashKnowsEveryOptionOfTheHelpOfEveryCommand) {
  for (const std::string& name : subcommands()) {
    const std::string help = run_program(name + " --help").out;
    std::set<std::string> in_help;
    const std::regex option("(^|[\\n ,])(--[a-z][a-z-]*)");
    const std::string options = help.substr(0, help.find("\n\nExample"));
    std::istringstream lines(options);
    for (std::string line; std::getline(lines, line);) {
      // Lines of options begin with "  -"; what else their descriptions mention is no option of this command.
      std::smatch found;
      if (line.rfind("  -", 0) == 0 && std::regex_search(line, found, option)) in_help.insert(found[2]);
    }
    ASSERT_TRUE(in_help.count("--help")) << name;
    EXPECT_EQ(completions(name + " --"), in_help) << name;
  }
}

TEST(Completion, BashKnowsTheWordsOfAnOption) {
  EXPECT_EQ(completions("export run.h5 --to \"\""), (std::set<std::string>{"vtp", "lammps", "csv", "graphml"}));
  EXPECT_EQ(completions("export run.h5 --to gr"), std::set<std::string>{"graphml"});
  EXPECT_EQ(completions("metrics --format j"), std::set<std::string>{"json"});
  EXPECT_EQ(completions("completion \"\""), (std::set<std::string>{"bash", "zsh", "fish"}));
  // Nothing of ours: bash then offers files.
  EXPECT_EQ(completions("analyze --map \"\""), std::set<std::string>{});
  EXPECT_EQ(completions("inspect \"\""), std::set<std::string>{});
  EXPECT_THAT(run_shell("bash", "source <(" JAMSCOPE_PROGRAM " completion bash)\ncomplete -p jamscope\n"),
              HasSubstr("complete -o default -F _jamscope jamscope"));
}

TEST(Completion, OtherShellsReadTheirScripts) {
  EXPECT_EQ(run_program("completion tcsh").code, 2);
  const bool zsh = std::system("command -v zsh >/dev/null 2>&1") == 0, fish = std::system("command -v fish >/dev/null 2>&1") == 0;
  EXPECT_THAT(run_program("completion fish").out, HasSubstr("complete -c jamscope -f -n __fish_use_subcommand -a export -d "));
  EXPECT_THAT(run_program("completion zsh").out, HasSubstr("bashcompinit"));
  if (zsh) {
    EXPECT_THAT(run_shell("zsh -f", "autoload -U +X compinit && compinit -u\nsource <(" JAMSCOPE_PROGRAM
                                    " completion zsh)\nwhence -w _jamscope\nprint $_comps[jamscope]\n"),
                HasSubstr("_jamscope: function"));
  }
  if (fish) {
    EXPECT_EQ(run_shell("fish", JAMSCOPE_PROGRAM " completion fish | source\ncomplete -C 'jamscope export run.h5 --to g'\n").substr(0, 7),
              "graphml");
  }
}

}  // namespace
}  // namespace jamscope
