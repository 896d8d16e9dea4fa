// gloam::Bridges: starts the bridges of a scene, around one Operator and one token.

#include <algorithm>
#include <cstdlib>
#include <utility>

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
    Status status;
    const auto start = [&](const auto& row) {
      if (const auto& own = options.*row.options; own && status.ok())
        status = add(row.start(context_, *own));
    };
    std::apply([&](const auto&... rows) { (start(rows), ...); }, bridge::kBridges);
    return status;
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

std::vector<BridgeKind> bridge_kinds() {
  const auto kind = []<size_t kRow>(std::integral_constant<size_t, kRow>) {
    const auto& row = std::get<kRow>(bridge::kBridges);
    const auto request = [](BridgeOptions* options) {
      auto& own = options->*std::get<kRow>(bridge::kBridges).options;
      if (!own) own.emplace();
    };
    return BridgeKind{row.name, row.help, request};
  };
  return [&]<size_t... kRows>(std::index_sequence<kRows...>) {
    return std::vector<BridgeKind>{kind(std::integral_constant<size_t, kRows>())...};
  }(std::make_index_sequence<std::tuple_size_v<decltype(bridge::kBridges)>>());
}

Result<std::unique_ptr<Bridges>> Bridges::start(Simulation& simulation,
                                                const BridgeOptions& options, LogPlayer* player) {
  GLOAM_TRY(std::string token, token_of_environment());
  auto bridges = std::make_unique<BridgesOfRun>(simulation, player, std::move(token));
  GLOAM_TRY_STATUS(bridges->start_all(options));
  return std::unique_ptr<Bridges>(std::move(bridges));
}

}  // namespace gloam
