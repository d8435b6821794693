#include "reader/new_tag_counter.hpp"

#include <algorithm>
#include <bit>

namespace forager::reader {

NewTagCounter::NewTagCounter(std::span<const ReadPort> ports, ShareRule rule, std::size_t expected_tags)
    : rule_(rule), sightings_(expected_tags) {
  index_of_port_.fill(kNotPlanned);
  for (const ReadPort& port : ports.first(std::min(ports.size(), kMaxPorts))) {
    index_of_port_[port.port] = static_cast<std::uint8_t>(weights_.size());
    weights_.push_back({port.port, port.bearing_rad, 0.0});
  }
  if (rule_ == ShareRule::split) shared_by_.resize(weights_.size() * (weights_.size() + 1));
}

void NewTagCounter::add(const TagRead& read) {
  const std::uint8_t index = index_of_port_[read.port];
  if (index == kNotPlanned) {
    ++strangers_;
    return;
  }
  const std::uint32_t bit = std::uint32_t{1} << index;
  const auto [sighting, added] = sightings_.insert(read.epc, Sighting{read.heard, bit, index, false});
  if (added) return;
  // Tags counted for good are kept up to date as well: cheaper than asking, and nothing looks at them again.
  sighting->heard_by |= bit;
  const bool lower_port = read.port < weights_[sighting->first_index].port;
  if (read.heard < sighting->first_heard || (read.heard == sighting->first_heard && lower_port)) {
    sighting->first_heard = read.heard;
    sighting->first_index = index;
  }
}

std::span<const PortWeight> NewTagCounter::close_window() {
  closed_begin_ = open_begin_;
  open_begin_ = sightings_.size();
  for (PortWeight& weight : weights_) weight.weight = 0.0;
  std::fill(shared_by_.begin(), shared_by_.end(), 0U);
  new_tags_ = 0;
  for (const auto& entry : sightings_.entries().subspan(closed_begin_)) {
    if (entry.value.known) continue;
    ++new_tags_;
    credit(entry.value);
  }
  if (rule_ == ShareRule::split) share_out();
  counted_ += new_tags_;
  return weights_;
}

void NewTagCounter::credit(const Sighting& sighting) {
  if (rule_ == ShareRule::first_heard) {
    weights_[sighting.first_index].weight += 1.0;
    return;
  }
  const auto antennas = static_cast<std::size_t>(std::popcount(sighting.heard_by));
  for (std::size_t i = 0; i < weights_.size(); ++i)
    if (((sighting.heard_by >> i) & 1U) != 0) ++shared_by_[i * (weights_.size() + 1) + antennas];
}

// Shares are summed by their size, not tag by tag, so that rounding does not depend on the order of arrival.
void NewTagCounter::share_out() {
  for (std::size_t i = 0; i < weights_.size(); ++i)
    for (std::size_t antennas = 1; antennas <= weights_.size(); ++antennas)
      weights_[i].weight += static_cast<double>(shared_by_[i * (weights_.size() + 1) + antennas]) /
                            static_cast<double>(antennas);
}

void NewTagCounter::reopen() {
  open_begin_ = closed_begin_;
  counted_ -= new_tags_;
  new_tags_ = 0;
}

void NewTagCounter::mark_known(const Epc& epc) { sightings_.insert(epc, Sighting{}).first->known = true; }

}  // namespace forager::reader
