#include "libjam/partial_file.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "libjam/errors.hpp"
#include "libjam/results_tables.hpp"
#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/schema_run_info.hpp"
#include "libjam/snapshot/validate.hpp"

namespace jam {

// What a frame has once, flat.
struct PartialRow {
  double power = 0;
  Vec3 low, high;  // Extent
  bool blade_moves = false, tangential_forces_missing = false;
  std::uint64_t recovered_contacts = 0;
  Series::EndedContacts ages_pp{}, ages_pw{};
};

template <class Visit>
void columns_of(PartialRow*, Visit&& column) {
  column("power", &PartialRow::power, "W", "that the blades put into the grains; NaN where it is not known");
  column("low", &PartialRow::low, "m", "where the particles are: from here");
  column("high", &PartialRow::high, "m", "to here");
  column("blade_moves", &PartialRow::blade_moves, "1", "some blade does");
  column("tangential_forces_missing", &PartialRow::tangential_forces_missing, "1", "of contacts with walls");
  column("recovered_contacts", &PartialRow::recovered_contacts, "1", "contacts with walls that are not in the source");
  column("ages_pp", &PartialRow::ages_pp, "1", "contacts of particles by octave of age in steps");
  column("ages_pw", &PartialRow::ages_pw, "1", "contacts with walls likewise");
}

namespace {

constexpr const char* group_name = "/partial";

PartialRow partial_row_of(const ExaminedFrame& f) {
  return {f.power, f.extent.low, f.extent.high, f.blade_moves,
          f.tangential_forces_missing, f.recovered_contacts, f.ages_pp, f.ages_pw};
}

void take(ExaminedFrame& f, const PartialRow& r) {
  f.power = r.power;
  f.extent.low = r.low;
  f.extent.high = r.high;
  f.blade_moves = r.blade_moves;
  f.tangential_forces_missing = r.tangential_forces_missing;
  f.recovered_contacts = r.recovered_contacts;
  f.ages_pp = r.ages_pp;
  f.ages_pw = r.ages_pw;
}

std::vector<std::string> metric_names(const Criteria& criteria) { return criteria.metrics.value_or(std::vector<std::string>{}); }

void expect_rows(const h5::File& file, const std::string& what, std::size_t rows, std::size_t expected) {
  if (rows != expected) file.fail(what, "has " + std::to_string(rows) + " rows, expected " + std::to_string(expected));
}

// Everything that decides what the numbers of a part mean.
bool same_run(const PartialAnalysis& a, const PartialAnalysis& b) {
  return a.run.case_toml == b.run.case_toml && a.run.case_sha256 == b.run.case_sha256 && a.run.creator == b.run.creator &&
         a.run.created_utc == b.run.created_utc && a.run.seed == b.run.seed && a.run.dt == b.run.dt && a.run.walls.size() == b.run.walls.size();
}
bool same_criteria(const Criteria& a, const Criteria& b) {
  return a.criterion == b.criterion && a.threshold == b.threshold && a.measure == b.measure && a.jam_force == b.jam_force &&
         a.end_force == b.end_force && a.hold_off == b.hold_off && a.shortest_jam == b.shortest_jam &&
         a.bridge_contact_share == b.bridge_contact_share && a.gap_margin == b.gap_margin && a.survival_classes == b.survival_classes &&
         a.metrics == b.metrics;
}

}  // namespace

void write_partial(const std::filesystem::path& path, const PartialAnalysis& part) {
  h5::write_aside(path, [&](h5::File& file) {
    write_run_info(file, part.run);
    file.make_group(group_name);
    file.set_attribute(group_name, "first_frame", part.first_frame);
    file.write_texts("/partial/inputs", part.inputs, "files that the frames were read from");
    file.write_texts("/partial/command_line", part.command_line, "that examined the frames");
    write_criteria(file, part.criteria);
    file.write_texts("/criteria/metrics", metric_names(part.criteria), "recorded for each frame");
    const auto summary = [](const ExaminedFrame& f) -> const FrameSummary& { return f.summary; };
    write_table<FrameSummary>(file, "/partial/frames", part.frames, summary);
    std::vector<PartialRow> rows;
    for (const ExaminedFrame& f : part.frames) rows.push_back(partial_row_of(f));
    write_table(file, "/partial/rows", rows);
    std::vector<BladeRow> blade;
    for (const ExaminedFrame& f : part.frames) blade.push_back(row_of(f.blade));
    write_table(file, "/partial/blade", blade);
    write_table(file, "/partial/loaded",
                write_parts(file, "/partial/rows", "loaded", "/partial/loaded", part.frames,
                            [](const ExaminedFrame& f) -> const std::vector<LoadedGrain>& { return f.loaded; }));
    write_with_members(file, "/partial/clusters",
                       write_parts(file, "/partial/rows", "cluster", "/partial/clusters", part.frames,
                                   [](const ExaminedFrame& f) -> const std::vector<Cluster>& { return f.clusters; }));
    write_table(file, "/partial/jammed",
                write_parts(file, "/partial/rows", "jammed", "/partial/jammed", part.frames,
                            [](const ExaminedFrame& f) -> const std::vector<JammedSample>& { return f.jams.jammed; }));
    write_table(file, "/partial/nearly",
                write_parts(file, "/partial/rows", "nearly", "/partial/nearly", part.frames,
                            [](const ExaminedFrame& f) -> const std::vector<JammedSample>& { return f.jams.nearly; }));
    write_table(file, "/partial/flow", part.frames.empty() ? std::vector<FlowSums::Bin>{} : part.frames.front().flow.bins);
    const std::vector<std::string> names = metric_names(part.criteria);
    for (std::size_t m = 0; m < names.size(); ++m) {
      std::vector<double> values;
      for (const ExaminedFrame& f : part.frames) values.push_back(f.metrics[m]);
      file.write("/partial/metrics/" + names[m], values, "1", "of each frame, in the metric's unit");
    }
    const auto write = [&](const std::string& column, const schema::Item& item, const auto& values) {
      if (!values.empty()) file.write("/partial" + column, values, std::string(item.unit), std::string(item.doc));
    };
    schema::visit_all_series(part.series, part.run.walls, write);
    schema::visit_excursions(part.series.excursions, [&](const schema::Item& item, const auto& values) { write(schema::path_of(item), item, values); });
    file.set_attribute(group_name, "walls_in_series", std::uint32_t(part.series.walls.size()));
  });
}

PartialAnalysis read_partial(const std::filesystem::path& path) {
  const h5::File file = h5::File::open(path);
  if (!file.exists(group_name)) file.fail(group_name, "missing: not a part of an analysis, expected one that `analyze --partial` wrote");
  PartialAnalysis part;
  part.run = read_run_info(file);
  part.first_frame = file.attribute<std::uint64_t>(group_name, "first_frame");
  part.inputs = file.read_texts("/partial/inputs");
  part.command_line = file.read_texts("/partial/command_line");
  part.criteria = read_criteria(file);
  part.criteria.metrics = file.read_texts("/criteria/metrics");
  const auto summaries = read_table<FrameSummary>(file, "/partial/frames");
  const auto rows = read_table<PartialRow>(file, "/partial/rows");
  expect_rows(file, "/partial/rows", rows.size(), summaries.size());
  const auto blade = read_table<BladeRow>(file, "/partial/blade");
  expect_rows(file, "/partial/blade", blade.size(), rows.size());
  const auto loaded = read_parts(file, "/partial/rows", "loaded", read_table<LoadedGrain>(file, "/partial/loaded"), rows.size());
  const auto clusters = read_parts(file, "/partial/rows", "cluster", read_with_members<Cluster>(file, "/partial/clusters"), rows.size());
  const auto jammed = read_parts(file, "/partial/rows", "jammed", read_table<JammedSample>(file, "/partial/jammed"), rows.size());
  const auto nearly = read_parts(file, "/partial/rows", "nearly", read_table<JammedSample>(file, "/partial/nearly"), rows.size());
  part.frames.resize(rows.size());
  for (const auto& grains : loaded) part.loaded += grains.size();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ExaminedFrame& f = part.frames[k];
    f.summary = summaries[k];
    take(f, rows[k]);
    f.blade = pose_of(blade[k]);
    f.loaded = loaded[k];
    f.clusters = clusters[k];
    f.jams = {summaries[k].time, jammed[k], nearly[k]};
  }
  if (auto flow = read_table<FlowSums::Bin>(file, "/partial/flow"); !flow.empty()) {
    expect_rows(file, "/partial/flow", flow.size(), FlowBin::count);
    if (part.frames.empty()) file.fail("/partial/flow", "has rows, expected none where there are no frames");
    part.frames.front().flow.bins = std::move(flow);
  }
  for (const std::string& name : *part.criteria.metrics) {
    const auto values = file.read<double>("/partial/metrics/" + name);
    expect_rows(file, "/partial/metrics/" + name, values.size(), rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) part.frames[k].metrics.push_back(values[k]);
  }
  const auto walls = file.attribute<std::uint32_t>(group_name, "walls_in_series");
  if (walls > part.run.walls.size()) file.fail(group_name, "walls_in_series is " + std::to_string(walls) + ", expected at most " + std::to_string(part.run.walls.size()));
  part.series.walls.resize(walls);
  const auto read = [&]<class V>(const std::string& column, const schema::Item&, std::vector<V>& values) {
    if (file.exists("/partial" + column)) values = file.read<V>("/partial" + column);
  };
  schema::visit_all_series(part.series, part.run.walls, read);
  schema::visit_excursions(part.series.excursions, [&](const schema::Item& item, auto& values) { read(schema::path_of(item), item, values); });
  validate(part.series, part.run, path.string());
  return part;
}

void add_frame(PartialAnalysis& part, ExaminedFrame frame) {
  part.loaded += frame.loaded.size();
  if (!part.frames.empty()) {
    add(part.frames.front().flow, frame.flow);
    frame.flow = {};
  }
  part.frames.push_back(std::move(frame));
  if (part.loaded <= 4 * LoadedGrains::most) return;
  std::vector<double> force;
  for (const ExaminedFrame& f : part.frames)
    for (const LoadedGrain& g : f.loaded) force.push_back(g.force);
  const auto place = force.begin() + std::ptrdiff_t(2 * LoadedGrains::most);
  std::nth_element(force.begin(), place, force.end(), std::greater<>());
  part.loaded = 0;
  for (ExaminedFrame& f : part.frames) {
    std::erase_if(f.loaded, [&](const LoadedGrain& g) { return !(g.force > *place); });
    f.loaded.shrink_to_fit();
    part.loaded += f.loaded.size();
  }
}

PartialAnalysis joined(std::vector<PartialAnalysis> parts, const std::vector<std::string>& names) {
  if (parts.empty()) return {};
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return parts[a].first_frame < parts[b].first_frame; });
  PartialAnalysis whole = std::move(parts[order[0]]);
  for (std::size_t k = 1; k < order.size(); ++k) {
    PartialAnalysis& next = parts[order[k]];
    const std::string &before = names[order[k - 1]], &name = names[order[k]];
    if (!same_run(whole, next)) throw DataError(name + ": belongs to another run than " + before);
    if (!same_criteria(whole.criteria, next.criteria)) throw DataError(name + ": was analysed by other criteria than " + before);
    const std::uint64_t end = whole.first_frame + whole.frames.size();
    if (next.first_frame != end)
      throw DataError(name + ": begins at frame " + std::to_string(next.first_frame) + ", expected frame " + std::to_string(end) + ", where " + before + " ends");
    for (ExaminedFrame& frame : next.frames) add_frame(whole, std::move(frame));
    schema::append(whole.series, next.series);
  }
  return whole;
}

Analysis finish(const PartialAnalysis& part) {
  Pipeline pipeline(part.run, part.criteria);
  for (ExaminedFrame frame : part.frames) {
    for (Cluster& cluster : frame.clusters) cluster.frame -= std::uint32_t(part.first_frame);
    pipeline.add(std::move(frame));
  }
  return pipeline.finish(part.series);
}

}  // namespace jam
