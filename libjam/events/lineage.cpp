#include "libjam/events/lineage.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "libjam/events/streams.hpp"

namespace jam {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Rows [first, last) of the clusters of each frame that has some.
struct Rows {
  std::uint32_t frame, first, last;
};
std::vector<Rows> rows_by_frame(std::span<const Cluster> clusters) {
  std::vector<Rows> rows;
  for (std::uint32_t k = 0; k < clusters.size(); ++k) {
    if (rows.empty() || rows.back().frame != clusters[k].frame) rows.push_back({clusters[k].frame, k, k});
    rows.back().last = k + 1;
  }
  return rows;
}

// Heaviest first; then the larger other cluster, then the one that is listed first.
bool heavier(const ClusterLink& a, std::uint32_t other_a, const ClusterLink& b, std::uint32_t other_b, std::span<const Cluster> clusters) {
  if (a.shared != b.shared) return a.shared > b.shared;
  const std::size_t size_a = clusters[other_a].members.size(), size_b = clusters[other_b].members.size();
  return size_a != size_b ? size_a > size_b : other_a < other_b;
}

}  // namespace

Lineage lineage(std::span<const Cluster> clusters, std::span<const std::uint32_t> site, std::span<const JamFrame> frames, double interval) {
  Lineage result;
  const std::vector<Rows> rows = rows_by_frame(clusters);
  std::vector<std::uint8_t> has_before(clusters.size(), 0), has_after(clusters.size(), 0);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const Rows &before = rows[r - 1], &now = rows[r];
    if (now.frame != before.frame + 1 || gap_before(frames, now.frame, interval)) continue;
    std::map<ParticleId, std::uint32_t> cluster_of;  // clusters of a frame share no particle
    for (std::uint32_t k = now.first; k < now.last; ++k)
      for (const ParticleId id : clusters[k].members) cluster_of[id] = k;
    std::vector<ClusterLink> links;
    for (std::uint32_t k = before.first; k < before.last; ++k) {
      std::map<std::uint32_t, std::uint32_t> shared;
      for (const ParticleId id : clusters[k].members)
        if (const auto found = cluster_of.find(id); found != cluster_of.end()) ++shared[found->second];
      for (const auto& [to, count] : shared) {
        links.push_back({k, to, count});
        has_after[k] = has_before[to] = 1;
      }
    }
    for (std::uint32_t k = before.first; k < before.last; ++k)
      for (std::uint32_t to = now.first; to < now.last; ++to)
        if (!has_after[k] && !has_before[to] && site[k] == site[to]) links.push_back({k, to, 0});
    std::sort(links.begin(), links.end(), [](const ClusterLink& a, const ClusterLink& b) { return std::pair(a.from, a.to) < std::pair(b.from, b.to); });
    result.links.insert(result.links.end(), links.begin(), links.end());
  }
  // The heaviest link after and before each cluster.
  std::vector<std::uint32_t> best_after(clusters.size(), none), best_before(clusters.size(), none);  // rows of links
  for (std::uint32_t l = 0; l < result.links.size(); ++l) {
    const ClusterLink& link = result.links[l];
    if (link.shared == 0) continue;
    std::uint32_t &after = best_after[link.from], &before = best_before[link.to];
    if (after == none || heavier(link, link.to, result.links[after], result.links[after].to, clusters)) after = l;
    if (before == none || heavier(link, link.from, result.links[before], result.links[before].from, clusters)) before = l;
  }
  result.identity.assign(clusters.size(), none);
  std::uint32_t next = 0;
  for (std::uint32_t k = 0; k < clusters.size(); ++k) {
    const std::uint32_t l = best_before[k];
    result.identity[k] = l != none && best_after[result.links[l].from] == l ? result.identity[result.links[l].from] : next++;
  }
  return result;
}

std::vector<JamEvent> cluster_events(std::span<const Cluster> clusters, const Lineage& lineage, std::span<const JamFrame> frames, double interval) {
  std::uint32_t count = 0;
  for (const std::uint32_t identity : lineage.identity) count = std::max(count, identity + 1);
  std::vector<JamEvent> events(count);
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const Cluster& cluster = clusters[k];
    JamEvent& event = events[lineage.identity[k]];
    if (event.members.empty()) event = begin_event(frames, cluster.frame, interval);
    event.members.insert(event.members.end(), cluster.members.begin(), cluster.members.end());
    for (const JammedSample& sample : frames[cluster.frame].jammed)
      if (std::binary_search(cluster.members.begin(), cluster.members.end(), sample.particle)) extend_event(event, frames, cluster.frame, sample);
  }
  for (JamEvent& event : events) {
    close_event(event, frames, interval);
    std::sort(event.members.begin(), event.members.end());
    event.members.erase(std::unique(event.members.begin(), event.members.end()), event.members.end());
  }
  return events;
}

std::vector<Fates> fates(std::size_t clusters, const Lineage& lineage) {
  std::vector<std::uint32_t> before(clusters, 0), after(clusters, 0);
  for (const ClusterLink& link : lineage.links)
    if (link.shared > 0) ++after[link.from], ++before[link.to];
  std::vector<Fates> all(clusters);
  for (const ClusterLink& link : lineage.links) {
    if (link.shared == 0) {
      all[link.from].after = all[link.to].before = Fate::handed_over;
      continue;
    }
    all[link.from].after = after[link.from] > 1 ? Fate::split : before[link.to] > 1 ? Fate::merged : Fate::continued;
    all[link.to].before = before[link.to] > 1 ? Fate::merged : after[link.from] > 1 ? Fate::split : Fate::continued;
  }
  return all;
}

}  // namespace jam
