// REST of the emulated AdvanReader: from a path to an operation, and envelopes around what it answers
// (AdvanNet: the first segment selects a context, below devices/{id} segments are object properties).
#include <fmt/format.h>

#include <charconv>
#include <iterator>

#include "mocks/sim_reader.hpp"
#include "mocks/sim_reader_operation.hpp"
#include "mocks/sim_reader_xml.hpp"

namespace forager::mocks {
namespace {

using hal::HttpMethod;

std::string percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    unsigned value = 0;
    const std::string_view digits = text.substr(std::min(at + 1, text.size()), 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (text[at] == '%' && digits.size() == 2 && error == std::errc() && end == digits.data() + 2) {
      out += static_cast<char>(value);
      at += 2;
    } else {
      out += text[at];
    }
  }
  return out;
}

// Empty segments (a trailing slash) are tolerated.
std::vector<std::string> segments_of(std::string_view path) {
  std::vector<std::string> segments;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find('/'), path.size());
    if (end > 0) segments.push_back(percent_decoded(path.substr(0, end)));
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return segments;
}

tl::unexpected<Refusal> unknown(std::string_view operation) {
  return refuse("UNKNOWN_OPERATION", fmt::format("Operation [{}] unknown.", operation));
}

}  // namespace

SimReader::Answered SimReader::handle_http(HttpMethod method, std::string_view path, std::string_view body,
                                           hal::Instant now) {
  catch_up(now);
  if (config_.faults.http_500 > 0.0 && random_.chance(config_.faults.http_500)) {
    note(now, fmt::format("{} -> HTTP 500", path));
    return {{500, "Internal Server Error"}, false};
  }
  const std::vector<std::string> segments = segments_of(path);
  std::string op = segments.empty() ? std::string() : segments.back();
  Answer<Content> answer = route(segments, op, Call{method, {}, body, now});
  note(now, fmt::format("{} {} -> {}", method == HttpMethod::get ? "GET" : "PUT", path,
                        answer ? std::string("OK") : answer.error().code));
  if (answer && answer->later) return {{}, true};
  return {envelope(op, std::move(answer), now), false};
}

std::optional<HttpReply> SimReader::sweep_reply(hal::Instant now) {
  catch_up(now);
  if (!sweep_) return HttpReply{500, "Internal Server Error"};  // stopped, rebooted under way
  if (now < sweep_->ends) return std::nullopt;
  const Sweep sweep = std::move(*sweep_);
  sweep_.reset();
  std::string text = inventory_text(sweep.operation, sweep.reads, now);
  const bool whole = sweep.operation != "jsonMinLocation";
  return envelope(sweep.operation, Content{std::move(text), whole, false}, now);
}

HttpReply SimReader::envelope(std::string_view op, Answer<Content> answer, hal::Instant now) const {
  if (answer && answer->whole) return {200, std::move(answer->text)};
  std::string out = fmt::format("<response><type>response</type><ts>{}</ts><status>{}</status>",
                                reader_ms(now), answer ? "OK" : "ERROR");
  if (answer) out += "<msg-version>2.3.0</msg-version>";
  append_element(out, "op", op);
  if (!answer)
    append_element(out, "msg", fmt::format("{}: {}", answer.error().code, answer.error().text));
  else if (!answer->text.empty())
    fmt::format_to(std::back_inserter(out), "<data>{}</data>", answer->text);
  out += "</response>";
  return {answer ? 200 : config_.error_http_status, std::move(out)};
}

bool SimReader::refused_by_fault(std::string_view op) {
  SimReaderFaults& faults = config_.faults;
  if (faults.refuse_operation.empty() || faults.refuse_operation != op || faults.refuse_times == 0)
    return false;
  if (faults.refuse_times > 0) --faults.refuse_times;
  return true;
}

Answer<SimReader::Content> SimReader::route(std::span<const std::string> path, std::string& op, Call call) {
  if (path.empty()) return unknown("");
  const std::string& context = path[0];
  const bool get = call.method == HttpMethod::get;
  if (refused_by_fault(op)) return refuse("INTERNAL_ERROR", "Injected fault.");
  if (context == "status" && path.size() == 1 && get) return Content{status_xml(call.now)};
  if (context == "conf" && path.size() == 2 && path[1] == "save" && get) return do_save(call);
  if (context == "system") return route_system(path.subspan(1), op, call);
  if (context != "devices") return unknown(op);
  if (path.size() == 1 || (path.size() == 2 && (path[1] == "all" || path[1] == config_.device_id))) {
    op = "devices";
    return get ? Answer<Content>(Content{"<devices>" + device_xml(call.now) + "</devices>"}) : unknown(op);
  }
  if (path[1] != config_.device_id)
    return refuse("UNKNOWN_DEVICE", fmt::format("Device [{}] unknown.", path[1]));
  return route_device(path.subspan(2), op, call);
}

Answer<SimReader::Content> SimReader::route_device(std::span<const std::string> path, std::string& op,
                                                   Call call) {
  // List members by index: the active device mode has one read mode.
  std::string name = path[0];
  if (name == "readModes[0]" || name == "readMode") {
    name = "readModes";
  } else if (name == "readModes" && call.method == HttpMethod::put) {
    return refuse("INVALID_REQUEST", "readModes needs an index.");
  }
  for (const Operation& operation : operations()) {
    if (operation.name != name || operation.method != call.method) continue;
    if (path.size() - 1 < operation.min_arguments || path.size() - 1 > operation.max_arguments) continue;
    op = path[0];
    if (path.size() > 1 && refused_by_fault(op)) return refuse("INTERNAL_ERROR", "Injected fault.");
    if (operation.changes_setup && status_ == Status::running && config_.refuse_changes_running)
      return refuse("OPERATION_NOT_EXECUTED", fmt::format("{}() device is running. Stop it first.", op));
    call.arguments = path.subspan(1);
    Answer<Content> answer = (this->*operation.handler)(call);
    if (answer && operation.changes_setup && status_ == Status::running) renew_radio(call.now);
    return answer;
  }
  return unknown(op);
}

Answer<SimReader::Content> SimReader::route_system(std::span<const std::string> path, std::string& op,
                                                   Call call) {
  const bool get = call.method == HttpMethod::get;
  if (path.size() == 1 && path[0] == "time") {
    if (!get) {
      const auto ms = decimal(trimmed(call.body));
      if (!ms || *ms < 0.0 || *ms > 4.0e12)
        return refuse("PARAMETER_ERROR", "Time is not in Unix milliseconds.");
      clock_base_ms_ += static_cast<std::int64_t>(*ms) - reader_ms(call.now);
    }
    return Content{fmt::format("<time>{}</time>", reader_ms(call.now))};
  }
  if (path.size() == 2 && path[0] == "runtime" && path[1] == "reboot" && get) {
    reboot_at_ = call.now + std::chrono::milliseconds(500);
    return Content{};
  }
  if (path.size() == 2 && path[0] == "parameter" && path[1] == "COMM_TCP3177_ENCODER") {
    if (get) return Content{"<result>XML_V2_3</result>"};
    if (trimmed(call.body) == "XML_V2_3") return Content{};
    return refuse("PARAMETER_ERROR", "Only the encoder XML_V2_3 is available.");
  }
  return unknown(op);
}

}  // namespace forager::mocks
