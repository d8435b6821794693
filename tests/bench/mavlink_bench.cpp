// The MAVLink codec, one message at a time; the peer is the generated C library at -O2 on the same kind of
// machine: encode ATTITUDE 104 ns and ODOMETRY 544 ns, parse 215 ns and 1246 ns.
#include <benchmark/benchmark.h>

#include <vector>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/parser.hpp"
#include "hal/random.hpp"

namespace forager::flight::mavlink {
namespace {

template <Message M>
M filled() {
  hal::Random random(11);
  std::array<std::byte, kMaxPayload> payload{};
  for (auto& byte : payload) byte = std::byte(random.below(255) + 1);
  Frame frame;
  frame.payload = payload;
  return decode<M>(frame);
}

template <Message M>
void encode_message(benchmark::State& state) {
  const M message = filled<M>();
  Sender sender;
  FrameBuffer buffer;
  for (auto _ : state) {
    benchmark::DoNotOptimize(encode(message, sender, buffer).data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(buffer.size()));
}
BENCHMARK(encode_message<Heartbeat>);
BENCHMARK(encode_message<Attitude>);
BENCHMARK(encode_message<VisionPositionEstimate>);
BENCHMARK(encode_message<ObstacleDistance>);
BENCHMARK(encode_message<Odometry>);

template <Message M>
void append(std::vector<std::byte>& stream, Sender& sender) {
  FrameBuffer buffer;
  const auto frame = encode(filled<M>(), sender, buffer);
  stream.insert(stream.end(), frame.begin(), frame.end());
}

template <Message M>
void take(const Frame& frame) {
  if (frame.id == M::kId) benchmark::DoNotOptimize(decode<M>(frame));
}

// Frames in 1024-byte reads, each decoded into its message.
template <Message... Ms>
void parse_stream(benchmark::State& state) {
  std::vector<std::byte> stream;
  Sender sender;
  constexpr int kRounds = 64;
  for (int i = 0; i < kRounds; ++i) (append<Ms>(stream, sender), ...);
  Parser parser;
  for (auto _ : state) {
    std::span<const std::byte> rest = stream;
    while (!rest.empty()) {
      const std::size_t count = std::min<std::size_t>(rest.size(), 1024);
      parser.feed(rest.first(count), [](const Frame& frame) { (take<Ms>(frame), ...); });
      rest = rest.subspan(count);
    }
  }
  if (parser.stats().frames != static_cast<std::uint64_t>(state.iterations()) * kRounds * sizeof...(Ms))
    state.SkipWithError("frames were lost");
  state.SetItemsProcessed(state.iterations() * kRounds * static_cast<std::int64_t>(sizeof...(Ms)));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(stream.size()));
}
BENCHMARK(parse_stream<Heartbeat>);
BENCHMARK(parse_stream<Attitude>);
BENCHMARK(parse_stream<ObstacleDistance>);
BENCHMARK(parse_stream<Odometry>);
BENCHMARK(parse_stream<Heartbeat, Attitude, LocalPositionNed, SysStatus, BatteryStatus, Timesync, CommandAck,
                       ExtendedSysState>);

}  // namespace
}  // namespace forager::flight::mavlink

BENCHMARK_MAIN();
