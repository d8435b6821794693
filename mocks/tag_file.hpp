#pragma once

#include <string>
#include <string_view>

#include "hal/error.hpp"
#include "mocks/tag_list.hpp"

namespace forager::mocks {

// Tags as a table of text (CSV), strictly:
//   epc,x,y,z[,wanted]                       the first line, to the letter
//   3034257bf7194e4000001a85,1.5,-1.75,0.8,1
// epc: 4 to 124 hexadecimal digits of either case, whole 16-bit words; kept in lower case; each once in the
// world. x, y, z: metres in the world frame, decimal or with exponent, within 1e9. wanted: 1 or 0, by default
// 1. Lines end in \n or \r\n; the last one may do without. No quotes, blanks, comments or empty lines.
//
// Errors: invalid_argument naming file, line and column (from 1) and what is wrong there; not_present and
// permission as the operating system says; io.
[[nodiscard]] hal::Result<> read_tag_file(const std::string& path, TagList& tags);
// The same from text; `name` stands in the errors.
[[nodiscard]] hal::Result<> parse_tags(std::string_view text, const std::string& name, TagList& tags);

// Writes them in this form; positions with as many digits as they need to be read back to the bit. Errors:
// io, permission, not_present.
[[nodiscard]] hal::Result<> write_tag_file(const std::string& path, const TagList& tags);

}  // namespace forager::mocks
