#pragma once
// Ros2Service: one service of the node, free of DDS.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam::bridge {

/// One of `answer` and `answer_later` is set. Both get the request and give the response as CDR
/// with its head of four bytes; they are called on the node's service thread, one after the other.
struct Ros2Service {
  std::string name;  ///< "/get_entities", full
  std::string type;  ///< "simulation_interfaces/srv/StepSimulation"
  /// Error: the request is damaged; it stays without an answer.
  std::function<Result<std::vector<uint8_t>>(std::span<const uint8_t> request)> answer = {};
  /// `reply` may be kept and called once, on any thread.
  std::function<void(std::span<const uint8_t> request,
                     std::function<void(std::vector<uint8_t>)> reply)>
      answer_later = {};
  std::string hash = {};  ///< of its type, "RIHS01_…"; empty = not told
};

}  // namespace gloam::bridge
