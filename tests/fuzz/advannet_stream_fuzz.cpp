// The event stream as any bytes: however they are cut, the bodies, the keep-alives and the garbage are the
// same, every byte is accounted for once, and a frame found has the length its header said.
// First input byte: how to cut; the rest: the stream.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "reader/advannet_stream.hpp"

namespace {

using forager::reader::AdvanNetStream;

void require(bool holds) {
  if (!holds) std::abort();
}

struct Outcome {
  std::string bodies;
  bool failed = false;
  forager::reader::AdvanNetStreamCounters counters;
};

Outcome feed(std::string_view bytes, std::size_t cut) {
  AdvanNetStream stream(1U << 14U);
  Outcome outcome;
  while (!bytes.empty() && !outcome.failed) {
    const auto room = stream.room();
    require(!room.empty());
    const std::size_t size = std::min({cut, room.size(), bytes.size()});
    std::memcpy(room.data(), bytes.data(), size);
    stream.commit(size);
    bytes.remove_prefix(size);
    while (true) {
      const auto body = stream.next();
      outcome.failed = !body;
      if (!body || !*body) break;
      require(!(*body)->empty() && (*body)->size() <= 1U << 14U);
      outcome.bodies.append(**body).push_back('\0');
    }
    cut = cut % 61 + 1;  // uneven pieces
  }
  if (!outcome.failed) {
    stream.reset();
    const auto& c = stream.counters();
    require(c.frame_bytes + c.blank_bytes + c.garbage_bytes == c.bytes);
  }
  outcome.counters = stream.counters();
  return outcome;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const Outcome whole = feed(bytes, SIZE_MAX - 1);
  const Outcome pieces = feed(bytes, std::size_t{data[0]} + 1);
  require(whole.bodies == pieces.bodies);
  require(whole.failed == pieces.failed);
  require(whole.counters.frames == pieces.counters.frames);
  require(whole.counters.keepalives == pieces.counters.keepalives);
  require(whole.counters.garbage_lines == pieces.counters.garbage_lines);
  require(whole.counters.bad_headers == pieces.counters.bad_headers);
  require(whole.counters.blank_bytes == pieces.counters.blank_bytes);
  return 0;
}
