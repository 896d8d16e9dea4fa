#include "policy/test/linear_network.h"

#include <unistd.h>

#include <atomic>

#include "base/files.h"

namespace gloam {
namespace fs = std::filesystem;

std::map<std::string, std::unique_ptr<Network>> PolicyFolder::networks_;

LinearNetwork::LinearNetwork(std::vector<NetworkPort> inputs, std::vector<NetworkPort> outputs,
                             std::vector<float> weights, std::vector<float> bias)
    : weights_(std::move(weights)), bias_(std::move(bias)) {
  inputs_ = std::move(inputs);
  outputs_ = std::move(outputs);
  for (const NetworkPort& port : inputs_) in_.emplace_back(port.size);
  for (const NetworkPort& port : outputs_) out_.emplace_back(port.size);
}

bool LinearNetwork::run() {
  std::vector<float> x;
  for (const auto& input : in_) x.insert(x.end(), input.begin(), input.end());
  size_t row = 0;
  for (auto& output : out_) {
    for (float& y : output) {
      y = bias_[row];
      for (size_t i = 0; i < x.size(); ++i) y += weights_[row * x.size() + i] * x[i];
      ++row;
    }
  }
  return true;
}

PolicyFolder::PolicyFolder() {
  static std::atomic<int> count{0};
  folder_ = fs::temp_directory_path() /
            ("gloam_policy_test_" + std::to_string(::getpid()) + "_" + std::to_string(++count));
  fs::create_directories(folder_);
}

PolicyFolder::~PolicyFolder() {
  std::error_code code;
  fs::remove_all(folder_, code);
}

fs::path PolicyFolder::write(const std::string& name, const std::string& text) const {
  static_cast<void>(write_text_file_atomic(folder_ / name, text));
  return folder_ / name;
}

void PolicyFolder::add(const std::string& name, const LinearNetwork& network) {
  networks_[path(name).string()] = network.share();
}

Result<LoadedNetwork> PolicyFolder::load(const fs::path& path) {
  const auto found = networks_.find(path.string());
  if (found == networks_.end()) return Error{ErrorKind::kIo, "no such file", {path.string(), 0, 0}};
  return LoadedNetwork{found->second->share(), {}};
}

}  // namespace gloam
