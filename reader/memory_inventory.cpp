#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reader/epc_table.hpp"
#include "reader/inventory_store.hpp"

namespace forager::reader {
namespace {

constexpr const char* kDevice = "inventory in memory";

class MemoryInventory final : public InventoryStore {
 public:
  hal::Result<> commit(std::uint64_t batch, std::span<const LocatedRead> reads) override {
    if (batch == 0 || batch > last_batch_ + 1)
      return hal::fail(hal::ErrorCode::invalid_argument, kDevice, fmt::format("store batch {}", batch),
                       fmt::format("the next number is {}", last_batch_ + 1));
    if (batch <= last_batch_) return {};
    for (const LocatedRead& located : reads) {
      fold(located);
      reads_by_port_[located.read.port] += located.read.read_count;
    }
    last_batch_ = batch;
    return {};
  }

  std::uint64_t last_batch() const override { return last_batch_; }

  hal::Result<std::vector<InventoryItem>> items() const override {
    std::vector<InventoryItem> items;
    items.reserve(items_.size());
    for (const auto& entry : items_.entries()) items.push_back(entry.value);
    std::sort(items.begin(), items.end(), [](const InventoryItem& a, const InventoryItem& b) {
      return std::ranges::lexicographical_compare(a.epc.bytes(), b.epc.bytes());
    });
    return items;
  }

  hal::Result<> set_fact(const std::string& key, const std::string& value) override {
    facts_[key] = value;
    return {};
  }

  hal::Result<std::vector<std::pair<std::string, std::string>>> facts() const override {
    return std::vector<std::pair<std::string, std::string>>(facts_.begin(), facts_.end());
  }

  hal::Result<std::vector<PortTotal>> port_totals() const override {
    std::map<std::uint8_t, PortTotal> totals;
    for (const auto& [port, reads] : reads_by_port_) totals[port] = {port, reads, 0};
    for (const auto& entry : items_.entries()) ++totals[entry.value.best_port].items;
    std::vector<PortTotal> list;
    list.reserve(totals.size());
    for (const auto& [port, total] : totals) list.push_back(total);
    return list;
  }

 private:
  void fold(const LocatedRead& located) {
    const TagRead& read = located.read;
    const InventoryItem first{read.epc,      read.heard, read.heard,         0,
                              read.rssi_dbm, read.port,  located.pose_world, located.pose_known};
    InventoryItem& item = *items_.insert(read.epc, first).first;
    item.count += read.read_count;
    item.first_seen = std::min(item.first_seen, read.heard);
    item.last_seen = std::max(item.last_seen, read.heard);
    if (read.rssi_dbm <= item.best_rssi_dbm) return;
    item.best_rssi_dbm = read.rssi_dbm;
    item.best_port = read.port;
    item.best_pose_world = located.pose_world;
    item.pose_known = located.pose_known;
  }

  EpcTable<InventoryItem> items_;
  std::map<std::uint8_t, std::uint64_t> reads_by_port_;
  std::map<std::string, std::string> facts_;
  std::uint64_t last_batch_ = 0;
};

}  // namespace

std::unique_ptr<InventoryStore> make_memory_inventory() { return std::make_unique<MemoryInventory>(); }

}  // namespace forager::reader
