#include "reader/read_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>

#include "hal/units.hpp"

namespace forager::reader {
namespace {

constexpr std::size_t kMaxNameLength = 32;
constexpr std::array<int, 12> kOffTimesMs{0, 10, 20, 30, 40, 50, 75, 100, 125, 150, 175, 200};

hal::Failure wrong(std::string field, std::string detail, std::string mend) {
  return hal::fail(hal::ErrorCode::invalid_argument, {}, std::move(field), std::move(detail),
                   std::move(mend));
}

hal::Result<> check_power(const std::string& where, double dbm) {
  const std::string field = fmt::format("{} = {}", where, dbm);
  const std::string mend = "Set 0 to 31.5 dBm in steps of 0.5";
  if (std::isnan(dbm)) return wrong(field, "is not a number", mend);
  if (dbm > 31.5) return wrong(field, "above 31.5 dBm, the most the reader transmits", mend);
  if (dbm < 0.0) return wrong(field, "below 0 dBm, the least the reader transmits", mend);
  if (std::round(dbm * 2.0) != dbm * 2.0) return wrong(field, "not a step of 0.5 dBm", mend);
  return {};
}

hal::Result<> check_sensitivity(const std::string& where, double dbm) {
  const std::string field = fmt::format("{} = {}", where, dbm);
  const std::string mend = "Set -90 to -20 dBm";
  if (std::isnan(dbm)) return wrong(field, "is not a number", mend);
  if (dbm > -20.0) return wrong(field, "above -20 dBm: hardly any tag would be kept", mend);
  if (dbm < -90.0) return wrong(field, "below -90 dBm, under the receiver's noise", mend);
  return {};
}

hal::Result<> check_times(const ReadPlan& plan) {
  const auto on_ms = std::chrono::duration<double, std::milli>(plan.on_time).count();
  const auto off_ms = std::chrono::duration<double, std::milli>(plan.off_time).count();
  if (on_ms < 50.0 || on_ms > 3000.0 || std::floor(on_ms) != on_ms)
    return wrong(fmt::format("[reader] on_time_ms = {}", on_ms),
                 "not a whole number of milliseconds from 50 to 3000",
                 "Set 50 to 3000; the reader's own choice is 600");
  if (std::ranges::find(kOffTimesMs, off_ms) == kOffTimesMs.end())
    return wrong(fmt::format("[reader] off_time_ms = {}", off_ms), "not an off time the reader knows",
                 fmt::format("Set one of {}", fmt::join(kOffTimesMs, ", ")));
  return {};
}

// The name travels inside a comma-separated field of an XML document; plain words survive both.
bool plain_name(std::string_view name) {
  return name.size() <= kMaxNameLength && std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == ' ' ||
                  c == '_' || c == '-' || c == '.';
         });
}

hal::Result<> check_port(const ReadPort& port) {
  const std::string where = fmt::format("[reader] ports[{}]", port.port);
  if (port.port < 1 || port.port > 32)
    return wrong(fmt::format("[reader] ports: port = {}", port.port), "not a port number",
                 "Ports count from 1 to 32, as printed on the reader");
  if (!plain_name(port.name))
    return wrong(where + " name",
                 "holds something else than letters, digits, space, '_', '-' and '.', "
                 "or more than 32 of them",
                 "Choose a plain name such as \"front\"");
  if (!std::isfinite(port.bearing_rad))
    return wrong(fmt::format("{} bearing_rad = {}", where, port.bearing_rad), "is not a finite angle",
                 "Set the direction the antenna looks to, positive to the left");
  if (port.power_dbm) FORAGER_TRY(check_power(where + " power_dbm", *port.power_dbm));
  if (port.sensitivity_dbm) FORAGER_TRY(check_sensitivity(where + " sensitivity_dbm", *port.sensitivity_dbm));
  return {};
}

std::string or_plan(const std::optional<double>& own) {
  return own ? fmt::format("{} dBm", *own) : std::string("as plan");
}

}  // namespace

hal::Result<> validate(const ReadPlan& plan) {
  if (plan.session > Session::s3) return wrong("[reader] session", "is none of S0, S1, S2, S3", "Set one");
  if (plan.target > Target::ba) return wrong("[reader] target", "is none of A, B, AB, BA", "Set one");
  if (plan.q && (*plan.q < 1 || *plan.q > 15))
    return wrong(fmt::format("[reader] q = {}", *plan.q), "outside 1 to 15",
                 "Set 1 to 15, or leave it out for the reader's dynamic Q");
  FORAGER_TRY(check_power("[reader] power_dbm", plan.power_dbm));
  FORAGER_TRY(check_sensitivity("[reader] sensitivity_dbm", plan.sensitivity_dbm));
  FORAGER_TRY(check_times(plan));
  if (plan.ports.empty())
    return wrong("[reader] ports", "names no port",
                 "Name every port that has an antenna: the reader does not find them by itself");
  std::bitset<33> used;
  for (const ReadPort& port : plan.ports) {
    FORAGER_TRY(check_port(port));
    if (used.test(port.port))
      return wrong(fmt::format("[reader] ports: port = {}", port.port), "is named twice",
                   "Name each port once");
    used.set(port.port);
  }
  return {};
}

std::string to_string(const ReadPlan& plan) {
  std::string text = fmt::format(
      "session      {}\ntarget       {}\nQ            {}\npower        {} dBm\nsensitivity  {} dBm\n"
      "RF on        {} ms\nRF off       {} ms\n",
      to_string(plan.session), to_string(plan.target), plan.q ? fmt::format("{}", *plan.q) : "dynamic",
      plan.power_dbm, plan.sensitivity_dbm, plan.on_time / std::chrono::milliseconds(1),
      plan.off_time / std::chrono::milliseconds(1));
  for (const ReadPort& port : plan.ports)
    text += fmt::format("port {:<8}{}, bearing {:.0f} deg, power {}, sensitivity {}\n", port.port,
                        port.name.empty() ? "(no name)" : port.name, hal::rad_to_deg(port.bearing_rad),
                        or_plan(port.power_dbm), or_plan(port.sensitivity_dbm));
  return text;
}

std::string_view to_string(Session session) {
  switch (session) {
    case Session::s0:
      return "S0";
    case Session::s1:
      return "S1";
    case Session::s2:
      return "S2";
    case Session::s3:
      return "S3";
  }
  return "?";
}

std::string_view to_string(Target target) {
  switch (target) {
    case Target::a:
      return "A";
    case Target::b:
      return "B";
    case Target::ab:
      return "AB";
    case Target::ba:
      return "BA";
  }
  return "?";
}

hal::Result<Session> session_from(std::string_view text) {
  for (const Session session : {Session::s0, Session::s1, Session::s2, Session::s3})
    if (text == to_string(session)) return session;
  return wrong(fmt::format("[reader] session = \"{}\"", text), "is none of S0, S1, S2, S3",
               "Set one of them");
}

hal::Result<Target> target_from(std::string_view text) {
  for (const Target target : {Target::a, Target::b, Target::ab, Target::ba})
    if (text == to_string(target)) return target;
  return wrong(fmt::format("[reader] target = \"{}\"", text), "is none of A, B, AB, BA", "Set one of them");
}

}  // namespace forager::reader
