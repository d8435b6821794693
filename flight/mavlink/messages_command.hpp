#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "flight/mavlink/description.hpp"

// Commands, modes, parameters and message rates. Definitions: MAVLink common.xml and ardupilotmega.xml.
// Members keep the names, order and units of the XML.
namespace forager::flight::mavlink {

// A command (MAV_CMD) with seven float parameters; answered by COMMAND_ACK.
struct CommandLong {
  static constexpr std::uint32_t kId = 76;
  static constexpr std::string_view kName = "COMMAND_LONG";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t command = 0;  // MAV_CMD
  std::uint8_t confirmation = 0;
  float param1 = 0.0F;
  float param2 = 0.0F;
  float param3 = 0.0F;
  float param4 = 0.0F;
  float param5 = 0.0F;
  float param6 = 0.0F;
  float param7 = 0.0F;

  static constexpr auto fields() {
    return std::tuple{field("target_system", &CommandLong::target_system),
                      field("target_component", &CommandLong::target_component),
                      field("command", &CommandLong::command),
                      field("confirmation", &CommandLong::confirmation),
                      field("param1", &CommandLong::param1),
                      field("param2", &CommandLong::param2),
                      field("param3", &CommandLong::param3),
                      field("param4", &CommandLong::param4),
                      field("param5", &CommandLong::param5),
                      field("param6", &CommandLong::param6),
                      field("param7", &CommandLong::param7)};
  }
};

// A command with a position in integers (degE7 or 1e-4 m) in a named frame.
struct CommandInt {
  static constexpr std::uint32_t kId = 75;
  static constexpr std::string_view kName = "COMMAND_INT";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t frame = 0;     // MAV_FRAME
  std::uint16_t command = 0;  // MAV_CMD
  std::uint8_t current = 0;
  std::uint8_t autocontinue = 0;
  float param1 = 0.0F;
  float param2 = 0.0F;
  float param3 = 0.0F;
  float param4 = 0.0F;
  std::int32_t x = 0;
  std::int32_t y = 0;
  float z = 0.0F;

  static constexpr auto fields() {
    return std::tuple{field("target_system", &CommandInt::target_system),
                      field("target_component", &CommandInt::target_component),
                      field("frame", &CommandInt::frame),
                      field("command", &CommandInt::command),
                      field("current", &CommandInt::current),
                      field("autocontinue", &CommandInt::autocontinue),
                      field("param1", &CommandInt::param1),
                      field("param2", &CommandInt::param2),
                      field("param3", &CommandInt::param3),
                      field("param4", &CommandInt::param4),
                      field("x", &CommandInt::x),
                      field("y", &CommandInt::y),
                      field("z", &CommandInt::z)};
  }
};

// The answer to a command: MAV_RESULT.
struct CommandAck {
  static constexpr std::uint32_t kId = 77;
  static constexpr std::string_view kName = "COMMAND_ACK";

  std::uint16_t command = 0;  // MAV_CMD
  std::uint8_t result = 0;    // MAV_RESULT
  // extensions
  std::uint8_t progress = 0;  // %
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto fields() {
    return std::tuple{field("command", &CommandAck::command),
                      field("result", &CommandAck::result),
                      extension("progress", &CommandAck::progress),
                      extension("result_param2", &CommandAck::result_param2),
                      extension("target_system", &CommandAck::target_system),
                      extension("target_component", &CommandAck::target_component)};
  }
};

// Ends a long-running command.
struct CommandCancel {
  static constexpr std::uint32_t kId = 80;
  static constexpr std::string_view kName = "COMMAND_CANCEL";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t command = 0;  // MAV_CMD

  static constexpr auto fields() {
    return std::tuple{field("target_system", &CommandCancel::target_system),
                      field("target_component", &CommandCancel::target_component),
                      field("command", &CommandCancel::command)};
  }
};

// The old way to change mode; MAV_CMD_DO_SET_MODE is answered, this is not.
struct SetMode {
  static constexpr std::uint32_t kId = 11;
  static constexpr std::string_view kName = "SET_MODE";

  std::uint8_t target_system = 0;
  std::uint8_t base_mode = 0;  // MAV_MODE_FLAG
  std::uint32_t custom_mode = 0;

  static constexpr auto fields() {
    return std::tuple{field("target_system", &SetMode::target_system),
                      field("base_mode", &SetMode::base_mode), field("custom_mode", &SetMode::custom_mode)};
  }
};

// Mode now and mode asked for.
struct CurrentMode {
  static constexpr std::uint32_t kId = 436;
  static constexpr std::string_view kName = "CURRENT_MODE";

  std::uint8_t standard_mode = 0;  // MAV_STANDARD_MODE
  std::uint32_t custom_mode = 0;
  std::uint32_t intended_custom_mode = 0;

  static constexpr auto fields() {
    return std::tuple{field("standard_mode", &CurrentMode::standard_mode),
                      field("custom_mode", &CurrentMode::custom_mode),
                      field("intended_custom_mode", &CurrentMode::intended_custom_mode)};
  }
};

// How often a message is sent; -1 never, 0 not available.
struct MessageInterval {
  static constexpr std::uint32_t kId = 244;
  static constexpr std::string_view kName = "MESSAGE_INTERVAL";

  std::uint16_t message_id = 0;
  std::int32_t interval_us = 0;  // us

  static constexpr auto fields() {
    return std::tuple{field("message_id", &MessageInterval::message_id),
                      field("interval_us", &MessageInterval::interval_us)};
  }
};

// Asks for one parameter; param_index -1 means by name.
struct ParamRequestRead {
  static constexpr std::uint32_t kId = 20;
  static constexpr std::string_view kName = "PARAM_REQUEST_READ";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  std::int16_t param_index = 0;

  static constexpr auto fields() {
    return std::tuple{field("target_system", &ParamRequestRead::target_system),
                      field("target_component", &ParamRequestRead::target_component),
                      field("param_id", &ParamRequestRead::param_id),
                      field("param_index", &ParamRequestRead::param_index)};
  }
};

// Asks for all parameters.
struct ParamRequestList {
  static constexpr std::uint32_t kId = 21;
  static constexpr std::string_view kName = "PARAM_REQUEST_LIST";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto fields() {
    return std::tuple{field("target_system", &ParamRequestList::target_system),
                      field("target_component", &ParamRequestList::target_component)};
  }
};

// One parameter. param_id has no terminator when it fills all 16 characters.
struct ParamValue {
  static constexpr std::uint32_t kId = 22;
  static constexpr std::string_view kName = "PARAM_VALUE";

  std::array<char, 16> param_id{};
  float param_value = 0.0F;
  std::uint8_t param_type = 0;  // MAV_PARAM_TYPE
  std::uint16_t param_count = 0;
  std::uint16_t param_index = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("param_id", &ParamValue::param_id), field("param_value", &ParamValue::param_value),
        field("param_type", &ParamValue::param_type), field("param_count", &ParamValue::param_count),
        field("param_index", &ParamValue::param_index)};
  }
};

// Sets one parameter; answered by PARAM_VALUE.
struct ParamSet {
  static constexpr std::uint32_t kId = 23;
  static constexpr std::string_view kName = "PARAM_SET";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  float param_value = 0.0F;
  std::uint8_t param_type = 0;  // MAV_PARAM_TYPE

  static constexpr auto fields() {
    return std::tuple{field("target_system", &ParamSet::target_system),
                      field("target_component", &ParamSet::target_component),
                      field("param_id", &ParamSet::param_id), field("param_value", &ParamSet::param_value),
                      field("param_type", &ParamSet::param_type)};
  }
};

// Why a parameter could not be read or set.
struct ParamError {
  static constexpr std::uint32_t kId = 345;
  static constexpr std::string_view kName = "PARAM_ERROR";

  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  std::int16_t param_index = 0;
  std::uint8_t error = 0;  // MAV_PARAM_ERROR

  static constexpr auto fields() {
    return std::tuple{field("target_system", &ParamError::target_system),
                      field("target_component", &ParamError::target_component),
                      field("param_id", &ParamError::param_id),
                      field("param_index", &ParamError::param_index), field("error", &ParamError::error)};
  }
};

}  // namespace forager::flight::mavlink
