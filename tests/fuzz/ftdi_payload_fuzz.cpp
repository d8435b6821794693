// Transfers of an FTDI chip, any bytes: the payload never grows, nothing outside the transfer is touched, and
// every error of line status is counted. First input byte: size of a packet.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "hal/ftdi.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t packet = 8 + std::size_t{data[0]} * 2;
  std::vector<std::byte> transfer(size - 1);
  std::transform(data + 1, data + size, transfer.begin(),
                 [](std::uint8_t value) { return std::byte{value}; });
  forager::hal::FtdiLineErrors errors;
  const std::size_t kept = forager::hal::ftdi_payload(transfer, packet, errors);
  const std::size_t packets = (transfer.size() + packet - 1) / packet;
  if (kept + 2 * (transfer.size() / packet) > transfer.size()) std::abort();
  if (errors.overruns > packets || errors.breaks + errors.framing + errors.parity > packets) std::abort();
  return 0;
}
