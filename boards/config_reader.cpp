#include "boards/config_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace forager::boards {
namespace {

std::string allowed_text(Range allowed) {
  if (std::isinf(allowed.min) && std::isinf(allowed.max)) return "any finite number";
  if (std::isinf(allowed.max)) return fmt::format("{} or more", allowed.min);
  if (std::isinf(allowed.min)) return fmt::format("{} or less", allowed.max);
  return fmt::format("{} to {}", allowed.min, allowed.max);
}

}  // namespace

ConfigReader::ConfigReader(const ConfigNode* node, std::string path, ConfigIssue& issue,
                           const ConfigNode* around)
    : node_(node), nearest_(node != nullptr ? node : around), path_(std::move(path)), issue_(&issue) {
  if (node_ == nullptr) return;
  node_->used = true;
  if (node_->table() == nullptr) {
    if (!*issue_)
      *issue_ = hal::Error{hal::ErrorCode::invalid_argument,
                           node_->where(),
                           "[" + path_ + "]",
                           fmt::format("is {}, not a table", node_->kind()),
                           fmt::format("Write [{}].", path_),
                           0};
    node_ = nullptr;
  }
}

bool ConfigReader::has(std::string_view key) const {
  if (node_ == nullptr) return false;
  node_->asked.emplace_back(key);
  return node_->find(key) != nullptr;
}

const ConfigNode* ConfigReader::take(std::string_view key) {
  if (node_ == nullptr || *issue_) return nullptr;
  node_->asked.emplace_back(key);
  const ConfigNode* found = node_->find(key);
  if (found != nullptr) found->used = true;
  return found;
}

void ConfigReader::complain(std::string_view key, std::string detail, std::string mend) {
  if (*issue_) return;
  const ConfigNode* at = node_ == nullptr ? nullptr : node_->find(key);
  if (at == nullptr) at = nearest_;
  *issue_ = hal::Error{hal::ErrorCode::invalid_argument,
                       at == nullptr ? std::string{} : at->where(),
                       path_.empty() ? std::string(key) : fmt::format("[{}] {}", path_, key),
                       std::move(detail),
                       std::move(mend),
                       0};
}

void ConfigReader::require(std::string_view key, std::string_view what) {
  if (!has(key)) complain(key, "is missing", fmt::format("Give {}.", what));
}

std::optional<double> ConfigReader::as_number(const ConfigNode& node, std::string_view key, Range allowed) {
  double value = 0.0;
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) {
    value = static_cast<double>(*integer);
  } else if (const auto* number = std::get_if<double>(&node.value)) {
    value = *number;
  } else {
    complain(key, fmt::format("is {}, not a number", node.kind()),
             fmt::format("Allowed: {}.", allowed_text(allowed)));
    return std::nullopt;
  }
  if (!std::isfinite(value) || value < allowed.min || value > allowed.max) {
    complain(key, fmt::format("is {}", value), fmt::format("Allowed: {}.", allowed_text(allowed)));
    return std::nullopt;
  }
  return value;
}

double ConfigReader::number(std::string_view key, double fallback, Range allowed) {
  return optional_number(key, allowed).value_or(fallback);
}

std::optional<double> ConfigReader::optional_number(std::string_view key, Range allowed) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return std::nullopt;
  return as_number(*node, key, allowed);
}

std::int64_t ConfigReader::integer(std::string_view key, std::int64_t fallback, Range allowed) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return fallback;
  if (std::get_if<std::int64_t>(&node->value) == nullptr) {
    complain(key, fmt::format("is {}, not an integer", node->kind()),
             fmt::format("Allowed: whole numbers, {}.", allowed_text(allowed)));
    return fallback;
  }
  const auto value = as_number(*node, key, allowed);
  return value ? std::get<std::int64_t>(node->value) : fallback;
}

bool ConfigReader::flag(std::string_view key, bool fallback) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return fallback;
  if (const auto* value = std::get_if<bool>(&node->value)) return *value;
  complain(key, fmt::format("is {}", node->kind()), "Write true or false.");
  return fallback;
}

std::string ConfigReader::text(std::string_view key, std::string_view fallback) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return std::string(fallback);
  if (const auto* value = std::get_if<std::string>(&node->value)) return *value;
  complain(key, fmt::format("is {}, not a string", node->kind()), "Write it in quotes.");
  return std::string(fallback);
}

std::string ConfigReader::choice(std::string_view key, std::string_view fallback,
                                 std::initializer_list<std::string_view> allowed) {
  std::string value = text(key, fallback);
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return value;
  complain(key, fmt::format("is \"{}\"", value), fmt::format("Allowed: {}.", fmt::join(allowed, ", ")));
  return std::string(fallback);
}

hal::Duration ConfigReader::duration(std::string_view key, hal::Duration fallback, Range allowed) {
  const auto value = optional_number(key, allowed);
  if (!value) return fallback;
  return hal::from_seconds(key.ends_with("_ms") ? *value * 1e-3 : *value);
}

std::optional<std::vector<double>> ConfigReader::as_numbers(const ConfigNode& node, std::string_view key,
                                                            std::size_t size) {
  const ConfigNode::Array* items = node.array();
  if (items == nullptr || items->size() != size) {
    complain(
        key,
        items == nullptr ? fmt::format("is {}", node.kind()) : fmt::format("has {} numbers", items->size()),
        fmt::format("Write {} numbers in brackets.", size));
    return std::nullopt;
  }
  std::vector<double> out;
  for (const ConfigNode& item : *items) {
    item.used = true;
    const auto value = as_number(item, key, {});
    if (!value) return std::nullopt;
    out.push_back(*value);
  }
  return out;
}

std::vector<double> ConfigReader::numbers(std::string_view key, std::size_t size) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return {};
  return as_numbers(*node, key, size).value_or(std::vector<double>{});
}

std::vector<double> ConfigReader::number_list(std::string_view key, Range allowed) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return {};
  std::vector<double> out;
  if (node->array() == nullptr) {
    complain(key, fmt::format("is {}", node->kind()), "Write numbers in brackets.");
    return out;
  }
  for (const ConfigNode& item : *node->array()) {
    item.used = true;
    const auto value = as_number(item, key, allowed);
    if (!value) return {};
    out.push_back(*value);
  }
  return out;
}

std::vector<std::vector<double>> ConfigReader::points(std::string_view key, std::size_t size) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return {};
  std::vector<std::vector<double>> out;
  if (node->array() == nullptr) {
    complain(key, fmt::format("is {}", node->kind()), "Write points in brackets: [[0, 0], [1, 0]].");
    return out;
  }
  for (const ConfigNode& item : *node->array()) {
    item.used = true;
    auto point = as_numbers(item, key, size);
    if (!point) return {};
    out.push_back(std::move(*point));
  }
  return out;
}

ConfigReader ConfigReader::table(std::string_view key) {
  return {take(key), path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key), *issue_, nearest_};
}

std::vector<ConfigReader> ConfigReader::tables(std::string_view key) {
  std::vector<ConfigReader> out;
  const ConfigNode* node = take(key);
  if (node == nullptr) return out;
  const std::string path = path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  if (node->array() == nullptr) {
    complain(key, fmt::format("is {}, not a list of tables", node->kind()),
             fmt::format("Write [[{}]].", path));
    return out;
  }
  for (const ConfigNode& item : *node->array()) out.emplace_back(&item, path, *issue_);
  return out;
}

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string nearest(const std::vector<std::string>& known, const std::string& key) {
  std::string best;
  std::size_t best_distance = 4;
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(name, key);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = name;
  }
  return best;
}

void find_unused(const ConfigNode& node, const std::string& path, ConfigIssue& issue) {
  if (issue) return;
  if (const auto* members = node.table()) {
    for (const auto& [key, value] : *members) {
      std::string full = path;
      if (!full.empty()) full += '.';
      full += key;
      if (value.used) {
        find_unused(value, full, issue);
      } else if (!issue) {
        const std::string guess = nearest(node.asked, key);
        issue = hal::Error{hal::ErrorCode::invalid_argument,
                           value.where(),
                           full,
                           "is not a known key here",
                           guess.empty() ? "Remove it, or see docs/boards.md for the keys there are."
                                         : fmt::format("Did you mean '{}'?", guess),
                           0};
      }
    }
  } else if (const auto* items = node.array()) {
    for (const ConfigNode& item : *items) find_unused(item, path, issue);
  }
}

}  // namespace

void check_unused(const ConfigNode& root, ConfigIssue& issue) { find_unused(root, "", issue); }

}  // namespace forager::boards
