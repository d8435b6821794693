#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/recording.hpp"

namespace forager::mocks {

// A recording as the devices it was made of. The calls of a device must be those that were recorded, in that
// order and with the same bytes; what came by itself comes again when its time has come, counted from the
// start of the replay. Doubles (replay_*.hpp) borrow it.
class Replay {
 public:
  // `clock` must outlive the replay; now is when the recording began.
  Replay(std::vector<hal::Record> records, const hal::Clock& clock);

  // The answer to the next call of this device. Errors: what was recorded as one; protocol (the recording has
  // another call here: both are named); invalid_state (it has none any more).
  [[nodiscard]] hal::Result<hal::Fields> call(std::string_view device, std::string_view operation,
                                              const hal::Fields& asked);
  // The next thing that came by itself and whose time has come.
  [[nodiscard]] std::optional<hal::Result<hal::Fields>> arrived(std::string_view device,
                                                                std::string_view operation);
  // As arrived(), for something that lasts: the last one again until the next has come, one change for each
  // look, so that none is missed; before the first one that.
  [[nodiscard]] hal::Result<hal::Fields> held(std::string_view device, std::string_view operation);

  // The first call that was another one than recorded; drivers may go on after it.
  [[nodiscard]] const std::optional<hal::Error>& difference() const { return difference_; }
  // Calls that nobody has made yet.
  [[nodiscard]] std::size_t calls_left() const;
  // Time of the replay from time of the recording.
  [[nodiscard]] hal::Instant moved(hal::Instant recorded) const;
  [[nodiscard]] const std::vector<hal::Record>& records() const { return records_; }

  // A recording whose fields are not those of the operation.
  [[nodiscard]] static hal::Failure broken(std::string_view device, std::string_view operation);

 private:
  struct Queue {
    std::vector<std::size_t> records;
    std::size_t next = 0;
  };
  Queue& queue(std::string_view device, std::string_view operation);

  std::vector<hal::Record> records_;
  const hal::Clock* clock_;
  hal::Duration shift_{};
  std::optional<hal::Error> difference_;
  std::map<std::pair<std::string, std::string>, Queue, std::less<>> queues_;  // calls: no operation
};

}  // namespace forager::mocks
