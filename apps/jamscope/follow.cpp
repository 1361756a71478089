#include "apps/jamscope/follow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "apps/jamscope/console.hpp"
#include "apps/jamscope/errors.hpp"
#include "libjam/events/jam_frame.hpp"
#include "libjam/graph/contact_force.hpp"
#include "libjam/metrics/frame_network.hpp"
#include "libjam/results_file.hpp"

namespace jamscope {
namespace {

constexpr std::size_t around = 10;  // frames

// What has gathered on a grain's way, by the trapezoidal rule over frames.
struct Way {
  double time = 0, speed = 0, spin = 0;  // s, m/s, rad/s, of the last frame
  double path = 0, turned = 0;           // m, rad
  void add(double now, double speed_now, double spin_now, bool first) {
    if (!first) {
      path += 0.5 * (now - time) * (speed + speed_now);
      turned += 0.5 * (now - time) * (spin + spin_now);
    }
    time = now, speed = speed_now, spin = spin_now;
  }
};

double force_of_walls(const jam::ContactGraph& graph, jam::ContactGraph::Vertex v, jam::WallRole role) {
  double sum = 0;
  for (const std::uint32_t c : graph.wall_contacts(v, role)) sum += jam::repulsive_force(graph.snapshot().pw, c);
  return sum;
}

std::string list(const jam::Vec3f& v) { return fmt::format("{},{},{}", v.x(), v.y(), v.z()); }

// The row of a particle; nothing where the frame does not have it.
std::optional<jam::ContactGraph::Vertex> row_of(const jam::Snapshot& snapshot, jam::ParticleId id) {
  const auto& ids = snapshot.particles.id;
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  if (found == ids.end() || *found != id) return std::nullopt;
  return jam::ContactGraph::Vertex(found - ids.begin());
}

void print_path(std::size_t number, jam::FrameNetwork& network, const jam::JamFrame& jams, jam::ContactGraph::Vertex v, const jam::BladePose& blade,
                Way& way, bool first) {
  const jam::ContactGraph& graph = network.graph;
  jam::JammedSample s = jam::sample_of(graph, v, network.compressive()[v], network.run, blade, network.criteria);
  const auto jammed = std::find_if(jams.jammed.begin(), jams.jammed.end(), [&](const jam::JammedSample& j) { return j.particle == s.particle; });
  if (jammed != jams.jammed.end()) s = *jammed;
  way.add(jams.time, double{s.velocity.norm()}, double{s.angular_velocity.norm()}, first);
  fmt::print("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", number, jams.time, s.particle, list(s.position), list(s.from_blade),
             list(s.velocity), s.speed_over_tip, list(s.angular_velocity), way.path, way.turned, s.compressive_force,
             force_of_walls(graph, v, jam::WallRole::blade), force_of_walls(graph, v, jam::WallRole::vessel), s.pushed_by,
             int{jammed != jams.jammed.end()}, int{s.in_gap}, int{s.bridged}, s.least_gap);
}

template <class Contacts>
void print_contact(std::size_t number, const jam::Snapshot& s, jam::ContactGraph::Vertex v, const std::string& kind, const std::string& partner,
                   const Contacts& contacts, std::size_t c) {
  const auto or_nan = [&](const std::vector<float>& column) {
    return jam::present(column, contacts.size()) ? double{column[c]} : std::numeric_limits<double>::quiet_NaN();
  };
  const double tangential = jam::present(contacts.tangential_force, contacts.size()) ? double{contacts.tangential_force[c].norm()}
                                                                                     : std::numeric_limits<double>::quiet_NaN();
  fmt::print("{},{},{},{},{},{},{},{}\n", number, s.time, s.particles.id[v], kind, partner, jam::normal_force(contacts, c), tangential,
             or_nan(contacts.overlap));
}

void print_contacts(std::size_t number, const jam::ContactGraph& graph, const jam::RunInfo& info, jam::ContactGraph::Vertex v) {
  const jam::Snapshot& s = graph.snapshot();
  for (const jam::ContactGraph::Neighbor& n : graph.neighbors(v))
    print_contact(number, s, v, "particle", fmt::format("{}", s.particles.id[n.vertex]), s.pp, n.contact);
  for (const std::uint32_t c : graph.wall_contacts(v)) print_contact(number, s, v, "wall", info.walls[s.pw.wall[c]].name, s.pw, c);
}

// The members of a jam, and the frames around it.
std::vector<std::uint32_t> members_of(const FollowOptions& options, std::string& frames) {
  const std::filesystem::path beside = std::filesystem::path(options.input.paths.front()).parent_path();
  const std::filesystem::path results = (options.results.empty() ? beside : std::filesystem::path(options.results)) / "jam.h5";
  if (!std::filesystem::exists(results))
    throw UsageError(fmt::format("--jam: there is no {}; --results names the folder of the analysis", results.string()));
  const jam::Analysis analysis = jam::read_results(results);
  if (*options.jam >= analysis.events.size())
    throw UsageError(fmt::format("--jam {}: {} has {} jams, counted from 0", *options.jam, results.string(), analysis.events.size()));
  const jam::JamEvent& event = analysis.events[*options.jam];
  if (frames.empty()) frames = fmt::format("{}:{}", event.first_frame - std::min<std::size_t>(event.first_frame, around), event.last_frame + around + 1);
  return event.members;
}

}  // namespace

int follow(const FollowOptions& options) {
  const jam::SnapshotSource source = open_stored_run(options.input);
  std::string frames = options.frames;
  std::vector<std::uint32_t> particles = options.jam ? members_of(options, frames) : options.particles;
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  if (particles.empty()) throw UsageError("follow whom? --particles ID,... or --jam K");
  const jam::Criteria criteria = stored_run_criteria(source.info, "", options.overrides);
  const FrameRange range = frame_range(frames, source.frames);

  Console console(stderr, LogFormat::text, options.quiet);
  Progress progress;
  progress.stage = "follow";
  progress.unit = "frames";
  progress.total = double(range.last - range.first);
  if (options.of == FollowOf::path)
    fmt::print("frame,time [s],id,x [m],y [m],z [m],from_blade_x [m],from_blade_y [m],from_blade_z [m],vx [m/s],vy [m/s],vz [m/s],speed_over_tip [1],"
               "wx [rad/s],wy [rad/s],wz [rad/s],path [m],turned [rad],compressive_force [N],blade_force [N],vessel_force [N],pushed_by [1],jammed,"
               "in_gap,bridged,least_gap [m]\n");
  else
    fmt::print("frame,time [s],id,partner_kind,partner,normal_force [N],tangential_force [N],overlap [m]\n");
  std::map<std::uint32_t, Way> ways;
  for (std::size_t k = range.first; k < range.last; ++k) {
    const jam::Snapshot snapshot = source.read(k);
    const jam::ContactGraph graph(snapshot, source.info.walls);
    jam::FrameNetwork network(graph, source.info, criteria);
    const jam::BladePose blade = jam::blade_of(snapshot, source.info.walls);
    const jam::JamFrame jams = jam::jam_frame(graph, network.compressive(), network.jammed(), network.clusters(), source.info, blade, criteria);
    for (const std::uint32_t id : particles) {
      const auto row = row_of(snapshot, id);
      if (!row) continue;
      const auto [way, first] = ways.try_emplace(id);
      if (options.of == FollowOf::path)
        print_path(k, network, jams, *row, blade, way->second, first);
      else
        print_contacts(k, graph, source.info, *row);
    }
    progress.done += 1;
    console.progress(progress);
  }
  for (const std::uint32_t id : particles)
    if (!ways.contains(id)) throw UsageError(fmt::format("no grain {} in frames {} to {}", id, range.first, range.last - 1));
  return 0;
}

}  // namespace jamscope
