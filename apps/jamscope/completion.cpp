#include "apps/jamscope/completion.hpp"

#include <fmt/format.h>

#include <vector>

namespace jamscope {
namespace {

struct Option {
  std::vector<std::string> spellings;  // "-o", "--output"; empty: positional
  std::vector<std::string> words;      // its choices; empty: anything
  bool takes_value = false;
  std::string doc;
};

struct Subcommand {
  std::string name, doc;
  std::vector<Option> options;
};

// "csv|json" -> csv, json. Types of other options are one word in capitals.
std::vector<std::string> choices(const std::string& type) {
  std::vector<std::string> words;
  if (type.find('|') == std::string::npos) return words;
  for (std::size_t begin = 0; begin <= type.size();) {
    const std::size_t end = std::min(type.find('|', begin), type.size());
    words.push_back(type.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::vector<Subcommand> table_of(const CLI::App& app) {
  std::vector<Subcommand> table;
  for (const CLI::App* sub : app.get_subcommands({})) {
    Subcommand& command = table.emplace_back(Subcommand{sub->get_name(), sub->get_description(), {}});
    for (const CLI::Option* option : sub->get_options()) {
      Option& o = command.options.emplace_back();
      for (const std::string& name : option->get_snames()) o.spellings.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) o.spellings.push_back("--" + name);
      o.words = choices(option->get_type_name());
      o.takes_value = option->get_items_expected_max() > 0;
      o.doc = option->get_description();
    }
  }
  return table;
}

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

// Every name in here is made of letters, digits and hyphens (the parser takes no others) and needs no quotes.
std::string bash_script(const std::vector<Subcommand>& table) {
  std::vector<std::string> names;
  std::string options, values, positionals;
  for (const Subcommand& command : table) {
    names.push_back(command.name);
    std::vector<std::string> spellings;
    for (const Option& option : command.options) {
      spellings.insert(spellings.end(), option.spellings.begin(), option.spellings.end());
      if (option.spellings.empty() && !option.words.empty())
        positionals += fmt::format("    {}) words=\"{}\" ;;\n", command.name, joined(option.words));
      if (!option.takes_value) continue;
      for (const std::string& spelling : option.spellings)
        values += fmt::format("    {}:{}) COMPREPLY=($(compgen -W \"{}\" -- \"$current\")); return ;;\n", command.name, spelling,
                              joined(option.words));
    }
    options += fmt::format("    {}) options=\"{}\" ;;\n", command.name, joined(spellings));
  }
  return fmt::format(
      R"(# Completion of jamscope for bash, made by `jamscope completion bash`.
_jamscope() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" previous="${{COMP_WORDS[COMP_CWORD-1]}}" command="${{COMP_WORDS[1]}}"
  local options="" words=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{} --help --version" -- "$current"))
    return
  fi
  # The value of an option: one of its words, or a file.
  case "$command:$previous" in
{}  esac
  case "$command" in
{}  esac
  case "$command" in
{}  esac
  if [[ "$current" == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  fi
}}
complete -o default -F _jamscope jamscope
)",
      joined(names), values, options, positionals);
}

std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "'";
}

std::string fish_script(const std::vector<Subcommand>& table) {
  std::string text = "# Completion of jamscope for fish, made by `jamscope completion fish`.\n";
  for (const Subcommand& command : table) {
    text += fmt::format("complete -c jamscope -f -n __fish_use_subcommand -a {} -d {}\n", command.name, fish_quoted(command.doc));
    const std::string seen = fmt::format("-n '__fish_seen_subcommand_from {}'", command.name);
    for (const Option& option : command.options) {
      std::string line = "complete -c jamscope " + seen;
      for (const std::string& spelling : option.spellings)
        line += spelling.rfind("--", 0) == 0 ? " -l " + spelling.substr(2) : " -s " + spelling.substr(1);
      if (option.spellings.empty() && option.words.empty()) continue;
      if (!option.words.empty())
        line += (option.spellings.empty() ? " -f -a " : " -x -a ") + fish_quoted(joined(option.words));
      else if (option.takes_value)
        line += " -r";
      text += line + " -d " + fish_quoted(option.doc) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  const std::vector<Subcommand> table = table_of(app);
  if (shell == "fish") return fish_script(table);
  // zsh reads bash's completions with a module of its own.
  if (shell == "zsh") return "autoload -U +X bashcompinit && bashcompinit\n" + bash_script(table);
  return bash_script(table);
}

}  // namespace jamscope
