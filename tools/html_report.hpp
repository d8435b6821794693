#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flight/mission.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::tools {

// Everything the report of one run shows. World frame REP-103, metres and radians; all instants on one time
// line, shown in seconds since `started`. Whatever is not known stays empty and its part of the page is left
// out; values that are not finite are skipped.
struct ReportData {
  struct Box {  // upright, axis-aligned: a shelf or a wall
    hal::Vec3 min;
    hal::Vec3 max;
  };
  struct Tag {
    hal::Vec3 position;
    bool read = false;
  };
  struct PathSample {
    hal::Instant at;
    double x = 0.0;
    double y = 0.0;
    double yaw_rad = 0.0;
  };
  struct TagSample {  // distinct tags up to this moment
    hal::Instant at;
    std::uint32_t count = 0;
    std::vector<std::uint32_t> per_port;  // as `ports`; may be empty
  };
  struct Port {
    std::uint8_t port = 0;
    std::string name;            // "front"
    std::uint32_t new_tags = 0;  // tags it heard first
    std::uint64_t reads = 0;
  };
  struct Event {
    hal::Instant at;
    std::string text;
  };

  std::string scene;   // "4A"
  std::string title;   // "300 tags, T shape, stigmergic"; may be empty
  std::string policy;  // "stigmergy"
  std::uint64_t seed = 0;
  std::string end_reason;  // "no_new_tags"; may be empty
  hal::Instant started;    // zero of the report's time axis
  hal::Instant ended;
  std::vector<Box> boxes;
  std::vector<Tag> tags;
  // Of a world with more tags than can be drawn `tags` holds some; how many there are, and were read.
  struct Totals {
    std::size_t tags = 0;
    std::size_t read = 0;
  };
  std::optional<Totals> totals;
  std::vector<PathSample> path;  // in time order
  std::optional<double> path_m;  // length flown, where it is known better than from the samples
  std::vector<flight::Decision> decisions;
  std::vector<TagSample> tags_over_time;  // in time order
  std::vector<Port> ports;
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<Event> events;
};

// One self-contained page, valid as HTML and as XML: no script, nothing loaded from elsewhere, all text
// escaped. The same data gives the same bytes. Long paths and curves are thinned to what the eye can see,
// long event lists are cut with a note, so the size stays below some 100 bytes per tag plus 300 kB.
[[nodiscard]] std::string render_html_report(const ReportData& data);

}  // namespace forager::tools
