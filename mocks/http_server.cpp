#include "mocks/http_server.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace forager::mocks {

using hal::StreamState;

HttpServer::HttpServer(HttpServerConfig config, HttpHandler& handler)
    : config_(std::move(config)), handler_(&handler) {
  if (config_.digest) digest_.emplace(config_.realm, config_.user, config_.password, config_.seed);
}

void HttpServer::attach(MemoryStreamPair& line) {
  attach(line.far());
  lines_.back()->pair = &line;
}

void HttpServer::attach(hal::ByteStream& end) {
  lines_.push_back(std::make_unique<Line>());
  lines_.back()->end = &end;
}

void HttpServer::detach(const hal::ByteStream& end) {
  std::erase_if(lines_, [&end](const auto& line) { return line->end == &end; });
}

bool HttpServer::attached(const hal::ByteStream& end) const {
  return std::ranges::any_of(lines_, [&end](const auto& line) { return line->end == &end; });
}

std::size_t HttpServer::connections() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(lines_, [](const auto& line) { return line->session != nullptr; }));
}

void HttpServer::update(hal::Instant now) {
  std::erase_if(lines_, [this, now](const auto& line) { return !service(*line, now); });
}

bool HttpServer::hang_up(Line& line) {
  line.session.reset();
  line.end->close();
  return line.end->open().has_value();
}

bool HttpServer::service(Line& line, hal::Instant now) {
  const HttpReach reach = handler_->reach(now);
  const bool listening = reach == HttpReach::listening;
  if (line.pair != nullptr) {
    line.pair->cut(reach == HttpReach::silent);
    line.pair->refuse_connects(!listening);
  }
  if (reach == HttpReach::silent) {
    line.lost = line.lost || line.session != nullptr;
    line.session.reset();
    return line.pair != nullptr || hang_up(line);
  }
  if (std::exchange(line.lost, false)) return hang_up(line);
  const auto state = line.end->poll();
  if (!state || *state == StreamState::closed) return hang_up(line);
  if (*state != StreamState::open) return true;
  const std::uint32_t connection = line.pair != nullptr ? line.pair->connections() : 0;
  if (line.session && connection != line.connection) line.session.reset();
  if (!line.session) {
    if (!listening || connections() >= config_.max_connections) return hang_up(line);
    line.connection = connection;
    line.last_heard = now;
    line.session =
        std::make_unique<HttpServerSession>(*handler_, digest_ ? &*digest_ : nullptr, config_.limits);
  }
  return exchange(line, now) || hang_up(line);
}

// False when the connection is over.
bool HttpServer::exchange(Line& line, hal::Instant now) {
  std::array<std::byte, 4096> bytes{};
  HttpServerSession& session = *line.session;
  while (const std::size_t room = std::min(session.room(), bytes.size())) {
    const auto count = line.end->read(std::span(bytes).first(room));
    if (!count) return false;
    if (*count == 0) break;
    line.last_heard = now;
    session.take_in(std::span(bytes).first(*count), now);
  }
  session.update(now);
  while (!session.output().empty()) {
    const std::string_view output = session.output();
    const auto count = line.end->write({reinterpret_cast<const std::byte*>(output.data()), output.size()});
    if (!count) return false;
    if (*count == 0) break;
    session.sent(*count);
  }
  return !session.finished() && now - line.last_heard < config_.idle_timeout;
}

}  // namespace forager::mocks
