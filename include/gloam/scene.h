#pragma once
// Scene: the user's description, freely editable until it is compiled into a World. Every node
// stores its file and line. There is one options struct per feature, used by TOML, C++ and Python.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/agent.h"
#include "gloam/scene/bridge.h"
#include "gloam/scene/camera.h"
#include "gloam/scene/effect.h"
#include "gloam/scene/environment.h"
#include "gloam/scene/lidar.h"
#include "gloam/scene/light.h"
#include "gloam/scene/material.h"
#include "gloam/scene/metric.h"
#include "gloam/scene/object.h"
#include "gloam/scene/planner.h"
#include "gloam/scene/probe.h"
#include "gloam/scene/robot.h"
#include "gloam/scene/robot_model.h"
#include "gloam/scene/run.h"
#include "gloam/scene/sensor.h"
#include "gloam/scene/sky.h"
#include "gloam/scene/topic.h"
#include "gloam/scene/volume.h"

namespace gloam {

struct Scene {
  std::string name = "scene";
  std::filesystem::path file = {};  ///< file it was read from; empty for scenes made in code
  FileAccess access = {};
  EnvironmentOptions environment = {};
  std::vector<PropOptions> props = {};
  std::vector<ObjectOptions> objects = {};
  std::vector<HeightFieldOptions> hfields = {};
  std::vector<RobotOptions> robots = {};        ///< in source order
  std::vector<OverrideOptions> overrides = {};  ///< in source order
  std::vector<CameraOptions> cameras = {};
  std::vector<LidarOptions> lidars = {};
  std::vector<MaterialOptions> materials = {};
  std::vector<LightOptions> lights = {};
  std::optional<SkyOptions> sky = {};
  std::optional<BlackoutOptions> blackout = {};
  std::vector<VolumeOptions> volumes = {};
  std::vector<GasOptions> gases = {};
  std::vector<FireOptions> fires = {};
  std::vector<SmokeOptions> smokes = {};
  std::vector<RotorOptions> rotors = {};
  std::vector<DustOptions> dusts = {};
  std::optional<WeatherOptions> weather = {};
  std::optional<AdversityOptions> adversity = {};
  std::vector<WaterOptions> waters = {};
  std::vector<SoilOptions> soils = {};
  NavigationOptions navigation = {};
  std::vector<AgentOptions> agents = {};
  std::vector<CrowdOptions> crowds = {};
  std::vector<VisualOptions> visuals = {};
  std::vector<PushOptions> pushes = {};
  std::vector<StereoOptions> stereo = {};  ///< a compiled Scene has their cameras in `cameras`
  std::vector<RgbdOptions> rgbd = {};      ///< as for `stereo`
  std::vector<SensorOptions> sensors = {};
  std::vector<ProbeOptions> probes = {};
  std::vector<TemperatureOptions> temperatures = {};
  std::vector<RandomizeOptions> randomize = {};  ///< empty in a compiled Scene
  SimOptions sim = {};
  RenderOptions render = {};
  std::vector<TopicOptions> topics = {};
  std::vector<MetricOptions> metrics = {};
  std::vector<GoalOptions> goals = {};
  std::optional<PlannerOptions> planner = {};
  RecordOptions record = {};
  BridgeOptions bridge = {};
  /// Path of a bare MJCF or URDF, which is used unchanged: no prefix, no additions, original
  /// options. Robots and environment are then empty.
  std::filesystem::path bare_model = {};
};

/// Reads a scene (.toml) or wraps a bare model (.xml, .urdf). Errors name file and line.
Result<Scene> load_scene(const std::filesystem::path& path, const FileAccess& access = {});

/// Reads a scene from text, as if it were a file in `folder`: relative paths start there. Errors
/// name line and column.
Result<Scene> parse_scene(std::string_view toml, const std::filesystem::path& folder,
                          const FileAccess& access = {});

/// Sets one option like a line of the scene file: `path` is "sim.duration",
/// "robot.NAME.controller.kp", "camera.NAME.width" …, `toml_value` is the text after "=". Quotes
/// around a string may be left out. The Scene is unchanged on error.
Status set_option(Scene& scene, std::string_view path, std::string_view toml_value);

/// JSON Schema (draft 7) of scene files, for editors: docs/scenes.md.
std::string scene_schema();

}  // namespace gloam
