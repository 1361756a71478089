#include "apps/jamscope/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "libjam/errors.hpp"

namespace jamscope {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using List = std::vector<double>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Claim {
  std::string name, says, source, expected, measure, of, at, run, against_of, against_run, unit;
  std::uint64_t number = 0, first = 0, components = 1;
  double least_time = 0;  // s, of a record that counts
  List values;
  std::optional<double> low, high;
};

struct Summary {
  std::string path, name;
  Json analysis;
};

// A number, or a list of numbers; "of" is the path with dots. Nothing where it is not there; null counts as NaN.
std::optional<List> find(const Json& analysis, const std::string& of) {
  const Json* at = &analysis;
  for (std::size_t begin = 0; begin <= of.size();) {
    const std::size_t end = std::min(of.find('.', begin), of.size());
    const std::string key = of.substr(begin, end - begin);
    begin = end + 1;
    if (at->is_array() && !at->empty() && at->front().is_object()) {
      // Of a list of objects: this key of each.
      List column;
      for (const Json& row : *at) {
        if (!row.contains(key)) return std::nullopt;
        column.push_back(row[key].is_number() ? row[key].get<double>() : nan);
      }
      return column;
    }
    if (!at->is_object() || !at->contains(key)) return std::nullopt;
    at = &(*at)[key];
  }
  if (at->is_array() && !at->empty() && at->front().is_object()) return std::nullopt;
  List values;
  if (!at->is_array()) return List{at->is_number() ? at->get<double>() : nan};
  for (const Json& value : *at) values.push_back(value.is_number() ? value.get<double>() : nan);
  return values;
}

List ranks(const List& values) {
  List rank(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    double below = 0, same = 0;
    for (const double other : values) below += other < values[k], same += other == values[k];
    rank[k] = below + (same + 1) / 2;  // equal ones share the mean of their ranks
  }
  return rank;
}

// Pearson's correlation.
double correlation(const List& x, const List& y) {
  const double n = double(x.size());
  double sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sx += x[k], sy += y[k];
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double a = x[k] - sx / n, b = y[k] - sy / n;
    xx += a * a, yy += b * b, xy += a * b;
  }
  return xy / std::sqrt(xx * yy);
}

// MEASURES. Add one: a row with a function of what `of` gives in `run`, what `against_of` gives in `against_run` (empty where the measure takes one
// run), and the claim.
struct Measure {
  const char *name, *doc;
  bool two;  // takes two runs
  double (*of)(const List& a, const List& b, const Claim& claim);
  const char* needs = "";  // without which it is not defined, where that is not plain
};
double same_length(const List& a, const List& b, double (*f)(const List&, const List&)) { return a.size() == b.size() && !a.empty() ? f(a, b) : nan; }
// As far as both go: what stands at one place in one is compared with what stands there in the other.
double both_have(const List& a, const List& b, double (*f)(const List&, const List&)) {
  const auto n = std::ptrdiff_t(std::min(a.size(), b.size()));
  return n > 0 ? f(List(a.begin(), a.begin() + n), List(b.begin(), b.begin() + n)) : nan;
}
// Two numbers, or the last that two lists of places (`at`) share.
double of_last(const List& a, const List& b, const Claim& claim, double (*f)(double, double)) {
  if (a.empty() || a.size() != b.size() || (a.size() != 1 && claim.at.empty())) return nan;
  return f(a.back(), b.back());
}
// Places of `components` numbers each; one of which a number is unknown is unknown.
double rms_difference(const List& a, const List& b, const Claim& claim) {
  if (a.size() != b.size() || a.size() % claim.components != 0) return nan;
  double sum = 0;
  std::size_t both = 0, either = 0;
  for (std::size_t k = 0; k < a.size(); k += claim.components) {
    bool in_a = true, in_b = true;
    double square = 0;
    for (std::size_t i = k; i < k + claim.components; ++i) {
      in_a = in_a && std::isfinite(a[i]);
      in_b = in_b && std::isfinite(b[i]);
      square += (a[i] - b[i]) * (a[i] - b[i]);
    }
    either += in_a || in_b;
    if (!in_a || !in_b) continue;
    sum += square;
    ++both;
  }
  return both > 0 && 2 * both >= either ? std::sqrt(sum / double(both)) : nan;
}
constexpr Measure measures[] = {
    {"value", "the number itself", false, [](const List& a, const List&, const Claim&) { return a.size() == 1 ? a[0] : nan; }},
    {"sum", "of the numbers of a list, from number `first` on", false,
     [](const List& a, const List&, const Claim& c) {
       double sum = 0;
       for (std::size_t k = c.first; k < a.size(); ++k) sum += a[k];
       return sum;
     }},
    {"largest_at", "which number of a list is the largest, from number `first` on, counted from 0", false,
     [](const List& a, const List&, const Claim& c) {
       return a.size() <= c.first ? nan : double(std::max_element(a.begin() + std::ptrdiff_t(c.first), a.end()) - a.begin());
     }},
    {"rank_correlation", "Spearman's, of a list against its order, from number `first` on: -1 where it only falls", false,
     [](const List& a, const List&, const Claim& c) {
       if (a.size() < c.first + 2) return nan;
       const List values(a.begin() + std::ptrdiff_t(c.first), a.end());
       List order(values.size());
       for (std::size_t k = 0; k < order.size(); ++k) order[k] = double(k);
       return correlation(ranks(values), order);
     }},
    {"largest_difference", "from a list of `values`, in magnitude", false,
     [](const List& a, const List&, const Claim& c) {
       return same_length(a, c.values, [](const List& x, const List& y) {
         double most = 0;
         for (std::size_t k = 0; k < x.size(); ++k) most = std::max(most, std::abs(x[k] - y[k]));
         return most;
       });
     }},
    {"ratio", "of two runs' numbers; with `at`, at the last place that both cover", true,
     [](const List& a, const List& b, const Claim& c) { return of_last(a, b, c, [](double x, double y) { return x / y; }); }},
    {"difference", "of two runs' numbers; with `at`, at the last place that both cover", true,
     [](const List& a, const List& b, const Claim& c) { return of_last(a, b, c, [](double x, double y) { return x - y; }); }},
    {"share_above", "of the places at which one run's list is above the other's, as far as both go", true,
     [](const List& a, const List& b, const Claim&) {
       return both_have(a, b, [](const List& x, const List& y) {
         double above = 0;
         for (std::size_t k = 0; k < x.size(); ++k) above += x[k] > y[k];
         return above / double(x.size());
       });
     }},
    {"largest_ratio", "between two runs' lists, upward or downward, as far as both go", true,
     [](const List& a, const List& b, const Claim&) {
       return both_have(a, b, [](const List& x, const List& y) {
         double most = 1;
         for (std::size_t k = 0; k < x.size(); ++k) most = std::max({most, x[k] / y[k], y[k] / x[k]});
         return most;
       });
     }},
    {"rms_difference", "of two runs' lists: root of the mean of squared differences, over the places that both have; with `components` = 3, squares of vectors", true,
     rms_difference, "lists of equal length, and at least half of the places that one run has to be in both"},
    {"power", "exponent of the ratio of two runs' numbers in that of `values` = [run's, against_run's], for example their stiffnesses", true,
     [](const List& a, const List& b, const Claim& c) {
       return a.size() == 1 && b.size() == 1 && c.values.size() == 2 ? std::log(a[0] / b[0]) / std::log(c.values[0] / c.values[1]) : nan;
     }},
};

// A list over the places it stands at, which ascend.
struct Curve {
  List at, value;
};

// Both at the places of `a` that `b` covers, `b` by straight lines between its own.
std::pair<List, List> at_common_places(const Curve& a, const Curve& b) {
  std::pair<List, List> both;
  for (std::size_t k = 0; k < a.at.size(); ++k) {
    const double x = a.at[k];
    const auto after = std::lower_bound(b.at.begin(), b.at.end(), x);
    if (after == b.at.end() || (after == b.at.begin() && *after != x)) continue;
    const auto i = std::size_t(after - b.at.begin());
    const double y = *after == x ? b.value[i] : b.value[i - 1] + (b.value[i] - b.value[i - 1]) * (x - b.at[i - 1]) / (b.at[i] - b.at[i - 1]);
    both.first.push_back(a.value[k]);
    both.second.push_back(y);
  }
  return both;
}

const Measure* find_measure(const std::string& name) {
  for (const Measure& m : measures)
    if (m.name == name) return &m;
  return nullptr;
}

std::vector<Claim> read_claims(const std::string& path) {
  Document document(read_text_file(path), path, {});
  Section root = document.root();
  Section table = root.section("claim");
  std::vector<Claim> all;
  for (auto& [name, s] : table.named_sections()) {
    Claim c;
    c.name = name;
    s.whole_number("number", c.number);
    s.text("says", c.says);
    s.text("source", c.source, Need::optional);
    s.text("expected", c.expected, Need::optional);
    s.text("measure", c.measure);
    s.text("of", c.of);
    s.text("run", c.run);
    s.text("unit", c.unit, Need::optional);
    s.whole_number("first", c.first, Need::optional);
    s.numbers("values", c.values, Need::optional);
    if (s.whole_number("components", c.components, Need::optional) && c.components == 0) document.problem("claim." + name + ".components", "components is 0, expected 1 or more");
    s.text("at", c.at, Need::optional);
    s.quantity("observed_time", dimension::time, c.least_time, Need::optional);
    if (double value = 0; s.number("low", value, Need::optional)) c.low = value;
    if (double value = 0; s.number("high", value, Need::optional)) c.high = value;
    const bool against = s.text("against_run", c.against_run, Need::optional);
    c.against_of = c.of;
    s.text("against_of", c.against_of, Need::optional);
    s.finish();
    const std::string at = "claim." + name;
    if (const Measure* const m = find_measure(c.measure); m == nullptr) {
      std::vector<std::string> known;
      for (const Measure& row : measures) known.emplace_back(row.name);
      if (!c.measure.empty()) document.problem(at + ".measure", fmt::format("no measure '{}'{}", c.measure, suggestion(c.measure, known)));
    } else if (m->two != against) {
      document.problem(at, m->two ? fmt::format("'{}' takes two runs: against_run is missing", c.measure) : fmt::format("'{}' takes one run, not against_run", c.measure));
    } else if (!c.at.empty() && !m->two) {
      document.problem(at + ".at", fmt::format("'{}' takes one run: `at` says where lists of two stand", c.measure));
    }
    if (!c.low && !c.high) document.problem(at, "holds always: expected low, high or both");
    if (c.low && c.high && *c.low > *c.high) document.problem(at + ".low", "is above high");
    all.push_back(std::move(c));
  }
  root.finish();
  document.throw_problems();
  std::stable_sort(all.begin(), all.end(), [](const Claim& a, const Claim& b) { return a.number < b.number; });
  return all;
}

Summary read_summary(const fs::path& path) {
  const std::string text = read_text_file(path.string());
  Json json = Json::parse(text, nullptr, false);
  const auto text_of = [&](const char* pointer) { return json.value(Json::json_pointer(pointer), std::string()); };
  if (json.is_discarded() || !json.is_object() || !json.contains("analysis") || !json.contains("run") || !json["analysis"].is_object() || !json["run"].is_object())
    throw jam::DataError(path.string() + ": no summary of a run, expected the summary.json of `jamscope simulate` or `jamscope analyze`");
  return {path.string(), json["run"].contains("name") && json["run"]["name"].is_string() ? text_of("/run/name") : path.parent_path().filename().string(),
          std::move(json["analysis"])};
}

// A folder with a summary.json, such a file, or a folder of either, in order of their names.
std::vector<Summary> read_summaries(const std::vector<std::string>& paths) {
  std::vector<Summary> all;
  for (const std::string& path : paths) {
    if (!fs::exists(path)) throw jam::DataError(path + ": cannot be read: no such file or folder");
    if (!fs::is_directory(path)) {
      all.push_back(read_summary(path));
      continue;
    }
    std::vector<fs::path> files;
    if (fs::exists(fs::path(path) / "summary.json")) {
      files.push_back(fs::path(path) / "summary.json");
    } else {
      for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
        if (entry.is_directory() && fs::exists(entry.path() / "summary.json")) files.push_back(entry.path() / "summary.json");
        if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry.path());
      }
      std::sort(files.begin(), files.end());
    }
    if (files.empty()) throw jam::DataError(path + ": holds no summary.json, nor folders that do");
    for (const fs::path& file : files) all.push_back(read_summary(file));
  }
  return all;
}

struct Verdict {
  double value = nan, low = nan, high = nan;
  std::size_t runs = 0, against = 0;            // repetitions
  double observed = nan, observed_against = nan;  // s, the longest record of each
  std::string word, why;
};

// s, how long the record is; NaN where the summary does not say.
double observed_time(const Summary& s) {
  const auto time = find(s.analysis, "observed_time_s");
  return time && time->size() == 1 ? time->front() : nan;
}

// What a claim is about, of one run.
struct Measured {
  Curve curve;           // without places where the claim names none
  double observed = nan;  // s
};

Verdict judge(const Claim& claim, const std::vector<Summary>& summaries) {
  const Measure& measure = *find_measure(claim.measure);
  Verdict v;
  std::string missing;
  const auto of_runs = [&](const std::string& run, const std::string& of) {
    std::vector<Measured> found;
    for (const Summary& s : summaries) {
      if (s.name != run) continue;
      const double observed = observed_time(s);
      if (claim.least_time > 0 && !(observed >= claim.least_time)) {
        missing = std::isnan(observed) ? fmt::format("{} does not say how long it is", s.path)
                                       : fmt::format("{} is {:.4g} s long, expected at least {:.4g} s", s.path, observed, claim.least_time);
        continue;
      }
      auto value = find(s.analysis, of), at = claim.at.empty() ? std::optional<List>(List{}) : find(s.analysis, claim.at);
      if (!value || !at)
        missing = fmt::format("{} has no {}", s.path, value ? claim.at : of);
      else if (!claim.at.empty() && (at->size() != value->size() || !std::is_sorted(at->begin(), at->end())))
        missing = fmt::format("{}: {} are not the ascending places of {}", s.path, claim.at, of);
      else
        found.push_back({{std::move(*at), std::move(*value)}, observed});
    }
    if (found.empty() && missing.empty()) missing = fmt::format("no run {}", run);
    return found;
  };
  const std::vector<Measured> mine = of_runs(claim.run, claim.of);
  const std::vector<Measured> others = measure.two ? of_runs(claim.against_run, claim.against_of) : std::vector<Measured>(1);
  v.runs = mine.size();
  v.against = measure.two ? others.size() : 0;
  List values;
  for (const Measured& a : mine)
    for (const Measured& b : others) {
      const auto [x, y] = claim.at.empty() ? std::pair(a.curve.value, b.curve.value) : at_common_places(a.curve, b.curve);
      if (const double value = measure.of(x, y, claim); std::isfinite(value)) values.push_back(value);
    }
  v.word = "not measured";
  if (values.empty()) {
    v.why = !missing.empty() ? missing : *measure.needs == 0 ? "not defined in these runs" : fmt::format("not defined in these runs: it needs {}", measure.needs);
    return v;
  }
  const auto longest = [](const std::vector<Measured>& runs) {
    double most = nan;
    for (const Measured& m : runs) most = std::fmax(most, m.observed);
    return most;
  };
  v.observed = longest(mine);
  v.observed_against = measure.two ? longest(others) : nan;
  std::sort(values.begin(), values.end());
  v.low = values.front();
  v.high = values.back();
  const std::size_t half = values.size() / 2;
  v.value = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
  v.word = (!claim.low || v.value >= *claim.low) && (!claim.high || v.value <= *claim.high) ? "holds" : "does not hold";
  return v;
}

std::string band(const Claim& c) {
  if (c.low && c.high) return *c.low == *c.high ? fmt::format("{:.4g}", *c.low) : fmt::format("{:.4g} to {:.4g}", *c.low, *c.high);
  return c.low ? fmt::format("from {:.4g}", *c.low) : fmt::format("up to {:.4g}", *c.high);
}

std::string ours(const Claim& c, const Verdict& v) {
  if (std::isnan(v.value)) return "-";
  const std::string unit = c.unit.empty() ? "" : " " + c.unit;
  return v.low == v.high ? fmt::format("{:.4g}{}", v.value, unit) : fmt::format("{:.4g} ({:.4g} to {:.4g}){}", v.value, v.low, v.high, unit);
}

std::string how(const Claim& c, const Verdict& v) {
  const auto of = [](const std::string& path, const std::string& run, std::size_t n, double observed) {
    std::string text = fmt::format("{} of {}", path, run);
    if (std::isfinite(observed)) text += fmt::format(", {:.3g} s", observed);
    return n > 1 ? text + fmt::format(" ({} runs)", n) : text;
  };
  std::string text = fmt::format("{}: {}", c.measure, of(c.of, c.run, v.runs, v.observed));
  if (!c.against_run.empty()) text += ", against " + of(c.against_of, c.against_run, v.against, v.observed_against);
  return v.why.empty() ? text : text + "; " + v.why;
}

std::string markdown(const std::vector<Claim>& all, const std::vector<Verdict>& verdicts) {
  std::string out = "| # | claim | source says | measured | holds in | verdict | how |\n| --- | --- | --- | --- | --- | --- | --- |\n";
  for (std::size_t k = 0; k < all.size(); ++k)
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", all[k].number, all[k].says, all[k].expected, ours(all[k], verdicts[k]), band(all[k]), verdicts[k].word,
                       how(all[k], verdicts[k]));
  return out;
}

std::string plain(const std::vector<Claim>& all, const std::vector<Verdict>& verdicts) {
  std::string out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    out += fmt::format("{:>3}  {:<13} {}\n", all[k].number, verdicts[k].word, all[k].says);
    out += fmt::format("     {:<13} source: {}; measured: {}; holds in: {}\n     {:<13} {}\n", "", all[k].expected.empty() ? "-" : all[k].expected,
                       ours(all[k], verdicts[k]), band(all[k]), "", how(all[k], verdicts[k]));
  }
  return out;
}

Json json_of(const std::vector<Claim>& all, const std::vector<Verdict>& verdicts) {
  const auto or_null = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  Json rows = Json::array();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Claim& c = all[k];
    const Verdict& v = verdicts[k];
    rows.push_back({{"number", c.number}, {"name", c.name}, {"says", c.says}, {"source", c.source}, {"expected", c.expected}, {"unit", c.unit.empty() ? "1" : c.unit},
                    {"value", or_null(v.value)}, {"low", or_null(v.low)}, {"high", or_null(v.high)}, {"runs", v.runs},
                    {"holds_from", c.low ? Json(*c.low) : Json(nullptr)}, {"holds_to", c.high ? Json(*c.high) : Json(nullptr)}, {"verdict", v.word}, {"how", how(c, v)}});
  }
  return rows;
}

}  // namespace

std::string claim_measures() {
  std::string text = "Measures:\n";
  for (const Measure& m : measures) text += fmt::format("  {:<20} {}{}\n", m.name, m.doc, m.two ? " (takes against_run)" : "");
  return text;
}

int claims(const ClaimsOptions& options) {
  std::vector<Claim> all;
  const std::vector<Summary> summaries = read_summaries(options.runs);
  if (std::none_of(summaries.begin(), summaries.end(), [&](const Summary& s) { return s.name.ends_with(options.variant); }))
    throw UsageError(fmt::format("--variant {}: no run has a name that ends so", options.variant));
  std::vector<Verdict> verdicts;
  for (Claim claim : read_claims(options.claims)) {
    claim.run += options.variant;
    if (!claim.against_run.empty()) claim.against_run += options.variant;
    claim.least_time = options.shortest.value_or(claim.least_time);
    Verdict verdict = judge(claim, summaries);
    if (options.only_measured && std::isnan(verdict.value)) continue;
    all.push_back(std::move(claim));
    verdicts.push_back(std::move(verdict));
  }
  switch (options.format) {
    case ClaimsFormat::json: fmt::print("{}\n", json_of(all, verdicts).dump(2)); return 0;
    case ClaimsFormat::markdown: fmt::print("{}", markdown(all, verdicts)); break;
    case ClaimsFormat::text: fmt::print("{}", plain(all, verdicts)); break;
  }
  std::map<std::string, std::size_t> count;
  for (const Verdict& v : verdicts) ++count[v.word];
  fmt::print("\n{} claims, {} runs: {} hold, {} do not, {} not measured\n", all.size(), summaries.size(), count["holds"], count["does not hold"], count["not measured"]);
  return 0;
}

}  // namespace jamscope
