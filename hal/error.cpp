#include "hal/error.hpp"

#include <fmt/format.h>

#include <cstring>

namespace forager::hal {

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_argument:
      return "invalid argument";
    case ErrorCode::invalid_state:
      return "invalid state";
    case ErrorCode::not_present:
      return "not present";
    case ErrorCode::permission:
      return "no permission";
    case ErrorCode::busy:
      return "busy";
    case ErrorCode::timeout:
      return "timed out";
    case ErrorCode::no_ack:
      return "not acknowledged";
    case ErrorCode::disconnected:
      return "disconnected";
    case ErrorCode::io:
      return "input/output failure";
    case ErrorCode::protocol:
      return "protocol violation";
    case ErrorCode::refused:
      return "refused";
    case ErrorCode::authentication:
      return "authentication failed";
    case ErrorCode::unsupported:
      return "unsupported";
  }
  return "unknown error";
}

std::string describe(const Error& error) {
  std::string line;
  for (const std::string* part : {&error.device, &error.operation}) {
    if (!part->empty()) line += *part + ": ";
  }
  line += error.detail.empty() ? std::string(to_string(error.code)) : error.detail;
  if (error.sys_errno != 0) line += fmt::format(" [{}]", std::strerror(error.sys_errno));
  if (!error.mend.empty()) line += ". " + error.mend;
  return line;
}

}  // namespace forager::hal
