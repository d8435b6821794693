#include "boards/run_journal.hpp"

#include <cerrno>
#include <cstdio>
#include <utility>

#include "mocks/text_journal.hpp"

namespace forager::boards {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

class TextRunJournal final : public RunJournal {
 public:
  TextRunJournal(File file, Listener listener)
      : file_(std::move(file)), listener_(std::move(listener)), text_({.keep = false, .sink = sink()}) {}

  std::uint64_t hash() const override { return text_.hash(); }
  bool flush() override {
    return file_ == nullptr || (std::fflush(file_.get()) == 0 && std::ferror(file_.get()) == 0);
  }

 private:
  std::function<void(std::string_view)> sink() {
    if (file_ == nullptr) return {};
    return [file = file_.get()](std::string_view line) { std::fwrite(line.data(), 1, line.size(), file); };
  }
  void do_note(hal::Instant now, std::string_view source, std::string_view text) override {
    text_.note(now, source, text);
    if (listener_) listener_(now, source, text);
  }
  void do_wire(hal::Instant now, std::string_view source, std::string_view direction,
               std::span<const std::byte> bytes) override {
    text_.wire(now, source, direction, bytes);
  }

  File file_;
  Listener listener_;
  mocks::TextJournal text_;
};

}  // namespace

hal::Result<std::unique_ptr<RunJournal>> RunJournal::open(const std::string& path, Listener listener) {
  File file;
  if (!path.empty()) {
    file.reset(std::fopen(path.c_str(), "wbe"));
    if (file == nullptr) {
      const int number = errno;
      return hal::fail(number == EACCES ? hal::ErrorCode::permission : hal::ErrorCode::io, path,
                       "create journal", "cannot be written", "Choose another --output folder.", number);
    }
  }
  return std::make_unique<TextRunJournal>(std::move(file), std::move(listener));
}

}  // namespace forager::boards
