#include "mocks/gen2_beam_bound.hpp"

namespace forager::mocks {

BeamBound::BeamBound(const AntennaPattern& pattern) : any_(pattern.beam().has_value()) {
  // Cosines have rounding of their own: the edges are taken a little nearer to the middle.
  constexpr double kAbove = 1e-12;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double cosine = std::min(static_cast<double>(i + 1) / static_cast<double>(kSteps) + kAbove, 1.0);
    const double sine = std::sqrt(1.0 - cosine * cosine);
    azimuth_[i] = pattern.power({cosine, sine, 0.0}) + kAbove;
    elevation_[i] = pattern.power({cosine, 0.0, sine}) + kAbove;
  }
}

}  // namespace forager::mocks
