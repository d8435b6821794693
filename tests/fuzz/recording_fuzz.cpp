// Whatever the three files of a recording hold, they are taken or complained about.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "boards/calibration_data.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The files stand one after another, apart by a byte that no text has.
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  std::array<std::string_view, 3> files{};
  std::size_t start = 0;
  for (std::string_view& file : files) {
    const std::size_t end = start <= all.size() ? all.find('\xFF', start) : std::string_view::npos;
    if (start <= all.size()) file = all.substr(start, end == std::string_view::npos ? end : end - start);
    start = end == std::string_view::npos ? all.size() + 1 : end + 1;
  }
  const auto recording = forager::boards::parse_recording(files[0], files[1], files[2]);
  if (!recording) {
    if (recording.error().detail.empty()) std::abort();
    return 0;
  }
  for (const auto& read : recording->reads)
    if (read.tag >= recording->tags.size()) std::abort();
  for (std::size_t i = 1; i < recording->poses.size(); ++i)
    if (recording->poses[i].time_s <= recording->poses[i - 1].time_s) std::abort();
  return 0;
}
