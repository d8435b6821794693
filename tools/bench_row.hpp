#pragma once

#include <optional>
#include <span>
#include <string>

namespace forager::tools {

// One measured figure beside what it is held against.
struct BenchRow {
  std::string name;  // "AdvanNet event decode"
  double ours = 0.0;
  std::string unit;  // of both values: "events/s"
  std::string peer;  // what the other value is; empty: nothing to compare with
  std::optional<double> peer_value = {};

  // ours / peer_value; nullopt without a peer.
  [[nodiscard]] std::optional<double> ratio() const;
};

// One JSON object on one line (no line break): name, ours, unit, peer, peer_value, ratio; the last three null
// without a peer.
[[nodiscard]] std::string bench_json(const BenchRow& row);

// All rows for a person, with prefixes to the units and, for rates, the time one of them takes.
[[nodiscard]] std::string bench_table(std::span<const BenchRow> rows);

}  // namespace forager::tools
