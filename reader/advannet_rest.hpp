#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/http_client.hpp"
#include "reader/read_plan.hpp"

// AdvanNet's REST interface: requests out of values, values out of replies. Actions are GETs, setters PUTs;
// a scalar travels as plain text, a structure as an XML <request>. The requests leave the timeout to the
// caller.
namespace forager::reader::advannet {

// Everything outside RFC 3986's unreserved characters as %XX; for one path segment.
[[nodiscard]] std::string percent_encode(std::string_view segment);

[[nodiscard]] hal::HttpRequest get_devices();
[[nodiscard]] hal::HttpRequest get_status();
[[nodiscard]] hal::HttpRequest get_device(std::string_view id);
// "start", "stop", "connect", "getGPIAll"; `operation` may have further segments, which are not encoded.
[[nodiscard]] hal::HttpRequest get_operation(std::string_view id, std::string_view operation);
[[nodiscard]] hal::HttpRequest set_gpo(std::string_view id, unsigned line, bool active);
[[nodiscard]] hal::HttpRequest put_device_mode(std::string_view id, std::string_view mode);
// readModes[0] as AUTONOMOUS with the plan's RF on and off times.
[[nodiscard]] hal::HttpRequest put_read_mode(std::string_view id, const ReadPlan& plan);
// Replaces the reader's whole antenna list by the plan's ports. A port without a power or sensitivity of its
// own leaves the field empty, which means the reader's global value.
[[nodiscard]] hal::HttpRequest put_antennas(std::string_view id, const ReadPlan& plan);
[[nodiscard]] hal::HttpRequest put_parameter(std::string_view id, std::string_view name,
                                             std::string_view value);
[[nodiscard]] hal::HttpRequest get_parameter(std::string_view id, std::string_view name);

// "PUT GEN2_SESSION = S1", "GET start": what a person wants to read in an error line.
[[nodiscard]] std::string describe_request(const hal::HttpRequest& request);

// One scalar parameter of the plan and the scene key it comes from.
struct Setting {
  std::string_view name;   // "GEN2_SESSION"
  std::string value;       // "S1"
  std::string_view key;    // "session"
  bool read_back = false;  // worth asking for again: decides what the air looks like
};
// In the order they are written: power, sensitivity, session, target, Q.
[[nodiscard]] std::vector<Setting> settings_of(const ReadPlan& plan);
// Equal as text or, for numbers ("30" and "30.0"), in value.
[[nodiscard]] bool same_value(std::string_view wanted, std::string_view answered);

struct Device {
  std::string id;
  std::string serial;
  std::string family;
  std::string status;  // "RUNNING"; empty if not reported
};
struct InputLevel {
  unsigned line = 0;  // 1-based (the wire counts from 0)
  bool high = false;
};
struct Reply {
  bool ok = false;
  std::string code;                   // of an ERROR: "PARAMETER_ERROR"; empty if the reader named none
  std::string message;                // of an ERROR: the whole <msg>
  std::optional<std::int64_t> ts_ms;  // reader clock, Unix milliseconds
  std::optional<std::string> result;
  std::optional<hal::Duration> uptime;  // of /status
  std::vector<Device> devices;
  std::vector<InputLevel> inputs;
};

// Reads the envelope, leniently: the outer <response> may be missing, an ERROR may come with any HTTP status,
// and only the element names count. Errors: protocol (no XML, longer than 4 MiB, or no envelope with a
// failing HTTP status).
[[nodiscard]] hal::Result<Reply> parse_reply(const hal::HttpResponse& response);
// Of a reply that is not ok: "answered PARAMETER_ERROR: ...".
[[nodiscard]] std::string describe_refusal(const Reply& reply);

}  // namespace forager::reader::advannet
