#pragma once
// ActuatorNetwork: the learned map of a [[robot.actuator]] with `network`.

#include <filesystem>
#include <functional>
#include <memory>
#include <span>

#include "gloam/result.h"

namespace gloam {

/// One thread at a time.
class ActuatorNetwork {
 public:
  virtual ~ActuatorNetwork() = default;
  virtual size_t inputs() const = 0;   ///< numbers for one joint
  virtual size_t outputs() const = 0;  ///< numbers for one joint
  /// The same inputs give the same bits. False: the library reported an error.
  virtual bool evaluate(std::span<const float> inputs, std::span<float> outputs) = 0;
  /// Returns a network with the same weights for another thread.
  virtual std::unique_ptr<ActuatorNetwork> share() const = 0;
};

using ActuatorNetworkLoader =
    std::function<Result<std::unique_ptr<ActuatorNetwork>>(const std::filesystem::path&)>;

/// Reads an ONNX file. Errors: as for load_onnx_network(); several inputs or outputs.
Result<std::unique_ptr<ActuatorNetwork>> load_actuator_network(const std::filesystem::path& file);

}  // namespace gloam
