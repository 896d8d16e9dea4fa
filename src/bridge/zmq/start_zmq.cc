// The bridge to ZeroMQ: operations at a ROUTER socket, streams at an XPUB socket (docs/zmq.md).

#include <fmt/format.h>

#include <utility>

#include "bridge/bridge_list.h"
#include "bridge/zmq/address_file.h"
#include "bridge/zmq/dispatcher.h"
#include "bridge/zmq/server.h"
#include "bridge/zmq/streams/shared_ring.h"
#include "bridge/zmq/streams/streams.h"

namespace gloam::bridge {
namespace zeromq {
namespace {

class ZmqBridge final : public Bridge {
 public:
  static Result<std::unique_ptr<Bridge>> start(const BridgeContext& context,
                                               const ZmqOptions& options) {
    GLOAM_TRY(std::unique_ptr<Endpoints> endpoints, Endpoints::bind(options));
    GLOAM_TRY(std::unique_ptr<Outbox> outbox, Outbox::create());
    GLOAM_TRY(std::unique_ptr<AddressFile> file,
              AddressFile::write({.operations = endpoints->operations_address,
                                  .streams = endpoints->streams_address,
                                  .port = endpoints->port,
                                  .token = context.token,
                                  .public_key = endpoints->public_key,
                                  .scene = context.simulation.world().scene().name}));
    if (options.shared_memory) remove_stale_rings();
    std::unique_ptr<ZmqBridge> bridge(
        new ZmqBridge(context, options, std::move(endpoints), std::move(outbox), std::move(file)));
    GLOAM_TRY_STATUS(bridge->streams_.open());
    bridge->server_.start();
    return std::unique_ptr<Bridge>(std::move(bridge));
  }

  // The file first, so that nobody finds a server that ends; then whoever uses the sockets.
  ~ZmqBridge() override {
    file_.reset();
    is_stopping_ = true;
    dispatcher_.stop();
    server_.stop();
  }

  std::string name() const override { return "zmq"; }
  std::string address() const override { return address_; }
  BridgeStats stats() const override {
    const ServerCounts& counts = server_.counts();
    return {.clients = sessions_.count(),
            .messages_out = counts.sent,
            .messages_in = dispatcher_.obeyed(),
            .refused = dispatcher_.refused() + counts.malformed,
            .dropped = counts.dropped + outbox_->dropped() + streams_.dropped()};
  }
  Status status() const override { return server_.status(); }

 private:
  ZmqBridge(const BridgeContext& context, const ZmqOptions& options,
            std::unique_ptr<Endpoints> endpoints, std::unique_ptr<Outbox> outbox,
            std::unique_ptr<AddressFile> file)
      : file_(std::move(file)),
        outbox_(std::move(outbox)),
        address_(fmt::format("{}, token {}", endpoints->operations_address, context.token)),
        sessions_(context.simulation),
        streams_(context.simulation, *outbox_, layouts_, options.shared_memory),
        dispatcher_({.context = context,
                     .sessions = sessions_,
                     .layouts = layouts_,
                     .operations_address = endpoints->operations_address,
                     .streams_address = endpoints->streams_address,
                     .shared_memory = options.shared_memory,
                     .is_stopping = is_stopping_},
                    *outbox_),
        server_(std::move(endpoints), *outbox_, events()) {}

  ServerEvents events() {
    return {.on_request =
                [this](const Envelope& from, std::span<const uint8_t> request) {
                  dispatcher_.dispatch(from, request);
                },
            .on_subscription = [this](const std::string& topic,
                                      bool is_wanted) { streams_.set_wanted(topic, is_wanted); },
            .on_gone = [this](const std::string& client) { sessions_.end(client); },
            .watched = [this] { return sessions_.holders(); }};
  }

  std::unique_ptr<AddressFile> file_;
  std::unique_ptr<Outbox> outbox_;
  const std::string address_;
  std::atomic<bool> is_stopping_{false};
  StateLayouts layouts_;
  Sessions sessions_;
  Streams streams_;
  Dispatcher dispatcher_;
  Server server_;  // last: its thread calls the others
};

}  // namespace
}  // namespace zeromq

Result<std::unique_ptr<Bridge>> start_zmq(const BridgeContext& context, const ZmqOptions& options) {
  return zeromq::ZmqBridge::start(context, options);
}

}  // namespace gloam::bridge
