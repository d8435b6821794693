#include "mocks/tag_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "mocks/epc_index.hpp"

namespace forager::mocks {
namespace {

constexpr std::string_view kHeader = "epc,x,y,z";
constexpr std::string_view kHeaderWithWanted = "epc,x,y,z,wanted";
constexpr double kFarthest_m = 1e9;
constexpr std::size_t kLongestEpc = 124;
constexpr std::size_t kLongestLine = 1024;
constexpr std::size_t kChunk = std::size_t{1} << 20U;

// What a person sees of a piece of somebody's file.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? out + "..." : out;
}

// Takes the lines of a tag file one after the other.
class TagReader {
 public:
  TagReader(std::string name, TagList& tags) : name_(std::move(name)), tags_(&tags), index_(tags) {}

  hal::Result<> take(std::string_view line) {
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line_ == 1) return take_header(line);
    if (line.size() > kLongestLine) return refuse(kLongestLine, "the line is too long");
    std::array<std::string_view, 5> cells;
    std::size_t count = 0;
    for (std::size_t from = 0;;) {
      const std::size_t comma = line.find(',', from);
      const std::size_t end = comma == std::string_view::npos ? line.size() : comma;
      if (count == columns_) return refuse(from, fmt::format("there are more than {} values", columns_));
      cells[count++] = line.substr(from, end - from);
      if (comma == std::string_view::npos) break;
      from = comma + 1;
    }
    const auto column = [&](std::size_t i) {
      return static_cast<std::size_t>(cells[i].data() - line.data());
    };
    if (count < columns_)
      return refuse(line.size(), fmt::format("{} values instead of {}", line.empty() ? 0 : count, columns_));
    const auto epc = read_epc(cells[0]);
    if (!epc) return refuse(0, *why_);
    std::array<double, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto number = read_number(cells[i + 1]);
      if (!number) return refuse(column(i + 1), *why_);
      at[i] = *number;
    }
    if (columns_ == 5 && cells[4] != "0" && cells[4] != "1")
      return refuse(column(4), fmt::format("\"{}\" is neither 1 (wanted) nor 0", shown(cells[4])));
    tags_->push_back({*epc, {at[0], at[1], at[2]}, columns_ == 4 || cells[4] == "1"});
    if (const auto twin = index_.add_last())
      return refuse(0, fmt::format("EPC {} is there already, as tag {}", shown(*epc), *twin + 1));
    return {};
  }
  // A last line that is not there does not count; a file without even a header does.
  hal::Result<> end() {
    if (line_ > 0) return {};
    ++line_;
    return refuse(0, "the file is empty");
  }

 private:
  [[nodiscard]] hal::Failure refuse(std::size_t column, std::string detail) const {
    return hal::fail(hal::ErrorCode::invalid_argument, name_,
                     fmt::format("line {}, column {}", line_, column + 1), std::move(detail),
                     "A tag file has lines epc,x,y,z or epc,x,y,z,wanted; see docs/boards.md.");
  }
  hal::Result<> take_header(std::string_view line) {
    if (line == kHeader)
      columns_ = 4;
    else if (line == kHeaderWithWanted)
      columns_ = 5;
    else
      return refuse(0, fmt::format("the first line is \"{}\", not \"{}\" or \"{}\"", shown(line), kHeader,
                                   kHeaderWithWanted));
    return {};
  }
  const std::string* read_epc(std::string_view text) {
    if (text.empty() || text.size() > kLongestEpc || text.size() % 4 != 0) {
      why_ = fmt::format("\"{}\" has {} digits: an EPC has 4 to {}, whole 16-bit words", shown(text),
                         text.size(), kLongestEpc);
      return nullptr;
    }
    epc_.assign(text);
    for (char& c : epc_) {
      if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
      if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f')) continue;
      why_ = fmt::format("\"{}\" is not hexadecimal", shown(text));
      return nullptr;
    }
    return &epc_;
  }
  std::optional<double> read_number(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && std::abs(value) <= kFarthest_m)
      return value;
    why_ = fmt::format("\"{}\" is not a number of metres within {}", shown(text), kFarthest_m);
    return std::nullopt;
  }

  std::string name_;
  TagList* tags_;
  EpcIndex index_;
  std::size_t line_ = 0;
  std::size_t columns_ = 4;
  std::string epc_;
  std::optional<std::string> why_;
};

// Feeds what is whole of `text`, and gives the rest of the last line back.
hal::Result<std::string_view> feed(TagReader& reader, std::string_view text) {
  for (std::size_t from = 0;;) {
    const auto* const end =
        static_cast<const char*>(std::memchr(text.data() + from, '\n', text.size() - from));
    if (end == nullptr) return text.substr(from);
    const auto to = static_cast<std::size_t>(end - text.data());
    if (auto taken = reader.take(text.substr(from, to - from)); !taken)
      return hal::fail(std::move(taken).error());
    from = to + 1;
    if (from == text.size()) return std::string_view{};
  }
}

struct Close {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};
using File = std::unique_ptr<std::FILE, Close>;

hal::Failure failed(const std::string& path, const char* operation, int error) {
  const hal::ErrorCode code = error == ENOENT                     ? hal::ErrorCode::not_present
                              : error == EACCES || error == EPERM ? hal::ErrorCode::permission
                                                                  : hal::ErrorCode::io;
  return hal::fail(hal::Error{code, path, operation, std::strerror(error), {}, error});
}

}  // namespace

hal::Result<> parse_tags(std::string_view text, const std::string& name, TagList& tags) {
  TagReader reader(name, tags);
  if (!text.empty()) {
    const auto rest = feed(reader, text);
    if (!rest) return hal::fail(rest.error());
    if (!rest->empty()) FORAGER_TRY(reader.take(*rest));
  }
  return reader.end();
}

hal::Result<> read_tag_file(const std::string& path, TagList& tags) {
  const File file(std::fopen(path.c_str(), "rb"));
  if (file == nullptr) return failed(path, "open tag file", errno);
  TagReader reader(path, tags);
  std::vector<char> buffer(kChunk + kLongestLine + 1);
  std::size_t kept = 0;
  while (true) {
    const std::size_t got = std::fread(buffer.data() + kept, 1, kChunk, file.get());
    if (got == 0) break;
    const auto rest = feed(reader, {buffer.data(), kept + got});
    if (!rest) return hal::fail(rest.error());
    // A line longer than allowed is refused with what is there of it.
    if (rest->size() > kLongestLine) FORAGER_TRY(reader.take(*rest));
    kept = std::min(rest->size(), kLongestLine);
    if (kept > 0) std::memmove(buffer.data(), rest->data(), kept);
  }
  if (std::ferror(file.get()) != 0) return failed(path, "read tag file", errno);
  if (kept > 0) FORAGER_TRY(reader.take({buffer.data(), kept}));
  return reader.end();
}

hal::Result<> write_tag_file(const std::string& path, const TagList& tags) {
  const File file(std::fopen(path.c_str(), "wb"));
  if (file == nullptr) return failed(path, "write tag file", errno);
  std::string text(kHeaderWithWanted);
  text += '\n';
  for (std::size_t tag = 0; tag < tags.size(); ++tag) {
    tags.append_epc_hex(tag, text);
    const hal::Vec3 at = tags.position(tag);
    fmt::format_to(std::back_inserter(text), ",{},{},{},{:d}\n", at.x, at.y, at.z, tags.wanted(tag));
    if (text.size() < kChunk && tag + 1 < tags.size()) continue;
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size())
      return failed(path, "write tag file", errno);
    text.clear();
  }
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0)
    return failed(path, "write tag file", errno);
  return {};
}

}  // namespace forager::mocks
