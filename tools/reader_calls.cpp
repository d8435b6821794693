#include "tools/reader_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
namespace advannet = reader::advannet;

constexpr hal::Duration kTick = 5ms;

}  // namespace

hal::Error ReaderCalls::blame(const hal::HttpRequest& request, hal::Error error) const {
  error.device = fmt::format("AdvanReader at {}", bench_.rest().name());
  error.operation = advannet::describe_request(request);
  if (error.detail.empty()) error.detail = std::string(to_string(error.code));
  if (error.mend.empty()) error.mend = "Check the reader's power and the network";
  return error;
}

hal::Result<advannet::Reply> ReaderCalls::ask(hal::HttpRequest request) {
  request.timeout = timeout_;
  if (auto started = bench_.rest().start(request, clock_.now()); !started)
    return hal::fail(blame(request, std::move(started).error()));
  const hal::Deadline deadline(clock_.now(), timeout_ + kTick);
  while (!StopSignal::raised()) {
    wait(kTick);
    auto response = bench_.rest().poll(clock_.now());
    if (!response) return hal::fail(blame(request, std::move(response).error()));
    if (*response) {
      auto reply = advannet::parse_reply(**response);
      if (!reply) return hal::fail(blame(request, std::move(reply).error()));
      return reply;
    }
    if (!deadline.expired(clock_.now())) continue;
    bench_.rest().cancel();
    return hal::fail(blame(request, {hal::ErrorCode::timeout, {}, {}, "no answer in time", {}}));
  }
  bench_.rest().cancel();
  return hal::fail(
      blame(request, {hal::ErrorCode::invalid_state, {}, {}, StopSignal::name(), "Ended by a signal"}));
}

hal::Result<advannet::Reply> ReaderCalls::demand(const hal::HttpRequest& request) {
  auto reply = ask(request);
  if (!reply || reply->ok) return reply;
  return hal::fail(blame(request, {hal::ErrorCode::refused,
                                   {},
                                   {},
                                   advannet::describe_refusal(*reply),
                                   "Look at the reader's web page"}));
}

hal::Result<advannet::Device> ReaderCalls::find_device(const std::string& wanted) {
  const hal::HttpRequest request = advannet::get_devices();
  auto reply = demand(request);
  if (!reply) return hal::fail(std::move(reply).error());
  const auto& devices = reply->devices;
  if (devices.empty())
    return hal::fail(blame(
        request,
        {hal::ErrorCode::not_present, {}, {}, "the reader lists no device", "It may still be starting"}));
  std::string ids;
  for (const auto& device : devices) ids += (ids.empty() ? "" : ", ") + device.id;
  const auto chosen =
      wanted.empty() ? devices.begin() : std::ranges::find(devices, wanted, &advannet::Device::id);
  if (chosen == devices.end())
    return hal::fail(blame(request, {hal::ErrorCode::not_present,
                                     {},
                                     {},
                                     fmt::format("no device '{}', there is: {}", wanted, ids),
                                     "Change reader.device_id of the board file"}));
  if (wanted.empty() && devices.size() > 1)
    return hal::fail(blame(request, {hal::ErrorCode::invalid_argument,
                                     {},
                                     {},
                                     fmt::format("there are {} devices: {}", devices.size(), ids),
                                     "Name one in reader.device_id of a board file"}));
  return *chosen;
}

void ReaderCalls::wait(hal::Duration time) {
  const hal::Instant end = clock_.now() + time;
  for (hal::Instant next = clock_.now(); next < end && !StopSignal::raised();) {
    next = std::min(next + kTick, end);
    clock_.sleep_until(next);
    bench_.advance(clock_.now());
  }
}

}  // namespace forager::tools
