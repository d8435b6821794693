#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/digital_out.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"

namespace forager::mocks {

// An output line whose state and edges a test can look at. With a journal every edge is noted as
// "active" or "inactive" from the source `name`, at the time last told by tick().
class FakeDigitalOut final : public hal::DigitalOut {
 public:
  struct Edge {
    hal::Instant at;
    bool active;
  };

  explicit FakeDigitalOut(std::string name, hal::Journal* journal = nullptr)
      : name_(std::move(name)), journal_(journal) {}

  void tick(hal::Instant now) { now_ = now; }
  [[nodiscard]] bool active() const { return active_; }
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
  [[nodiscard]] std::uint32_t sets() const { return sets_; }  // calls of set() that were let through
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  // The cable is out: every set() answers disconnected until it is back; the line keeps its state.
  void disconnect(bool out = true) { disconnected_ = out; }

 private:
  hal::Result<> do_set(bool active) override;
  std::string_view do_name() const override { return name_; }

  std::string name_;
  hal::Journal* journal_;
  hal::Instant now_;
  bool active_ = false;
  bool disconnected_ = false;
  std::uint32_t sets_ = 0;
  std::vector<Edge> edges_;
  std::optional<hal::Error> next_error_;
};

}  // namespace forager::mocks
