#include "libjam/events/streams.hpp"

#include <algorithm>
#include <limits>

namespace jam {

JamEvent begin_event(std::span<const JamFrame> frames, std::uint32_t k, double interval) {
  JamEvent event;
  event.first_frame = k;
  event.start = frames[k].time;
  event.open_at_start = k == 0 || gap_before(frames, k, interval);
  return event;
}

void extend_event(JamEvent& event, std::span<const JamFrame> frames, std::uint32_t k, const JammedSample& sample) {
  event.last_frame = k;
  event.end = frames[k].time;
  event.bridged = event.bridged || sample.bridged;
  if (sample.compressive_force > event.peak_force) {
    event.peak_force = sample.compressive_force;
    event.peak_time = frames[k].time;
    event.peak_particle = sample.particle;
    event.peak_in_gap = sample.in_gap;
  }
}

void close_event(JamEvent& event, std::span<const JamFrame> frames, double interval) {
  const std::size_t next = std::size_t{event.last_frame} + 1;
  event.open_at_end = next == frames.size() || gap_before(frames, next, interval);
  event.samples = event.last_frame - event.first_frame + 1;
  event.survival_time = event.samples * interval;
  event.shortest = (event.samples - 1) * interval;
  event.longest = event.open_at_start || event.open_at_end ? std::numeric_limits<double>::infinity()
                                                           : (event.samples + 1) * interval;
}

std::vector<JamEvent> global_events(std::span<const JamFrame> frames, double interval) {
  std::vector<JamEvent> events;
  bool open = false;
  for (std::uint32_t k = 0; k < frames.size(); ++k) {
    const bool jammed = !frames[k].jammed.empty();
    const bool continues = jammed && open && !gap_before(frames, k, interval);
    if (jammed && !continues) events.push_back(begin_event(frames, k, interval));
    for (const JammedSample& sample : frames[k].jammed) {
      extend_event(events.back(), frames, k, sample);
      events.back().members.push_back(sample.particle);
    }
    open = jammed;
  }
  for (JamEvent& event : events) {
    close_event(event, frames, interval);
    std::sort(event.members.begin(), event.members.end());
    event.members.erase(std::unique(event.members.begin(), event.members.end()), event.members.end());
  }
  return events;
}

std::vector<Track> particle_tracks(std::span<const JamFrame> frames, double interval) {
  std::vector<Track> tracks;
  // Tracks that reached the previous frame, as (particle, index into tracks), ascending by particle.
  std::vector<std::pair<ParticleId, std::size_t>> open, still_open;
  for (std::uint32_t k = 0; k < frames.size(); ++k) {
    if (k > 0 && gap_before(frames, k, interval)) open.clear();
    still_open.clear();
    auto previous = open.begin();
    for (const JammedSample& sample : frames[k].jammed) {
      while (previous != open.end() && previous->first < sample.particle) ++previous;
      const bool continues = previous != open.end() && previous->first == sample.particle;
      const std::size_t index = continues ? previous->second : tracks.size();
      if (!continues) {
        Track track;
        track.particle = sample.particle;
        track.event = begin_event(frames, k, interval);
        track.event.members = {sample.particle};
        tracks.push_back(std::move(track));
      }
      extend_event(tracks[index].event, frames, k, sample);
      tracks[index].points.push_back(
          {k, sample.position, sample.velocity, static_cast<float>(sample.compressive_force)});
      still_open.emplace_back(sample.particle, index);
    }
    std::swap(open, still_open);
  }
  for (Track& track : tracks) close_event(track.event, frames, interval);
  return tracks;
}

}  // namespace jam
