#include "apps/jamscope/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "apps/jamscope/analyze.hpp"
#include "apps/jamscope/bench.hpp"
#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/check.hpp"
#include "apps/jamscope/claims.hpp"
#include "apps/jamscope/compare.hpp"
#include "apps/jamscope/checkpoint.hpp"
#include "apps/jamscope/completion.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/export.hpp"
#include "apps/jamscope/follow.hpp"
#include "apps/jamscope/inspect.hpp"
#include "apps/jamscope/network_metrics.hpp"
#include "apps/jamscope/report_command.hpp"
#include "apps/jamscope/simulate.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "apps/jamscope/version.hpp"
#include "libdem/errors.hpp"
#include "libjam/errors.hpp"

namespace jamscope {
namespace {

using Command = std::function<int()>;

// Whatever the subcommands parse into; lives as long as the parser.
struct Options {
  std::vector<std::string> command_line;
  std::string case_path;
  std::vector<std::string> overrides;
  bool json = false;
  SimulateOptions simulate;
  std::string until, shortest;
  AnalyzeOptions analyze;
  InspectOptions inspect;
  MetricsOptions metrics;
  FollowOptions follow;
  CompareOptions compare;
  ClaimsOptions claims;
  MergeOptions merge;
  BenchOptions bench;
  ReportOptions report;
  ExportOptions export_;
  std::string shell;
};

const std::map<std::string, LogFormat> log_formats{{"text", LogFormat::text}, {"jsonl", LogFormat::jsonl}};

// s, of an option's text with its unit.
double time_of(const char* option, const std::string& text) try {
  return to_si(text, dimension::time);
} catch (const UnitError& error) {
  throw UsageError(fmt::format("{} {}", option, error.what()));
}

void add_overrides(CLI::App& command, std::vector<std::string>& overrides, const char* example) {
  // Without allow_extra_args(false) the option would swallow every argument up to the next option.
  command.add_option("--set", overrides, fmt::format("replace one key, may be repeated: {}", example))
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

// One of some words. CLI11's own check speaks of its table of numbers.
template <class Choice>
CLI::Validator one_of(const std::map<std::string, Choice>& choices) {
  return {[choices](std::string& text) -> std::string {
            std::vector<std::string> words;
            for (const auto& [word, choice] : choices) words.push_back(word);
            const auto found = choices.find(text);
            if (found == choices.end()) return fmt::format("'{}' is no choice{}", text, suggestion(text, words));
            text = std::to_string(static_cast<int>(found->second));
            return {};
          },
          ""};
}

void add_log_options(CLI::App& command, bool& quiet, LogFormat& format) {
  command.add_flag("-q,--quiet", quiet, "no progress, only warnings and errors");
  command.add_option("--log-format", format, "progress for people (text) or for machines (jsonl)")
      ->transform(one_of(log_formats))
      ->type_name("text|jsonl");
}

// CLI11's own checks say "not in range 0 to 1.8e308" with all its digits.
CLI::Validator number_from(double least, bool itself) {
  return {[least, itself](std::string& text) -> std::string {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && (value > least || (itself && value == least))) return {};
            return fmt::format("{} is no number {} {}", text, itself ? "from" : "above", least);
          },
          ""};
}

void add_threads(CLI::App& command, int& threads, const char* doc) {
  command.add_option("-t,--threads", threads, doc)
      ->check(CLI::Range(1, 4096).description(""))
      ->type_name("N")
      ->capture_default_str();
}

void add_bed_cache(CLI::App& command, std::string& folder) {
  folder = default_bed_cache();
  command.add_option("--bed-cache", folder, "folder in which settled beds are kept for later runs; \"\" keeps none")
      ->type_name("DIR")
      ->capture_default_str();
}

void add_input(CLI::App& command, InputOptions& input) {
  command.add_option("INPUT", input.paths, "file of snapshots (run.h5), or another code's dumps with --map")
      ->required()
      ->type_name("");
  command.add_option("--map", input.map, "TOML file that names the dumps' columns, units and walls")->type_name("FILE");
  command.add_option("--blade", input.blade, "the wall that is the blade, whatever the data say")->type_name("NAME");
  command.add_option("--vessel", input.vessel, "the wall that is the vessel")->type_name("NAME");
}

Command add_check(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("check", "read a case and print what follows from it; simulates nothing");
  c.add_option("CASE", o.case_path, "case file (TOML)")->required()->type_name("");
  add_overrides(c, o.overrides, "--set bed.depth=\"4 mm\"");
  c.add_flag("--json", o.json, "for machines, in SI units");
  c.footer("Example:\n  jamscope check data/cases/ft4_a_down.toml --set run.step=\"2.5e-8 s\"");
  return [&o] {
    const CaseFile file = read_case_file(o.case_path, o.overrides);
    fmt::print("{}", o.json ? check_json(file) : check_text(file));
    return 0;
  };
}

Command add_simulate(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("simulate", "simulate a case, analyse it in place and write the report");
  SimulateOptions& s = o.simulate;
  c.add_option("CASE", s.case_path, "case file (TOML)")->required()->type_name("");
  c.add_option("-o,--output", s.output, "folder for all results")->required()->type_name("DIR");
  s.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  add_threads(c, s.threads, "number of threads; the results do not depend on it");
  c.add_flag("--resume", s.resume, "continue from the last checkpoint in DIR");
  c.add_option("--until", o.until, "stop at this simulated time, for example \"0.5 s\"")->type_name("TIME");
  add_overrides(c, s.overrides, "--set bed.depth=\"4 mm\"");
  add_bed_cache(c, s.bed_cache);
  c.add_flag("--overwrite", s.overwrite, "replace the results of an earlier run in DIR");
  add_log_options(c, s.quiet, s.log_format);
  c.footer("Example:\n  jamscope simulate data/cases/ft4_quick.toml -o quick --threads 2");
  return [&o] {
    if (!o.until.empty()) o.simulate.until = time_of("--until", o.until);
    o.simulate.command_line = o.command_line;
    return simulate(o.simulate);
  };
}

Command add_analyze(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("analyze", "find the jams in stored snapshots");
  AnalyzeOptions& a = o.analyze;
  add_input(c, a.input);
  c.add_option("-o,--output", a.output, "folder for jam.h5, events.csv, summary.json and report.html")
      ->required()
      ->type_name("DIR");
  c.add_option("--criteria", a.criteria, "TOML file with an [analysis] table; default: that of the run's own case")
      ->type_name("FILE");
  add_overrides(c, a.overrides, "--set analysis.jam_force=\"5 N\"");
  c.add_option("--frames", a.frames, "from frame A to before frame B, counted from 0; default: all")->type_name("A:B");
  c.add_flag("--partial", a.partial, "write partial.h5 for `jamscope merge` instead of results");
  c.add_flag("--overwrite", a.overwrite, "replace the results of an earlier analysis in DIR");
  a.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  add_threads(c, a.threads, "number of threads; the results do not depend on it");
  add_log_options(c, a.quiet, a.log_format);
  c.footer(
      "Examples:\n  jamscope analyze run/run.h5 -o jams --set jam_force=\"5 N\"\n"
      "  jamscope analyze atoms.dump pairs.dump --map map.toml -o jams");
  return [&o] {
    o.analyze.command_line = o.command_line;
    return analyze(o.analyze);
  };
}

Command add_merge(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("merge", "put parts of an analysis together");
  MergeOptions& m = o.merge;
  c.add_option("PART", m.parts, "partial.h5 of `analyze --partial`, or folders that hold one, in any order")->required()->type_name("");
  c.add_option("-o,--output", m.output, "folder for the results")->required()->type_name("DIR");
  c.add_flag("--partial", m.partial, "write the parts as one part");
  c.add_flag("--overwrite", m.overwrite, "replace earlier results in DIR");
  c.add_flag("-q,--quiet", m.quiet, "no output");
  c.footer("Example, on two machines:\n  jamscope analyze run.h5 --frames 0:500 --partial -o a\n"
           "  jamscope analyze run.h5 --frames 500: --partial -o b\n  jamscope merge a b -o jams");
  return [&o] {
    o.merge.command_line = o.command_line;
    return merge(o.merge);
  };
}

Command add_inspect(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("inspect", "say what a file holds, whether it is valid, what it lacks");
  add_input(c, o.inspect.input);
  c.add_flag("--json", o.inspect.json, "for machines");
  c.add_flag("-q,--quiet", o.inspect.quiet, "no progress");
  c.footer("Example:\n  jamscope inspect run/run.h5");
  return [&o] { return inspect(o.inspect); };
}

Command add_metrics(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("metrics", "network metrics of every frame, particle or contact, as a table on standard output");
  MetricsOptions& m = o.metrics;
  add_input(c, m.input);
  c.add_option("--frame", m.frame, "this frame only, counted from 0; default: every frame")->type_name("K");
  const std::map<std::string, MetricsOf> parts{{"frames", MetricsOf::frames},
                                               {"changes", MetricsOf::changes},
                                               {"particles", MetricsOf::particles},
                                               {"contacts", MetricsOf::contacts}};
  c.add_option("--of", m.of, "a row for each of these (default: frames)")
      ->transform(one_of(parts))
      ->type_name("frames|changes|particles|contacts");
  auto* const names = c.add_option("--metric", m.names, "names from the list below, separated by commas; default: those without *")
                          ->delimiter(',')
                          ->allow_extra_args(false)
                          ->type_name("NAME,...");
  c.add_flag("--all", m.all, "all metrics of the list, those with * too")->excludes(names);
  const std::map<std::string, TableFormat> formats{{"csv", TableFormat::csv}, {"json", TableFormat::json}};
  c.add_option("--format", m.format, "csv or json")
      ->transform(one_of(formats))
      ->type_name("csv|json");
  c.footer(metric_list() +
           "\nExamples:\n  jamscope metrics run/run.h5 --metric coordination,bridge_strength > bridge.csv\n"
           "  jamscope metrics run/run.h5 --of particles --frame 3 > grains.csv");
  m.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  add_threads(c, m.threads, "number of threads; the results do not depend on it");
  c.add_flag("-q,--quiet", m.quiet, "no progress");
  return [&o] { return network_metrics(o.metrics); };
}

Command add_follow(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("follow", "the way of some grains through a run, before, in and after their jams, as a table on standard output");
  FollowOptions& m = o.follow;
  add_input(c, m.input);
  auto* const particles = c.add_option("--particles", m.particles, "ids, separated by commas")->delimiter(',')->allow_extra_args(false)->type_name("ID,...");
  c.add_option("--jam", m.jam, "the members of this jam, counted from 0 as in the global rows of events.csv")->type_name("K")->excludes(particles);
  c.add_option("--results", m.results, "folder with the analysis that has the jam; default: that of INPUT")->type_name("DIR");
  c.add_option("--frames", m.frames, "from frame A to before frame B; default: all, or those around the jam")->type_name("A:B");
  const std::map<std::string, FollowOf> parts{{"path", FollowOf::path}, {"contacts", FollowOf::contacts}};
  c.add_option("--of", m.of, "where each grain is and what it does (path), or each of its contacts (contacts)")
      ->transform(one_of(parts))
      ->type_name("path|contacts");
  add_overrides(c, m.overrides, "--set analysis.jam_force=\"5 N\"");
  c.add_flag("-q,--quiet", m.quiet, "no progress");
  c.footer("Examples:\n  jamscope follow run/run.h5 --jam 0 > path.csv\n  jamscope follow run/run.h5 --particles 17,204 --of contacts > touches.csv");
  return [&o] { return follow(o.follow); };
}

Command add_compare(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("compare", "jams of several runs side by side, and whether they differ");
  CompareOptions& m = o.compare;
  c.add_option("RUN", m.runs, "folders with results, or their jam.h5; the first is compared with each of the others")->required()->type_name("");
  auto* const against = c.add_option("--against", m.against, "a second group of such runs: compared as groups, seeds of one condition with seeds of another")->type_name("RUN ...");
  c.add_flag("--paired", m.paired, "the first of each group began from the same bed, and so on: what beds differ by is left out")->needs(against);
  const std::map<std::string, CompareBy> ways{{"step", CompareBy::step}, {"frame", CompareBy::frame}};
  c.add_option("--by", m.by, "jams of every step (default), or those of frames, with rates corrected for what frames miss")
      ->transform(one_of(ways))
      ->type_name("step|frame");
  c.add_option("--stream", m.stream, "of every step: any grain's jams as one (default), each grain's, or each site's")->type_name("global|particle|site");
  c.add_flag("--json", m.json, "for machines");
  c.footer("Examples:\n  jamscope compare down up\n  jamscope compare seed1 seed2 seed3 --stream particle\n  jamscope compare glass_1 glass_2 glass_3 glass_4 --against soft_1 soft_2 soft_3 soft_4\n  jamscope compare coarse_* --against fine_* --paired");
  return [&o] { return compare(o.compare); };
}

Command add_claims(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("claims", "measure statements about runs, each with its verdict, from the runs' summaries");
  ClaimsOptions& m = o.claims;
  c.add_option("RUN", m.runs, "folders with a summary.json, such files, or folders of either")->required()->type_name("");
  c.add_option("--claims", m.claims, "TOML file of [claim.NAME] tables")->required()->type_name("FILE");
  const std::map<std::string, ClaimsFormat> formats{{"text", ClaimsFormat::text}, {"markdown", ClaimsFormat::markdown}, {"json", ClaimsFormat::json}};
  c.add_option("--format", m.format, "text (default), markdown or json")->transform(one_of(formats))->type_name("text|markdown|json");
  c.add_option("--variant", m.variant, "ask the claims of runs whose names end so as well: with _flat, of ft4_a_down_flat in place of ft4_a_down")
      ->type_name("SUFFIX");
  c.add_option("--shortest", o.shortest, "the shortest record that counts, for example \"0.05 s\"; default: what each claim asks for (observed_time)")
      ->type_name("TIME");
  c.add_flag("--measured", m.only_measured, "leave out the claims that these runs do not measure");
  c.footer(claim_measures() + "\nExample:\n  jamscope claims a_down b_down c_down --claims data/reference/paper_claims.toml");
  return [&o] {
    if (!o.shortest.empty()) o.claims.shortest = time_of("--shortest", o.shortest);
    return claims(o.claims);
  };
}

Command add_report(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("report", "build report.html again from results, or one report of several runs");
  ReportOptions& r = o.report;
  c.add_option("DIR", r.folders, "folders of results; the curves of several are drawn over each other")->required()->type_name("");
  c.add_option("-o,--output", r.output, "the page; default: report.html in DIR, of several in the current folder")->type_name("FILE");
  c.add_flag("--figures", r.figures, "write every figure as DIR/figures/NAME.svg and its numbers as NAME.csv");
  c.add_flag("-q,--quiet", r.quiet, "no output");
  c.footer("Examples:\n  jamscope report out --figures\n  jamscope report down up -o both.html");
  return [&o] { return report(o.report); };
}

Command add_bench(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("bench", "measure how fast this machine steps a case, and where the time goes");
  BenchOptions& b = o.bench;
  c.add_option("CASE", b.case_path, "case file (TOML)")->required()->type_name("");
  c.add_option("--beads", b.beads, "as deep a bed as holds about so many grains")->type_name("N")->check(number_from(0, false));
  CLI::Option* const uniform = c.add_flag("--uniform", b.uniform, "every contact at every step, whatever the case says");
  c.add_flag("--auto", b.at_own_rate, "contacts at their own rate (run.step=auto), whatever the case says")->excludes(uniform);
  b.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  add_threads(c, b.threads, "number of threads");
  const auto add_seconds = [&](const char* name, double& seconds, const char* doc, bool may_be_zero) {
    c.add_option(name, seconds, doc)->type_name("S")->check(number_from(0, may_be_zero))->capture_default_str();
  };
  add_seconds("--seconds", b.seconds, "how long to measure, s", false);
  add_seconds("--warm-up", b.warm_up, "how long to run before that, s", true);
  add_overrides(c, b.overrides, "--set blade.start_height=\"26 mm\"");
  add_bed_cache(c, b.bed_cache);
  c.add_flag("--json", b.json, "for machines");
  add_log_options(c, b.quiet, b.log_format);
  c.footer("Example:\n  jamscope bench data/cases/ft4_quick.toml --uniform --threads 1");
  return [&o] { return bench(o.bench); };
}

Command add_export(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("export", "write frames in the formats of other programs");
  ExportOptions& e = o.export_;
  add_input(c, e.input);
  const std::vector<std::string> names = export_format_names();
  c.add_option("--to", e.format, "format, see below")
      ->required()
      ->check(CLI::Validator(
          [names](std::string& text) -> std::string {
            if (std::find(names.begin(), names.end(), text) != names.end()) return {};
            return fmt::format("'{}' is no choice{}", text, suggestion(text, names));
          },
          ""))
      ->type_name(fmt::format("{}", fmt::join(names, "|")));
  c.add_option("-o,--output", e.output, "folder for the files")->required()->type_name("DIR");
  auto* const frame = c.add_option("--frame", e.frame, "this frame only, counted from 0; default: every frame")->type_name("K");
  c.add_option("--frames", e.frames, "from frame A to before frame B")->type_name("A:B")->excludes(frame);
  c.add_flag("--overwrite", e.overwrite, "replace an earlier export in DIR");
  add_log_options(c, e.quiet, e.log_format);
  c.footer(export_format_list() +
           "\nExamples:\n  jamscope export run/run.h5 --to vtp -o paraview\n"
           "  jamscope export run/run.h5 --to lammps --frames 10:20 -o ovito\n"
           "  jamscope export particles.csv contacts.csv --to graphml --frame 3 -o networks");
  return [&o] { return export_frames(o.export_); };
}

Command add_completion(CLI::App& app, Options& o) {
  CLI::App& c = *app.add_subcommand("completion", "print a script that completes commands and options in a shell");
  c.add_option("SHELL", o.shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::Validator(
          [](std::string& text) -> std::string {
            if (text == "bash" || text == "zsh" || text == "fish") return {};
            return fmt::format("'{}' is no choice{}", text, suggestion(text, {"bash", "zsh", "fish"}));
          },
          ""))
      ->type_name("bash|zsh|fish");
  c.footer("Example, for the shell you are in:\n  source <(jamscope completion bash)");
  return [&app, &o] {
    fmt::print("{}", completion_script(app, o.shell));
    return 0;
  };
}

// The table of subcommands, in the order of the help text. To add one: a function like those above and a row here; it
// adds its options to the parser and returns what is to be done.
using AddCommand = Command (*)(CLI::App&, Options&);
constexpr AddCommand commands[] = {
    add_check,
    add_simulate,
    add_analyze,  add_merge,  add_inspect, add_metrics, add_follow, add_compare, add_claims,
    add_report,   add_export, add_bench,   add_completion,
};

int fail(int code, const std::string& message) {
  fmt::print(stderr, "error: {}\n", message);
  return code;
}

// Exceptions of the three gates to exit codes.
int run_guarded(const Command& command) {
  try {
    return command();
  } catch (const dem::PhysicsError& error) {
    return fail(1, error.what());
  } catch (const dem::CaseError& error) {
    return fail(2, error.what());
  } catch (const jam::CriteriaError& error) {
    return fail(2, error.what());
  } catch (const UsageError& error) {
    return fail(2, error.what());
  } catch (const UnitError& error) {
    return fail(2, error.what());
  } catch (const jam::DataError& error) {
    return fail(3, error.what());
  } catch (const std::bad_alloc&) {
    return fail(3, "not enough memory");
  } catch (const std::exception& error) {
    return fail(3, fmt::format("unexpected, please report it: {}", error.what()));
  }
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  CLI::App app("Simulates a granular bed that a blade drives past a wall, and finds, follows and measures the jams.",
               "jamscope");
  Options options;
  options.command_line.assign(argv, argv + argc);
  // Where the program lay says nothing of a run, and may say whose home it was.
  if (argc > 0) options.command_line[0] = std::filesystem::path(argv[0]).filename().string();
  app.set_version_flag("--version", fmt::format("jamscope {} ({})", version, commit));
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  app.footer(
      "Exit codes: 0 done; 1 the physics stopped the run; 2 usage or case error; 3 unreadable or invalid data.\n"
      "Example:\n  jamscope check data/cases/ft4_a_down.toml");
  std::vector<Command> actions;
  for (const AddCommand add : commands) actions.push_back(add(app, options));

  if (argc > 1 && argv[1][0] != '-') {
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
    if (std::find(names.begin(), names.end(), argv[1]) == names.end())
      return fail(2, fmt::format("unknown command '{}'{}", argv[1], suggestion(argv[1], names)));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    return fail(2, fmt::format("{}\nsee: jamscope{}{} --help", error.what(), chosen.empty() ? "" : " ",
                               chosen.empty() ? "" : chosen.front()->get_name()));
  }
  const auto all = app.get_subcommands({});
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k]->parsed()) return run_guarded(actions[k]);
  return fail(2, "no command given\nsee: jamscope --help");
}

}  // namespace jamscope
