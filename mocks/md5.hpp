#pragma once

#include <string>
#include <string_view>

namespace forager::mocks {

// MD5 of the text in 32 lower-case hexadecimal digits (RFC 1321). Only because HTTP Digest authentication,
// as AdvanNet speaks it, is made of it; good for nothing else.
[[nodiscard]] std::string md5_hex(std::string_view text);

}  // namespace forager::mocks
