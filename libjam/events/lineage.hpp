// Clusters through time: which one became which.
//
// Clusters of frames next to each other are linked where they share particles, whatever the share: the links make a directed graph in which a
// cluster may have several before it (they merged) and several after it (it split). Along its heaviest links a cluster keeps its identity: the
// next one bears the identity of that before it with which it shares the most particles (ties: the larger, then the one listed first), if that one
// shares with none after it more than with this one. A cluster of one particle is a cluster with an identity like any other.
//
// A hand-over is where one jam ends and, in the next frame, one begins at the same place of the blade without a particle of it: the load goes on, the
// grains do not. It is a link of its own kind and passes on no identity.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "libjam/events/event.hpp"
#include "libjam/events/jam_frame.hpp"
#include "libjam/jamming/cluster.hpp"

namespace jam {

struct ClusterLink {
  std::uint32_t from = 0, to = 0;  // rows of the clusters
  std::uint32_t shared = 0;        // particles; 0: a hand-over
};

struct Lineage {
  std::vector<std::uint32_t> identity;  // [clusters] counted from 0 in order of birth
  std::vector<ClusterLink> links;       // by `from`, then `to`
};

// `clusters` by frame; `site`: where each is, where the same number means the same place. Nothing is linked across missing frames
// (gap_before).
Lineage lineage(std::span<const Cluster> clusters, std::span<const std::uint32_t> site, std::span<const JamFrame> frames, double interval);

// The cluster stream: for each identity the time from its first to its last frame, by start, then identity. Members: every particle that was in it.
std::vector<JamEvent> cluster_events(std::span<const Cluster> clusters, const Lineage& lineage, std::span<const JamFrame> frames, double interval);

// What happened to a cluster before and after a frame.
enum class Fate : std::uint8_t { born, continued, merged, split, handed_over, ended };
inline constexpr std::string_view fate_names[] = {"born", "continued", "merged", "split", "handed_over", "ended"};
struct Fates {
  Fate before = Fate::born, after = Fate::ended;  // before: born, continued, merged, split or handed_over; after: likewise, and ended
};
std::vector<Fates> fates(std::size_t clusters, const Lineage& lineage);

}  // namespace jam
