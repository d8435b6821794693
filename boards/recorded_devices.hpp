#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "boards/device_set.hpp"
#include "hal/recording.hpp"

namespace forager::boards {

// Who takes a run down: the sink gets the lines of the recording, the first of which says what run it is.
struct RunRecording {
  std::function<void(std::string_view line)> sink;
  hal::Fields facts;  // of the record "run begin"
};

// The same devices; everything that passes between them and their drivers is recorded, and "<tick" of "run"
// with each update, so that the same times come back.
[[nodiscard]] std::unique_ptr<DeviceSet> record_devices(std::unique_ptr<DeviceSet> devices,
                                                        const RunRecording& recording, hal::Instant now);

// Devices that answer from a recording.
class ReplayedDevices : public DeviceSet {
 public:
  // The first call that was another one than recorded; nothing: none was.
  [[nodiscard]] virtual const std::optional<hal::Error>& difference() const = 0;
  // Calls of the recording that nobody has made yet, and all of them.
  [[nodiscard]] virtual std::size_t calls_left() const = 0;
  [[nodiscard]] virtual std::size_t calls() const = 0;
};
[[nodiscard]] std::unique_ptr<ReplayedDevices> replay_devices(std::vector<hal::Record> records,
                                                              hal::Instant now);

}  // namespace forager::boards
