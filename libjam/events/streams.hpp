// The event streams. They are never mixed: two jams at two places of the blade are one global event, and a jam handed
// from one grain to the next without a jam-free frame is one global event and two tracks.
#pragma once
#include <span>
#include <vector>

#include "libjam/events/event.hpp"
#include "libjam/events/jam_frame.hpp"

namespace jam {

// The same rule as for jams of every step (every_step.hpp): an event is a run of frames in which its stream is jammed or nearly so, over pauses of up
// to `hold_off`; it counts if it is jammed in one of them and survives `shortest`. With end_force = jam_force and no hold-off this is the paper's.
struct SampledDetector {
  double interval = 0;  // s, D
  double hold_off = 0;  // s, the longest pause that does not end it
  double shortest = 0;  // s, events of a shorter survival time do not count
};

// The paper's stream: maximal runs of frames in which any particle is jammed, in order of time.
std::vector<JamEvent> global_events(std::span<const JamFrame> frames, const SampledDetector& detector);

// The same for each particle by itself, by first frame, then particle id.
std::vector<Track> particle_tracks(std::span<const JamFrame> frames, const SampledDetector& detector);

// What events of any stream are put together from. One that begins in frame k:
JamEvent begin_event(std::span<const JamFrame> frames, std::uint32_t k, double interval);
// Frame k belongs to it, because of this particle among others.
void extend_event(JamEvent& event, std::span<const JamFrame> frames, std::uint32_t k, const JammedSample& sample);
// What follows from an event's first and last frame: its samples, its bracket, whether the record cuts it off at its end.
void close_event(JamEvent& event, std::span<const JamFrame> frames, double interval);

}  // namespace jam
