#pragma once

#include "hal/error.hpp"
#include "reader/sqlite_database.hpp"

namespace forager::reader {

// True: an inventory of this layout. False: an empty file, which may become one. Errors: protocol (of another
// program, damaged, or of a later layout), busy, io.
[[nodiscard]] hal::Result<bool> identify_inventory(const SqliteDatabase& database);

// Creates the tables and marks the file as ours, all in one transaction: a kill leaves either an empty file,
// which resuming takes, or a whole one. Errors: busy, io.
[[nodiscard]] hal::Result<> lay_out_inventory(const SqliteDatabase& database);

}  // namespace forager::reader
