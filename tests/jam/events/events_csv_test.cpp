#include "libjam/events/events_csv.hpp"

#include <gtest/gtest.h>

#include "libjam/events/streams.hpp"
#include "tests/jam/events/hand_made_record.hpp"

namespace jam {
namespace {

using hand_made::record;

constexpr const char* header =
    "stream,start_s,end_s,samples,survival_time_s,shortest_s,longest_s,open_at_start,open_at_end,peak_force_N,"
    "peak_time_s,peak_particle,peak_in_gap,bridged,least_gap_m,members\n";

TEST(EventsCsvTest, HasOneRowPerGlobalEventAndPerTrack) {
  auto frames = record({{3, ".33.."},  //
                        {12, "..8.4"}},
                       0.5);
  frames[2].jammed[1].in_gap = frames[2].jammed[1].bridged = true;
  frames[2].jammed[1].least_gap = 7.5e-4;
  EXPECT_EQ(events_csv(global_events(frames, {0.5}), {}, particle_tracks(frames, {0.5})),
            std::string(header) +
                "global,0.5,1,2,1,0.5,1.5,0,0,80,1,12,1,1,0.00075,3;12\n"
                "global,2,2,1,0.5,0,inf,0,1,40,2,12,0,0,nan,12\n"
                "particle,0.5,1,2,1,0.5,1.5,0,0,30,0.5,3,0,0,nan,3\n"
                "particle,1,1,1,0.5,0,1,0,0,80,1,12,1,1,0.00075,12\n"
                "particle,2,2,1,0.5,0,inf,0,1,40,2,12,0,0,nan,12\n");
}

TEST(EventsCsvTest, NumbersReadBackAsTheSameDouble) {
  JamEvent event;
  event.start = 0.1 + 0.2;
  event.peak_force = 1.0 / 3.0;
  const std::string csv = events_csv(std::vector<JamEvent>{event}, {}, {});
  EXPECT_NE(csv.find("\nglobal,0.30000000000000004,"), std::string::npos);
  EXPECT_NE(csv.find(",0.3333333333333333,"), std::string::npos);
}

TEST(EventsCsvTest, IsOnlyAHeaderWithoutEvents) {
  EXPECT_EQ(events_csv({}, {}, {}), header);
}

}  // namespace
}  // namespace jam
