#pragma once
// ServiceServer: the node's services. Requests wait in one queue and are answered one after the
// other on a thread of their own, since some take as long as a compilation.

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "base/threads/bounded_queue.h"
#include "bridge/ros2/dds_node.h"
#include "bridge/ros2/ros2_service.h"

namespace gloam::bridge {

class ServiceServer {
 public:
  explicit ServiceServer(DdsNode& node) : node_(node) {}
  ~ServiceServer() { stop(); }

  Status add(Ros2Service service);
  void start();
  void stop();
  int64_t answered() const { return answered_; }
  int64_t refused() const { return refused_; }

 private:
  struct Entry {
    Ros2Service service;
    std::shared_ptr<DdsWriter> writer;  // shared with replies that come later
    std::unique_ptr<DdsReader> reader;
  };
  struct Waiting {
    const Entry* entry;
    std::vector<uint8_t> bytes;
    DdsRequest request;
  };

  void run();
  void answer(const Waiting& waiting);

  DdsNode& node_;
  std::vector<std::unique_ptr<Entry>> entries_;
  static constexpr size_t kMaxQueuedRequests = 256;  // further ones are refused
  BoundedQueue<Waiting> queue_{{.items = kMaxQueuedRequests}, Overflow::kReject};
  std::atomic<int64_t> answered_{0}, refused_{0};
  std::thread thread_;
};

}  // namespace gloam::bridge
