#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "gloam/log_player.h"
#include "gloam/view.h"
#include "studio/driver.h"
#include "studio/inspector.h"
#include "studio/messages.h"
#include "studio/page.h"
#include "studio/picture_sender.h"
#include "studio/publisher.h"
#include "studio/replies.h"
#include "web/websocket_server.h"

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

/// Slots of a client's outbox.
enum OutboxSlot : size_t { kStateSlot, kFieldsSlot, kPictureSlot };

constexpr size_t kMaxReplies = size_t{64} << 20;  // bytes that wait for a client that is kept

web::ServerOptions server_options(const ViewOptions& options) {
  return {.host = options.host,
          .port = options.port,
          .methods = "GET, HEAD",
          .max_clients = options.max_clients,
          .outbox = {.kept_bytes = kMaxReplies, .slots = {0, 0, kPicturesInFlight}},
          .message_bytes = size_t{64} << 10,
          .accepts_binary = false};
}

web::Frame text_frame(std::string text) { return {std::move(text), nullptr, true}; }

}  // namespace

/// Puts the parts together and knows who is in control.
///
///     renderer → Publisher → PictureSender (JPEG, H.264) → clients' outboxes → WebSocketServer
///     clients → WebSocketServer → here (access) → Driver → Simulation
///                                               → Inspector → fields of the model
class ViewServer::Impl : public web::ServerEvents {
 public:
  Impl(Simulation& simulation, const ViewOptions& options, const std::string& token)
      : simulation_(simulation),
        options_(options),
        token_(token),
        pictures_(kPictureSlot, options.rate),
        publisher_(
            {.picture = [this](std::shared_ptr<const CameraFrame> frame,
                               uint64_t sequence) { send_picture(std::move(frame), sequence); },
             .beat = [this] { send_state(); }}),
        driver_(
            simulation, options, publisher_,
            {.reply = [this](int64_t client, std::string text) { send(client, std::move(text)); },
             .changed = [this] { send_state(); }}),
        inspector_(simulation, inspector_outputs()),
        web_(server_options(options), *this) {}
  ~Impl() override { stop(); }

  Status start() {
    GLOAM_TRY_STATUS(web_.listen());
    GLOAM_TRY_STATUS(driver_.start());
    simulation_.set_pace(options_.pace, options_.speed);
    publisher_.start();
    inspector_.start();
    return {};
  }

  /// From where the data come to where they go, so that nobody calls one who is gone.
  void stop() {
    const std::lock_guard lock(stop_mutex_);
    web_.stop();
    inspector_.stop();
    driver_.stop();
    publisher_.stop();
  }

  std::string url() const {
    const bool v6 = options_.host.find(':') != std::string::npos && options_.host.front() != '[';
    const std::string host = v6 ? "[" + options_.host + "]" : options_.host;
    return "http://" + host + ":" + std::to_string(port()) + "/?token=" + token_;
  }
  int port() const { return web_.port(); }

  web::Answer answer(const web::RequestFacts& request) override {
    return answer_page_request(request, token_);
  }

  void on_open(const web::ClientPtr& client) override {
    if (controller_ == 0) controller_ = client->id;
    client->outbox.send(text_frame(hello_message(greeting(client->id))));
    {
      const std::lock_guard lock(clients_mutex_);
      clients_[client->id] = client;
    }
    pictures_.add(client);
    driver_.set_clients(client_count());
  }

  void on_close(const web::ClientPtr& client) override {
    {
      const std::lock_guard lock(clients_mutex_);
      clients_.erase(client->id);
    }
    pictures_.remove(client->id);
    inspector_.forget(client->id);
    driver_.set_clients(client_count());
    if (controller_ == client->id) give_up_control();
  }

  void on_text(const web::ClientPtr& client, std::string_view text) override {
    const auto notify = [&](std::string_view notice) {
      client->outbox.send(text_frame(notice_message(notice)));
    };
    const auto message = parse_message(text);
    if (!message.ok()) return notify(message.error().message);
    if (std::holds_alternative<SeenMessage>(*message))
      return client->outbox.acknowledge(kPictureSlot);
    if (const auto* codec = std::get_if<CodecMessage>(&*message))
      return pictures_.set_codec(client->id, codec->is_h264 ? Codec::kH264 : Codec::kJpeg);
    if (std::holds_alternative<ClaimMessage>(*message)) {
      if (controller_ == client->id) return;
      give_up_control();
      controller_ = client->id;
      return;
    }
    if (controller_ != client->id && !is_for_watchers(*message))
      return notify("You are watching. Take control first.");
    if (std::holds_alternative<ReleaseMessage>(*message)) return give_up_control();
    const bool is_taken = is_about_data(*message) ? inspector_.post(client->id, *message)
                                                  : driver_.post(client->id, *message);
    if (!is_taken) notify("The simulation is busy; the request was not executed.");
  }

 private:
  void give_up_control() {
    if (controller_ != 0) driver_.release(controller_);
    controller_ = 0;
  }

  int client_count() const {
    const std::lock_guard lock(clients_mutex_);
    return static_cast<int>(clients_.size());
  }

  Greeting greeting(int64_t client) const {
    const World world = simulation_.world();
    return {.client = client,
            .title = world.compiled() == nullptr ? "" : world.scene().name,
            .cameras = driver_.cameras(),
            .step_rate = simulation_.step_rate().value(),
            .log_end = options_.player != nullptr ? options_.player->end() : 0};
  }

  Inspector::Outputs inspector_outputs() {
    using Bytes = std::vector<uint8_t>;
    const auto frame = [](Bytes bytes) {
      return web::Frame{"", std::make_shared<const Bytes>(std::move(bytes))};
    };
    return {.shown = [this] { return driver_.shown(); },
            .text = [this](int64_t client, std::string text) { send(client, std::move(text)); },
            .reply =
                [this, frame](int64_t client, Bytes bytes) {
                  with_client(client,
                              [&](web::Outbox& outbox) { outbox.send(frame(std::move(bytes))); });
                },
            .watched =
                [this, frame](int64_t client, Bytes bytes) {
                  with_client(client, [&](web::Outbox& outbox) {
                    outbox.replace(kFieldsSlot, frame(std::move(bytes)));
                  });
                }};
  }

  template <class Use>
  void with_client(int64_t client, Use use) {
    const std::lock_guard lock(clients_mutex_);
    const auto found = clients_.find(client);
    if (found != clients_.end()) use(found->second->outbox);
  }

  void send(int64_t client, std::string text) {
    with_client(client, [&](web::Outbox& outbox) { outbox.send(text_frame(std::move(text))); });
  }

  void send_picture(std::shared_ptr<const CameraFrame> frame, uint64_t sequence) {
    const auto& cameras = driver_.cameras();
    const auto row = std::find(cameras.begin(), cameras.end(), frame->camera) - cameras.begin();
    pictures_.send({std::move(frame), sequence, static_cast<uint32_t>(row)});
  }

  void send_state() {
    if (client_count() == 0) return;
    const SimulationStats stats = simulation_.stats();
    const Status physics = simulation_.status();
    const Driver::Report report = driver_.report();
    const World world = simulation_.world();
    ViewState state = {.step = stats.step,
                       .time = stats.time,
                       .hash = stats.hash,
                       .realtime_factor = stats.realtime_factor,
                       .paused = simulation_.paused(),
                       .speed = report.speed,
                       .camera = report.camera.camera,
                       .dropped = report.camera.dropped,
                       .warnings = stats.warnings,
                       .error = physics.ok() ? report.camera.error : physics.error().to_string(),
                       .controller = controller_,
                       .history_start = report.history_start,
                       .run = report.returns,
                       .serial = world.compiled() == nullptr ? 0 : world.serial()};
    if (state.error.empty()) state.error = pictures_.error();
    const std::lock_guard lock(clients_mutex_);
    state.clients = static_cast<int>(clients_.size());
    const web::Frame frame = text_frame(state_message(state));
    for (const auto& [id, client] : clients_) client->outbox.replace(kStateSlot, frame);
  }

  Simulation& simulation_;
  const ViewOptions options_;
  const std::string token_;
  std::atomic<int64_t> controller_ = 0;  // written on the network thread, read by the publisher's
  mutable std::mutex clients_mutex_;     // guards clients_
  std::map<int64_t, web::ClientPtr> clients_;
  std::mutex stop_mutex_;
  PictureSender pictures_;
  Publisher publisher_;
  Driver driver_;
  Inspector inspector_;
  web::WebSocketServer web_;
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
