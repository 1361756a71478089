// The event streams. They are never mixed: two jams at two places of the blade are one global event, and a jam handed
// from one grain to the next without a jam-free frame is one global event and two tracks.
#pragma once
#include <span>
#include <vector>

#include "libjam/events/event.hpp"
#include "libjam/events/jam_frame.hpp"

namespace jam {

// The paper's stream: maximal runs of consecutive frames in which any particle is jammed, in order of time. `interval`
// is D.
std::vector<JamEvent> global_events(std::span<const JamFrame> frames, double interval);

// The same for each particle by itself, by first frame, then particle id.
std::vector<Track> particle_tracks(std::span<const JamFrame> frames, double interval);

// What events of any stream are put together from. One that begins in frame k:
JamEvent begin_event(std::span<const JamFrame> frames, std::uint32_t k, double interval);
// Frame k belongs to it, because of this particle among others.
void extend_event(JamEvent& event, std::span<const JamFrame> frames, std::uint32_t k, const JammedSample& sample);
// What follows from an event's first and last frame: its samples, its bracket, whether the record cuts it off at its end.
void close_event(JamEvent& event, std::span<const JamFrame> frames, double interval);

}  // namespace jam
