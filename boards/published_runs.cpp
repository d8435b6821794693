#include "boards/published_runs.hpp"

#include <algorithm>
#include <array>

namespace forager::boards {
namespace {

constexpr auto kNoTime = std::nullopt;

constexpr std::array<PublishedRun, 18> kRuns{{
    {"1A", "1A", 330, 72, kNoTime, false, true, false, "sec. 3.6.1"},
    {"1B", "1B", 330, 168, kNoTime, false, true, false, "sec. 3.6.1"},
    {"1C", "1C", 330, 319, kNoTime, true, true, false, "sec. 3.6.1"},
    {"2A", "2A", 330, 110, kNoTime, false, true, false, "sec. 3.6.2"},
    {"2B", "2B", 330, 161, kNoTime, false, true, false, "sec. 3.6.2"},
    {"2C", "2C", 330, 321, kNoTime, true, true, false, "sec. 3.6.2"},
    {"3A", "3A", 660, 157, kNoTime, false, true, false, "sec. 3.6.3"},
    {"3B", "3B", 660, 408, kNoTime, false, true, false, "sec. 3.6.3"},
    {"3C", "3C", 660, 639, kNoTime, true, true, false, "sec. 3.6.3"},
    {"4A", "4A", 300, 292, 300.0, true, true, false, "sec. 3.6.4"},
    {"4B", "4B", 480, 467, 400.0, true, true, false, "sec. 3.6.4"},
    {"4C", "4C", 960, 933, 700.0, true, true, false, "sec. 3.6.4"},
    {"5A", "5A", 300, 298, kNoTime, true, true, false, "sec. 3.7.1"},
    {"5B", "5B", 1700, 1639, 1300.0, true, true, false, "sec. 3.7.2"},
    {"4.8", "5A", 300, 283, kNoTime, true, false, true, "sec. 4.8"},
    {"ch4-1", "ch4-1", 240, std::nullopt, kNoTime, false, false, false, "sec. 4.6.2"},
    {"ch4-2", "ch4-2", 600, std::nullopt, kNoTime, false, false, false, "sec. 4.6.2"},
    {"ch4-3", "ch4-3", 1200, std::nullopt, kNoTime, false, false, false, "sec. 4.6.2"},
}};

constexpr std::array<PublishedRatio, 3> kRatios{
    {{"1C", "1B", 2.0}, {"2C", "2B", 5.0 / 3.0}, {"3C", "3B", 4.0}}};

}  // namespace

std::span<const PublishedRun> published_runs() { return kRuns; }

const PublishedRun* published_run(std::string_view run) {
  const auto found = std::find_if(kRuns.begin(), kRuns.end(), [run](const auto& r) { return r.run == run; });
  return found == kRuns.end() ? nullptr : &*found;
}

std::span<const PublishedRatio> published_ratios() { return kRatios; }

}  // namespace forager::boards
