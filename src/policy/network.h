#pragma once
// Networks of policies: f32 tensors in, f32 tensors out.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gloam/joints/policy.h"
#include "gloam/result.h"

namespace gloam {

/// A network that is ready to run, with buffers of its own. One thread at a time.
class Network {
 public:
  virtual ~Network() = default;
  const std::vector<NetworkPort>& inputs() const { return inputs_; }
  const std::vector<NetworkPort>& outputs() const { return outputs_; }

  /// Buffers of the tensors, valid as long as the network: an input is written before run(), an
  /// output read after it. `i` as in inputs() and outputs().
  virtual std::span<float> input(size_t i) = 0;
  virtual std::span<const float> output(size_t i) const = 0;
  /// Computes the outputs. The same inputs give the same bits. False: the library reported an
  /// error.
  virtual bool run() = 0;
  /// A network of the same weights with other buffers.
  virtual std::unique_ptr<Network> share() const = 0;

 protected:
  std::vector<NetworkPort> inputs_, outputs_;
};

/// A network and the metadata of its file.
struct LoadedNetwork {
  std::unique_ptr<Network> network;
  std::vector<std::pair<std::string, std::string>> metadata;
};

/// Reads networks. Tests use their own.
using NetworkLoader = Result<LoadedNetwork> (*)(const std::filesystem::path&);

/// An ONNX file, computed by OpenVINO on the CPU: f32, one thread. Open batch sizes become 1.
/// Errors: those of parse_onnx(); OpenVINO is missing (the hint has the remedy) or rejects the
/// network; inputs or outputs that are not f32; sizes that are open or exceed kLargestOnnxTensors
/// in total.
Result<LoadedNetwork> load_onnx_network(const std::filesystem::path& path);

}  // namespace gloam
