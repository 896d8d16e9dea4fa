// gloam::Bridges: starts the bridges of a scene, around one Operator and one token.

#include <algorithm>
#include <cstdlib>

#include "bridge/bridge_list.h"
#include "web/access.h"

namespace gloam {
namespace {

constexpr const char* kTokenVariable = "GLOAM_TOKEN";
constexpr size_t kShortestToken = 16;

// The user's own, so that clients can be started before the simulation; else a new one.
Result<std::string> token_of_environment() {
  const char* given = std::getenv(kTokenVariable);
  if (given == nullptr || *given == '\0') return web::make_token();
  const std::string token = given;
  const auto is_odd = [](unsigned char c) { return c <= ' ' || c >= 127; };
  if (token.size() >= kShortestToken && std::none_of(token.begin(), token.end(), is_odd))
    return token;
  return Error{ErrorKind::kUsage,
               "GLOAM_TOKEN must have at least 16 characters and no spaces",
               {},
               "unset it to generate a new token at each start"};
}

class BridgesOfRun final : public Bridges {
 public:
  BridgesOfRun(Simulation& simulation, LogPlayer* player, std::string token)
      : operations_(simulation), context_{simulation, operations_, player, std::move(token)} {}

  Status start_all(const BridgeOptions& options) {
    if (options.ros2) GLOAM_TRY_STATUS(add(bridge::start_ros2(context_, *options.ros2)));
    if (options.zmq) GLOAM_TRY_STATUS(add(bridge::start_zmq(context_, *options.zmq)));
    if (options.foxglove)
      GLOAM_TRY_STATUS(add(bridge::start_foxglove(context_, *options.foxglove)));
    return {};
  }
  const std::vector<std::unique_ptr<Bridge>>& list() const override { return bridges_; }
  bool end_asked() const override { return operations_.end_asked(); }

 private:
  Status add(Result<std::unique_ptr<Bridge>> bridge) {
    if (!bridge.ok()) return bridge.error();
    bridges_.push_back(std::move(*bridge));
    return {};
  }

  bridge::Operator operations_;
  const bridge::BridgeContext context_;
  std::vector<std::unique_ptr<Bridge>> bridges_;  // end first
};

}  // namespace

Result<std::unique_ptr<Bridges>> Bridges::start(Simulation& simulation,
                                                const BridgeOptions& options, LogPlayer* player) {
  GLOAM_TRY(std::string token, token_of_environment());
  auto bridges = std::make_unique<BridgesOfRun>(simulation, player, std::move(token));
  GLOAM_TRY_STATUS(bridges->start_all(options));
  return std::unique_ptr<Bridges>(std::move(bridges));
}

}  // namespace gloam
