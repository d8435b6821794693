// Anything a client may send to the emulated reader's REST port: the first byte says how the rest is cut into
// pieces. The server must stay within its limits and answer only well-formed responses.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mocks/fake_tag_field.hpp"
#include "mocks/http_server_digest.hpp"
#include "mocks/http_server_session.hpp"
#include "mocks/sim_reader.hpp"

namespace {

using namespace forager;

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  mocks::FakeTagField field;
  hal::NullJournal journal;
  mocks::SimReader reader({}, field, journal);
  mocks::HttpServerDigest digest("AdvanNet", "admin", "admin", 1);
  const mocks::HttpServerLimits limits{.header_bytes = 1024, .body_bytes = 4096};
  const bool with_digest = (data[0] & 0x80) != 0;
  mocks::HttpServerSession session(reader, with_digest ? &digest : nullptr, limits);
  const std::size_t piece = 1 + (data[0] & 0x7F);
  auto rest = std::as_bytes(std::span(data, size)).subspan(1);
  hal::Instant now;
  while (!rest.empty() && session.room() > 0) {
    const auto count = std::min({rest.size(), piece, session.room()});
    session.take_in(rest.first(count), now);
    rest = rest.subspan(count);
    const std::string_view output = session.output();
    require(output.empty() || output.starts_with("HTTP/1.1 "));
    session.sent(output.size());
    now += std::chrono::milliseconds(1);
    reader.update(now);
  }
  session.update(now);
  return 0;
}
