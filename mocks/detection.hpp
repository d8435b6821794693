#pragma once

namespace forager::mocks {

// Probability that a reader hears a passive tag, from its distance and the antenna pattern.
//
// PD = 2 / (1 + 3^u), u = R / (R0 D0^e): half of the tags at boresight distance R0 answer within a reference
// time T0 of continuous listening. e = 1/2 follows from the forward link (power falls with R^2); e = 1 is
// what the laboratory's published plugin computed.
inline constexpr double kPaperPatternExponent = 0.5;
inline constexpr double kPluginPatternExponent = 1.0;

// u for a range (m), R0 (m) and pattern power D0 (0..1). Infinite where nothing can be heard: D0 or R0 not
// above 0, or an argument that is not a number. Never NaN.
[[nodiscard]] double normalised_range(double range_m, double r0_m, double pattern_power,
                                      double pattern_exponent = kPaperPatternExponent);

// PD for u >= 0 within T0, as 2 e^-t / (1 + e^-t) with t = u ln 3: no overflow, no cancellation in the tail.
// Relative error below (4 + t) 2^-52. 0 for u that is negative, infinite or not a number.
[[nodiscard]] double detection_probability(double u);

// The same to within 1.5 ulp, whatever the size of u: in the tail it is the rounding of u ln 3 that costs
// digits, 150 ulp at a PD of 1e-47, and here that rounding is carried along (Dekker's product by fma) and put
// right to first order. From x = u^2, the form in which range and pattern come without a root, what the root
// loses is carried, too; within 2.2 ulp for 1e-8 <= x <= 1e4. 0 for arguments that are negative, infinite or
// not a number.
[[nodiscard]] double detection_probability_compensated_u(double u);
[[nodiscard]] double detection_probability_compensated(double u_squared);

// Expected answers within T0, -ln(1 - PD) = -ln tanh(t/2) with t = u ln 3, exact in both tails: it grows as
// -ln(t/2) for u -> 0 (infinite at 0) and falls as 2 e^-t. Divide by T0 for the hazard rate in 1/s. Relative
// error below (6 + t) 2^-52. 0 for u that is negative, infinite or not a number.
[[nodiscard]] double expected_answers(double u);

// Probability of at least one answer in a dwell of dwell_s seconds at a hazard rate in 1/s: -expm1(-rate dt),
// so that ten dwells of 0.1 s find what one of 1 s finds. 0 for arguments that are not above 0.
[[nodiscard]] double answer_probability(double hazard_per_s, double dwell_s);

}  // namespace forager::mocks
