// Twin of sqlite_inventory.cpp for a build without SQLite.
#include "reader/inventory_store.hpp"

namespace forager::reader {

bool have_sqlite_inventory() { return false; }

hal::Result<std::unique_ptr<InventoryStore>> open_sqlite_inventory(const std::string& path,
                                                                   const StoreOptions&) {
  return hal::fail(hal::ErrorCode::unsupported, "inventory " + path, "open",
                   "this program was built without SQLite",
                   "Install libsqlite3-dev and build again, or run without an inventory file");
}

}  // namespace forager::reader
