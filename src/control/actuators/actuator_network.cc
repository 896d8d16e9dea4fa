#include "control/actuators/actuator_network.h"

#include <algorithm>

#include "policy/network.h"

namespace gloam {
namespace {

/// An ONNX network with one input and one output tensor.
class OnnxActuatorNetwork final : public ActuatorNetwork {
 public:
  explicit OnnxActuatorNetwork(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  size_t inputs() const override { return network_->inputs()[0].size; }
  size_t outputs() const override { return network_->outputs()[0].size; }
  bool evaluate(std::span<const float> inputs, std::span<float> outputs) override {
    std::ranges::copy(inputs, network_->input(0).begin());
    if (!network_->run()) return false;
    std::copy_n(network_->output(0).begin(), outputs.size(), outputs.begin());
    return true;
  }
  std::unique_ptr<ActuatorNetwork> share() const override {
    return std::make_unique<OnnxActuatorNetwork>(network_->share());
  }

 private:
  std::unique_ptr<Network> network_;
};

}  // namespace

Result<std::unique_ptr<ActuatorNetwork>> load_actuator_network(const std::filesystem::path& file) {
  GLOAM_TRY(LoadedNetwork loaded, load_onnx_network(file));
  if (loaded.network->inputs().size() != 1 || loaded.network->outputs().size() != 1)
    return Error{ErrorKind::kInput,
                 "an actuator network must have one input tensor and one output tensor",
                 {file.string(), 0, 0},
                 "recurrent networks (LSTM, GRU) are not supported: export one with histories"};
  return std::unique_ptr<ActuatorNetwork>(
      std::make_unique<OnnxActuatorNetwork>(std::move(loaded.network)));
}

}  // namespace gloam
