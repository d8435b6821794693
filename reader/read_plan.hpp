#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::reader {

enum class Session : std::uint8_t { s0, s1, s2, s3 };  // Gen2 inventory session
enum class Target : std::uint8_t { a, b, ab, ba };     // which inventoried flag answers

// A port of the reader and where its antenna looks. Bearing is configuration, never an assumption: the
// laboratory's robot has port 4 = front, 2 = right, 1 = back, 3 = left.
struct ReadPort {
  std::uint8_t port = 0;     // 1-based
  std::string name;          // "front"; becomes the location id in the reader
  double bearing_rad = 0.0;  // direction of maximum radiation in the body frame, REP-103 (left positive)
  std::optional<double> power_dbm;        // empty: the plan's
  std::optional<double> sensitivity_dbm;  // empty: the plan's
  bool operator==(const ReadPort&) const = default;
};

// Everything that decides what the reader does on the air: explicit, validated, printable. There are no
// hidden defaults in the reader: the driver writes every field before it starts.
struct ReadPlan {
  Session session = Session::s0;
  Target target = Target::a;
  std::optional<int> q;            // fixed Q 1..15; empty: dynamic
  double power_dbm = 30.0;         // 0..31.5 in steps of 0.5
  double sensitivity_dbm = -80.0;  // -90..-20; reads weaker than this are dropped by the reader
  hal::Duration on_time{};         // RF on, 50..3000 ms (AUTONOMOUS onTime)
  hal::Duration off_time{};        // RF off: 0,10,20,30,40,50,75,100,125,150,175,200 ms
  std::vector<ReadPort> ports;     // 1..32, distinct port numbers 1..32
  bool operator==(const ReadPlan&) const = default;
};

// Errors: invalid_argument naming the field, its value, what is allowed.
[[nodiscard]] hal::Result<> validate(const ReadPlan& plan);

// What a person wants to see before take-off: one field per line.
[[nodiscard]] std::string to_string(const ReadPlan& plan);
[[nodiscard]] std::string_view to_string(Session session);  // "S0"
[[nodiscard]] std::string_view to_string(Target target);    // "A"
[[nodiscard]] hal::Result<Session> session_from(std::string_view text);
[[nodiscard]] hal::Result<Target> target_from(std::string_view text);

}  // namespace forager::reader
