#include "tools/cli_style.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>

namespace forager::tools {
namespace {

hal::Failure write_failure(const std::string& name, const char* operation) {
  const int cause = errno;
  hal::ErrorCode code = hal::ErrorCode::io;
  if (cause == ENOENT || cause == ENOTDIR) code = hal::ErrorCode::not_present;
  if (cause == EACCES || cause == EPERM || cause == EROFS) code = hal::ErrorCode::permission;
  return hal::fail(code, name, operation, std::string(to_string(code)), {}, cause);
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

int exit_code_for(hal::ErrorCode code) {
  switch (code) {
    case hal::ErrorCode::invalid_argument:
      return kExitUsage;
    case hal::ErrorCode::not_present:
    case hal::ErrorCode::permission:
    case hal::ErrorCode::unsupported:
      return kExitUnavailable;
    case hal::ErrorCode::invalid_state:
    case hal::ErrorCode::busy:
    case hal::ErrorCode::timeout:
    case hal::ErrorCode::no_ack:
    case hal::ErrorCode::disconnected:
    case hal::ErrorCode::io:
    case hal::ErrorCode::protocol:
    case hal::ErrorCode::refused:
    case hal::ErrorCode::authentication:
      return kExitFailure;
  }
  return kExitFailure;
}

int complain(const hal::Error& error) {
  fmt::print(stderr, "forager: {}\n", one_line(describe(error)));
  return exit_code_for(error.code);
}

int complain_usage(std::string_view message) {
  fmt::print(stderr, "forager: {}\n", one_line(message));
  return kExitUsage;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  return line;
}

hal::Result<> write_output(const std::string& path, std::string_view text) {
  if (path == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
      return write_failure("stdout", "write");
    return {};
  }
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "wb"));
  if (!file) return write_failure("file " + path, "open for writing");
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size())
    return write_failure("file " + path, "write");
  // A full disk may show only here.
  if (std::fclose(file.release()) != 0) return write_failure("file " + path, "write");
  return {};
}

}  // namespace forager::tools
