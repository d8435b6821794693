#include <array>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "hal/random.hpp"
#include "reader/new_tag_counter.hpp"
#include "tools/bench_duel.hpp"

namespace forager::tools {
namespace {

constexpr std::size_t kTags = 1700;
constexpr std::size_t kReads = 17000;
constexpr std::size_t kWindow = 100;  // reads from one decision to the next

// A mission's reads as they arrive: tags in reach come again and again while new ones come into it.
struct Contest {
  std::vector<reader::ReadPort> ports;
  std::vector<reader::TagRead> reads;
  std::vector<std::string> names;  // the EPC of each read as text, as the reader sends it
  std::vector<double> weights, plain_weights;

  Contest() {
    for (std::uint8_t port = 1; port <= 4; ++port) {
      reader::ReadPort& entry = ports.emplace_back();
      entry.port = port;
      entry.bearing_rad = 1.5 * port;
    }
    hal::Random random(3);
    for (std::size_t i = 0; i < kReads; ++i) {
      const std::size_t reach = i * (kTags - 100) / kReads;
      const std::uint64_t tag = reach + random.below(100);
      std::array<std::uint8_t, 12> bytes{0x30, 0x34, 0x25, 0x7B, 0xF7, 0x19};
      bytes[10] = static_cast<std::uint8_t>(tag >> 8U);
      bytes[11] = static_cast<std::uint8_t>(tag);
      reader::TagRead& read = reads.emplace_back();
      read.epc = reader::Epc::from_bytes(bytes).value_or(reader::Epc{});
      read.port = static_cast<std::uint8_t>(1 + random.below(4));
      read.heard = hal::Instant(std::chrono::milliseconds(20 * i + random.below(500)));
      names.push_back(read.epc.hex());
    }
  }

  void ours() {
    weights.clear();
    reader::NewTagCounter counter(ports, reader::ShareRule::first_heard, kTags);
    for (std::size_t i = 0; i < reads.size(); ++i) {
      counter.add(reads[i]);
      if ((i + 1) % kWindow != 0) continue;
      for (const reader::PortWeight& weight : counter.close_window()) weights.push_back(weight.weight);
    }
    keep(weights.data());
  }

  void other() {
    struct First {
      hal::Instant heard;
      std::uint8_t port;
    };
    plain_weights.clear();
    std::unordered_set<std::string> known;
    std::unordered_map<std::string, First> window;
    for (std::size_t i = 0; i < reads.size(); ++i) {
      const reader::TagRead& read = reads[i];
      if (!known.contains(names[i])) {
        const auto [at, fresh] = window.try_emplace(names[i], First{read.heard, read.port});
        First& first = at->second;
        if (!fresh && (read.heard < first.heard || (read.heard == first.heard && read.port < first.port)))
          first = {read.heard, read.port};
      }
      if ((i + 1) % kWindow != 0) continue;
      std::array<double, 4> counts{};
      for (const auto& [name, first] : window) {
        counts[first.port - 1U] += 1.0;
        known.insert(name);
      }
      window.clear();
      plain_weights.insert(plain_weights.end(), counts.begin(), counts.end());
    }
    keep(plain_weights.data());
  }

  bool agree() {
    ours();
    other();
    return !weights.empty() && weights == plain_weights;
  }
};

}  // namespace

Duel new_tags_duel() {
  const auto contest = std::make_shared<Contest>();
  return {.name = "new-tag counter",
          .unit = "reads/s",
          .peer = "std::unordered_map of strings",
          .items = kReads,
          .ours = [contest] { contest->ours(); },
          .other = [contest] { contest->other(); },
          .agree = [contest] { return contest->agree(); }};
}

}  // namespace forager::tools
