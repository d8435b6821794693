#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// One logical input: active or inactive. Polarity, pull resistor and debouncing belong to the board file.
class DigitalIn {
 public:
  virtual ~DigitalIn() = default;
  // The level now. Errors: permission, busy (another program holds the line), disconnected (the adapter is
  // unplugged), io.
  [[nodiscard]] Result<bool> active() { return do_active(); }
  // "gpio gpiochip0/BRAKE_STOP".
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<bool> do_active() = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

struct Edge {
  Instant at;           // when the kernel's interrupt saw it, on the run's time line
  bool active = false;  // the level it led to
};

// An input that keeps the edges it has seen, so that a pulse shorter than an update is not missed.
class EdgeIn : public DigitalIn {
 public:
  // Takes up to into.size() edges out of the queue, oldest first; 0: none. Never blocks. The kernel keeps 16
  // edges: of more the first 16 by its older interface (libgpiod 1), the last 16 by its newer (libgpiod 2);
  // where some are lost, two edges in a row may have the same level. Errors as active().
  [[nodiscard]] Result<std::size_t> edges(std::span<Edge> into) { return do_edges(into); }

 private:
  virtual Result<std::size_t> do_edges(std::span<Edge> into) = 0;
};

}  // namespace forager::hal
