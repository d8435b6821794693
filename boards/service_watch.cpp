#include "boards/service_watch.hpp"

#include "hal/linux/service_notify.hpp"

namespace forager::boards {
namespace {

class Notified final : public ServiceWatch {
 public:
  Notified() { service_.ready(); }
  ~Notified() override { service_.stopping(); }
  Notified(const Notified&) = delete;
  Notified& operator=(const Notified&) = delete;
  void alive(hal::Instant now) override { service_.alive(now); }

 private:
  hal::ServiceNotify service_ = hal::ServiceNotify::from_environment();
};

}  // namespace

std::unique_ptr<ServiceWatch> ServiceWatch::begin() { return std::make_unique<Notified>(); }

}  // namespace forager::boards
