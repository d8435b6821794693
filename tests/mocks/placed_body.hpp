#pragma once

#include "mocks/body.hpp"

namespace forager::mocks {

// A body that is where a test puts it.
struct PlacedBody final : TrueBody {
  BodyState body;
  [[nodiscard]] const BodyState& state() const override { return body; }
};

}  // namespace forager::mocks
