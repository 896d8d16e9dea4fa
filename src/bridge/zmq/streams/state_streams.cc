#include "bridge/zmq/streams/state_streams.h"

#include <chrono>
#include <utility>

#include "bridge/zmq/streams/subscription.h"

namespace gloam::bridge::zeromq {
namespace {

constexpr size_t kMaxStateRates = 16;

PackBuffer state_header(const Snapshot& snapshot, uint64_t sequence) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  PackBuffer buffer;
  Packer packer(buffer);
  packer.pack_map(6);
  pack_pair(packer, "type", std::string_view("state"));
  pack_pair(packer, "step", snapshot.step());
  pack_pair(packer, "time", snapshot.time());
  pack_pair(packer, "encoding", std::string_view("msgpack"));
  pack_pair(packer, "sequence", sequence);
  pack_pair(packer, "sent_ns", static_cast<int64_t>(std::chrono::nanoseconds(now).count()));
  return buffer;
}

}  // namespace

void StateStreams::set_wanted(const std::string& subscription, bool is_wanted) {
  if (is_wanted)
    worker_.post([this, subscription] { open(subscription); });
  else
    worker_.post_always([this, subscription] { streams_.close(subscription); });
}

void StateStreams::open(const std::string& subscription) {
  if (streams_.has(subscription)) return;
  if (streams_.size() >= kMaxStateRates)
    return publish_error(subscription, {ErrorKind::kUsage, "too many different state rates"});
  auto stream = open_stream(subscription);
  if (!stream.ok()) return publish_error(subscription, stream.error());
  streams_.add(subscription, std::move(*stream));
}

Result<std::unique_ptr<SnapshotStream>> StateStreams::open_stream(const std::string& subscription) {
  GLOAM_TRY(const Rational rate, parse_rate(subscription));
  SnapshotRequest request{.rate = rate};
  request.on_end = [this, subscription](const Error& why) {
    publish_error(subscription, why);
    worker_.post_always([this, subscription] { streams_.close(subscription); });
  };
  return simulation_.open_snapshots(
      request, [this, subscription, sequence = uint64_t{0}](const Snapshot& snapshot) mutable {
        const auto layout = layouts_.of(snapshot);
        if (!layout.ok()) return;
        PackBuffer body;
        Packer packer(body);
        packer.pack_map(kStatePairs);
        pack_state(packer, snapshot, *layout);
        const PackBuffer header = state_header(snapshot, sequence++);
        outbox_.publish({subscription, zmq::message_t(header.data(), header.size()),
                         zmq::message_t(body.data(), body.size())});
      });
}

void StateStreams::publish_error(const std::string& subscription, const Error& error) {
  outbox_.publish(error_publication(subscription, error));
}

}  // namespace gloam::bridge::zeromq
