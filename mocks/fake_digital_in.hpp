#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hal/digital_in.hpp"

namespace forager::mocks {

// An input line that a test drives. Keeps 16 edges unread like the kernel; later ones are lost.
class FakeDigitalIn final : public hal::EdgeIn {
 public:
  explicit FakeDigitalIn(std::string name) : name_(std::move(name)) {}

  // Drives the line; a change is an edge.
  void drive(bool active, hal::Instant now);
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  void disconnect(bool out = true) { disconnected_ = out; }

 private:
  hal::Result<bool> do_active() override;
  hal::Result<std::size_t> do_edges(std::span<hal::Edge> into) override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  hal::Result<> admit(std::string_view operation);

  std::string name_;
  bool active_ = false;
  bool disconnected_ = false;
  std::deque<hal::Edge> edges_;
  std::optional<hal::Error> next_error_;
};

}  // namespace forager::mocks
