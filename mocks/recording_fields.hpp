#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "hal/recording.hpp"

namespace forager::mocks {

// What every Recording* double does: passes the answer on after it was taken down.
template <class Value, class ToFields>
hal::Result<Value> taken(hal::Recorder& recorder, std::string_view device, std::string_view operation,
                         hal::Fields asked, hal::Result<Value> answer, ToFields to_fields) {
  hal::Result<hal::Fields> fields =
      answer ? hal::Result<hal::Fields>(to_fields(*answer)) : hal::fail(answer.error());
  recorder.take(device, operation, std::move(asked), std::move(fields));
  return answer;
}

inline hal::Result<> taken(hal::Recorder& recorder, std::string_view device, std::string_view operation,
                           hal::Fields asked, hal::Result<> answer) {
  recorder.take(device, operation, std::move(asked),
                answer ? hal::Result<hal::Fields>(hal::Fields{}) : hal::fail(answer.error()));
  return answer;
}

// What is looked at again and again is taken down when it has changed.
class LastAnswer {
 public:
  // The answer as one text; true: it is another one than before.
  [[nodiscard]] bool changed(std::string answer) {
    if (last_ == answer) return false;
    last_ = std::move(answer);
    return true;
  }
  template <class Value, class ToFields>
  hal::Result<Value> take(hal::Recorder& recorder, std::string_view device, std::string_view operation,
                          hal::Result<Value> answer, ToFields to_fields) {
    hal::Result<hal::Fields> fields =
        answer ? hal::Result<hal::Fields>(to_fields(*answer)) : hal::fail(answer.error());
    if (changed(hal::to_line({hal::Instant{}, "", "", {}, fields})))
      recorder.take(device, operation, {}, std::move(fields));
    return answer;
  }

 private:
  std::optional<std::string> last_;
};

// What a Replay* double reads out of a record.
inline hal::Result<> nothing_of(const hal::Result<hal::Fields>& fields) {
  return fields ? hal::Result<>() : hal::Result<>(hal::fail(fields.error()));
}

// Copies recorded bytes to where the driver wants them; their number, or nothing: they are no bytes, or more
// than there is room for.
inline std::optional<std::size_t> copied(std::string_view field, std::span<std::byte> into) {
  const auto bytes = hal::bytes_in(field);
  if (!bytes || bytes->size() > into.size()) return std::nullopt;
  std::copy(bytes->begin(), bytes->end(), into.begin());
  return bytes->size();
}

}  // namespace forager::mocks
