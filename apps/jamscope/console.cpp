#include "apps/jamscope/console.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

namespace jamscope {
namespace {

// Signals are a property of the process, so this flag is one too.
std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_stop(int signal) {
  if (stop.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

std::size_t terminal_columns(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

void catch_stop_signals() {
  stop = false;
  std::signal(SIGINT, on_stop);
  std::signal(SIGTERM, on_stop);
}
bool stop_requested() {
  return stop;
}

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string duration_text(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  if (seconds > 1e12) return "very long";
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  const std::uint64_t minutes = (whole + 30) / 60;
  if (minutes < 48 * 60) return fmt::format("{} h {} min", minutes / 60, minutes % 60);
  return fmt::format("{} d {} h", minutes / 1440, minutes % 1440 / 60);
}

std::string progress_text(const Progress& p, double left, std::size_t columns) {
  std::string text = fmt::format("{} {:.5g}/{:.5g} {}", p.stage, p.done, p.total, p.unit);
  bool room = true;
  const auto add = [&](const std::string& part) {
    room = room && text.size() + 2 + part.size() <= columns;
    if (room) text += "  " + part;
  };
  if (std::isfinite(left)) add((p.at_most ? "left at most " : "left ") + duration_text(left));
  if (p.jammed) add(fmt::format("jammed {}", *p.jammed));
  if (p.events) add(fmt::format("events {}", *p.events));
  if (std::isfinite(p.largest_force)) add(fmt::format("force {:.3g} N", p.largest_force));
  if (std::isfinite(p.particle_steps_per_second)) {
    add(fmt::format("{:.2g} grain steps/s", p.particle_steps_per_second));
  } else if (std::isfinite(p.steps_per_second)) {
    add(fmt::format("{:.3g} steps/s", p.steps_per_second));
  }
  if (p.contacts) add(fmt::format("contacts {}", *p.contacts));
  if (std::isfinite(p.largest_overlap)) add(fmt::format("overlap {:.2g} % R", 100 * p.largest_overlap));
  if (p.step) add(fmt::format("step {}", *p.step));
  return text.substr(0, columns);
}

std::string progress_json(const Progress& p, double elapsed, double left) {
  nlohmann::ordered_json json{
      {"log", "progress"}, {"stage", p.stage}, {"done", p.done}, {"total", p.total}, {"unit", p.unit}};
  if (p.step) json["step"] = *p.step;
  if (std::isfinite(p.steps_per_second)) json["steps_per_second"] = p.steps_per_second;
  if (std::isfinite(p.particle_steps_per_second)) json["particle_steps_per_second"] = p.particle_steps_per_second;
  if (p.contacts) json["contacts"] = *p.contacts;
  if (std::isfinite(p.largest_overlap)) json["largest_overlap"] = p.largest_overlap;
  if (std::isfinite(p.largest_force)) json["largest_force_N"] = p.largest_force;
  if (p.jammed) json["jammed"] = *p.jammed;
  if (p.events) json["events"] = *p.events;
  json["elapsed_s"] = elapsed;
  if (std::isfinite(left)) json["left_s"] = left;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Console::Console(std::FILE* out, LogFormat format, bool quiet)
    : out_(out),
      format_(format),
      quiet_(quiet),
      terminal_(format == LogFormat::text && isatty(fileno(out)) == 1),
      stage_begin_(Clock::now()),
      last_print_(stage_begin_) {}

Console::~Console() {
  end_progress_line();
}

bool Console::due() const {
  const double interval = format_ == LogFormat::jsonl ? 1 : terminal_ ? 0.1 : 5;
  return !quiet_ && std::chrono::duration<double>(Clock::now() - last_print_).count() >= interval;
}

void Console::progress(const Progress& p) {
  if (p.stage != stage_) {
    stage_ = p.stage;
    stage_begin_ = Clock::now();
    stage_begin_done_ = p.done;
  }
  if (due()) print(p);
}

void Console::finished(const Progress& p) {
  if (!quiet_) print(p);
  end_progress_line();
}

void Console::print(const Progress& p) {
  last_print_ = Clock::now();
  const double elapsed = std::chrono::duration<double>(last_print_ - stage_begin_).count();
  const double moved = p.done - stage_begin_done_;
  const double left = p.stage == stage_ && moved > 0 && p.total > p.done ? elapsed * (p.total - p.done) / moved
                                                                         : std::numeric_limits<double>::quiet_NaN();
  if (format_ == LogFormat::jsonl) {
    fmt::print(out_, "{}\n", progress_json(p, elapsed, left));
  } else {
    std::string text = progress_text(p, left, terminal_ ? terminal_columns(out_) - 1 : std::string::npos);
    if (terminal_) {
      // The cursor stays on the line; what the last, longer line left over is overwritten.
      const std::size_t length = text.size();
      if (length < shown_) text.append(shown_ - length, ' ');
      shown_ = length;
      fmt::print(out_, "\r{}", text);
    } else {
      fmt::print(out_, "{}\n", text);
    }
  }
  std::fflush(out_);
}

void Console::end_progress_line() {
  if (shown_ > 0) fmt::print(out_, "\n");
  shown_ = 0;
}

void Console::line(const char* kind, const std::string& text) {
  end_progress_line();
  if (format_ == LogFormat::jsonl) {
    const nlohmann::ordered_json json{{"log", kind}, {"text", text}};
    fmt::print(out_, "{}\n", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else if (std::string(kind) == "note") {
    fmt::print(out_, "{}\n", text);
  } else {
    fmt::print(out_, "{}: {}\n", kind, text);
  }
  std::fflush(out_);
}

void Console::note(const std::string& text) {
  if (!quiet_) line("note", text);
}
void Console::warning(const std::string& text) {
  line("warning", text);
}

}  // namespace jamscope
