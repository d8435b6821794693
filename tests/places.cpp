#include "tests/places.hpp"

namespace forager::test {

std::string source_path(std::string_view file) { return FORAGER_SOURCE_DIR "/" + std::string(file); }
std::string data_path(std::string_view file) { return FORAGER_SOURCE_DIR "/tests/data/" + std::string(file); }
const char* program() { return FORAGER_PROGRAM; }
const char* fake_machine() { return FORAGER_FAKE_MACHINE; }

}  // namespace forager::test
