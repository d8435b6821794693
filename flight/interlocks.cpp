#include "flight/interlocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace forager::flight {
namespace {

constexpr std::array<std::string_view, kInterlockCount> kNames{
    "emergency_stop", "deadman",  "autopilot_link", "control", "pose",
    "brakes",         "corridor", "motion",         "command", "way_ahead"};

// The table is indexed by its own first column.
constexpr bool in_order() {
  for (std::size_t i = 0; i < kInterlockCount; ++i)
    if (static_cast<std::size_t>(kInterlockTable[i].interlock) != i) return false;
  return true;
}
static_assert(in_order());

}  // namespace

std::string_view to_string(Interlock interlock) { return kNames[static_cast<std::size_t>(interlock)]; }

void Interlocks::say(Interlock interlock, bool holds, std::string_view detail) {
  Row& row = rows_[index(interlock)];
  row.said = holds;
  if (holds) return;
  row.detail_size = std::min(detail.size(), row.detail.size());
  std::copy_n(detail.data(), row.detail_size, row.detail.data());
}

void Interlocks::update(hal::Instant now) {
  may_arm_ = may_thrust_ = true;
  tripped_ = must_disarm_ = false;
  const InterlockRule* first = nullptr;
  first_latched_ = nullptr;
  for (const InterlockRule& rule : kInterlockTable) {
    Row& row = rows_[index(rule.interlock)];
    if (row.said != row.holds) {
      row.holds = row.said;
      if (row.holds) {
        note(rule, row, row.latched ? "holds again, but stays latched" : "holds", now);
      } else if (row.ever) {
        row.latched = rule.latches;
        note(rule, row, rule.latches ? "lost, latched" : "lost", now);
      }
      row.ever = true;
    }
    if (row.good()) continue;
    if (rule.to_arm) may_arm_ = false;
    if (!rule.to_thrust) continue;
    may_thrust_ = false;
    tripped_ = tripped_ || row.latched;
    must_disarm_ = must_disarm_ || (row.latched && rule.disarms);
    if (first == nullptr) first = &rule;
    if (row.latched && first_latched_ == nullptr) first_latched_ = &rule;
  }
  if (first != first_lost_) lost_since_ = now;
  first_lost_ = first;
}

void Interlocks::reset(hal::Instant now) {
  for (const InterlockRule& rule : kInterlockTable) {
    Row& row = rows_[index(rule.interlock)];
    if (!row.latched) continue;
    row.latched = false;
    note(rule, row, "latch reset", now);
  }
}

void Interlocks::note(const InterlockRule& rule, const Row& row, std::string_view what,
                      hal::Instant now) const {
  fmt::basic_memory_buffer<char, 256> line;
  fmt::format_to(std::back_inserter(line), "{} {}", to_string(rule.interlock), what);
  if (!row.holds) {
    fmt::format_to(std::back_inserter(line), ": {}", rule.why);
    if (row.detail_size > 0)
      fmt::format_to(std::back_inserter(line), " ({})", std::string_view(row.detail.data(), row.detail_size));
  }
  journal_->note(now, "interlocks", {line.data(), line.size()});
}

}  // namespace forager::flight
