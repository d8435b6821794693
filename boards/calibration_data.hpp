#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"

namespace forager::boards {

// A recorded run: what was heard, where the vehicle was, and where the tags really are. World frame REP-103,
// metres, radians, seconds on one time line.
struct Recording {
  struct Read {
    double time_s = 0.0;
    std::uint32_t tag = 0;  // index into tags
    int port = 0;
    double rssi_dbm = 0.0;
  };
  struct PoseAt {
    double time_s = 0.0;
    hal::Pose pose;
  };
  struct Tag {
    std::string epc;  // lower case
    hal::Vec3 position;
  };
  std::vector<Tag> tags;
  std::vector<Read> reads;      // by time
  std::vector<PoseAt> poses;    // by time, no two at one
  std::uint64_t strangers = 0;  // reads of tags whose place is not known; left out
};

// Columns of the three files:
//   reads  time_s,epc,port,rssi      poses  time_s,x,y,z,yaw      tags  epc,x,y,z
// Errors: invalid_argument with file, line and column: those of CsvTable, an EPC that is not hexadecimal
// digits in pairs, a tag twice, poses that do not go forward in time.
[[nodiscard]] hal::Result<Recording> parse_recording(std::string_view reads, std::string_view poses,
                                                     std::string_view tags);
// The same from files. Errors: those of read_text_file besides.
[[nodiscard]] hal::Result<Recording> load_recording(const std::string& reads, const std::string& poses,
                                                    const std::string& tags);

// The three files of a recording.
[[nodiscard]] std::string reads_csv(const Recording& recording);
[[nodiscard]] std::string poses_csv(const Recording& recording);
[[nodiscard]] std::string tags_csv(const Recording& recording);

}  // namespace forager::boards
