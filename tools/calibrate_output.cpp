#include "tools/calibrate_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace forager::tools {
namespace {

using boards::Calibration;
using boards::CalibrationResidual;
using boards::FittedParameter;
using Json = nlohmann::ordered_json;

}  // namespace

std::string interval_text(const FittedParameter& p) {
  if (p.held) return "held";
  return fmt::format("{} - {}", p.open_low ? std::string() : fmt::format("{:.3f}", p.low),
                     p.open_high ? std::string() : fmt::format("{:.3f}", p.high));
}

std::string calibration_table(const Calibration& result) {
  std::string out = fmt::format("{:<14}{:>10} {:<4}{:>20}\n", "parameter", "value", "", "95 % interval");
  for (const FittedParameter& p : result.parameters)
    out += fmt::format("{:<14}{:>10.3f} {:<4}{:>20}\n", p.name, p.value, p.unit, interval_text(p));
  out += fmt::format("\n{:>17} {:>9} {:>8} {:>9} {:>9}\n", "range, m", "slices", "heard", "expected",
                     "residual");
  for (const CalibrationResidual& r : result.residuals)
    out += fmt::format("{:>7.2f} - {:>7.2f} {:>9.0f} {:>8.0f} {:>9.1f} {:>+9.2f}\n", r.from_m, r.to_m,
                       r.slices, r.seen, r.expected, r.standardised);
  out += fmt::format("\n{} reads of {} tags; log-likelihood {:.2f}", result.reads, result.tags,
                     result.log_likelihood);
  if (result.strangers > 0)
    out += fmt::format("; {} reads of tags of unknown place left out", result.strangers);
  if (!result.misplaced.empty())
    out +=
        fmt::format("\n{} tags are not where the list has them, and were left out:", result.misplaced.size());
  for (const boards::MisplacedTag& tag : result.misplaced)
    out += fmt::format(
        "\n  {}  listed at ({:.2f}, {:.2f}, {:.2f}), heard strongest from ({:.2f}, {:.2f}, {:.2f})", tag.epc,
        tag.listed.x, tag.listed.y, tag.listed.z, tag.heard_from.x, tag.heard_from.y, tag.heard_from.z);
  out += "\nFor the scene:\n[world.radio]\n";
  for (const FittedParameter& p : result.parameters) out += fmt::format("{} = {:.3f}\n", p.name, p.value);
  return out;
}

std::string calibration_json(const Calibration& result) {
  std::string out;
  for (const FittedParameter& p : result.parameters) {
    Json row;
    row["parameter"] = p.name;
    row["value"] = p.value;
    row["low"] = p.open_low || p.held ? Json() : Json(p.low);
    row["high"] = p.open_high || p.held ? Json() : Json(p.high);
    row["unit"] = p.unit;
    row["held"] = p.held;
    out += row.dump() + "\n";
  }
  for (const CalibrationResidual& r : result.residuals)
    out += Json{{"from_m", r.from_m}, {"to_m", r.to_m},         {"slices", r.slices},
                {"heard", r.seen},    {"expected", r.expected}, {"residual", r.standardised}}
               .dump() +
           "\n";
  const auto place = [](hal::Vec3 p) { return Json{p.x, p.y, p.z}; };
  for (const boards::MisplacedTag& tag : result.misplaced)
    out += Json{{"misplaced", tag.epc},
                {"listed", place(tag.listed)},
                {"heard_from", place(tag.heard_from)},
                {"reads", tag.reads}}
               .dump() +
           "\n";
  out += Json{{"reads", result.reads},
              {"tags", result.tags},
              {"strangers", result.strangers},
              {"misplaced", result.misplaced.size()},
              {"log_likelihood", result.log_likelihood},
              {"evaluations", result.evaluations}}
             .dump() +
         "\n";
  return out;
}

}  // namespace forager::tools
