#include "libjam/events/streams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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
  event.least_gap = std::fmin(event.least_gap, sample.least_gap);
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

namespace {

// Does an event whose last frame is `last` reach frame k?
bool goes_on(std::span<const JamFrame> frames, std::size_t last, std::size_t k, const SampledDetector& detector) {
  if (double(k - last - 1) * detector.interval > detector.hold_off * (1 + 1e-9)) return false;
  for (std::size_t next = last + 1; next <= k; ++next)
    if (gap_before(frames, next, detector.interval)) return false;
  return true;
}

void close(JamEvent& event, std::span<const JamFrame> frames, const SampledDetector& detector) {
  close_event(event, frames, detector.interval);
  std::sort(event.members.begin(), event.members.end());
  event.members.erase(std::unique(event.members.begin(), event.members.end()), event.members.end());
}

bool counts(const JamEvent& event, const SampledDetector& detector) {
  return !event.members.empty() && event.survival_time >= detector.shortest * (1 - 1e-9);
}

}  // namespace

std::vector<JamEvent> global_events(std::span<const JamFrame> frames, const SampledDetector& detector) {
  std::vector<JamEvent> events;
  for (std::uint32_t k = 0; k < frames.size(); ++k) {
    const JamFrame& frame = frames[k];
    if (frame.jammed.empty() && frame.nearly.empty()) continue;
    if (events.empty() || !goes_on(frames, events.back().last_frame, k, detector)) events.push_back(begin_event(frames, k, detector.interval));
    for (const JammedSample& sample : frame.jammed) {
      extend_event(events.back(), frames, k, sample);
      events.back().members.push_back(sample.particle);
    }
    for (const JammedSample& sample : frame.nearly) extend_event(events.back(), frames, k, sample);
  }
  for (JamEvent& event : events) close(event, frames, detector);
  std::erase_if(events, [&](const JamEvent& event) { return !counts(event, detector); });
  return events;
}

std::vector<Track> particle_tracks(std::span<const JamFrame> frames, const SampledDetector& detector) {
  std::vector<Track> tracks;
  std::map<ParticleId, std::size_t> latest;  // of each particle its last track
  // Returns the particle's track of frame k.
  const auto extend = [&](std::uint32_t k, const JammedSample& sample) -> Track& {
    const auto [place, fresh] = latest.try_emplace(sample.particle, tracks.size());
    if (fresh || !goes_on(frames, tracks[place->second].event.last_frame, k, detector)) {
      place->second = tracks.size();
      Track& track = tracks.emplace_back();
      track.particle = sample.particle;
      track.event = begin_event(frames, k, detector.interval);
    }
    Track& track = tracks[place->second];
    extend_event(track.event, frames, k, sample);
    track.points.push_back({sample, k});
    return track;
  };
  for (std::uint32_t k = 0; k < frames.size(); ++k) {
    for (const JammedSample& sample : frames[k].jammed) extend(k, sample).event.members = {sample.particle};
    for (const JammedSample& sample : frames[k].nearly) extend(k, sample);
  }
  for (Track& track : tracks) close(track.event, frames, detector);
  std::erase_if(tracks, [&](const Track& track) { return !counts(track.event, detector); });
  // Particles that only nearly jammed in a track's first frame came after the jammed ones.
  std::stable_sort(tracks.begin(), tracks.end(), [](const Track& a, const Track& b) {
    return std::pair(a.event.first_frame, a.particle) < std::pair(b.event.first_frame, b.particle);
  });
  return tracks;
}

}  // namespace jam
