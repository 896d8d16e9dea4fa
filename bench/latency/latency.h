#pragma once
// Latency of bridges: from the moment at which an instant exists to its message in another process.
// A bridge is measured by a client: one file with a function and a row of kClients.

#include <cstdint>
#include <span>
#include <string>

#include "gloam/scene/bridge.h"

namespace gloam::latency {

/// A topic of the measured scene.
struct Subject {
  std::string name;
  std::string topic;
  int rate;  ///< [Hz]
};

/// Report of a client's process on a message.
struct Arrival {
  uint64_t instant = 0;  ///< simulation time of its stamp [ns]
  double at = 0;         ///< when it was there, of the machine's clock [ms]
  uint64_t bytes = 0;
};

/// CLOCK_MONOTONIC, the same in all processes [ms].
double now_ms();
/// Tells the measuring process. False: it is gone.
bool tell(int out, const Arrival& arrival);

struct Client {
  const char* name;  ///< "ros2"
  void (*choose)(BridgeOptions* options);
  /// In a process of its own: subscribes to `topic` at the bridge's `address` and tells of its
  /// messages until it is killed.
  int (*run)(const std::string& address, const std::string& topic, int out);
};
std::span<const Client> clients();

int run_ros2_client(const std::string& address, const std::string& topic, int out);
int run_zmq_client(const std::string& address, const std::string& topic, int out);
int run_shm_client(const std::string& address, const std::string& topic, int out);
int run_rclpy_client(const std::string& address, const std::string& topic, int out);
int run_foxglove_client(const std::string& address, const std::string& topic, int out);

}  // namespace gloam::latency
