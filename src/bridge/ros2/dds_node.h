#pragma once
// DdsNode: one DDS participant that other programs see as one ROS 2 node: its writers and readers
// of encoded messages, and what rmw expects of their names, types, hashes and user data. The facts
// of the wire are in rmw_fastrtps and rmw_dds_common.

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "bridge/ros2/dds_api.h"
#include "gloam/result.h"
#include "gloam/topics.h"

namespace gloam::bridge {

struct DdsNodeOptions {
  int domain = 0;        ///< 0 … 232
  bool network = false;  ///< all network cards; else loopback alone
  std::string node = "gloam", ns = "/";
};

/// A topic of DDS as one endpoint has it.
struct DdsEndpoint {
  std::string topic, type;     ///< names of DDS: "rt/clock", "rosgraph_msgs::msg::dds_::Clock_"
  std::string type_hash = {};  ///< "RIHS01_…"; empty = not told
  TopicQos qos = {};
  bool is_large = false;  ///< sent by a thread of DDS's own, in pieces
};

using DdsRequest = rtps::SampleIdentity;

/// A message that came in. `data` lives as long as the callback.
struct DdsSample {
  std::span<const uint8_t> data;  ///< CDR with its head
  std::string writer;             ///< GUID of who wrote it, bytes
  DdsRequest request;             ///< of a request: whom a reply is for
};

class DdsWriter {
 public:
  virtual ~DdsWriter() = default;
  virtual int readers() const = 0;  ///< that match now
  /// Any thread; copies. False: lost.
  virtual bool write(std::span<const uint8_t> data) = 0;
  /// The reply to a request; waits a moment for its client's reader to be known.
  virtual bool reply(std::span<const uint8_t> data, const DdsRequest& request) = 0;
};

class DdsReader {
 public:
  virtual ~DdsReader() = default;
  virtual int writers() const = 0;  ///< that match now
};

class DdsNode {
 public:
  static Result<std::unique_ptr<DdsNode>> create(const DdsNodeOptions& options);
  /// After all of its endpoints.
  ~DdsNode();

  /// `on_match` comes on a thread of DDS when readers come or go; it must not block.
  Result<std::unique_ptr<DdsWriter>> add_writer(const DdsEndpoint& endpoint,
                                                std::function<void()> on_match = {});
  /// `on_sample` comes on a thread of DDS, for one reader one at a time.
  Result<std::unique_ptr<DdsReader>> add_reader(const DdsEndpoint& endpoint,
                                                std::function<void(const DdsSample&)> on_sample);
  /// Tells other nodes which endpoints are this node's; after some have been added or taken away.
  void announce();

 private:
  class Impl;
  explicit DdsNode(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

}  // namespace gloam::bridge
