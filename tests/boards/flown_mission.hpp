#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "boards/run_summary.hpp"
#include "boards/scene.hpp"
#include "flight/mission_status.hpp"

namespace forager::boards {

// Seeds 1..kSeeds are flown where a test speaks about the median of a scene; fewer in builds that are many
// times slower (tests/CMakeLists.txt).
inline constexpr std::uint64_t kSeeds = FORAGER_MISSION_SEEDS;

struct FlyOptions {
  std::uint64_t seed = 1;
  std::string journal = {};  // file; empty: none, only the digest
  bool wire = false;         // bytes of both links into the journal too
};

// The digest of everything journalled up to a moment.
struct JournalMark {
  double at_s = 0.0;
  std::uint64_t digest = 0;
};

// A mission from take-off to landing on the emulated board, as fast as it goes.
struct FlownMission {
  RunSummary summary;
  std::vector<flight::Decision> decisions;
  std::vector<flight::FlownPath::Point> path;
  std::vector<JournalMark> journal;  // every ten seconds, and at the end

  [[nodiscard]] double coverage() const;  // share of the wanted tags that were read
  [[nodiscard]] std::uint64_t digest() const { return journal.empty() ? 0 : journal.back().digest; }
};

// Flies it to its end; a mission that has not ended after two hours of its own time is a test failure.
[[nodiscard]] FlownMission fly(const Scene& scene, const FlyOptions& options = {});

// scenes/<name>.toml, or a test failure.
[[nodiscard]] Scene published_scene(const std::string& name);
// tests/data/mission/<name>.toml, or a test failure.
[[nodiscard]] Scene test_scene(const std::string& name);

// One mission per seed.
[[nodiscard]] std::vector<FlownMission> fly_seeds(const Scene& scene);

[[nodiscard]] double median(std::vector<double> values);
[[nodiscard]] double median_coverage(const std::vector<FlownMission>& missions);

}  // namespace forager::boards
