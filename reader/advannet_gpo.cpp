#include "reader/advannet_gpo.hpp"

#include <fmt/format.h>

#include <utility>

namespace forager::reader {

AdvanNetGpo::AdvanNetGpo(std::uint8_t line) : line_(line), name_(fmt::format("reader GPO{}", line)) {}

void AdvanNetGpo::reject(bool active, hal::Error error) {
  told_ = active;
  error_ = std::move(error);
}

hal::Result<> AdvanNetGpo::do_set(bool active) {
  wanted_ = active;
  if (!error_) return {};
  told_.reset();  // after a refusal nobody knows how the line stands
  return hal::fail(*std::exchange(error_, std::nullopt));
}

}  // namespace forager::reader
