// A keyboard that sends any reports: what comes out are EPCs, and every one is counted. First input byte:
// digits of an EPC; then for each report its size and its bytes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "reader/wedge_text.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  forager::reader::WedgeText wedge(data[0]);
  std::span<const std::byte> rest(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
  std::vector<forager::reader::Epc> epcs;
  std::uint64_t reports = 0;
  while (!rest.empty()) {
    const std::size_t count =
        std::min<std::size_t>(std::to_integer<std::size_t>(rest[0]) % 16, rest.size() - 1);
    wedge.feed(rest.subspan(1, count), epcs);
    rest = rest.subspan(1 + count);
    ++reports;
  }
  wedge.pause(epcs);
  require(!wedge.in_word());
  require(wedge.counters().reports == reports);
  require(wedge.counters().epcs == epcs.size());
  for (const auto& epc : epcs) {
    require(epc.bytes().size() >= 2 && epc.bytes().size() % 2 == 0);
    require(data[0] == 0 || epc.bytes().size() * 2 == data[0]);
  }
  return 0;
}
