#include "apps/jamscope/figure_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/jamscope/outputs.hpp"
#include "libjam/events/peaks.hpp"
#include "libjam/statistics/rates.hpp"

namespace jamscope {
namespace {

struct Data {
  const jam::RunInfo& info;
  const jam::Analysis& analysis;
  const jam::Series& series;
};
using Figures = std::vector<FigureFile>;

template <class Rows, class Value>
std::vector<double> column(const Rows& rows, Value value) {
  std::vector<double> values;
  for (const auto& row : rows) values.push_back(static_cast<double>(value(row)));
  return values;
}
template <class T>
std::vector<double> doubles(const std::vector<T>& values) {
  return column(values, [](const T& v) { return v; });
}
std::vector<double> axial(const std::vector<jam::Vec3>& values) {
  return column(values, [](const jam::Vec3& v) { return v.z(); });
}

std::vector<double> frame_times(const Data& d) {
  return column(d.analysis.frames, [](const auto& f) { return f.time; });
}
FigureCurve of_frames(const Data& d, const char* label, auto member, FigureCurve::Kind kind = FigureCurve::Kind::line) {
  return {label, frame_times(d), column(d.analysis.frames, [&](const auto& f) { return f.*member; }), {}, {}, kind};
}

const Axis time_axis{"Time", "s", false};

using F = jam::FrameSummary;
using Kind = FigureCurve::Kind;

void forces(const Data& d, Figures& out) {
  FigureFile f{"grain-force", "Compressive force on the grains", time_axis, {"Compressive force", "N", true}, {}, {}};
  if (jam::present(d.series.largest_compressive_force, d.series.size()) && d.series.size() > 0)
    f.curves.push_back({"largest in any step", d.series.time, doubles(d.series.largest_compressive_force), {}, {}, Kind::dashes});
  f.curves.push_back(of_frames(d, "largest in the frame", &F::largest_compressive_force));
  f.curves.push_back(of_frames(d, "mean of the frame", &F::mean_compressive_force));
  out.push_back(f);
}

void jammed(const Data& d, Figures& out) {
  FigureFile f{"jammed-count", "Jammed grains and bridges", time_axis, {"Number", "", false}, {}, {}};
  f.curves.push_back(of_frames(d, "jammed grains", &F::jammed, Kind::steps));
  f.curves.push_back(of_frames(d, "bridges", &F::bridges, Kind::steps));
  out.push_back(f);
}

void coordination(const Data& d, Figures& out) {
  FigureFile f{"coordination", "Coordination number", time_axis, {"Contacts per grain", "", false}, {}, {}};
  f.curves.push_back(of_frames(d, "with walls", &F::coordination_with_walls));
  f.curves.push_back(of_frames(d, "grains only", &F::coordination));
  out.push_back(f);
}

void blade_loads(const Data& d, Figures& out) {
  FigureFile force{"blade-force", "Axial force on the blade", time_axis, {"Axial force", "N", false}, {}, {}};
  FigureFile torque{"blade-torque", "Torque on the blade", time_axis, {"Torque", "N m", false}, {}, {}};
  FigureFile size{"log-force", "Axial force on the blade, logarithmic", time_axis, {"|Axial force|", "N", true}, {}, {}};
  for (std::size_t w = 0; w < std::min(d.info.walls.size(), d.series.walls.size()); ++w) {
    const auto& s = d.series.walls[w];
    const std::string& name = d.info.walls[w].name;
    if (d.info.walls[w].role != jam::WallRole::blade || s.force.empty()) continue;
    force.curves.push_back({name, d.series.time, axial(s.force), axial(s.force_min), axial(s.force_max)});
    torque.curves.push_back({name, d.series.time, axial(s.torque), axial(s.torque_min), axial(s.torque_max)});
    size.curves.push_back({name, d.series.time, column(s.force, [](const jam::Vec3& v) { return std::abs(v.z()); }), {}, {}});
  }
  for (FigureFile* f : {&force, &torque, &size}) out.push_back(*f);
}

void flow_energy(const Data& d, Figures& out) {
  FigureFile f{"flow-energy", "Flow energy", time_axis, {"Flow energy", "J", false}, {}, {}};
  f.curves.push_back({"work of the blade", d.analysis.flow_energy.time, d.analysis.flow_energy.energy, {}, {}});
  out.push_back(f);
}

void health(const Data& d, Figures& out) {
  FigureFile kinetic{"kinetic-energy", "Kinetic energy", time_axis, {"Kinetic energy", "J", false}, {}, {}};
  kinetic.curves.push_back({"kinetic energy", d.series.time, doubles(d.series.kinetic_energy), {}, {}});
  FigureFile overlap{"overlap", "Largest overlap", time_axis, {"Overlap / radius", "%", false}, {}, {}};
  overlap.curves.push_back({"largest overlap", d.series.time, column(d.series.largest_overlap, [](double v) { return 100 * v; }), {}, {}});
  FigureFile ledger{"energy-ledger", "Energy ledger", time_axis, {"Energy", "J", false}, {}, {}};
  const auto& e = d.series.energy;
  for (std::size_t w = 0; w < std::min(d.info.walls.size(), d.series.walls.size()); ++w)
    ledger.curves.push_back({"work of " + d.info.walls[w].name, d.series.time, d.series.walls[w].work, {}, {}});
  const std::pair<const char*, const std::vector<double>*> places[] = {
      {"kinetic", &e.kinetic}, {"rotational", &e.rotational}, {"gravitational", &e.gravitational}, {"elastic", &e.elastic}, {"adhesive", &e.adhesive},
      {"tangential springs", &e.tangential}, {"rolling springs", &e.rolling}, {"normal damping", &e.normal_damping}, {"tangential damping", &e.tangential_damping},
      {"sliding", &e.sliding}, {"rolling resistance", &e.rolling_resistance}, {"detachment", &e.detachment}, {"change of stiffness", &e.stiffness_change},
      {"lost by the finite step", &e.time_stepping}, {"unexplained", &e.residual}};
  for (const auto& [name, values] : places) ledger.curves.push_back({name, d.series.time, *values, {}, {}});
  if (e.residual.empty()) ledger.curves.clear();
  for (const FigureFile& f : {kinetic, overlap, ledger}) out.push_back(f);
}

std::string class_label(const jam::SurvivalClass& c) {
  return std::isfinite(c.high) ? fmt::format("{:g}-{:g}", 1e3 * c.low, 1e3 * c.high) : fmt::format(">= {:g}", 1e3 * c.low);
}

void survival_classes(const Data& d, Figures& out) {
  if (d.analysis.events.empty()) return;
  FigureFile rate{"survival-frequency", "Frequency by survival time", {"Survival time", "ms", false}, {"Frequency", "Hz", false}, {}, {}};
  FigureFile share{"survival-share", "Share of the jam time by survival time", {"Survival time", "ms", false}, {"Share of jam time", "%", false}, {}, {}};
  for (const jam::SurvivalClass& c : d.analysis.survival_classes) {
    const jam::Rate interval = jam::poisson_rate(c.events, d.analysis.observed_time);
    rate.bars.push_back({class_label(c), c.frequency, interval.low, interval.high});
    share.bars.push_back({class_label(c), 100 * c.share_of_jam_time});
  }
  out.push_back(rate);
  out.push_back(share);
}

void jammed_histogram(const Data& d, Figures& out) {
  FigureFile f{"jammed-histogram", "Number of grains jammed at once", {"Grains jammed at once", "", false}, {"Frames", "", false}, {}, {}};
  for (std::size_t n = 1; n < d.analysis.jammed_histogram.size(); ++n) f.bars.push_back({std::to_string(n), double(d.analysis.jammed_histogram[n])});
  while (!f.bars.empty() && f.bars.back().value == 0) f.bars.pop_back();
  out.push_back(f);
}

void survival_curves(const Data& d, Figures& out) {
  FigureFile f{"survival-curve", "Survival of jams, of every step", {"Duration", "s", true}, {"Share that lasts longer", "", false}, {}, {}};
  for (std::size_t s = 0; s < d.analysis.every_step.size(); ++s) {
    const jam::SurvivalCurve& c = d.analysis.every_step[s].statistics.survival;
    if (c.time.empty()) continue;
    // All last longer than half of the shortest.
    const auto after = [](double first, const std::vector<double>& rest) {
      std::vector<double> all{first};
      all.insert(all.end(), rest.begin(), rest.end());
      return all;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    f.curves.push_back({std::string(jam::jam_stream_names[s]), after(c.time.front() / 2, c.time), after(1, c.share), after(nan, c.low), after(nan, c.high), Kind::steps});
  }
  out.push_back(f);
}

void events_over_time(const Data& d, Figures& out) {
  FigureFile f{"event-timeline", "Jams by stream: peak force and time of the peak", time_axis, {"Peak force", "N", true}, {}, {}};
  const auto add = [&](const char* label, const auto& events, auto event_of) {
    FigureCurve c{label, column(events, [&](const auto& e) { return event_of(e).peak_time; }), column(events, [&](const auto& e) { return event_of(e).peak_force; }),
                  {}, {}, Kind::points};
    if (!c.x.empty()) f.curves.push_back(std::move(c));
  };
  const auto itself = [](const auto& e) -> const auto& { return e; };
  add("global, of frames", d.analysis.events, itself);
  add("cluster, of frames", d.analysis.cluster_events, itself);
  add("particle, of frames", d.analysis.tracks, [](const jam::Track& t) -> const auto& { return t.event; });
  for (std::size_t s = 0; s < d.analysis.every_step.size(); ++s)
    add((std::string(jam::jam_stream_names[s]) + ", of every step").c_str(), d.analysis.every_step[s].jams, itself);
  out.push_back(f);
}

void jams_above(const Data& d, Figures& out) {
  const bool windows = jam::present(d.series.largest_compressive_force, d.series.size()) && d.series.size() > 0;
  const std::vector<double> force = windows ? doubles(d.series.largest_compressive_force) : column(d.analysis.frames, [](const auto& f) { return f.largest_compressive_force; });
  const double most = force.empty() ? 0.0 : *std::max_element(force.begin(), force.end());
  if (!(most > 0)) return;
  std::vector<double> thresholds, counts;
  const double top = std::floor(10 * std::log10(most));
  for (double k = top - 40; k <= top; ++k) thresholds.push_back(std::pow(10, k / 10));
  for (const std::size_t n : jam::counts_above(jam::peaks(force), thresholds)) counts.push_back(double(n));
  out.push_back({"jams-above", fmt::format("Jams above every threshold, of {}", windows ? "windows of steps" : "frames"), {"Threshold", "N", true}, {"Jams", "", false},
                 {{"jams", thresholds, counts, {}, {}, Kind::steps}}, {}});
}

// Where and how fast each grain was while it was jammed: as points over the time of the peak.
void tracks(const Data& d, Figures& out) {
  FigureFile radius{"radial-position", "Where grains jammed", time_axis, {"Distance from the axis at the peak", "mm", false}, {}, {}};
  FigureFile speed{"jammed-speed", "Speed of jammed grains", time_axis, {"Mean speed while jammed", "m/s", false}, {}, {}};
  FigureCurve r{"jammed grain", {}, {}, {}, {}, Kind::points}, v = r;
  const auto vessel = std::find_if(d.info.walls.begin(), d.info.walls.end(), [](const jam::Wall& w) { return w.role == jam::WallRole::vessel && w.kind == "cylinder"; });
  for (const jam::Track& t : d.analysis.tracks) {
    if (t.points.empty()) continue;
    const auto peak = std::max_element(t.points.begin(), t.points.end(), [](const auto& a, const auto& b) { return a.compressive_force < b.compressive_force; });
    if (vessel != d.info.walls.end()) {
      const jam::Vec3 axis = vessel->axis.normalized(), arm = peak->position.cast<double>() - vessel->point;
      r.x.push_back(t.event.peak_time);
      r.y.push_back(1e3 * (arm - arm.dot(axis) * axis).norm());
    }
    double sum = 0;
    for (const auto& p : t.points) sum += double{p.velocity.norm()};
    v.x.push_back(t.event.peak_time);
    v.y.push_back(sum / double(t.points.size()));
  }
  radius.curves.push_back(r);
  speed.curves.push_back(v);
  out.push_back(radius);
  out.push_back(speed);
}

void metrics(const Data& d, Figures& out) {
  for (const jam::RecordedMetric& m : d.analysis.metrics)
    out.push_back({"metric-" + m.name, m.doc, time_axis, {m.name, m.unit == "1" ? "" : m.unit, false}, {{m.name, frame_times(d), m.values, {}, {}}}, {}});
}

// TABLE of the figures. To add one: a function above and a row here. One without a finite value is left out.
using AddFigures = void (*)(const Data&, Figures&);
constexpr AddFigures table[] = {forces,           jammed,          blade_loads,      flow_energy, survival_classes, survival_curves, jammed_histogram,
                                events_over_time, jams_above,      tracks,           coordination, health,           metrics};

// Colours of Okabe and Ito, which differ without red-green vision.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#666666", "#000000"};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') safe += "&lt;";
    else if (c == '>') safe += "&gt;";
    else if (c == '&') safe += "&amp;";
    else if (c == '"') safe += "&quot;";
    else if (static_cast<unsigned char>(c) >= 32) safe += c;
  }
  return safe;
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.10g}", value) : std::string(); }
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

constexpr double width = 720, height = 420, left = 78, right = 20, top = 40, bottom = 56;  // px
constexpr double legend_width = 200;                                                     // beside the plot, where there are several curves

// A value's place on an axis from `from` to `to`, pixels.
struct Scale {
  double low, high, from, to;
  bool log;
  double at(double v) const {
    const double share = log ? (std::log10(v) - std::log10(low)) / (std::log10(high) - std::log10(low)) : (v - low) / (high - low);
    return from + share * (to - from);
  }
  bool holds(double v) const { return std::isfinite(v) && (!log || v > 0); }
};

Scale scale_of(const std::vector<double>& values, bool log, double from, double to, bool from_zero) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values)
    if (std::isfinite(v) && (!log || v > 0)) low = std::min(low, v), high = std::max(high, v);
  if (!(low <= high)) low = log ? 1 : 0, high = log ? 10 : 1;
  if (log) {
    low = std::max(low, 1e-9 * high) / 1.2;
    high *= 1.2;
  } else {
    if (from_zero) low = std::min(low, 0.0), high = std::max(high, 0.0);
    const double room = high > low ? 0.05 * (high - low) : std::max(0.05 * std::abs(high), 1e-12);
    if (!(from_zero && low == 0)) low -= room;
    high += room;
  }
  return {low, high, from, to, log};
}

// Consecutive points that fall on one pixel are drawn as their lowest and highest: no peak is lost.
std::string path_of(const std::vector<double>& x, const std::vector<double>& y, const Scale& across, const Scale& up, bool steps) {
  std::string d;
  bool pen = false;
  const auto to = [&](double px, double py) {
    if (pen && steps) d += fmt::format("H{:.1f}V{:.1f}", px, py);
    else d += fmt::format("{}{:.1f} {:.1f}", pen ? "L" : "M", px, py);
    pen = true;
  };
  for (std::size_t k = 0; k < x.size();) {
    if (!across.holds(x[k]) || !up.holds(y[k])) {
      pen = false;
      ++k;
      continue;
    }
    const double px = across.at(x[k]);
    std::size_t end = k, lowest = k, highest = k;
    for (; end < x.size() && across.holds(x[end]) && up.holds(y[end]) && across.at(x[end]) < px + 1; ++end) {
      if (y[end] < y[lowest]) lowest = end;
      if (y[end] > y[highest]) highest = end;
    }
    if (end - k < 3 || steps)
      for (std::size_t r = k; r < end; ++r) to(across.at(x[r]), up.at(y[r]));
    else
      for (const std::size_t r : {std::min(lowest, highest), std::max(lowest, highest), end - 1}) to(across.at(x[r]), up.at(y[r]));
    k = end;
  }
  return d;
}

std::string tick_text(double v, bool log) {
  if (v == 0) return "0";
  if (log) {
    const double exponent = std::round(std::log10(v));
    if (std::abs(std::log10(v) - exponent) < 1e-9 && (exponent < -2 || exponent > 4))
      return fmt::format("10<tspan dy=\"-4\" font-size=\"9\">{:g}</tspan>", exponent);
  }
  return fmt::format("{:.6g}", v);
}

std::string frame_of(const FigureFile& f, const Scale& across, const Scale& up, bool bars) {
  std::string s;
  for (const double v : axis_ticks(up.low, up.high, up.log)) {
    const double y = up.at(v);
    s += fmt::format("<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#e3e6ea\"/>\n<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
                     left, width - right, y, left - 7, y + 4, tick_text(v, up.log));
  }
  if (!bars)
    for (const double v : axis_ticks(across.low, across.high, across.log)) {
      const double x = across.at(v);
      s += fmt::format("<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#333\"/>\n<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n", x,
                       height - bottom, height - bottom + 5, height - bottom + 19, tick_text(v, across.log));
    }
  s += fmt::format("<path d=\"M{} {}V{}H{}\" fill=\"none\" stroke=\"#333\"/>\n", left, top, height - bottom, width - right);
  s += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2, height - 14, escaped(f.x.title()));
  s += fmt::format("<text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n", (top + height - bottom) / 2, escaped(f.y.title()));
  s += fmt::format("<text x=\"{}\" y=\"20\" font-size=\"14\" font-weight=\"600\">{}</text>\n", left, escaped(f.title));
  return s;
}

}  // namespace

std::vector<double> axis_ticks(double low, double high, bool log) {
  std::vector<double> ticks;
  if (log) {
    const double decades = std::log10(high / low);
    const auto every = std::max(1.0, std::ceil(decades / 8));
    for (double e = std::floor(std::log10(low)); e <= std::ceil(std::log10(high)); ++e)
      for (const double m : {1.0, 2.0, 5.0}) {
        const double v = m * std::pow(10, e);
        if (v < low * (1 - 1e-9) || v > high * (1 + 1e-9)) continue;
        if (m == 1 ? std::fmod(e, every) == 0 : decades < 2) ticks.push_back(v);
      }
    return ticks;
  }
  const double rough = (high - low) / 7, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double m : {5.0, 2.0, 1.0})
    if (m * power >= rough * (1 - 1e-9)) step = m * power;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push_back(k * step);
  return ticks;
}

std::vector<FigureFile> figure_files(const jam::RunInfo& info, const jam::Analysis& analysis, const jam::Series& series) {
  Figures figures;
  for (const AddFigures add : table) add({info, analysis, series}, figures);
  const auto empty = [](const FigureCurve& c) {
    return c.y.size() != c.x.size() || std::none_of(c.y.begin(), c.y.end(), [](double v) { return std::isfinite(v); });
  };
  for (FigureFile& f : figures) {
    std::erase_if(f.curves, empty);
    for (FigureCurve& c : f.curves)
      if (c.low.size() != c.x.size() || c.high.size() != c.x.size()) c.low.clear(), c.high.clear();
  }
  std::erase_if(figures, [](const FigureFile& f) { return f.curves.empty() && f.bars.empty(); });
  return figures;
}

std::string csv_of(const FigureFile& f) {
  std::string text;
  if (!f.bars.empty()) {
    text = fmt::format("{},{},low,high\r\n", quoted(f.x.title()), quoted(f.y.title()));
    for (const FigureBar& b : f.bars) text += fmt::format("{},{},{},{}\r\n", quoted(b.label), cell(b.value), cell(b.low), cell(b.high));
    return text;
  }
  text = fmt::format("curve,{},{},low,high\r\n", quoted(f.x.title()), quoted(f.y.title()));
  for (const FigureCurve& c : f.curves)
    for (std::size_t k = 0; k < c.x.size(); ++k)
      text += fmt::format("{},{},{},{},{}\r\n", quoted(c.label), cell(c.x[k]), cell(c.y[k]), c.low.empty() ? "" : cell(c.low[k]), c.high.empty() ? "" : cell(c.high[k]));
  return text;
}

std::string svg_of(const FigureFile& f) {
  std::vector<double> xs, ys;
  for (const FigureCurve& c : f.curves) {
    xs.insert(xs.end(), c.x.begin(), c.x.end());
    for (const auto* values : {&c.y, &c.low, &c.high}) ys.insert(ys.end(), values->begin(), values->end());
  }
  for (const FigureBar& b : f.bars) ys.insert(ys.end(), {b.value, b.high});
  const Scale across = scale_of(xs, f.x.log, left, width - right, false), up = scale_of(ys, f.y.log, height - bottom, top, !f.bars.empty());
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      f.curves.size() > 1 ? width + legend_width : width, height);
  s += frame_of(f, across, up, !f.bars.empty());
  const double slot = f.bars.empty() ? 0 : (width - left - right) / double(f.bars.size());
  const std::size_t every = (f.bars.size() + 19) / 20;
  for (std::size_t k = 0; k < f.bars.size(); ++k) {
    const FigureBar& b = f.bars[k];
    const double x = left + (double(k) + 0.5) * slot, y = up.at(b.value);
    s += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", x - 0.36 * slot, y, 0.72 * slot, up.at(0) - y, colours[0]);
    if (std::isfinite(b.low) && std::isfinite(b.high))
      s += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h8M{3:.1f} {2:.1f}h8\" stroke=\"#222\" fill=\"none\"/>\n", x, up.at(b.low), up.at(b.high), x - 4);
    if (k % every == 0) s += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", x, height - bottom + 19, escaped(b.label));
  }
  for (std::size_t k = 0; k < f.curves.size(); ++k) {
    const FigureCurve& c = f.curves[k];
    const char* const colour = colours[k % std::size(colours)];
    for (const auto* edge : {&c.low, &c.high})
      if (!edge->empty())
        s += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-opacity=\"0.4\" stroke-width=\"0.8\"/>\n", path_of(c.x, *edge, across, up, c.kind == Kind::steps), colour);
    if (c.kind == Kind::points) {
      for (std::size_t r = 0; r < c.x.size(); ++r)
        if (across.holds(c.x[r]) && up.holds(c.y[r])) s += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\" fill-opacity=\"0.7\"/>\n", across.at(c.x[r]), up.at(c.y[r]), colour);
    } else {
      s += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"{}/>\n", path_of(c.x, c.y, across, up, c.kind == Kind::steps), colour,
                       c.kind == Kind::dashes || k >= std::size(colours) ? " stroke-dasharray=\"5 3\"" : "");
    }
    if (f.curves.size() > 1)
      s += fmt::format("<rect x=\"{0}\" y=\"{1}\" width=\"12\" height=\"3\" fill=\"{2}\"/><text x=\"{3}\" y=\"{4}\" font-size=\"11\">{5}</text>\n", width, top + 8 + 16 * double(k), colour,
                       width + 18, top + 13 + 16 * double(k), escaped(c.label));
  }
  return s + "</svg>\n";
}

std::size_t write_figures(const std::string& folder, const jam::RunInfo& info, const jam::Analysis& analysis, const jam::Series& series) {
  prepare_folder(folder, true);
  const std::vector<FigureFile> figures = figure_files(info, analysis, series);
  for (const FigureFile& f : figures) {
    const auto path = [&](const char* suffix) { return (std::filesystem::path(folder) / (f.name + suffix)).string(); };
    write_text_file(path(".svg"), svg_of(f));
    write_text_file(path(".csv"), csv_of(f));
  }
  return figures.size();
}

}  // namespace jamscope
