#include "tools/emulate_watch.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;

void say(std::FILE* to, const std::string& line) {
  std::fputs(line.c_str(), to);
  std::fflush(to);
}

void say_json(const Json& object) {
  say(stdout, object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace

EmulateWatch::EmulateWatch(Options options, hal::Instant start)
    : options_(std::move(options)), start_(start), next_status_s_(options_.status_every_s) {}

EmulateWatch::~EmulateWatch() { clear_line(); }

void EmulateWatch::listening(const boards::EmulatedServer& server) {
  if (!options_.json)
    return say(stdout, fmt::format("emulated {}: {}\n", options_.device, one_line(server.address())));
  Json endpoints = Json::object();
  for (const boards::NamedEndpoint& endpoint : server.endpoints())
    endpoints[endpoint.name] = {{"host", endpoint.at.host}, {"port", endpoint.at.port}};
  say_json({{"event", "listening"},
            {"device", options_.device},
            {"address", server.address()},
            {"endpoints", endpoints}});
}

void EmulateWatch::note(hal::Instant now, std::string_view source, std::string_view text) {
  if (!options_.notes) return;
  const double t_s = hal::to_seconds(now - start_);
  if (options_.json) return say_json({{"event", "note"}, {"t_s", t_s}, {"source", source}, {"text", text}});
  clear_line();
  say(stderr, fmt::format("{:9.2f} s  {}: {}\n", t_s, one_line(source), one_line(text)));
}

void EmulateWatch::update(const boards::EmulatedServer& server, hal::Instant now, double wall_time_s) {
  if (!(options_.json && options_.notes) && !options_.status_line) return;
  if (wall_time_s < next_status_s_) return;
  next_status_s_ = wall_time_s + options_.status_every_s;
  const double t_s = hal::to_seconds(now - start_);
  if (options_.json)
    return say_json(
        {{"event", "status"}, {"t_s", t_s}, {"device", options_.device}, {"text", server.status()}});
  clear_line();
  say(stderr, fmt::format("{:9.2f} s  {}", t_s, one_line(server.status())));
  line_open_ = true;
}

void EmulateWatch::ended(std::string_view why) {
  clear_line();
  if (options_.json)
    say_json({{"event", "ended"}, {"device", options_.device}, {"why", why}});
  else if (options_.notes)
    say(stderr, fmt::format("emulated {}: ended, {}\n", options_.device, why));
}

void EmulateWatch::clear_line() {
  if (!line_open_) return;
  say(stderr, "\r\x1b[K");
  line_open_ = false;
}

}  // namespace forager::tools
