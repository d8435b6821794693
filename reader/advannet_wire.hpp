#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>

// Names and numbers of the AdvanNet interface, and nothing else: what the driver and an emulator must agree
// on. Sources: vendor client examples, captures of an AdvanReader-m4-160 with AdvanNet 2.10.33.
namespace forager::reader::advannet {

inline constexpr std::uint16_t kRestPort = 3161;
inline constexpr std::uint16_t kStreamPort = 3177;

// Event stream: "ADVANNET/1.1", "Content-Length:n", "Content-Type:text/xml", blank line, n bytes, blank
// lines.
inline constexpr std::string_view kFrameMagic = "ADVANNET/";
inline constexpr std::string_view kContentLength = "Content-Length";
inline constexpr std::string_view kContentType = "Content-Type";
inline constexpr std::chrono::milliseconds kKeepAlivePeriod{5000};  // a frame of length 0
inline constexpr int kMaxStreamClients = 4;
inline constexpr int kClientQueueMessages = 100;                   // the reader drops the oldest beyond
inline constexpr std::size_t kMaxFrameBytes = 4U * 1024U * 1024U;  // ours: no real frame comes near

// Device and read modes.
inline constexpr std::string_view kModeAutonomous = "Autonomous";
inline constexpr std::string_view kReadModeAutonomous = "AUTONOMOUS";

// Device status.
inline constexpr std::string_view kStatusShutdown = "SHUTDOWN";
inline constexpr std::string_view kStatusConnected = "CONNECTED";
inline constexpr std::string_view kStatusStopped = "STOPPED";
inline constexpr std::string_view kStatusRunning = "RUNNING";

// Reader parameters, /devices/{id}/reader/parameter/{NAME}.
inline constexpr std::string_view kReadPower = "RF_READ_POWER";
inline constexpr std::string_view kSensitivity = "RF_SENSITIVITY";
inline constexpr std::string_view kSession = "GEN2_SESSION";
inline constexpr std::string_view kTarget = "GEN2_TARGET";
inline constexpr std::string_view kQ = "GEN2_Q";
inline constexpr std::string_view kGpoNumber = "DATA_GPO_NUMBER";
inline constexpr std::string_view kGpiNumber = "DATA_GPI_NUMBER";

// Error codes of the envelope's <msg>CODE: text</msg>.
inline constexpr std::string_view kInternalError = "INTERNAL_ERROR";
inline constexpr std::string_view kRfError = "RF_ERROR";
inline constexpr std::string_view kOpError = "OP_ERROR";
inline constexpr std::string_view kUnknownOperation = "UNKNOWN_OPERATION";
inline constexpr std::string_view kOperationNotExecuted = "OPERATION_NOT_EXECUTED";
inline constexpr std::string_view kUnknownDevice = "UNKNOWN_DEVICE";
inline constexpr std::string_view kCommunicationsError = "COMMUNICATIONS_ERROR";
inline constexpr std::string_view kParameterError = "PARAMETER_ERROR";
inline constexpr std::string_view kInvalidRequest = "INVALID_REQUEST";
inline constexpr std::string_view kInvalidParams = "INVALID_PARAMS";
inline constexpr std::string_view kInvalidTarget = "INVALID_TARGET";
inline constexpr std::string_view kInvalidUser = "INVALID_USER";
inline constexpr std::string_view kConfigurationError = "CONFIGURATION_ERROR";
inline constexpr std::string_view kInvalidReadMode = "INVALID_READMODE";
inline constexpr std::string_view kReadModeNotConfigured = "READMODE_NOT_CONFIGURED";
inline constexpr std::string_view kNoSuchDeviceMode = "DEVICEMODE_DO_NOT_EXIST";
inline constexpr std::string_view kInvalidGpoNumber = "INVALID_GPO_NUMBER";
inline constexpr std::string_view kInvalidGpiNumber = "INVALID_GPI_NUMBER";
inline constexpr std::string_view kDeviceStopped = "DEVICE_STOPPED";
inline constexpr std::string_view kDeviceNotConnected = "DEVICE_NOT_CONNECTED";

}  // namespace forager::reader::advannet
