#include "boards/config_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include <toml++/toml.h>

namespace forager::boards {
namespace {

using hal::ErrorCode;
using hal::fail;
using hal::Result;

constexpr int kMaxBases = 8;
constexpr int kMaxDepth = 32;

Result<ConfigNode> convert(const toml::node& node, const std::string& file, int depth) {
  ConfigNode out;
  out.file = file;
  out.line = node.source().begin.line;
  if (depth > kMaxDepth)
    return fail(ErrorCode::invalid_argument, file, fmt::format("line {}", out.line), "nested too deeply",
                "Flatten the tables.");
  if (const auto* table = node.as_table()) {
    ConfigNode::Table members;
    for (const auto& [key, value] : *table) {
      auto member = convert(value, file, depth + 1);
      if (!member) return member;
      members.emplace_back(std::string(key.str()), std::move(*member));
    }
    out.value = std::move(members);
  } else if (const auto* array = node.as_array()) {
    ConfigNode::Array items;
    for (const auto& value : *array) {
      auto item = convert(value, file, depth + 1);
      if (!item) return item;
      items.push_back(std::move(*item));
    }
    out.value = std::move(items);
  } else if (const auto* text = node.as_string()) {
    out.value = text->get();
  } else if (const auto* integer = node.as_integer()) {
    out.value = integer->get();
  } else if (const auto* number = node.as_floating_point()) {
    out.value = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    out.value = flag->get();
  } else {
    return fail(ErrorCode::unsupported, file, fmt::format("line {}", out.line),
                "dates and times are not used here", "Write a number of seconds or a string.");
  }
  return out;
}

void overlay(ConfigNode& base, ConfigNode&& top) {
  auto* base_table = std::get_if<ConfigNode::Table>(&base.value);
  auto* top_table = std::get_if<ConfigNode::Table>(&top.value);
  if (base_table == nullptr || top_table == nullptr) {
    base = std::move(top);
    return;
  }
  base.file = top.file;
  base.line = top.line;
  for (auto& [key, value] : *top_table) {
    ConfigNode* existing = nullptr;
    for (auto& [name, node] : *base_table)
      if (name == key) existing = &node;
    if (existing != nullptr)
      overlay(*existing, std::move(value));
    else
      base_table->emplace_back(key, std::move(value));
  }
}

Result<std::string> slurp(const std::string& path) {
  std::error_code error;
  const bool is_directory = std::filesystem::is_directory(path, error);
  std::ifstream in(path, std::ios::binary);
  if (!in || is_directory) {
    const int number = is_directory ? EISDIR : errno;
    const ErrorCode code = number == EACCES ? ErrorCode::permission : ErrorCode::not_present;
    return fail(code, path, "read file", "cannot be read",
                is_directory ? "It is a folder: name a file in it." : "Check the path.", number);
  }
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// Where a TOML string that starts at `at` ends, quotes included; the end of its line or of the text if it is
// not closed.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool multi_line = text.substr(at, 3) == three;
  for (std::size_t i = at + (multi_line ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (multi_line && text.substr(i, 3) == three) {
      i += 3;
      for (int more = 0; more < 2 && i < text.size() && text[i] == quote; ++more) ++i;
      return i;
    } else if (!multi_line && (text[i] == quote || text[i] == '\n')) {
      return i + 1;
    }
  }
  return text.size();
}

// The first byte outside ASCII that is neither in a string nor in a comment; npos if there is none. TOML 1.0
// allows none there, and toml++ 3.3 does not survive some of them.
std::size_t stray_byte(std::string_view text) {
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  while (at < text.size()) {
    const char c = text[at];
    if (static_cast<unsigned char>(c) >= 0x80) return at;
    if (c == '#')
      at = std::min(text.find('\n', at), text.size());
    else if (c == '"' || c == '\'')
      at = end_of_string(text, at);
    else
      ++at;
  }
  return std::string_view::npos;
}

// Takes the key `base` out of a table; empty when there is none.
Result<std::string> take_base(ConfigNode& node) {
  auto* members = std::get_if<ConfigNode::Table>(&node.value);
  for (auto it = members->begin(); it != members->end(); ++it) {
    if (it->first != "base") continue;
    const auto* text = std::get_if<std::string>(&it->second.value);
    if (text == nullptr || text->empty())
      return fail(ErrorCode::invalid_argument, it->second.where(), "read base", "is not a file name",
                  "Write base = \"lab.toml\", relative to this file.");
    std::string base = *text;
    members->erase(it);
    return base;
  }
  return std::string{};
}

Result<ConfigNode> load(const std::string& path, int depth) {
  if (depth > kMaxBases)
    return fail(ErrorCode::invalid_argument, path, "read base",
                "more than eight files lie on top of each other",
                "Look for a file that names itself as its base.");
  auto text = slurp(path);
  if (!text) return fail(std::move(text).error());
  auto node = parse_config(*text, path);
  if (!node) return node;
  auto base = take_base(*node);
  if (!base) return fail(std::move(base).error());
  if (base->empty()) return node;
  auto below = load((std::filesystem::path(path).parent_path() / *base).string(), depth + 1);
  if (!below) return below;
  overlay(*below, std::move(*node));
  return below;
}

}  // namespace

const ConfigNode* ConfigNode::find(std::string_view key) const {
  if (const Table* members = table())
    for (const auto& [name, node] : *members)
      if (name == key) return &node;
  return nullptr;
}

std::string ConfigNode::where() const { return line == 0 ? file : fmt::format("{}:{}", file, line); }

std::string_view ConfigNode::kind() const {
  constexpr std::string_view kNames[] = {"a table",    "an array", "a string",
                                         "an integer", "a number", "a truth value"};
  return kNames[value.index()];
}

Result<ConfigNode> parse_config(std::string_view text, const std::string& file) {
  if (const std::size_t stray = stray_byte(text); stray != std::string_view::npos) {
    const std::string_view before = text.substr(0, stray);
    const std::size_t line_start = before.rfind('\n') + 1;  // 0 without one
    return fail(
        ErrorCode::invalid_argument, file,
        fmt::format("line {}, column {}", std::ranges::count(before, '\n') + 1, stray - line_start + 1),
        "a character outside ASCII, neither in a string nor in a comment",
        "Put it in quotes, or take it out.");
  }
  try {
    return convert(toml::parse(text, file), file, 0);
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::invalid_argument, file,
                fmt::format("line {}, column {}", error.source().begin.line, error.source().begin.column),
                std::string(error.description()), "The file must be TOML 1.0.");
  }
}

Result<ConfigNode> load_config(const std::string& path) { return load(path, 0); }

}  // namespace forager::boards
