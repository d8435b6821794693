#pragma once

namespace forager::hal {

// Anything that can move or radiate. halt() puts it into its declared safe state (brakes locked, motors
// stopped or landing, lamp off, radio off), may be called at any time and more than once, and never fails: it
// does what it can and leaves the rest to the device's own time-out.
class Halt {
 public:
  virtual ~Halt() = default;
  virtual void halt() noexcept = 0;
};

// Halts at the end of a scope, whatever the way out. Put it beside the object it guards: an interface's own
// destructor is too late, the derived part is gone by then.
class HaltGuard {
 public:
  explicit HaltGuard(Halt& target) : target_(&target) {}
  ~HaltGuard() { target_->halt(); }
  HaltGuard(const HaltGuard&) = delete;
  HaltGuard& operator=(const HaltGuard&) = delete;

 private:
  Halt* target_;
};

}  // namespace forager::hal
