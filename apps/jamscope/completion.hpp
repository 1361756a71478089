// Scripts that complete commands and options in a shell, made from the parser's own table.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace jamscope {

// shell: "bash", "zsh" or "fish". Knows every subcommand and option of `app`; an option whose type is a list of words,
// "csv|json", and a positional argument of that kind complete to these words, all others to file names.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace jamscope
