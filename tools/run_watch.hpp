#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "boards/run.hpp"
#include "hal/time.hpp"
#include "tools/html_report.hpp"

namespace forager::tools {

// Follows a run from outside: progress for a person (one line on a terminal, on stderr) or JSON lines for a
// program (on stdout), and the samples and events that the report shows.
class RunWatch {
 public:
  struct Options {
    bool json = false;
    bool progress = false;  // terminal line
    hal::Duration sample_every = std::chrono::seconds(1);
    hal::Duration json_every = std::chrono::seconds(10);
  };
  explicit RunWatch(const Options& options) : options_(options) {}
  ~RunWatch();
  RunWatch(const RunWatch&) = delete;
  RunWatch& operator=(const RunWatch&) = delete;

  // A journal note.
  void note(hal::Instant now, std::string_view source, std::string_view text);
  // The run as it stands after an update.
  void update(const boards::Run& run, hal::Instant now, double wall_time_s);
  // A line to the person at the terminal, on stderr.
  void say(std::string_view text);
  // Ends the terminal line.
  void finish();

  [[nodiscard]] const std::vector<ReportData::TagSample>& samples() const { return samples_; }
  [[nodiscard]] const std::vector<ReportData::Event>& events() const { return events_; }

 private:
  void print_decisions(const boards::Run& run);
  void print_progress(const boards::Run& run, hal::Instant now, double wall_time_s);

  Options options_;
  std::vector<ReportData::TagSample> samples_;
  std::vector<ReportData::Event> events_;
  hal::Instant next_sample_;
  hal::Instant next_json_;
  double next_line_wall_s_ = 0.0;
  std::size_t decisions_told_ = 0;
  bool line_open_ = false;
};

}  // namespace forager::tools
