#pragma once
// Small Worlds with known motions for the tests of the runtime.

#include <gtest/gtest.h>

#include <string>

#include "gloam/simulation.h"
#include "scene/test/temp_folder.h"

namespace gloam {

/// A ball without weight that flies along +X at 1 m/s past a wall, with a camera on it and one in
/// the world. 2 ms steps.
inline const char* const kFlight = R"(
<mujoco model="flight">
  <option timestep="0.002" gravity="0 0 0"/>
  <worldbody>
    <light pos="0 0 4" dir="0 0 -1"/>
    <geom name="wall" type="box" size="5 0.1 5" pos="0 3.1 0" rgba="0.7 0.6 0.5 1"/>
    <camera name="fixed" pos="0 -2 0" xyaxes="1 0 0 0 0 1"/>
    <body name="ball">
      <freejoint name="ball"/>
      <geom name="ball" type="sphere" size="0.2" mass="1" rgba="0.2 0.4 0.8 1"/>
      <camera name="rider" pos="0 0.5 0" xyaxes="1 0 0 0 0 1"/>
    </body>
  </worldbody>
  <keyframe><key name="go" qpos="0 0 0 1 0 0 0" qvel="1 0 0 0 0 0"/></keyframe>
</mujoco>)";

/// Loads and compiles through the public API; fails the test when that cannot be done.
inline World compile_file(const std::filesystem::path& file) {
  const Result<Scene> scene = load_scene(file);
  if (!scene.ok()) {
    ADD_FAILURE() << scene.error().to_string();
    abort();
  }
  Result<World> world = World::compile(*scene);
  if (!world.ok()) {
    ADD_FAILURE() << world.error().to_string();
    abort();
  }
  return std::move(*world);
}

/// The same of the scene file `text` in `folder`.
inline World compile_text(const TempFolder& folder, const std::string& name,
                          const std::string& text) {
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  return compile_file(folder.write(name, text));
}

/// kFlight as the only robot "a" of a scene; `more` = lines of TOML that follow.
inline World flight(const TempFolder& folder, const std::string& more = "") {
  folder.write("flight.xml", kFlight);
  folder.write("nothing.xml", "<mujoco/>");
  return compile_text(folder, "scene.toml",
                      "[environment]\nfile = \"nothing.xml\"\n[[robot]]\nname = \"a\"\nfile = "
                      "\"flight.xml\"\nkeyframe = \"go\"\n" +
                          more);
}

inline std::unique_ptr<Simulation> simulate(const World& world,
                                            const SimulationOptions& options = {}) {
  auto simulation = Simulation::create(world, options);
  if (!simulation.ok()) {
    ADD_FAILURE() << simulation.error().to_string();
    abort();
  }
  return std::move(*simulation);
}

}  // namespace gloam
