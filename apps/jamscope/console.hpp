// How a long task talks: one line that is rewritten on a terminal, a plain line every few seconds elsewhere, or one
// JSON object per line for machines. Everything goes to standard error; standard output is for results.
#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>

namespace jamscope {

enum class LogFormat { text, jsonl };

// One moment of a task. What is not known stays NaN or empty and is not shown.
struct Progress {
  std::string stage;           // "simulate", "read"
  double done = 0, total = 0;  // simulated s, or frames; total > done means not finished
  std::string unit;            // "s", "frames"
  std::optional<std::uint64_t> step;
  double steps_per_second = std::numeric_limits<double>::quiet_NaN();
  double particle_steps_per_second = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::uint64_t> contacts;
  double largest_overlap = std::numeric_limits<double>::quiet_NaN();  // over particle radius
  double largest_force = std::numeric_limits<double>::quiet_NaN();    // N, largest compressive force
  std::optional<std::uint64_t> jammed, events;
  bool at_most = false;  // `total` is an upper bound
};

// The line for people, for example
//   simulate 0.0124/2 s  left 3 h 12 min  jammed 2  events 7  force 412 N  4.1e+06 grain steps/s  contacts 91234
//   overlap 3.1 % R  step 248000
// left: seconds that remain; NaN: not known. Of what does not fit into the columns of a terminal the last parts are left out.
std::string progress_text(const Progress& p, double left, std::size_t columns = std::string::npos);

// The line for machines: {"log":"progress","stage":"simulate","done":0.0124,...}.
std::string progress_json(const Progress& p, double elapsed, double left);

// "3 h 12 min", "2 min 5 s", "0.4 s".
std::string duration_text(double seconds);

using Clock = std::chrono::steady_clock;
// s of wall time.
double seconds_since(Clock::time_point begin);

class Console {
 public:
  // quiet: warnings only.
  explicit Console(std::FILE* out = stderr, LogFormat format = LogFormat::text, bool quiet = false);
  ~Console();  // ends an unfinished progress line
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  // Prints if the last print is long enough ago (0.1 s on a terminal, 5 s elsewhere, 1 s in JSON). Cheap otherwise, but
  // filling a Progress may not be: ask due() first.
  bool due() const;
  void progress(const Progress& p);
  // The last moment of a stage, always printed.
  void finished(const Progress& p);

  void note(const std::string& text);
  void warning(const std::string& text);

 private:
  void print(const Progress& p);
  void line(const char* kind, const std::string& text);
  void end_progress_line();

  std::FILE* out_;
  LogFormat format_;
  bool quiet_, terminal_;
  std::size_t shown_ = 0;  // columns of the line that is being rewritten
  // Where and when the present stage began, for the estimate of what is left.
  std::string stage_;
  double stage_begin_done_ = 0;
  Clock::time_point stage_begin_, last_print_;
};

// From now on SIGINT and SIGTERM are remembered instead of ending the program; a second one ends it at once.
void catch_stop_signals();
bool stop_requested();

}  // namespace jamscope
