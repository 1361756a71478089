#include "libjam/events/events_csv.hpp"

#include <array>
#include <charconv>
#include <string_view>

namespace jam {
namespace {

template <class Number>
std::string printed(Number value) {
  std::array<char, 32> buffer;  // the shortest round trip of any double has at most 24 characters
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string joined(const std::vector<ParticleId>& members) {
  std::string text;
  for (const ParticleId id : members) {
    if (!text.empty()) text += ';';
    text += printed(id);
  }
  return text;
}

void append_row(std::string& csv, std::string_view stream, const JamEvent& e) {
  csv += stream;
  for (const std::string& cell :
       {printed(e.start), printed(e.end), printed(e.samples), printed(e.survival_time), printed(e.shortest),
        printed(e.longest), printed(int{e.open_at_start}), printed(int{e.open_at_end}), printed(e.peak_force),
        printed(e.peak_time), printed(e.peak_particle), printed(int{e.peak_in_gap}), printed(int{e.bridged}),
        printed(e.least_gap),
        joined(e.members)}) {
    csv += ',';
    csv += cell;
  }
  csv += '\n';
}

}  // namespace

std::string events_csv(std::span<const JamEvent> events, std::span<const JamEvent> clusters, std::span<const Track> tracks) {
  std::string csv =
      "stream,start_s,end_s,samples,survival_time_s,shortest_s,longest_s,open_at_start,open_at_end,peak_force_N,"
      "peak_time_s,peak_particle,peak_in_gap,bridged,least_gap_m,members\n";
  for (const JamEvent& event : events) append_row(csv, "global", event);
  for (const JamEvent& event : clusters) append_row(csv, "cluster", event);
  for (const Track& track : tracks) append_row(csv, "particle", track.event);
  return csv;
}

std::string_view step_jams_header() {
  return "stream,start_s,end_s,duration_s,open_at_start,open_at_end,peak_force_N,peak_time_s,peak_particle,site,impulse_Ns,work_J,"
         "share_of_flow_energy,path_m,turned_rad,stays,members\n";
}

std::string step_jams_rows(JamStream stream, std::span<const StepJam> jams) {
  std::string csv;
  for (const StepJam& j : jams) {
    csv += jam_stream_names[std::size_t(stream)];
    for (const std::string& cell :
         {printed(j.start), printed(j.end), printed(j.duration), printed(int{j.open_at_start}), printed(int{j.open_at_end}), printed(j.peak_force),
          printed(j.peak_time), printed(j.peak_particle), printed(j.site), printed(j.impulse), printed(j.work), printed(j.share_of_flow_energy), printed(j.path), printed(j.turned),
          printed(j.stays), joined(j.members)}) {
      csv += ',';
      csv += cell;
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace jam
