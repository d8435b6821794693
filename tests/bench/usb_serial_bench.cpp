// What a serial port over FTDI costs beside the bus itself: taking the status bytes out of its transfers.
// Compare with the time the bus needs for the same bytes: at most 53 MB/s at high speed, 1.2 MB/s at full
// speed (USB 2.0, section 5.8.4).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/ftdi.hpp"

namespace {

constexpr std::size_t kTransfer = 4096;

std::vector<std::byte> transfer_of(std::size_t packet) {
  std::vector<std::byte> bytes(kTransfer);
  for (std::size_t i = 0; i < kTransfer; ++i)
    bytes[i] = i % packet == 0   ? std::byte{0x31}
               : i % packet == 1 ? std::byte{0x60}
                                 : static_cast<std::byte>(i);
  return bytes;
}

void ftdi_payload(benchmark::State& state) {
  const auto packet = static_cast<std::size_t>(state.range(0));
  const auto fresh = transfer_of(packet);
  auto bytes = fresh;
  forager::hal::FtdiLineErrors errors;
  for (auto _ : state) {
    std::copy(fresh.begin(), fresh.end(), bytes.begin());
    benchmark::DoNotOptimize(forager::hal::ftdi_payload(bytes, packet, errors));
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kTransfer));
}
BENCHMARK(ftdi_payload)->Arg(64)->Arg(512);

void bare_copy(benchmark::State& state) {
  const auto fresh = transfer_of(64);
  auto bytes = fresh;
  for (auto _ : state) {
    std::copy(fresh.begin(), fresh.end(), bytes.begin());
    benchmark::DoNotOptimize(bytes.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kTransfer));
}
BENCHMARK(bare_copy);

}  // namespace
