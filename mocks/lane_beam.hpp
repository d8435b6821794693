#pragma once

#include "mocks/detection_lanes.hpp"

namespace forager::mocks {

// The pattern of an antenna for the loops of mocks/detection_lanes.hpp, in double or float: form, series and
// nulls. Widths in radians; outside 0..pi an antenna that radiates nothing. What the series leave out is
// left_out_of_amplitude() below; formula, reach and cut are the caller's.
template <class T>
[[nodiscard]] LaneBeam<T> make_lane_beam(bool cosine, double width_h_rad, double width_v_rad);

extern template LaneBeam<double> make_lane_beam<double>(bool, double, double);
extern template LaneBeam<float> make_lane_beam<float>(bool, double, double);

// Amplitude on boresight as the series of a cosine beam give it; 1 for all others.
[[nodiscard]] double left_out_of_amplitude(bool cosine, double width_h_rad, double width_v_rad);

}  // namespace forager::mocks
