#include "tests/reader/fake_advannet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "reader/advannet_rest.hpp"

namespace forager::test {

FakeAdvanNet::FakeAdvanNet() {
  parameters = {{"RF_READ_POWER", "31.5"}, {"RF_SENSITIVITY", "-82.0"}, {"GEN2_SESSION", "S0"},
                {"GEN2_TARGET", "A"},      {"GEN2_Q", "Q_DYNAMIC"},     {"DATA_GPO_NUMBER", "8"}};
}

std::size_t FakeAdvanNet::count(std::string_view request) const {
  return static_cast<std::size_t>(std::ranges::count(requests, request));
}

void FakeAdvanNet::reboot(hal::Instant now) {
  const FakeAdvanNet fresh;
  parameters = fresh.parameters;
  outputs.clear();
  status = "STOPPED";
  booted = now.time_since_epoch();
  wire.drop();
}

void FakeAdvanNet::send(std::string_view bytes) {
  if (!wire.connected()) return;
  const auto written = wire.far().write(std::as_bytes(std::span(bytes.data(), bytes.size())));
  (void)written;  // a client that went away a moment ago is what a reader has to live with
}

hal::Result<> FakeAdvanNet::do_start(const hal::HttpRequest& request, hal::Instant now) {
  if (pending_) {
    overlapped = true;
    return hal::fail(hal::ErrorCode::busy, "fake", "start", "one is in flight");
  }
  requests.push_back(reader::advannet::describe_request(request));
  pending_ = Pending{request, now};
  return {};
}

hal::Result<std::optional<hal::HttpResponse>> FakeAdvanNet::do_poll(hal::Instant now) {
  if (!pending_) return hal::fail(hal::ErrorCode::invalid_state, "fake", "poll", "none in flight");
  if (silent) {
    if (now - pending_->sent < pending_->request.timeout) return std::nullopt;
    pending_.reset();
    return hal::fail(hal::ErrorCode::timeout, "fake", "poll", "no answer in time");
  }
  if (now - pending_->sent < latency) return std::nullopt;
  const hal::HttpRequest request = pending_->request;
  pending_.reset();
  if (down) return hal::fail(hal::ErrorCode::refused, "fake", "connect", "nobody listens");
  if (wrong_password) return hal::fail(hal::ErrorCode::authentication, "fake", "poll", "401 Unauthorized");
  return hal::HttpResponse{200, answer(request, now)};
}

std::string FakeAdvanNet::devices() const {
  std::string list;
  for (const std::string& id : ids)
    list += fmt::format(
        "<device><id>{}</id><serial>0091104::64cfd9c7561c</serial><family>AdvanReader</family>"
        "<status>{}</status></device>",
        id, status);
  return "<devices>" + list + "</devices>";
}

std::string FakeAdvanNet::answer(const hal::HttpRequest& request, hal::Instant now) {
  const std::string last = request.path.substr(request.path.rfind('/') + 1);
  const auto envelope = [&](std::string_view state, std::string_view rest) {
    return fmt::format(
        "<response><type>response</type><ts>{}</ts><status>{}</status><msg-version>2.3.0</msg-version>"
        "<op>{}</op>{}</response>",
        ms(now), state, last, rest);
  };
  if (const auto error = errors.find(last); error != errors.end())
    return envelope("ERROR", "<msg>" + error->second + "</msg>");
  std::string data;
  const bool put = request.method == hal::HttpMethod::put;
  if (last == "devices" || last == ids.front()) {
    data = devices();
  } else if (last == "status") {
    const auto up =
        booted ? std::chrono::floor<std::chrono::seconds>(now.time_since_epoch() - *booted).count() : 0;
    if (booted) data = fmt::format("<uptime>{}h {}m {}s</uptime>", up / 3600, up / 60 % 60, up % 60);
  } else if (last == "start") {
    status = "RUNNING";
  } else if (last == "stop" || last == "connect") {
    status = "STOPPED";
  } else if (request.path.find("/setGPO/") != std::string::npos) {
    const std::size_t at = request.path.find("/setGPO/") + 8;
    outputs[std::stoi(request.path.substr(at))] = last == "true";
  } else if (request.path.find("reader/parameter/") != std::string::npos) {
    if (put) parameters[last] = request.body;
    const auto forced = read_back.find(last);
    if (!put)
      data = "<result>" + (forced == read_back.end() ? parameters[last] : forced->second) + "</result>";
  } else if (last == "getGPIAll") {
    data =
        "<entries><entry><index>0</index><result>true</result></entry>"
        "<entry><index>1</index><result>false</result></entry></entries>";
  } else if (!put) {
    return envelope("ERROR", "<msg>UNKNOWN_OPERATION: Operation [" + last + "] unknown.</msg>");
  }
  return envelope("OK", "<data>" + data + "</data>");
}

}  // namespace forager::test
