#include "mocks/http_server_digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "mocks/http_server_request.hpp"
#include "mocks/md5.hpp"

namespace forager::mocks {
namespace {

constexpr std::size_t kNoncesKept = 64;

using Fields = std::map<std::string, std::string, std::less<>>;

// key=value or key="quoted \"value\"", separated by commas.
std::optional<Fields> parse_fields(std::string_view text) {
  Fields fields;
  const auto skip = [&text](std::string_view what) {
    text.remove_prefix(std::min(text.find_first_not_of(what), text.size()));
  };
  for (skip(" \t,"); !text.empty(); skip(" \t,")) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string key(text.substr(0, equals));
    text.remove_prefix(equals + 1);
    std::string value;
    if (text.starts_with('"')) {
      text.remove_prefix(1);
      while (!text.empty() && text.front() != '"') {
        if (text.front() == '\\' && text.size() > 1) text.remove_prefix(1);
        value += text.front();
        text.remove_prefix(1);
      }
      if (text.empty()) return std::nullopt;
      text.remove_prefix(1);
    } else {
      const std::size_t end = std::min(text.find_first_of(" \t,"), text.size());
      value = text.substr(0, end);
      text.remove_prefix(end);
    }
    fields[key] = value;
  }
  return fields;
}

std::optional<std::uint32_t> count_from(std::string_view text) {
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count, 16);
  if (error != std::errc() || end != text.data() + text.size() || text.size() != 8) return std::nullopt;
  return count;
}

}  // namespace

HttpServerDigest::HttpServerDigest(std::string realm, std::string user, const std::string& password,
                                   std::uint64_t seed)
    : realm_(std::move(realm)),
      user_(std::move(user)),
      secret_(md5_hex(user_ + ":" + realm_ + ":" + password)),
      random_(hal::Random::stream(seed, 7616)) {}

std::string HttpServerDigest::challenge(bool stale) {
  if (nonces_.size() == kNoncesKept) nonces_.erase(nonces_.begin());
  nonces_.push_back({fmt::format("{:016x}{:016x}", random_.next(), random_.next()), 0});
  return fmt::format(R"(Digest realm="{}", qop="auth", nonce="{}", algorithm=MD5{})", realm_,
                     nonces_.back().text, stale ? ", stale=true" : "");
}

HttpServerDigest::Verdict HttpServerDigest::check(std::string_view authorization, std::string_view method,
                                                  std::string_view target) {
  constexpr std::string_view kScheme = "Digest ";
  if (!same_ignoring_case(authorization.substr(0, kScheme.size()), kScheme)) return Verdict::refused;
  auto fields = parse_fields(authorization.substr(kScheme.size()));
  if (!fields) return Verdict::refused;
  Fields& field = *fields;
  if (field["username"] != user_ || field["realm"] != realm_ || field["uri"] != target ||
      field["qop"] != "auth")
    return Verdict::refused;
  if (field.contains("algorithm") && !same_ignoring_case(field["algorithm"], "MD5")) return Verdict::refused;
  const auto count = count_from(field["nc"]);
  // RFC 7616 section 3.4.1: H(H(A1):nonce:nc:cnonce:qop:H(A2)) with A2 = method:uri.
  const std::string expected =
      md5_hex(fmt::format("{}:{}:{}:{}:auth:{}", secret_, field["nonce"], field["nc"], field["cnonce"],
                          md5_hex(fmt::format("{}:{}", method, target))));
  if (!count || field["response"] != expected) return Verdict::refused;
  const auto nonce = std::ranges::find(nonces_, field["nonce"], &Nonce::text);
  if (nonce == nonces_.end() || *count <= nonce->last_count) return Verdict::stale;
  nonce->last_count = *count;
  return Verdict::accepted;
}

}  // namespace forager::mocks
