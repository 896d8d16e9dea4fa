// Any bytes as a behaviour tree: they are refused with a reason, or a tree that can be ticked.

#include <cstdint>
#include <cstdlib>

#include "sim/agents/behavior_tree.h"

namespace {

class Host final : public gloam::TreeHost {
 public:
  double time() const override { return now; }
  gloam::NodeStatus go_to(gloam::Vec3d, double, bool) override { return next(); }
  gloam::NodeStatus wander(double, bool) override { return next(); }
  gloam::NodeStatus follow(const std::string&, double, double) override { return next(); }
  gloam::NodeStatus face(const std::string&) override { return next(); }
  void stand() override {}
  double robot_distance() const override { return 1; }
  double agent_distance() const override { return 1; }
  double distance_to(gloam::Vec3d) const override { return 1; }
  bool was_touched() const override { return false; }
  double now = 0;

 private:
  gloam::NodeStatus next() { return static_cast<gloam::NodeStatus>(1 + (calls_++ % 3)); }
  int calls_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto tree = gloam::read_behavior_tree(text, "fuzz.xml");
  if (!tree.ok()) {
    if (tree.error().message.empty()) std::abort();
    return 0;
  }
  Host host;
  gloam::TreeState state(*tree);
  for (int i = 0; i < 8; ++i) host.now += 0.1, state.tick(&host);
  return 0;
}
