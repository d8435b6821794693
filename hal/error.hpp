#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace forager::hal {

// The portable half of an error: what generic code may switch on. Each interface documents which of these its
// methods answer and what physically causes them.
enum class ErrorCode : std::uint8_t {
  invalid_argument,  // the caller asked for something that can never work; nothing was sent
  invalid_state,     // not now: the device is not open, not armed, already running
  not_present,       // no such host, file, device or object
  permission,        // the operating system forbids it
  busy,              // somebody (or an earlier request) holds it
  timeout,           // no answer within the deadline the caller gave
  no_ack,            // the addressed device did not acknowledge; the bus itself works
  disconnected,      // the peer closed, or the cable is out
  io,                // the bus or the operating system failed
  protocol,          // bytes arrived that the protocol does not allow
  refused,           // the device understood and said no
  authentication,    // the device wants other credentials
  unsupported,       // not built in, or the device cannot do it
};

[[nodiscard]] std::string_view to_string(ErrorCode code);

// What went wrong, where, and what to do. `code` is for programs; the rest is for the person reading the
// line.
struct Error {
  ErrorCode code = ErrorCode::io;
  std::string device;     // "AdvanReader at 192.168.1.50:3161", "scene scenes/4A.toml"
  std::string operation;  // "PUT antennas", "read [reader] power_dbm"
  std::string detail;     // the cause: "answered PARAMETER_ERROR", "40 is above 31.5"
  std::string mend;       // what to do about it; may be empty
  int sys_errno = 0;      // errno of the system call that failed; 0 if none
};

// One line: "<device>: <operation>: <detail> [errno text]. <mend>".
[[nodiscard]] std::string describe(const Error& error);

template <class T = void>
using Result = tl::expected<T, Error>;

using Failure = tl::unexpected<Error>;

[[nodiscard]] inline Failure fail(ErrorCode code, std::string device, std::string operation,
                                  std::string detail, std::string mend = {}, int sys_errno = 0) {
  return Failure(
      Error{code, std::move(device), std::move(operation), std::move(detail), std::move(mend), sys_errno});
}

[[nodiscard]] inline Failure fail(Error error) { return Failure(std::move(error)); }

}  // namespace forager::hal

// Leaves the enclosing function with the error of `expression`, or goes on. For Result<void>-like
// expressions.
#define FORAGER_TRY(expression)                                           \
  do {                                                                    \
    if (auto forager_try_result = (expression); !forager_try_result)      \
      return ::forager::hal::fail(std::move(forager_try_result).error()); \
  } while (false)
