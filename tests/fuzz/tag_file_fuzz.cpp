// Any bytes given as a tag file end in tags or in one error line that names a place, never in a crash; tags
// that were accepted lie at finite places and have whole EPCs.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mocks/tag_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  forager::mocks::TagList tags;
  const auto parsed = forager::mocks::parse_tags(text, "fuzz.csv", tags);
  if (!parsed && parsed.error().operation.find("line ") == std::string::npos) std::abort();
  for (std::size_t i = 0; i < tags.size(); ++i)
    if (!is_finite(tags.position(i)) || tags.epc_hex(i).size() % 4 != 0) std::abort();
  return 0;
}
