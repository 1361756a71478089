#include "libjam/events/lineage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace jam {
namespace {

using ::testing::ElementsAre;

constexpr double interval = 2e-3;

// Clusters of each frame by their members; where nothing else is said, at places of their own.
struct Record {
  std::vector<Cluster> clusters;
  std::vector<std::uint32_t> site;
  std::vector<JamFrame> frames;

  explicit Record(const std::vector<std::vector<std::vector<ParticleId>>>& by_frame, std::vector<std::uint32_t> sites = {}) : site(std::move(sites)) {
    for (const auto& of_frame : by_frame) {
      JamFrame frame;
      frame.time = interval * double(frames.size() + 1);
      for (const auto& members : of_frame) {
        Cluster cluster;
        cluster.frame = std::uint32_t(frames.size());
        cluster.members = members;
        clusters.push_back(cluster);
        for (const ParticleId id : members) {
          JammedSample sample;
          sample.particle = id;
          sample.compressive_force = 20 + double(id) + 0.5 * double(frames.size());
          frame.jammed.push_back(sample);
        }
      }
      std::sort(frame.jammed.begin(), frame.jammed.end(), [](const auto& a, const auto& b) { return a.particle < b.particle; });
      frames.push_back(frame);
    }
    for (std::uint32_t k = 0; site.size() < clusters.size(); ++k) site.push_back(1000 + k);
  }
  Lineage lineage() const { return jam::lineage(clusters, site, frames, interval); }
};

TEST(Lineage, FollowsAClusterThroughGrowthAndLoss) {
  const Record r({{{1, 2}}, {{1, 2, 3}}, {{3, 4}}, {}, {{3, 4}}});
  const Lineage l = r.lineage();
  EXPECT_THAT(l.identity, ElementsAre(0, 0, 0, 1));  // a frame without it ends it
  ASSERT_EQ(l.links.size(), 2u);
  EXPECT_EQ(l.links[0].shared, 2u);
  EXPECT_EQ(l.links[1].shared, 1u);
  const auto f = fates(4, l);
  EXPECT_EQ(f[0].before, Fate::born);
  EXPECT_EQ(f[0].after, Fate::continued);
  EXPECT_EQ(f[2].after, Fate::ended);
  const auto events = cluster_events(r.clusters, l, r.frames, interval);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_THAT(events[0].members, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(events[0].samples, 3u);
  EXPECT_TRUE(events[0].open_at_start);
  EXPECT_FALSE(events[0].open_at_end);
  EXPECT_EQ(events[0].peak_particle, 4u);
  EXPECT_EQ(events[0].peak_force, 25);
  EXPECT_TRUE(events[1].open_at_end);
}

TEST(Lineage, TheLargerPartKeepsTheIdentityInMergersAndSplits) {
  const Record r({{{1, 2, 3}, {7, 8}}, {{1, 2, 3, 7, 8}}, {{1, 2}, {3, 7, 8}}});
  const Lineage l = r.lineage();
  EXPECT_THAT(l.identity, ElementsAre(0, 1, 0, 2, 0));
  EXPECT_EQ(l.links.size(), 4u);
  const auto f = fates(5, l);
  EXPECT_EQ(f[0].after, Fate::merged);
  EXPECT_EQ(f[2].before, Fate::merged);
  EXPECT_EQ(f[2].after, Fate::split);
  EXPECT_EQ(f[3].before, Fate::split);
}

TEST(Lineage, HandsOverAtOnePlaceWithoutASharedGrain) {
  const Record r({{{1}}, {{2}}, {{3}}}, {4, 4, 5});
  const Lineage l = r.lineage();
  EXPECT_THAT(l.identity, ElementsAre(0, 1, 2));
  ASSERT_EQ(l.links.size(), 1u);
  EXPECT_EQ(l.links[0].shared, 0u);
  const auto f = fates(3, l);
  EXPECT_EQ(f[0].after, Fate::handed_over);
  EXPECT_EQ(f[1].before, Fate::handed_over);
  EXPECT_EQ(f[1].after, Fate::ended);
}

TEST(Lineage, LinksNothingAcrossMissingFrames) {
  Record r({{{1}}, {{1}}, {{1}}, {{1}}});
  for (std::size_t k = 2; k < 4; ++k) r.frames[k].time += 0.1;
  EXPECT_THAT(r.lineage().identity, ElementsAre(0, 0, 1, 1));
}

// Random partitions: links are all overlaps of neighbouring frames; an identity has at most one cluster in a frame and lives in frames in a row;
// where a cluster shares more than half of the union with one before it, it has its identity, as then no other can share more.
TEST(Lineage, IsWhatOverlapsSay) {
  std::mt19937_64 random(31);
  for (int scene = 0; scene < 100; ++scene) {
    std::vector<std::vector<std::vector<ParticleId>>> by_frame;
    for (int k = 0; k < 12; ++k) {
      std::vector<std::vector<ParticleId>> groups(1 + random() % 5);
      for (ParticleId id = 0; id < 14; ++id)
        if (random() % 3 != 0) groups[random() % groups.size()].push_back(id);
      std::erase_if(groups, [](const auto& g) { return g.empty(); });
      by_frame.push_back(groups);
    }
    const Record r(by_frame);
    const Lineage l = r.lineage();
    std::set<std::pair<std::uint32_t, std::uint32_t>> linked;
    for (const ClusterLink& link : l.links) linked.insert({link.from, link.to});
    for (std::uint32_t a = 0; a < r.clusters.size(); ++a)
      for (std::uint32_t b = 0; b < r.clusters.size(); ++b) {
        if (r.clusters[b].frame != r.clusters[a].frame + 1) {
          EXPECT_FALSE(linked.contains({a, b}));
          continue;
        }
        std::vector<ParticleId> both;
        std::set_intersection(r.clusters[a].members.begin(), r.clusters[a].members.end(), r.clusters[b].members.begin(), r.clusters[b].members.end(),
                              std::back_inserter(both));
        EXPECT_EQ(linked.contains({a, b}), !both.empty());
        const std::size_t either = r.clusters[a].members.size() + r.clusters[b].members.size() - both.size();
        if (2 * both.size() > either) {
          EXPECT_EQ(l.identity[a], l.identity[b]);
        }
      }
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (std::size_t k = 0; k < r.clusters.size(); ++k) EXPECT_TRUE(seen.insert({r.clusters[k].frame, l.identity[k]}).second);
    std::size_t clusters = 0;
    for (const JamEvent& event : cluster_events(r.clusters, l, r.frames, interval)) clusters += event.samples;
    EXPECT_EQ(clusters, r.clusters.size());  // no frame is missing from a life
  }
}

}  // namespace
}  // namespace jam
