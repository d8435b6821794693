#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "flight/mavlink/description.hpp"

// Presence, time, text, signing and the radio. Definitions: MAVLink common.xml and ardupilotmega.xml.
// Members keep the names, order and units of the XML.
namespace forager::flight::mavlink {

// A component is alive, and what it is. Customarily once a second.
struct Heartbeat {
  static constexpr std::uint32_t kId = 0;
  static constexpr std::string_view kName = "HEARTBEAT";

  std::uint8_t type = 0;       // MAV_TYPE
  std::uint8_t autopilot = 0;  // MAV_AUTOPILOT
  std::uint8_t base_mode = 0;  // MAV_MODE_FLAG
  std::uint32_t custom_mode = 0;
  std::uint8_t system_status = 0;  // MAV_STATE
  std::uint8_t mavlink_version = 0;

  static constexpr auto fields() {
    return std::tuple{field("type", &Heartbeat::type),
                      field("autopilot", &Heartbeat::autopilot),
                      field("base_mode", &Heartbeat::base_mode),
                      field("custom_mode", &Heartbeat::custom_mode),
                      field("system_status", &Heartbeat::system_status),
                      field("mavlink_version", &Heartbeat::mavlink_version)};
  }
};

// The sender's wall clock and time since boot.
struct SystemTime {
  static constexpr std::uint32_t kId = 2;
  static constexpr std::string_view kName = "SYSTEM_TIME";

  std::uint64_t time_unix_usec = 0;  // us
  std::uint32_t time_boot_ms = 0;    // ms

  static constexpr auto fields() {
    return std::tuple{field("time_unix_usec", &SystemTime::time_unix_usec),
                      field("time_boot_ms", &SystemTime::time_boot_ms)};
  }
};

// Round trip: a request has target 0/0, the answer the requester's ids and the same seq.
struct Ping {
  static constexpr std::uint32_t kId = 4;
  static constexpr std::string_view kName = "PING";

  std::uint64_t time_usec = 0;  // us
  std::uint32_t seq = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto fields() {
    return std::tuple{field("time_usec", &Ping::time_usec), field("seq", &Ping::seq),
                      field("target_system", &Ping::target_system),
                      field("target_component", &Ping::target_component)};
  }
};

// Clock comparison: tc1 = 0 asks, the answer carries the own time in tc1 and returns ts1.
struct Timesync {
  static constexpr std::uint32_t kId = 111;
  static constexpr std::string_view kName = "TIMESYNC";

  std::int64_t tc1 = 0;  // ns
  std::int64_t ts1 = 0;  // ns
  // extensions
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto fields() {
    return std::tuple{field("tc1", &Timesync::tc1), field("ts1", &Timesync::ts1),
                      extension("target_system", &Timesync::target_system),
                      extension("target_component", &Timesync::target_component)};
  }
};

// A line of text with a severity; longer texts come in chunks with one id.
struct Statustext {
  static constexpr std::uint32_t kId = 253;
  static constexpr std::string_view kName = "STATUSTEXT";

  std::uint8_t severity = 0;  // MAV_SEVERITY
  std::array<char, 50> text{};
  // extensions
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;

  static constexpr auto fields() {
    return std::tuple{field("severity", &Statustext::severity), field("text", &Statustext::text),
                      extension("id", &Statustext::id), extension("chunk_seq", &Statustext::chunk_seq)};
  }
};

// Injected by telemetry radios; never signed.
struct RadioStatus {
  static constexpr std::uint32_t kId = 109;
  static constexpr std::string_view kName = "RADIO_STATUS";

  std::uint8_t rssi = 0;
  std::uint8_t remrssi = 0;
  std::uint8_t txbuf = 0;  // %
  std::uint8_t noise = 0;
  std::uint8_t remnoise = 0;
  std::uint16_t rxerrors = 0;
  std::uint16_t fixed = 0;

  static constexpr auto fields() {
    return std::tuple{field("rssi", &RadioStatus::rssi),         field("remrssi", &RadioStatus::remrssi),
                      field("txbuf", &RadioStatus::txbuf),       field("noise", &RadioStatus::noise),
                      field("remnoise", &RadioStatus::remnoise), field("rxerrors", &RadioStatus::rxerrors),
                      field("fixed", &RadioStatus::fixed)};
  }
};

// Carries the signing key: only over a trusted link, never logged or forwarded.
struct SetupSigning {
  static constexpr std::uint32_t kId = 256;
  static constexpr std::string_view kName = "SETUP_SIGNING";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<std::uint8_t, 32> secret_key{};
  std::uint64_t initial_timestamp = 0;

  static constexpr auto fields() {
    return std::tuple{field("target_system", &SetupSigning::target_system),
                      field("target_component", &SetupSigning::target_component),
                      field("secret_key", &SetupSigning::secret_key),
                      field("initial_timestamp", &SetupSigning::initial_timestamp)};
  }
};

// A number with a name, for experiments.
struct NamedValueFloat {
  static constexpr std::uint32_t kId = 251;
  static constexpr std::string_view kName = "NAMED_VALUE_FLOAT";

  std::uint32_t time_boot_ms = 0;  // ms
  std::array<char, 10> name{};
  float value = 0.0F;

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &NamedValueFloat::time_boot_ms),
                      field("name", &NamedValueFloat::name), field("value", &NamedValueFloat::value)};
  }
};

// Firmware and board of the autopilot.
struct AutopilotVersion {
  static constexpr std::uint32_t kId = 148;
  static constexpr std::string_view kName = "AUTOPILOT_VERSION";

  std::uint64_t capabilities = 0;  // MAV_PROTOCOL_CAPABILITY
  std::uint32_t flight_sw_version = 0;
  std::uint32_t middleware_sw_version = 0;
  std::uint32_t os_sw_version = 0;
  std::uint32_t board_version = 0;
  std::array<std::uint8_t, 8> flight_custom_version{};
  std::array<std::uint8_t, 8> middleware_custom_version{};
  std::array<std::uint8_t, 8> os_custom_version{};
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint64_t uid = 0;
  // extensions
  std::array<std::uint8_t, 18> uid2{};

  static constexpr auto fields() {
    return std::tuple{field("capabilities", &AutopilotVersion::capabilities),
                      field("flight_sw_version", &AutopilotVersion::flight_sw_version),
                      field("middleware_sw_version", &AutopilotVersion::middleware_sw_version),
                      field("os_sw_version", &AutopilotVersion::os_sw_version),
                      field("board_version", &AutopilotVersion::board_version),
                      field("flight_custom_version", &AutopilotVersion::flight_custom_version),
                      field("middleware_custom_version", &AutopilotVersion::middleware_custom_version),
                      field("os_custom_version", &AutopilotVersion::os_custom_version),
                      field("vendor_id", &AutopilotVersion::vendor_id),
                      field("product_id", &AutopilotVersion::product_id),
                      field("uid", &AutopilotVersion::uid),
                      extension("uid2", &AutopilotVersion::uid2)};
  }
};

}  // namespace forager::flight::mavlink
