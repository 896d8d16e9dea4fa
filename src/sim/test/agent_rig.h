#pragma once
// Worlds with agents for the tests of sim/: an environment in MJCF, and people in it.

#include <gtest/gtest.h>

#include "scene/test/temp_folder.h"
#include "sim/agents/agents.h"
#include "sim/loop/stepper.h"
#include "test_world.h"

namespace gloam {

/// A place of `size` m with walls on all sides, at (0, 0); `more` = bodies and geoms in it.
inline std::string agent_place(const std::string& more, double size = 12) {
  const std::string half = std::to_string(size / 2), s = std::to_string(size / 2 + 0.1);
  const auto wall = [&](const std::string& edges, const std::string& p) {
    return "<geom type='box' size='" + edges + "' pos='" + p + "'/>";
  };
  return "<mujoco><option timestep='0.002'/><worldbody><geom type='plane' size='20 20 0.1'/>" +
         wall("0.1 " + half + " 1.3", s + " 0 1.3") +
         wall("0.1 " + half + " 1.3", "-" + s + " 0 1.3") +
         wall(half + " 0.1 1.3", "0 " + s + " 1.3") + wall(half + " 0.1 1.3", "0 -" + s + " 1.3") +
         more + "</worldbody></mujoco>";
}

class AgentRig {
 public:
  explicit AgentRig(const std::string& place) {
    scene.environment.file = folder.write("place.xml", place);
    scene.name = "agents";
  }

  AgentOptions& add(const std::string& name, Vec3 position, const std::string& behavior) {
    AgentOptions& agent = scene.agents.emplace_back();
    agent.name = name;
    agent.position = position;
    agent.behavior = behavior;
    agent.speed = 1.3;
    return agent;
  }

  std::shared_ptr<const CompiledWorld> compile() const {
    const Result<World> world = World::compile(scene);
    if (!world.ok()) {
      ADD_FAILURE() << world.error().to_string();
      abort();
    }
    return world->compiled();
  }

  /// A stepper at the beginning.
  std::unique_ptr<Stepper> stepper(uint64_t seed = 1) const {
    auto made = Stepper::create(compile(), seed, {});
    if (!made.ok()) {
      ADD_FAILURE() << made.error().to_string();
      abort();
    }
    return std::move(*made);
  }

  TempFolder folder;
  Scene scene;
};

inline const Agents& agents_of(const Stepper& stepper) {
  return static_cast<const Agents&>(*stepper.find_effect("agents"));
}

inline const AgentMotion& motion_of(const Stepper& stepper, size_t row) {
  return agents_of(stepper).bodies()[row].motion;
}

}  // namespace gloam
