#include <fmt/format.h>

#include <utility>

#include "boards/emulate.hpp"
#include "boards/sim_air.hpp"
#include "boards/world_builder.hpp"
#include "hal/linux/tcp_listener.hpp"
#include "hal/linux/udp_peer.hpp"
#include "mocks/http_server.hpp"
#include "mocks/sim_reader.hpp"
#include "mocks/truth_feed.hpp"

namespace forager::boards {
namespace {

// Callers beyond this in one update wait in the kernel until the next.
constexpr int kMaxAccepts = 32;

// A listening port whose connections are served by something that lets the dead ones go.
class Door {
 public:
  explicit Door(hal::TcpListener listener) : listener_(std::move(listener)) {}
  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }

  template <class Server>
  void let_in(Server& server) {
    for (int i = 0; i < kMaxAccepts; ++i) {
      auto caller = listener_.accept();
      // Out of descriptors: whoever knocks waits until somebody has left.
      if (!caller || *caller == nullptr) return;
      server.attach(**caller);
      guests_.push_back(*std::move(caller));
    }
  }
  template <class Server>
  void forget_gone(const Server& server) {
    std::erase_if(guests_, [&server](const auto& guest) { return !server.attached(*guest); });
  }

 private:
  hal::TcpListener listener_;
  std::vector<std::unique_ptr<hal::ByteStream>> guests_;
};

struct ReaderSockets {
  hal::TcpListener rest;
  hal::TcpListener stream;
  std::unique_ptr<hal::UdpPeer> truth;
};

class ReaderServer final : public EmulatedServer {
 public:
  ReaderServer(const Scene& scene, const EmulatedReaderOptions& options, ReaderSockets sockets,
               hal::Journal& journal)
      : options_(options),
        world_(build_world(scene, options.seed)),
        truth_line_(std::move(sockets.truth)),
        truth_port_(truth_line_->local_port()),
        body_(*truth_line_, start_of(scene)),
        field_(make_field(scene, world_, body_, seed_for(options.seed, SeedStream::air))),
        rest_door_(std::move(sockets.rest)),
        stream_door_(std::move(sockets.stream)),
        reader_(reader_config(options), *field_, journal),
        rest_(rest_config(options), reader_) {}

  void update(hal::Instant now) override {
    now_ = now;
    body_.update(now);
    rest_door_.let_in(rest_);
    stream_door_.let_in(reader_.streams());
    // Requests before the air: a start that has just come in takes effect now, its answer leaves at once.
    rest_.update(now);
    reader_.update(now);
    rest_.update(now);
    rest_door_.forget_gone(rest_);
    stream_door_.forget_gone(reader_.streams());
  }

  std::vector<NamedEndpoint> endpoints() const override {
    return {{"rest", {options_.host, rest_door_.port()}},
            {"stream", {options_.host, stream_door_.port()}},
            {"truth", {options_.truth.host, truth_port_}}};
  }

  std::string address() const override {
    return fmt::format("REST on http://{}:{}{}, event stream on tcp {}:{}, truth feed expected on udp {}:{}",
                       options_.host, rest_door_.port(), options_.user.empty() ? "" : " (digest login)",
                       options_.host, stream_door_.port(), options_.truth.host, truth_port_);
  }

  std::string status() const override {
    const hal::Vec3& at = body_.state().pose.position;
    return fmt::format("{}, {} stream client(s), {} reads on the air; vehicle {}", state_name(),
                       reader_.streams().clients(), reader_.reads(),
                       body_.fresh(now_, kTruthAge)
                           ? fmt::format("at x {:.2f} y {:.2f} z {:.2f} m", at.x, at.y, at.z)
                           : std::string("not heard of"));
  }

 private:
  static constexpr hal::Duration kTruthAge = std::chrono::seconds(1);

  static mocks::BodyState start_of(const Scene& scene) {
    mocks::BodyState body;
    body.pose = scene.vehicle.start;
    return body;
  }
  static mocks::SimReaderConfig reader_config(const EmulatedReaderOptions& options) {
    mocks::SimReaderConfig config;
    config.seed = seed_for(options.seed, SeedStream::reader);
    return config;
  }
  static mocks::HttpServerConfig rest_config(const EmulatedReaderOptions& options) {
    mocks::HttpServerConfig config;
    config.digest = !options.user.empty();
    config.user = options.user;
    config.password = options.password;
    config.seed = seed_for(options.seed, SeedStream::reader);
    return config;
  }
  [[nodiscard]] std::string_view state_name() const {
    if (reader_.radiating()) return "reading";
    return reader_.status() == mocks::SimReader::Status::running ? "running" : "stopped";
  }

  EmulatedReaderOptions options_;
  hal::Instant now_;
  mocks::World world_;
  std::unique_ptr<hal::UdpPeer> truth_line_;
  std::uint16_t truth_port_;
  mocks::TruthFollower body_;
  std::unique_ptr<mocks::TagField> field_;
  // The doors own the connections that reader and server borrow.
  Door rest_door_;
  Door stream_door_;
  mocks::SimReader reader_;
  mocks::HttpServer rest_;
};

}  // namespace

hal::Result<std::unique_ptr<EmulatedServer>> emulate_reader(const Scene& scene,
                                                            const EmulatedReaderOptions& options,
                                                            hal::Journal& journal) {
  FORAGER_TRY(check_air(scene));
  auto rest = hal::TcpListener::listen(options.host, options.rest_port);
  if (!rest) return hal::fail(std::move(rest).error());
  auto stream = hal::TcpListener::listen(options.host, options.stream_port);
  if (!stream) return hal::fail(std::move(stream).error());
  auto truth = hal::open_udp_listener(options.truth.host, options.truth.port);
  FORAGER_TRY(truth->open());
  return std::make_unique<ReaderServer>(
      scene, options, ReaderSockets{*std::move(rest), *std::move(stream), std::move(truth)}, journal);
}

}  // namespace forager::boards
