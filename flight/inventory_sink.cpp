#include "flight/inventory_sink.hpp"

#include <utility>

namespace forager::flight {

InventorySink::InventorySink(reader::InventoryStore& store, hal::Journal& journal,
                             const InventorySinkConfig& config)
    : store_(&store), journal_(&journal), config_(config), next_batch_(store.last_batch() + 1) {
  filling_.reserve(2 * config_.batch_reads);
  sending_.reserve(2 * config_.batch_reads);
}

void InventorySink::update(hal::Instant now) {
  if (!sending_.empty()) {
    if (now < retry_at_ || !commit(now)) return;
  }
  if (filling_.empty()) {
    oldest_waits_since_.reset();
    return;
  }
  if (!oldest_waits_since_) oldest_waits_since_ = now;
  if (filling_.size() >= config_.batch_reads || now - *oldest_waits_since_ >= config_.batch_interval) {
    std::swap(filling_, sending_);
    oldest_waits_since_.reset();
    commit(now);
  }
}

bool InventorySink::flush(hal::Instant now) {
  if (!sending_.empty() && !commit(now)) return false;
  if (filling_.empty()) return true;
  std::swap(filling_, sending_);
  return commit(now);
}

bool InventorySink::commit(hal::Instant now) {
  if (auto stored = store_->commit(next_batch_, sending_); !stored) {
    last_error_ = hal::describe(stored.error());
    if (!failing_since_) {
      failing_since_ = now;
      journal_->note(now, "inventory", last_error_);
    }
    retry_at_ = now + config_.retry_interval;
    return false;
  }
  if (failing_since_) journal_->note(now, "inventory", "the store takes reads again");
  failing_since_.reset();
  ++next_batch_;
  sending_.clear();
  return true;
}

}  // namespace forager::flight
