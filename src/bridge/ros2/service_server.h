#pragma once
// ServiceServer: the node's services. Requests wait in one queue and are answered one after the
// other on a thread of their own, since some take as long as a compilation.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

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
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<Waiting> queue_;
  bool stopping_ = false;
  std::atomic<int64_t> answered_{0}, refused_{0};
  std::thread thread_;
};

}  // namespace gloam::bridge
