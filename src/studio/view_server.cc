#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "gloam/log_player.h"
#include "gloam/view.h"
#include "studio/driver.h"
#include "studio/messages.h"
#include "studio/picture.h"
#include "studio/publisher.h"
#include "studio/web_server.h"
#include "web/access.h"

namespace gloam {
namespace {

using namespace studio;

Error usage(std::string message, std::string hint = {}) {
  return {.kind = ErrorKind::kUsage, .message = std::move(message), .hint = std::move(hint)};
}

Status check(const ViewOptions& options) {
  if (!web::is_loopback_name(options.host))
    return usage("the view is available only on this machine, and '" + options.host +
                     "' is not a loopback name",
                 "to view from another machine, run ssh -L 8080:localhost:8080 there and open the "
                 "printed address");
  if (options.port < 0 || options.port > 65535)
    return usage("port " + std::to_string(options.port) + " does not exist", "use 0 … 65535");
  if (options.max_clients < 1 || options.max_clients > 1024)
    return usage("the number of clients must be 1 … 1024");
  if (!(options.rate >= 0.001 && options.rate <= 240))
    return usage("the image rate must be above 0 and at most 240 per second");
  if (options.width < 0 || options.height < 0)
    return usage("the width and height of an image cannot be negative");
  return {};
}

}  // namespace

/// Puts the parts together and knows who is in control.
///
///     renderer → Publisher (JPEG, state) → WebServer → clients
///     clients → WebServer → here (who may) → Driver → Simulation
class ViewServer::Impl : public WebEvents {
 public:
  Impl(Simulation& simulation, const ViewOptions& options, const std::string& token)
      : simulation_(simulation),
        options_(options),
        token_(token),
        publisher_({.picture = [this](const CameraFrame& frame,
                                      uint64_t sequence) { send_picture(frame, sequence); },
                    .beat = [this] { send_state(); }}),
        driver_(simulation, options, publisher_,
                [this](int64_t client, std::string text) { web_.send(client, std::move(text)); }),
        web_({options.host, options.port, options.max_clients, token}, *this) {}
  ~Impl() override { stop(); }

  Status start() {
    GLOAM_TRY_STATUS(web_.listen());
    GLOAM_TRY_STATUS(driver_.start());
    simulation_.set_pace(options_.pace, options_.speed);
    publisher_.start();
    return {};
  }

  /// From where the data come to where they go, so that nobody calls one who is gone.
  void stop() {
    const std::lock_guard lock(stop_mutex_);
    web_.stop();
    driver_.stop();
    publisher_.stop();
  }

  std::string url() const {
    const bool v6 = options_.host.find(':') != std::string::npos && options_.host.front() != '[';
    const std::string host = v6 ? "[" + options_.host + "]" : options_.host;
    return "http://" + host + ":" + std::to_string(port()) + "/?token=" + token_;
  }
  int port() const { return web_.port(); }

  void on_open(int64_t client) override {
    driver_.set_clients(++clients_);
    if (controller_ == 0) controller_ = client;
    web_.send(client, hello_message(client, driver_.cameras(), simulation_.step_rate().value(),
                                    options_.player != nullptr ? options_.player->end() : 0));
  }

  void on_close(int64_t client) override {
    driver_.set_clients(--clients_);
    if (controller_ == client) give_up_control();
  }

  void on_text(int64_t client, std::string_view text) override {
    const auto message = parse_message(text);
    if (!message.ok()) return web_.send(client, notice_message(message.error().message));
    if (std::holds_alternative<SeenMessage>(*message)) return web_.picture_seen(client);
    if (std::holds_alternative<ClaimMessage>(*message)) {
      if (controller_ == client) return;
      give_up_control();
      controller_ = client;
      return;
    }
    if (controller_ != client)
      return web_.send(client, notice_message("You are watching. Take control first."));
    if (std::holds_alternative<ReleaseMessage>(*message)) return give_up_control();
    if (!driver_.post(client, *message))
      web_.send(client, notice_message("The simulation is busy; the request was not executed."));
  }

 private:
  void give_up_control() {
    if (controller_ != 0) driver_.release(controller_);
    controller_ = 0;
  }

  void send_picture(const CameraFrame& frame, uint64_t sequence) {
    // One image waits for the first client: the next one may take seconds.
    if (clients_ == 0 && has_picture_) return;
    has_picture_ = true;
    const auto& cameras = driver_.cameras();
    const auto row = std::find(cameras.begin(), cameras.end(), frame.camera) - cameras.begin();
    auto packet = encode_picture(frame, sequence, static_cast<uint32_t>(row));
    std::string error = packet.ok() ? "" : packet.error().to_string();
    if (packet.ok())
      web_.send_picture(std::make_shared<const std::string>(std::move(packet).value()));
    const std::lock_guard lock(error_mutex_);
    picture_error_ = std::move(error);
  }

  void send_state() {
    if (clients_ == 0) return;
    const SimulationStats stats = simulation_.stats();
    const Status physics = simulation_.status();
    const Driver::CameraReport camera = driver_.report();
    std::string error = physics.ok() ? camera.error : physics.error().to_string();
    if (error.empty()) {
      const std::lock_guard lock(error_mutex_);
      error = picture_error_;
    }
    web_.send_state(state_message({.step = stats.step,
                                   .time = stats.time,
                                   .hash = stats.hash,
                                   .realtime_factor = stats.realtime_factor,
                                   .paused = simulation_.paused(),
                                   .speed = camera.speed,
                                   .camera = camera.camera,
                                   .dropped = camera.dropped,
                                   .warnings = stats.warnings,
                                   .error = std::move(error),
                                   .clients = clients_,
                                   .controller = controller_}));
  }

  Simulation& simulation_;
  const ViewOptions options_;
  const std::string token_;
  // Written on the network thread, read by the publisher's.
  std::atomic<int> clients_ = 0;
  std::atomic<int64_t> controller_ = 0;
  std::mutex error_mutex_, stop_mutex_;
  std::string picture_error_;
  bool has_picture_ = false;  // the publisher's thread only
  Publisher publisher_;
  Driver driver_;
  WebServer web_;
};

ViewServer::ViewServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ViewServer::~ViewServer() = default;

Result<std::unique_ptr<ViewServer>> ViewServer::start(Simulation& simulation,
                                                      const ViewOptions& options) {
  GLOAM_TRY_STATUS(check(options));
  GLOAM_TRY(const std::string token, web::make_token());
  auto impl = std::make_unique<Impl>(simulation, options, token);
  GLOAM_TRY_STATUS(impl->start());
  return std::unique_ptr<ViewServer>(new ViewServer(std::move(impl)));
}

std::string ViewServer::url() const { return impl_->url(); }
int ViewServer::port() const { return impl_->port(); }
void ViewServer::stop() { impl_->stop(); }

}  // namespace gloam
