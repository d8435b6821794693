#include "mocks/faulty_stream.hpp"

#include <algorithm>
#include <cstring>

namespace forager::mocks {

FaultyStream::FaultyStream(hal::ByteStream& line, const StreamFaults& read, const StreamFaults& write,
                           std::uint64_t seed)
    : line_(&line), read_(read), write_(write), random_(seed) {}

bool FaultyStream::happens(double chance) {
  if (chance <= 0.0 || !random_.chance(chance)) return false;
  ++faults_;
  return true;
}

void FaultyStream::do_close() {
  damaged_.clear();
  outgoing_.clear();
  handed_on_ = sent_ = 0;
  line_->close();
}

hal::Result<> FaultyStream::maybe_disconnect(const StreamFaults& faults, const char* operation) {
  if (!happens(faults.disconnect)) return {};
  do_close();
  return hal::fail(hal::ErrorCode::disconnected, std::string(line_->name()), operation,
                   "connection lost (seeded fault)");
}

void FaultyStream::damage(std::vector<std::byte>& bytes, const StreamFaults& faults) {
  if (faults.drop > 0.0) std::erase_if(bytes, [&](std::byte) { return happens(faults.drop); });
  if (faults.flip > 0.0)
    for (std::byte& byte : bytes)
      if (happens(faults.flip)) byte ^= std::byte{1} << static_cast<int>(random_.below(8));
}

// Sends on what the caller thinks is sent already.
hal::Result<> FaultyStream::flush() {
  if (sent_ == outgoing_.size()) return {};
  const auto count = line_->write(std::span(outgoing_).subspan(sent_));
  if (!count) return hal::fail(count.error());
  sent_ += *count;
  return {};
}

hal::Result<std::size_t> FaultyStream::do_read(std::span<std::byte> into) {
  FORAGER_TRY(maybe_disconnect(read_, "read"));
  FORAGER_TRY(flush());
  if (happens(read_.join)) return std::size_t{0};
  if (handed_on_ == damaged_.size()) {
    damaged_.resize(into.size());
    handed_on_ = 0;
    const auto count = line_->read(damaged_);
    damaged_.resize(count.value_or(0));
    if (!count) return hal::fail(count.error());
    damage(damaged_, read_);
    if (!damaged_.empty() && happens(read_.garbage)) {
      std::vector<std::byte> garbage(1 + random_.below(16));
      for (std::byte& byte : garbage) byte = static_cast<std::byte>(random_.below(256));
      damaged_.insert(damaged_.begin(), garbage.begin(), garbage.end());
    }
  }
  std::size_t count = std::min(into.size(), damaged_.size() - handed_on_);
  if (count > 1 && happens(read_.split)) count = 1 + random_.below(count - 1);
  if (count > 0) std::memcpy(into.data(), damaged_.data() + handed_on_, count);
  handed_on_ += count;
  return count;
}

hal::Result<std::size_t> FaultyStream::do_write(std::span<const std::byte> bytes) {
  FORAGER_TRY(maybe_disconnect(write_, "write"));
  FORAGER_TRY(flush());
  if (sent_ < outgoing_.size()) return std::size_t{0};
  if (happens(write_.join)) return std::size_t{0};
  std::size_t taken = bytes.size();
  if (taken > 1 && happens(write_.split)) taken = 1 + random_.below(taken - 1);
  outgoing_.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
  sent_ = 0;
  damage(outgoing_, write_);
  const auto count = line_->write(outgoing_);
  if (!count) return hal::fail(count.error());
  sent_ = *count;
  return taken;
}

}  // namespace forager::mocks
