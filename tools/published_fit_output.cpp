#include "tools/published_fit_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/calibrate_output.hpp"
#include "tools/reproduce_output.hpp"
#include "tools/reproduce_page.hpp"

namespace forager::tools {
namespace {

using boards::FittedParameter;
using boards::PublishedFit;
using Json = nlohmann::ordered_json;

}  // namespace

std::string published_fit_table(const PublishedFit& fit) {
  std::string out = fmt::format("{:<14}{:>10} {:<4}{:>20}\n", "parameter", "value", "", "95 % interval");
  for (const FittedParameter& p : fit.parameters)
    out += fmt::format("{:<14}{:>10.3f} {:<4}{:>20}\n", p.name, p.value, p.unit, interval_text(p));
  out += fmt::format(
      "{} parameter sets tried, from r0_m {:.3f}, spread_db {:.3f}, rician_k_db {:.3f}, which came to {:.2f} "
      "points\n\n",
      fit.evaluations, fit.started.r0_m, fit.started.spread_db, fit.started.rician_k_db,
      fit.started_rms_points);
  return out + reproduction_table(fit.reproduction);
}

std::string published_fit_json(const PublishedFit& fit) {
  std::string out;
  for (const FittedParameter& p : fit.parameters)
    out += Json{{"parameter", p.name},
                {"value", p.value},
                {"low", p.open_low ? Json() : Json(p.low)},
                {"high", p.open_high ? Json() : Json(p.high)},
                {"unit", p.unit}}
               .dump() +
           "\n";
  out += Json{{"start",
               {{"r0_m", fit.started.r0_m},
                {"spread_db", fit.started.spread_db},
                {"rician_k_db", fit.started.rician_k_db},
                {"rms_points", fit.started_rms_points}}},
              {"evaluations", fit.evaluations}}
             .dump() +
         "\n";
  return out + reproduction_json(fit.reproduction);
}

std::string published_fit_page(const PublishedFit& fit) { return reproduction_page(fit.reproduction); }

}  // namespace forager::tools
