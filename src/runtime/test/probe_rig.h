#pragma once
// Scenes with probes, and what the probes of a simulation say.

#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <vector>

#include "gloam/simulation.h"
#include "scenes.h"

namespace gloam {

/// A scene without light of its own around `bodies` (MJCF), 2 ms steps; `more` = lines of TOML.
inline World probe_world(const TempFolder& folder, const std::string& more,
                         const std::string& bodies = "") {
  folder.write("around.xml",
               "<mujoco><visual><headlight active=\"0\"/></visual>"
               "<option timestep=\"0.002\" integrator=\"implicitfast\"/>"
               "<worldbody>" +
                   bodies + "</worldbody></mujoco>");
  return compile_text(folder, "scene.toml", "[environment]\nfile = \"around.xml\"\n" + more);
}

/// Samples of sensors over `seconds` of a new simulation, by the order of `names`.
inline std::vector<std::vector<SensorMessage>> read_probes(const World& world,
                                                           const std::vector<std::string>& names,
                                                           double seconds) {
  auto simulation = simulate(world);
  std::vector<std::vector<SensorMessage>> read(names.size());
  std::mutex mutex;
  std::vector<std::unique_ptr<SensorStream>> streams;
  for (size_t i = 0; i < names.size(); ++i) {
    auto opened = simulation->open_sensor({names[i], true}, [&, i](const SensorMessage& message) {
      const std::lock_guard lock(mutex);
      read[i].push_back(message);
    });
    if (!opened.ok()) {
      ADD_FAILURE() << opened.error().to_string();
      return read;
    }
    streams.push_back(std::move(*opened));
  }
  const int64_t steps = std::llround(seconds * simulation->step_rate().value());
  EXPECT_TRUE(simulation->run_until(steps).ok());
  for (const auto& stream : streams) {
    stream->flush();
    EXPECT_TRUE(stream->status().ok()) << stream->status().error().to_string();
  }
  return read;
}
inline std::vector<SensorMessage> read_probe(const World& world, const std::string& name,
                                             double seconds) {
  return read_probes(world, {name}, seconds).front();
}

}  // namespace gloam
