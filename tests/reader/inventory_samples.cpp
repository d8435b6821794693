#include "tests/reader/inventory_samples.hpp"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace forager::test {

TemporaryFolder::TemporaryFolder() : path_(std::filesystem::temp_directory_path() / "forager-XXXXXX") {
  if (::mkdtemp(path_.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace forager::test
