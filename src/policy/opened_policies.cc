#include "policy/opened_policies.h"

#include <map>
#include <mutex>
#include <utility>

namespace gloam {
namespace {
namespace fs = std::filesystem;

// Entries stay: a checkpoint may be restored after the program has released its policy.
struct OpenedPolicies {
  std::mutex mutex;
  std::map<std::pair<fs::path, fs::path>, std::weak_ptr<const Policy>> policies;
};

OpenedPolicies& opened() {
  static OpenedPolicies instance;
  return instance;
}

}  // namespace

Result<std::shared_ptr<const Policy>> open_policy(const fs::path& network,
                                                  const fs::path& settings) {
  GLOAM_TRY(std::shared_ptr<const Policy> policy, Policy::load(network, settings));
  const std::lock_guard lock(opened().mutex);
  opened().policies[{network, settings}] = policy;
  return policy;
}

Result<std::shared_ptr<const Policy>> find_opened_policy(const fs::path& network,
                                                         const fs::path& settings) {
  {
    const std::lock_guard lock(opened().mutex);
    const auto found = opened().policies.find({network, settings});
    if (found == opened().policies.end()) return std::shared_ptr<const Policy>();
    if (std::shared_ptr<const Policy> policy = found->second.lock()) return policy;
  }
  return open_policy(network, settings);
}

}  // namespace gloam
