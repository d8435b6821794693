#include "reader/silence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace forager::reader {
namespace {

constexpr double kLowReach = 0.5;           // of 30 dBm's: worth a remark
constexpr double kHighSensitivity = -60.0;  // dBm; tags at the edge of reach answer well below

std::optional<std::string> link_silence(const LinkStatus& link) {
  switch (link.phase) {
    case LinkPhase::closed:
      return fmt::format("not started{}{}", link.reason.empty() ? "" : ": ", link.reason);
    case LinkPhase::opening:
      return "not started yet: the reader is being found and set up";
    case LinkPhase::lost:
      return fmt::format("the link is down: {}", link.reason);
    case LinkPhase::failed:
      return fmt::format("the link has failed: {}", link.reason);
    case LinkPhase::open:
      break;
  }
  if (!link.speaks)
    return "the event stream is connected and has said nothing yet; a reader that lives sends something "
           "every 5 s";
  return std::nullopt;
}

// A tag that was read answers no more until its flag falls back, unless the other flag is asked for, too.
bool silences(const ReadPlan& plan) {
  return plan.session != Session::s0 && (plan.target == Target::a || plan.target == Target::b);
}

double strongest_power(const ReadPlan& plan) {
  double power = 0.0;
  for (const ReadPort& port : plan.ports) power = std::max(power, port.power_dbm.value_or(plan.power_dbm));
  return power;
}

std::string_view flag_time(Session session) {
  return session == Session::s1 ? "for 0.5 to 5 s" : "for as long as they have power, and 2 s more";
}

}  // namespace

double relative_reach(double power_dbm) { return std::pow(10.0, (power_dbm - 30.0) / 20.0); }

std::string why_silent(const SilenceFacts& facts) {
  if (auto reason = link_silence(facts.link)) return *std::move(reason);
  if (facts.reads_dropped > 0 && facts.tags_before == 0)
    return fmt::format(
        "{} reads came and are older than the start by the reader's own clock: set the reader's clock",
        facts.reads_dropped);
  if (facts.bad_items > 0 && facts.tags_before == 0)
    return fmt::format("{} items came without EPC or time: set the reader's encoder to XML_V2_3",
                       facts.bad_items);
  if (!facts.reader_says.empty()) return fmt::format("the reader says {}", facts.reader_says);
  const ReadPlan& plan = facts.plan;
  if (silences(plan) && facts.tags_before > 0)
    return fmt::format(
        "session {} keeps tags silent {} once they were read; session S0 or target AB reads them again",
        to_string(plan.session), flag_time(plan.session));
  const double power_dbm = strongest_power(plan);
  if (relative_reach(power_dbm) <= kLowReach)
    return fmt::format("power may be too low: {:g} dBm reaches {:.0f} % as far as 30 dBm", power_dbm,
                       100.0 * relative_reach(power_dbm));
  if (plan.sensitivity_dbm > kHighSensitivity)
    return fmt::format(
        "the reader drops replies weaker than {:g} dBm; tags farther away than a metre or two come in "
        "below that",
        plan.sensitivity_dbm);
  if (facts.tags_before > 0) return "no tag is in reach any more, or an antenna cable has come loose";
  return fmt::format(
      "the radio is on and nothing answers: no tag in reach, or no antenna at port {}; the reader "
      "cannot check that{}",
      fmt::join(
          [&plan] {
            std::vector<int> ports;
            for (const ReadPort& port : plan.ports) ports.push_back(port.port);
            return ports;
          }(),
          ", "),
      silences(plan) && plan.session != Session::s1
          ? fmt::format("; tags read shortly before this start may be silent, too (session {})",
                        to_string(plan.session))
          : std::string());
}

}  // namespace forager::reader
