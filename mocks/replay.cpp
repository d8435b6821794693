#include "mocks/replay.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace forager::mocks {
namespace {

bool is_call(std::string_view operation) { return operation.substr(0, 1) != "<"; }

// A call as it stands in the recording, without time and answer.
std::string text_of(std::string_view operation, const hal::Fields& asked) {
  std::string text(operation);
  for (const std::string& field : asked) text += " " + (field.empty() ? "-" : field);
  return text;
}

}  // namespace

Replay::Replay(std::vector<hal::Record> records, const hal::Clock& clock)
    : records_(std::move(records)), clock_(&clock) {
  if (!records_.empty()) shift_ = clock.now() - records_.front().at;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const hal::Record& record = records_[i];
    if (record.operation == "start" && record.device == "recorder") continue;
    queue(record.device, record.operation).records.push_back(i);
  }
}

// A stamp inside a record may be any number.
hal::Instant Replay::moved(hal::Instant recorded) const {
  constexpr hal::Instant kMost{std::chrono::seconds(4'000'000'000)};
  return std::clamp(recorded, hal::Instant(-kMost.time_since_epoch()), kMost) + shift_;
}

Replay::Queue& Replay::queue(std::string_view device, std::string_view operation) {
  return queues_[{std::string(device), is_call(operation) ? std::string() : std::string(operation)}];
}

hal::Result<hal::Fields> Replay::call(std::string_view device, std::string_view operation,
                                      const hal::Fields& asked) {
  Queue& calls = queue(device, operation);
  const auto differs = [&](hal::ErrorCode code, std::string detail) {
    hal::Error error{code,
                     std::string(device),
                     text_of(operation, asked),
                     std::move(detail),
                     "The driver does not do what it did when this was recorded",
                     0};
    if (!difference_) difference_ = error;
    return hal::fail(std::move(error));
  };
  if (calls.next >= calls.records.size())
    return differs(hal::ErrorCode::invalid_state, "the recording has no more calls of this device");
  const hal::Record& record = records_[calls.records[calls.next]];
  if (record.operation != operation || record.asked != asked)
    return differs(hal::ErrorCode::protocol,
                   fmt::format("the recording has \"{}\" here, at {:.3f} s",
                               text_of(record.operation, record.asked), hal::to_seconds(record.at)));
  ++calls.next;
  return record.answer;
}

std::optional<hal::Result<hal::Fields>> Replay::arrived(std::string_view device, std::string_view operation) {
  Queue& arrivals = queue(device, operation);
  if (arrivals.next >= arrivals.records.size()) return std::nullopt;
  const hal::Record& record = records_[arrivals.records[arrivals.next]];
  if (moved(record.at) > clock_->now()) return std::nullopt;
  ++arrivals.next;
  return record.answer;
}

hal::Result<hal::Fields> Replay::held(std::string_view device, std::string_view operation) {
  if (auto next = arrived(device, operation)) return *std::move(next);
  const Queue& arrivals = queue(device, operation);
  if (arrivals.records.empty())
    return hal::fail(hal::ErrorCode::invalid_state, std::string(device), std::string(operation),
                     "the recording has nothing of the kind");
  return records_[arrivals.records[arrivals.next == 0 ? 0 : arrivals.next - 1]].answer;
}

std::size_t Replay::calls_left() const {
  std::size_t left = 0;
  for (const auto& [key, queue] : queues_)
    if (key.second.empty()) left += queue.records.size() - queue.next;
  return left;
}

hal::Failure Replay::broken(std::string_view device, std::string_view operation) {
  return hal::fail(hal::ErrorCode::protocol, std::string(device), std::string(operation),
                   "the recording's fields are not those of this operation");
}

}  // namespace forager::mocks
