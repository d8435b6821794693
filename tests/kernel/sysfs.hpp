#pragma once

#include <string>
#include <string_view>

// Files of sysfs and configfs, as a shell would use them: what goes wrong ends the test program's case with a
// message.
namespace forager::kernel {

// Writes the text in one call. False, with a failure of the running test, if the kernel refuses.
bool put(const std::string& path, std::string_view text);
// The errno of the same write; 0: it was taken.
[[nodiscard]] int put_error(const std::string& path, std::string_view text);
// The file's text without the last line break; empty, with a failure of the running test, if it cannot be
// read.
[[nodiscard]] std::string get(const std::string& path);

}  // namespace forager::kernel
