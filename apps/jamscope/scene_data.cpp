#include "apps/jamscope/scene_data.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <set>

#include "libjam/errors.hpp"
#include "libjam/events/every_step.hpp"
#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/contact_graph.hpp"
#include "libjam/jamming/compressive_force.hpp"
#include "libjam/jamming/jam_clusters.hpp"
#include "libjam/jamming/jam_criteria.hpp"
#include "libjam/snapshot/reader.hpp"

namespace jamscope {
namespace {

static_assert(std::endian::native == std::endian::little, "the sections are little-endian");

using nlohmann::json;

constexpr double part_reach = 4;               // mean diameters around a jammed grain
constexpr std::size_t most_frames = 500;       // of the view
constexpr std::size_t most_fine_frames = 200;  // of those, from capture.h5
constexpr std::size_t most_stays = 100'000;
constexpr std::size_t most_triangles = 100'000;  // of a mesh; or glued grains
constexpr std::size_t most_contacts = 40'000;  // of a frame, the strongest

class Bytes {
 public:
  template <class T>
  void add(const std::vector<T>& values) {
    const auto* const from = reinterpret_cast<const char*>(values.data());
    bytes_.append(from, values.size() * sizeof(T));
  }
  const std::string& all() const { return bytes_; }

 private:
  std::string bytes_;
};

// In the format of zlib, by libdeflate, which takes a third to a twentieth of the time of zlib's best compression for the same size.
std::vector<char> deflated(const std::string& bytes) {
  constexpr int level = 6;  // the highest, 12, takes three times as long or more for a hundredth less
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(libdeflate_alloc_compressor(level), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::vector<char> packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
  return packed;
}

std::string base64(const std::vector<char>& bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  std::size_t to = 0;
  for (std::size_t k = 0; k < bytes.size(); k += 3, to += 4) {
    const auto byte = [&](std::size_t i) { return i < bytes.size() ? std::uint32_t{static_cast<unsigned char>(bytes[i])} : 0U; };
    const std::uint32_t word = byte(k) << 16 | byte(k + 1) << 8 | byte(k + 2);
    text[to] = letters[word >> 18 & 63];
    text[to + 1] = letters[word >> 12 & 63];
    if (k + 1 < bytes.size()) text[to + 2] = letters[word >> 6 & 63];
    if (k + 2 < bytes.size()) text[to + 3] = letters[word & 63];
  }
  return text;
}

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }
json point(const jam::Vec3& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

struct Box {
  jam::Vec3 low, high;
  std::uint16_t code(double v, int axis) const {
    const double length = high[axis] - low[axis];
    return std::uint16_t(std::lround(length > 0 ? std::clamp((v - low[axis]) / length, 0.0, 1.0) * 65535 : 0));
  }
};

// What all frames share.
struct Record {
  Box box;
  std::vector<jam::ParticleId> id;  // of all grains of all frames, ascending
  std::vector<float> radius;

  void know(const jam::Particles& grains) {
    if (grains.id == id) return;
    std::vector<std::pair<jam::ParticleId, float>> both;
    for (std::size_t k = 0; k < id.size(); ++k) both.emplace_back(id[k], radius[k]);
    for (std::size_t k = 0; k < grains.size(); ++k)
      if (!std::binary_search(id.begin(), id.end(), grains.id[k])) both.emplace_back(grains.id[k], grains.radius[k]);
    std::sort(both.begin(), both.end());
    id.clear();
    radius.clear();
    for (const auto& [i, r] : both) {
      id.push_back(i);
      radius.push_back(r);
    }
  }
};

// A frame has a grain that the record does not.
struct UnknownGrain {};

// In nearly every record all frames have the same grains: then the first and the last have them, and all have as many. `look_at_all`: reads every frame.
Record record_of(const jam::SnapshotSource& source, std::size_t first, const jam::Analysis& a, bool look_at_all) {
  Record record{{a.loaded.extent.low, a.loaded.extent.high}, {}, {}};
  record.know(source.read(first).particles);
  record.know(source.read(first + a.frames.size() - 1).particles);
  const bool as_many = std::all_of(a.frames.begin(), a.frames.end(), [&](const jam::FrameSummary& f) { return f.particles == record.id.size(); });
  for (std::size_t k = 1; (look_at_all || !as_many) && k + 1 < a.frames.size(); ++k) record.know(source.read(first + k).particles);
  return record;
}

// The frames of capture.h5, where it stands beside the run and is of it.
struct FineFrames {
  std::optional<jam::SnapshotIndex> index;
  std::vector<double> time;
};
FineFrames fine_frames(const std::filesystem::path& run_file, const jam::RunInfo& info) {
  FineFrames fine;
  if (run_file.empty()) return fine;
  const std::filesystem::path file = std::filesystem::path(run_file).replace_filename("capture.h5");
  if (!jam::is_jamscope_file(file)) return fine;
  jam::SnapshotIndex index = jam::read_index(file);
  if (index.info.created_utc != info.created_utc || index.info.case_sha256 != info.case_sha256) return fine;
  for (const jam::schema::FrameRow& row : index.frames) fine.time.push_back(row.time);
  fine.index = std::move(index);
  return fine;
}

// Frames in the order in which they are wanted; those of jams first.
struct Wanted {
  std::vector<std::size_t> of_jams, fine, spread;
};
Wanted wanted_frames(const jam::Analysis& a, const std::vector<double>& fine_times) {
  Wanted wanted;
  std::set<std::size_t> seen;
  const std::size_t frames = a.frames.size();
  const auto want = [&](std::vector<std::size_t>& list, std::size_t k) {
    if (k < frames && seen.insert(k).second) list.push_back(k);
  };
  const auto at = [&](double time) {
    const auto after = std::lower_bound(a.frames.begin(), a.frames.end(), time, [](const jam::FrameSummary& f, double t) { return f.time < t; });
    return std::size_t(after - a.frames.begin());
  };
  std::vector<const jam::JamEvent*> events, stays;
  for (const jam::JamEvent& e : a.events) events.push_back(&e);
  for (const jam::Track& t : a.tracks) stays.push_back(&t.event);
  for (auto* list : {&events, &stays})
    std::stable_sort(list->begin(), list->end(), [](const auto* x, const auto* y) { return x->peak_force > y->peak_force; });
  for (const jam::JamEvent* e : events) want(wanted.of_jams, at(e->peak_time));
  for (const jam::JamEvent* e : events) {
    want(wanted.of_jams, e->first_frame);
    want(wanted.of_jams, e->last_frame);
  }
  for (const jam::JamEvent* e : stays) want(wanted.of_jams, at(e->peak_time));
  // Jams of single grains that fall between two frames.
  std::vector<const jam::StepJam*> jams;
  if (a.every_step.size() > 1)
    for (const jam::StepJam& j : a.every_step[1].jams) jams.push_back(&j);
  std::stable_sort(jams.begin(), jams.end(), [](const auto* x, const auto* y) { return x->peak_force > y->peak_force; });
  std::set<std::size_t> fine;
  for (const jam::StepJam* j : jams) {
    if (const std::size_t k = at(j->start); k < frames && a.frames[k].time <= j->end) continue;
    std::size_t best = fine_times.size();
    for (auto t = std::lower_bound(fine_times.begin(), fine_times.end(), j->start); t != fine_times.end() && *t <= j->end; ++t)
      if (best == fine_times.size() || std::abs(*t - j->peak_time) < std::abs(fine_times[best] - j->peak_time)) best = std::size_t(t - fine_times.begin());
    if (best < fine_times.size() && fine.size() < most_fine_frames && fine.insert(best).second) wanted.fine.push_back(best);
  }
  // Halves, quarters, eighths: wherever it stops, what there is is spread evenly.
  if (frames > 0) {
    want(wanted.spread, 0);
    want(wanted.spread, frames - 1);
    for (std::size_t parts = 2; parts / 2 < frames; parts *= 2)
      for (std::size_t k = 1; k < parts; k += 2) want(wanted.spread, (k * (frames - 1) + parts / 2) / parts);
  }
  return wanted;
}

struct Shown {
  json row;
  std::string section;
};

// `part`: only the grains near jammed ones. `fine`: of capture.h5, so that the samples do not know it.
Shown encoded(const jam::Snapshot& s, const jam::RunInfo& info, const jam::Analysis& a, std::size_t frame, const Record& record, bool part, bool fine) {
  const std::vector<jam::ParticleId>& ids = record.id;
  const jam::Particles& p = s.particles;
  if (!std::includes(ids.begin(), ids.end(), p.id.begin(), p.id.end())) throw UnknownGrain{};
  const jam::ContactGraph graph(s, info.walls);
  const std::vector<double> force = jam::compressive_forces(graph, a.criteria.measure);
  const std::vector<double> limit = jam::jam_limits(graph, info, a.criteria);
  std::vector<std::uint32_t> rows;
  if (part) {
    double diameter = 0;
    for (const float r : p.radius) diameter += 2 * double{r} / double(p.size());
    std::vector<jam::Vec3f> jammed;
    for (std::uint32_t v = 0; v < p.size(); ++v)
      if (force[v] > limit[v]) jammed.push_back(p.position[v]);
    for (std::uint32_t v = 0; v < p.size(); ++v)
      if (std::any_of(jammed.begin(), jammed.end(), [&](const jam::Vec3f& at) { return double((p.position[v] - at).norm()) < part_reach * diameter; }))
        rows.push_back(v);
  } else {
    rows.resize(p.size());
    for (std::uint32_t v = 0; v < rows.size(); ++v) rows[v] = v;
  }
  const bool whole = rows.size() == ids.size() && p.id == ids;
  std::vector<std::uint32_t> place(p.size(), std::uint32_t(-1)), table;
  for (std::uint32_t k = 0; k < rows.size(); ++k) {
    place[rows[k]] = k;
    table.push_back(std::uint32_t(std::lower_bound(ids.begin(), ids.end(), p.id[rows[k]]) - ids.begin()));
  }
  const bool has_velocity = jam::present(p.velocity, p.size());
  std::array<std::vector<std::uint16_t>, 3> at;
  std::vector<std::uint16_t> speeds, forces;
  std::vector<std::uint8_t> contacts;
  for (const std::uint32_t v : rows) {
    for (int axis = 0; axis < 3; ++axis) at[std::size_t(axis)].push_back(record.box.code(double{p.position[v][axis]}, axis));
    speeds.push_back(has_velocity ? log_code(double{p.velocity[v].norm()}) : log_code(std::numeric_limits<double>::quiet_NaN()));
    forces.push_back(log_code(force[v]));
    contacts.push_back(std::uint8_t(std::min<std::size_t>(255, graph.degree(v) + graph.wall_contacts(v).size())));
  }
  // Contacts above the mean of those that press, and all that carry the load of a jammed grain; the strongest where there are too many.
  double sum = 0;
  std::size_t pressing = 0;
  const auto count = [&](double f) {
    sum += f;
    pressing += f > 0;
  };
  for (std::size_t c = 0; c < s.pp.size(); ++c) count(jam::repulsive_force(s.pp, c));
  for (std::size_t c = 0; c < s.pw.size(); ++c) count(jam::repulsive_force(s.pw, c));
  double least = pressing > 0 ? sum / double(pressing) : 0.0;
  const double mean = least;
  std::vector<double> above;
  for (std::size_t c = 0; c < s.pp.size(); ++c)
    if (const double f = jam::repulsive_force(s.pp, c); f > least) above.push_back(f);
  if (above.size() > most_contacts) {
    std::nth_element(above.begin(), above.begin() + std::ptrdiff_t(most_contacts), above.end(), std::greater<>());
    least = above[most_contacts];
  }
  std::vector<std::uint32_t> first, second, grain;
  std::vector<std::uint16_t> pair_force, wall_force;
  std::array<std::vector<std::uint16_t>, 3> touch;
  std::vector<std::uint8_t> wall;
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const double f = jam::repulsive_force(s.pp, c);
    const auto [v, w] = s.pp.row[c];
    const std::uint32_t i = place[v], j = place[w];
    const bool of_jam = f > 0 && force[v] > limit[v] && force[w] > limit[w];
    if (!(f > least || of_jam) || i == std::uint32_t(-1) || j == std::uint32_t(-1)) continue;
    first.push_back(i);
    second.push_back(j);
    pair_force.push_back(log_code(f));
  }
  const bool has_point = jam::present(s.pw.point, s.pw.size()), has_normal = jam::present(s.pw.normal, s.pw.size());
  for (std::size_t c = 0; c < s.pw.size() && (has_point || has_normal); ++c) {
    const double f = jam::repulsive_force(s.pw, c);
    const std::uint32_t v = s.pw.row[c], i = place[v];
    if (!(f > least || (f > 0 && force[v] > limit[v])) || i == std::uint32_t(-1)) continue;
    const jam::Vec3f end = has_point ? s.pw.point[c] : jam::Vec3f(p.position[v] + p.radius[v] * s.pw.normal[c]);
    grain.push_back(i);
    wall.push_back(s.pw.wall[c]);
    for (int axis = 0; axis < 3; ++axis) touch[std::size_t(axis)].push_back(record.box.code(double{end[axis]}, axis));
    wall_force.push_back(log_code(f));
  }
  Bytes bytes;
  if (!whole) bytes.add(table);
  for (const auto& axis : at) bytes.add(axis);
  bytes.add(speeds);
  bytes.add(forces);
  bytes.add(contacts);
  bytes.add(first);
  bytes.add(second);
  bytes.add(pair_force);
  bytes.add(grain);
  bytes.add(wall);
  for (const auto& axis : touch) bytes.add(axis);
  bytes.add(wall_force);
  Shown shown;
  shown.row = {{"frame", frame}, {"time", s.time}, {"fine", fine}, {"whole", whole}, {"part", part}, {"grains", rows.size()}, {"contacts", first.size()},
               {"wall_contacts", grain.size()}, {"mean_force", mean}, {"least_force", least}, {"poses", json::array()}};
  for (const jam::WallState& w : s.walls) {
    const auto& q = w.orientation;
    shown.row["poses"].push_back({w.position.x(), w.position.y(), w.position.z(), q.w(), q.x(), q.y(), q.z()});
  }
  // Who is jammed, by the criterion of the analysis, in which of the clusters, and which of these bridge blade and vessel.
  for (const char* name : {"jammed", "cluster", "bridges"}) shown.row[name] = json::array();
  const std::vector<jam::Cluster> clusters = jam::jam_clusters(graph, jam::jammed_particles(graph, force, info, a.criteria), a.criteria, 0);
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    for (const jam::ParticleId id : clusters[k].members) {
      shown.row["jammed"].push_back(id);
      shown.row["cluster"].push_back(k);
    }
    shown.row["bridges"].push_back(clusters[k].bridges);
  }
  if (fine) {
    shown.row["loaded"] = json::array();
    for (std::size_t v = 0; v < p.size(); ++v)
      if (force[v] > a.loaded.floor) shown.row["loaded"].push_back({p.id[v], force[v]});
  }
  shown.section = base64(deflated(bytes.all()));
  return shown;
}

const char* role_name(jam::WallRole role) {
  return role == jam::WallRole::blade ? "blade" : role == jam::WallRole::vessel ? "vessel" : "other";
}

class Sections {
 public:
  explicit Sections(SceneData& data, std::size_t room) : data_(data), room_(room) {}
  bool fits(const std::string& section, double share = 1) const { return used_ + section.size() <= std::size_t(share * double(room_)); }
  std::size_t add(std::string section) {
    used_ += section.size();
    data_.sections.push_back(std::move(section));
    return data_.sections.size() - 1;
  }

 private:
  SceneData& data_;
  std::size_t room_, used_ = 0;
};

json walls_json(const jam::RunInfo& info, Sections& sections) {
  json walls = json::array();
  for (const jam::Wall& w : info.walls) {
    json row{{"name", w.name}, {"kind", w.kind}, {"role", role_name(w.role)}, {"free", w.free_side}, {"point", point(w.point)}, {"axis", point(w.axis)}, {"radius", w.radius},
             {"high_radius", w.high_radius}, {"hole_radius", w.hole_radius}, {"low", number(w.low)}, {"high", number(w.high)}};
    if (!w.triangles.empty()) {
      if (w.triangles.size() > most_triangles) {
        row["left_out"] = fmt::format("{} triangles are too many for this page", w.triangles.size());
      } else {
        std::vector<float> vertices;
        std::vector<std::uint32_t> triangles;
        for (const jam::Vec3& v : w.vertices)
          for (int axis = 0; axis < 3; ++axis) vertices.push_back(float(v[axis]));
        for (const auto& t : w.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
        Bytes bytes;
        bytes.add(vertices);
        bytes.add(triangles);
        row["vertices"] = w.vertices.size();
        row["triangles"] = w.triangles.size();
        row["section"] = sections.add(base64(deflated(bytes.all())));
      }
    }
    if (w.sphere_centre.size() > most_triangles) {
      row["left_out"] = fmt::format("{} glued grains are too many for this page", w.sphere_centre.size());
    } else if (!w.sphere_centre.empty()) {
      std::vector<float> spheres;
      for (std::size_t k = 0; k < w.sphere_centre.size(); ++k) {
        for (int axis = 0; axis < 3; ++axis) spheres.push_back(float(w.sphere_centre[k][axis]));
        spheres.push_back(float(w.sphere_radius[k]));
      }
      Bytes bytes;
      bytes.add(spheres);
      row["spheres"] = w.sphere_centre.size();
      row["section"] = sections.add(base64(deflated(bytes.all())));
    }
    walls.push_back(row);
  }
  return walls;
}

json samples_json(const Record& record, const jam::Analysis& a, Sections& sections) {
  std::vector<double> time, force;
  std::vector<std::uint32_t> particle;
  std::array<std::vector<std::uint16_t>, 3> at;
  std::vector<std::uint16_t> speed;
  std::vector<std::uint8_t> in_gap;
  for (const jam::FrameSummary& f : a.frames) time.push_back(f.time);
  for (const jam::LoadedGrain& g : a.loaded.grains) {
    particle.push_back(g.particle);
    force.push_back(g.force);
    for (int axis = 0; axis < 3; ++axis) at[std::size_t(axis)].push_back(record.box.code(double{g.position[axis]}, axis));
    speed.push_back(log_code(double{g.speed}));
    in_gap.push_back(g.in_gap);
  }
  Bytes bytes;
  bytes.add(time);
  bytes.add(a.loaded.count);
  bytes.add(particle);
  bytes.add(force);
  for (const auto& axis : at) bytes.add(axis);
  bytes.add(speed);
  bytes.add(in_gap);
  std::string section = base64(deflated(bytes.all()));
  if (!sections.fits(section)) return nullptr;
  return {{"frames", time.size()}, {"samples", particle.size()}, {"floor", a.loaded.floor}, {"by_force", jam::criterion_of(a.criteria).name == "compressive_force"},
          {"end_force", a.criteria.end_force ? json(*a.criteria.end_force) : json(nullptr)}, {"hold_off", a.criteria.hold_off},
          {"shortest", a.criteria.shortest_jam}, {"section", sections.add(std::move(section))}};
}

json stays_json(const jam::RunInfo& info, const jam::Analysis& a, const jam::Series& series, Sections& sections) {
  if (a.every_step.empty()) return nullptr;
  const jam::Excursions stays = jam::last_word(series.excursions);
  if (stays.size() > most_stays) return nullptr;
  const jam::Sites sites{.z_low = info.gap.z_low, .z_high = info.gap.z_high};
  std::vector<double> first, last, peak;
  std::vector<std::uint8_t> site;
  for (std::size_t k = 0; k < stays.size(); ++k) {
    first.push_back(double(stays.first_step[k]));
    last.push_back(double(stays.last_step[k]));
    peak.push_back(double(stays.peak_step[k]));
    site.push_back(std::uint8_t(sites.of(jam::in_blade_frame(a.blade, double(stays.peak_step[k]) * info.dt, stays.peak_position[k].cast<double>()))));
  }
  Bytes bytes;
  bytes.add(stays.particle);
  bytes.add(first);
  bytes.add(last);
  bytes.add(peak);
  bytes.add(stays.peak_force);
  bytes.add(site);
  bytes.add(stays.open);
  std::string section = base64(deflated(bytes.all()));
  if (!sections.fits(section)) return nullptr;
  return {{"rows", stays.size()}, {"watch_force", info.watch_force}, {"dt", info.dt}, {"stride", info.watch_stride},
          {"first_step", a.frames.empty() ? 0 : a.frames.front().step}, {"hold_off", a.criteria.hold_off}, {"shortest", a.criteria.shortest_jam},
          {"begin", a.frames.empty() ? 0.0 : double(a.frames.front().step) * info.dt}, {"end", series.time.empty() ? 0.0 : series.time.back()},
          {"section", sections.add(std::move(section))}};
}

SceneData scene_of(const jam::SnapshotSource& source, std::size_t first, const Record& record, const jam::Analysis& a, const jam::Series& series, std::size_t room,
                   const std::filesystem::path& file) {
  SceneData data;
  Sections sections(data, room);
  data.samples = samples_json(record, a, sections);
  data.stays = stays_json(source.info, a, series, sections);

  const FineFrames fine = fine_frames(file, source.info);
  const Wanted wanted = wanted_frames(a, fine.time);
  Bytes grains;
  grains.add(record.id);
  grains.add(record.radius);
  const std::size_t grains_section = sections.add(base64(deflated(grains.all())));
  const json walls = walls_json(source.info, sections);

  std::vector<json> rows;
  const auto add = [&](Shown shown, double share) {
    if (rows.size() >= most_frames || !sections.fits(shown.section, share)) return false;
    shown.row["section"] = sections.add(std::move(shown.section));
    rows.push_back(std::move(shown.row));
    return true;
  };
  bool whole = true;
  // Whole while there is room for it, then part; false where not even that fits.
  const auto add_jam = [&](const jam::Snapshot& s, std::size_t frame, bool is_fine) {
    whole = whole && add(encoded(s, source.info, a, frame, record, false, is_fine), 0.5);
    return whole || add(encoded(s, source.info, a, frame, record, true, is_fine), 0.75);
  };
  for (const std::size_t frame : wanted.of_jams)
    if (!add_jam(source.read(first + frame), frame, false)) break;
  for (const std::size_t k : wanted.fine) {
    const auto after = std::upper_bound(a.frames.begin(), a.frames.end(), fine.time[k], [](double t, const jam::FrameSummary& f) { return t < f.time; });
    if (!add_jam(jam::read_frame(*fine.index, k), std::size_t(std::max<std::ptrdiff_t>(after - a.frames.begin() - 1, 0)), true)) break;
  }
  for (const std::size_t frame : wanted.spread)
    if (!add(encoded(source.read(first + frame), source.info, a, frame, record, false, false), 1)) break;
  std::sort(rows.begin(), rows.end(), [](const json& x, const json& y) { return x["time"].get<double>() < y["time"].get<double>(); });
  data.view = {{"why", ""}, {"low", point(record.box.low)}, {"high", point(record.box.high)}, {"grains", record.id.size()}, {"grains_section", grains_section},
               {"walls", walls}, {"frames", rows}, {"all_frames", a.frames.size()}, {"part_reach", part_reach}};
  return data;
}

}  // namespace

std::uint16_t log_code(double value) {
  if (std::isnan(value)) return 65535;
  if (!(value > 1e-12)) return 0;
  return std::uint16_t(1 + std::lround((std::log10(std::min(value, 1e6)) + 12) * 65533 / 18));
}

double from_log_code(std::uint16_t code) {
  if (code == 65535) return std::numeric_limits<double>::quiet_NaN();
  return code == 0 ? 0.0 : std::pow(10, (code - 1) * 18.0 / 65533 - 12);
}

std::optional<std::size_t> first_frame(const jam::SnapshotSource& source, const jam::Analysis& a) {
  if (a.frames.size() > source.frames || a.frames.empty()) return std::nullopt;
  std::size_t low = 0, high = source.frames - a.frames.size();
  if (low == high) return source.read(0).step == a.frames.front().step ? std::optional<std::size_t>(0) : std::nullopt;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (source.read(middle).time < a.frames.front().time)
      low = middle + 1;
    else
      high = middle;
  }
  return source.read(low).time == a.frames.front().time ? std::optional<std::size_t>(low) : std::nullopt;
}

SceneData no_scene(const std::string& why) {
  SceneData data;
  data.view = {{"why", why}, {"frames", json::array()}};
  return data;
}

SceneData scene_data(const jam::SnapshotSource& source, const jam::Analysis& a, const jam::Series& series, std::size_t room, const std::filesystem::path& file) {
  if (a.frames.empty()) return no_scene("The record holds no frames.");
  try {
    const std::optional<std::size_t> first = first_frame(source, a);
    if (!first) return no_scene("The snapshots that were found are not those of this analysis.");
    if (!(a.loaded.extent.low.x() < a.loaded.extent.high.x())) return no_scene("The frames hold no grains.");
    try {
      return scene_of(source, *first, record_of(source, *first, a, false), a, series, room, file);
    } catch (const UnknownGrain&) {
      return scene_of(source, *first, record_of(source, *first, a, true), a, series, room, file);
    }
  } catch (const jam::DataError& error) {
    return no_scene(fmt::format("The snapshots could not be read: {}", error.what()));
  }
}

}  // namespace jamscope
