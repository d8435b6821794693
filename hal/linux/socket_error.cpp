#include "hal/linux/socket_error.hpp"

#include <cerrno>

namespace forager::hal {

namespace {

std::string_view detail_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::refused:
      return "nobody listens there";
    case ErrorCode::timeout:
      return "the network gave no answer";
    case ErrorCode::disconnected:
      return "the connection is gone";
    case ErrorCode::permission:
      return "the operating system forbids it";
    case ErrorCode::busy:
      return "another program has this port";
    case ErrorCode::not_present:
      return "this machine has no such address";
    default:
      return "the socket failed";
  }
}

std::string_view mend_of(ErrorCode code, int error) {
  switch (code) {
    case ErrorCode::refused:
      return "Check that the device or emulator is running and that the port is right";
    case ErrorCode::timeout:
      return "Check power, cable and address of the device";
    case ErrorCode::disconnected:
      return error == ENETUNREACH || error == EHOSTUNREACH || error == ENETDOWN
                 ? "Check the cable and that this machine has an address in the device's network"
                 : "";
    case ErrorCode::permission:
      return "Use a port above 1023, and check the firewall";
    case ErrorCode::busy:
      return "Stop the other program or choose another port";
    case ErrorCode::not_present:
      return "Use an address of this machine, or 0.0.0.0 for all of them";
    default:
      return error == EMFILE || error == ENFILE ? "Raise the limit of open files (ulimit -n)" : "";
  }
}

}  // namespace

ErrorCode code_of_socket_errno(int error) {
  switch (error) {
    case ECONNREFUSED:
      return ErrorCode::refused;
    case ETIMEDOUT:
      return ErrorCode::timeout;
    case ECONNRESET:
    case ECONNABORTED:
    case EPIPE:
    case ENOTCONN:
    case ENETUNREACH:
    case EHOSTUNREACH:
    case ENETDOWN:
    case ENETRESET:
    case EHOSTDOWN:
      return ErrorCode::disconnected;
    case EACCES:
    case EPERM:
      return ErrorCode::permission;
    case EADDRINUSE:
      return ErrorCode::busy;
    case EADDRNOTAVAIL:
      return ErrorCode::not_present;
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return ErrorCode::unsupported;
    case EMSGSIZE:
    case EINVAL:
      return ErrorCode::invalid_argument;
    default:
      return ErrorCode::io;
  }
}

Failure socket_failure(std::string_view device, std::string_view operation, int error) {
  const ErrorCode code = code_of_socket_errno(error);
  return fail(code, std::string(device), std::string(operation), std::string(detail_of(code)),
              std::string(mend_of(code, error)), error);
}

}  // namespace forager::hal
