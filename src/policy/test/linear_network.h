#pragma once
// Networks of tests: y = W x + b of the concatenated inputs, without any library.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "policy/network.h"

namespace gloam {

class LinearNetwork final : public Network {
 public:
  /// `weights`: by outputs, then by numbers of the inputs in their order.
  LinearNetwork(std::vector<NetworkPort> inputs, std::vector<NetworkPort> outputs,
                std::vector<float> weights, std::vector<float> bias);

  std::span<float> input(size_t i) override { return in_[i]; }
  std::span<const float> output(size_t i) const override { return out_[i]; }
  bool run() override;
  std::unique_ptr<Network> share() const override { return std::make_unique<LinearNetwork>(*this); }

 private:
  std::vector<float> weights_, bias_;
  std::vector<std::vector<float>> in_, out_;
};

/// A folder for settings and the networks that test_loader() finds by their files' names.
class PolicyFolder {
 public:
  PolicyFolder();
  ~PolicyFolder();

  std::filesystem::path write(const std::string& name, const std::string& text) const;
  void add(const std::string& name, const LinearNetwork& network);
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  static Result<LoadedNetwork> load(const std::filesystem::path& path);

 private:
  std::filesystem::path folder_;
  static std::map<std::string, std::unique_ptr<Network>> networks_;
};

}  // namespace gloam
