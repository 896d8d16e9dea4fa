#pragma once
// Scene: what the user wrote. Freely editable until compiled into a World. Every node knows its
// file and line. One options struct per feature: the same struct is filled from TOML, C++ and
// (later) Python.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene_camera.h"
#include "gloam/scene_effect.h"
#include "gloam/scene_environment.h"
#include "gloam/scene_lidar.h"
#include "gloam/scene_light.h"
#include "gloam/scene_sensor.h"
#include "gloam/types.h"

namespace gloam {

/// How far a model's files may reach. Models come from strangers: see docs/security.md.
struct FileAccess {
  std::filesystem::path root =
      {};  ///< no file outside it is read; empty = found by the rules in docs/security.md
  bool strict = false;  ///< root = the model file's own folder
  std::vector<std::pair<std::string, std::filesystem::path>> packages =
      {};  ///< package://NAME -> folder (URDF)
};

/// One change of a velocity goal on the schedule of a robot's controller.
struct VelocityGoal {
  double time = 0;      ///< when it starts to apply [s], >= 0
  double vx = 0;        ///< forward [m/s], in the robot's heading frame
  double vy = 0;        ///< left [m/s]
  double yaw_rate = 0;  ///< counter-clockwise seen from above [rad/s]
  SourceLoc loc = {};
};

/// A value as it stands in a scene file: "0.5", "[1, 0, 0]", "08:30:00", "\"oak\"".
struct TomlText {
  std::string text = {};
};

/// [robot.controller]: what drives a robot's actuators.
struct ControllerOptions {
  /// none | torque | joint_position | trot, or a type that the program has registered
  /// (gloam/controller.h)
  std::string type = "none";
  Rational rate = {500,
                   1};  ///< how often it runs [Hz]; the model's step rate must be a multiple of it
  double kp = 40;       ///< joint_position: stiffness [N m/rad]
  double kd = 1;        ///< joint_position: damping [N m s/rad]
  std::vector<double> target =
      {};  ///< joint_position: joint angles [rad], torque: torques [N m]; empty = keyframe / zero
  std::vector<VelocityGoal> goals = {};  ///< trot: velocity goals over time; empty = stand
  TomlText params = {};                  ///< table of settings of a registered type's own
  SourceLoc loc = {};
};

/// [[robot]]: one MJCF or URDF file, attached under a name prefix "NAME/".
struct RobotOptions {
  std::string name = {};  ///< unique; prefix of every element it brings
  std::filesystem::path file =
      {};          ///< MJCF (.xml, .mjz, .mjb not) or URDF (.urdf), relative to the scene file
  Pose X_WR = {};  ///< where its root frame stands in the world
  std::string keyframe = {};  ///< initial pose by name; empty = the model's default
  /// model = as in its file (a URDF's root link is fixed); free = on a free joint "floating_base"
  std::string base = "model";
  ControllerOptions controller = {};
  SourceLoc loc = {};
};

/// [override.ROBOT.TAG."PATTERN"]: one attribute of elements of a robot's model, as its file would
/// give it. What names an element exactly beats what is a pattern, a later line an earlier one.
struct OverrideOptions {
  std::string robot = {};  ///< name of a [[robot]], or "environment"
  /// Element of MJCF, "joint" or "position"; a section for all of its elements, "actuator"; what a
  /// model has once, "option" or "visual/map".
  std::string tag = {};
  /// Name in the robot's own model, or a regular expression (RE2) for whole names; empty for what a
  /// model has once.
  std::string pattern = {};
  std::string attribute = {};
  std::string value = {};  ///< as in MJCF: "0.5", "1 0 0", "true"
  SourceLoc loc = {};
};

/// [[randomize]]: an option that sim.seed draws (docs/environments.md). One of the distributions.
struct RandomizeOptions {
  /// Path as of set_option; * in a name stands for any text, and each that it fits has its own draw
  std::string option = {};
  std::string operation = "set";           ///< set | add | scale: what is done to what is written
  std::vector<TomlText> uniform = {};      ///< from, to
  std::vector<TomlText> log_uniform = {};  ///< from, to; > 0
  std::vector<TomlText> normal = {};       ///< mean, standard deviation; within the option's range
  std::vector<TomlText> choice = {};       ///< one of these
  std::vector<double> weights = {};        ///< of the choices; empty = equal
  SourceLoc loc = {};
};

/// What came of a [[randomize]].
struct DrawnOption {
  std::string option = {};  ///< full path
  std::string value = {};   ///< as in a scene file
};

/// [environment]: everything that is not a robot.
struct EnvironmentOptions {
  /// MJCF, or a glTF, GLB, OBJ, STL or PLY file of a place; empty = nothing but a floor when a TOML
  /// scene has robots, nothing otherwise
  std::filesystem::path file = {};
  std::string up = "auto";         ///< of a mesh file: y | z points up; auto = y of glTF, else z
  double unit = 1;                 ///< of a mesh file: [m] of one of its units
  std::string colliders = "auto";  ///< of a mesh file, each node's: as of [[object]]
  /// Of a mesh file, nodes whose name another node or the scene has: rename = the later is NAME_2
  /// …, and so said; refuse = an error; prefix = all are FILE_STEM/NODE.
  std::string clash = "rename";
  // Instead of a file, one of the generators:
  std::optional<HouseOptions> house = {};
  std::optional<WarehouseOptions> warehouse = {};
  std::optional<OfficeOptions> office = {};
  std::optional<HallwayOptions> hallway = {};
  std::optional<BedroomOptions> bedroom = {};
  std::optional<TunnelOptions> tunnel = {};
  std::optional<TerrainOptions> terrain = {};
  SourceLoc loc = {};
};

/// [material.pattern] and [material.wear]: a material made by formula, in metres
/// (docs/materials.md). What is not given is the kind's own: solid oak, Carrara marble, a red brick
/// wall …
struct PatternOptions {
  std::string kind = {};  ///< noise wood marble concrete brick tiles fabric scratches dirt
  uint64_t seed = 0;      ///< another piece of the same stuff
  std::optional<Vec3> color_a = {};      ///< ground, linear Rec. 709, 0 … 1
  std::optional<Vec3> color_b = {};      ///< late wood, veins, brick's other end, weft, dirt
  std::optional<Vec3> color_c = {};      ///< pores, seams, mortar, grout
  std::optional<double> scale = {};      ///< characteristic length [m]
  std::optional<double> size_u = {};     ///< length of a board, panel, brick or tile [m]
  std::optional<double> size_v = {};     ///< its other side [m]
  std::optional<double> gap = {};        ///< joint, or width of a scratch [m]
  std::optional<double> depth = {};      ///< of joints, pores, yarns [m]
  std::optional<double> roughness = {};  ///< of the ground, 0 … 1
  std::optional<double> coat = {};       ///< varnish or glaze, 0 … 1
  std::optional<double> variation = {};  ///< between units, 0 … 1
  std::optional<double> amount = {};     ///< of pores, veins, scratches or dirt, 0 … 1
  std::optional<Vec3> axis = {};         ///< of the grain or the scratches
  std::string basis = "fbm";             ///< noise: fbm turbulence ridged cells
  std::string bond = "running";          ///< brick: running stack english
  std::string tile = "square";           ///< tiles: square hexagon
  std::string weave = "plain";           ///< fabric: plain twill
  SourceLoc loc = {};
};

/// [[material]]: what MJCF cannot say of one of its materials; names after OpenPBR 1.1. Colour,
/// roughness, metalness, emission, opacity and textures of an MJCF material stay the model's. What
/// is not given stays as the file has it that the material came with, or as in OpenPBR.
struct MaterialOptions {
  /// Of the model's material, robot prefix included, or "VISUAL/MATERIAL"; * stands for any text.
  std::string name = {};
  // Of materials of [[visual]]s alone; these multiply the file's textures.
  std::optional<Vec3> base_color = {};                  ///< linear Rec. 709, 0 … 1
  std::optional<double> metallic = {}, roughness = {};  ///< 0 … 1
  std::optional<Vec3> emission = {};                    ///< luminance per channel [cd/m²]
  // Of all materials.
  std::optional<double> ior = {};                  ///< index of refraction, 1 … 3
  std::optional<double> anisotropy = {};           ///< 0 … 1, along the texture's u
  std::optional<double> anisotropy_rotation = {};  ///< [turns], counter-clockwise
  std::optional<double> transmission_weight = {};  ///< 0 … 1: glass
  /// At transmission_depth, or of one passage where that is 0.
  std::optional<Vec3> transmission_color = {};
  std::optional<double> transmission_depth = {};  ///< [m]
  std::optional<bool> thin_walled = {};           ///< a sheet: window panes, leaves, paper
  std::optional<double> subsurface_weight = {};   ///< 0 … 1; light that goes through, of sheets
  std::optional<Vec3> subsurface_color = {};      ///< default 0.8
  std::optional<double> coat_weight = {}, coat_roughness = {}, coat_ior = {};  ///< ior: 1.6
  std::optional<Vec3> coat_color = {};  ///< of the coat, linear Rec. 709, 0 … 1
  /// 0 … 1, default 1: light that the coat throws back down is dimmed by the base again, as it is
  /// beneath real lacquer; 0: the base keeps its colour (OpenPBR 1.1)
  std::optional<double> coat_darkening = {};
  std::optional<double> fuzz_weight = {}, fuzz_roughness = {};  ///< roughness: 0.5
  std::optional<Vec3> fuzz_color = {};         ///< of the fibres, linear Rec. 709, 0 … 1
  std::optional<PatternOptions> pattern = {};  ///< multiplies the colour, sets roughness and bumps
  std::optional<PatternOptions> wear = {};     ///< scratches or dirt over it
  std::optional<double> wetness = {};          ///< 0 dry … 1 under water where level
  std::optional<double> porosity = {};         ///< 0 glass and metal … 0.8 concrete, wood
  std::optional<double> dust = {}, snow = {};  ///< 0 … 1
  /// PNG or JPEG, as `bump`; their red times the number of the same name. Empty = none.
  std::filesystem::path coat_weight_map = {}, coat_roughness_map = {}, transmission_weight_map = {};
  /// PNG or JPEG of heights, relative to the scene file, on the texture's coordinates; empty = none
  std::filesystem::path bump = {};
  std::optional<double> bump_scale = {};  ///< [m] that white stands above black, default 0.001
  SourceLoc loc = {};
};

/// [[visual]]: a glTF, GLB, OBJ, STL or PLY file that is drawn and has no physics.
struct VisualOptions {
  std::string name = {};            ///< unique; its materials are "NAME/MATERIAL"
  std::filesystem::path file = {};  ///< relative to the scene file
  std::string node = {};            ///< name of a node of the file; empty = all of it
  std::string body = {};            ///< full name of the body it is fixed to; empty = world
  Pose X_BV = {};                   ///< where it is in that body
  Vec3 scale = {
      1, 1,
      1};  ///< along the visual's axes, after `up`; not 0, < 0 mirrors; one number for all three
  std::string up = "auto";   ///< y | z: axis of the file that points up; auto = y of glTF, else z
  double unit = 1;           ///< [m] of one unit of the file
  bool casts_shadow = true;  ///< false: light passes through it
  SourceLoc loc = {};
};

/// [[push]]: a velocity kick for robustness tests: an impulse at the body's centre of mass.
struct PushOptions {
  std::string body = {};  ///< full name
  double time = 0;        ///< [s]
  Vec3 velocity = {};     ///< change of the whole subtree's centre-of-mass velocity [m/s]
  SourceLoc loc = {};
};

/// [sim]: the physics of a run.
struct SimOptions {
  std::optional<double> timestep = {};  ///< [s]; empty = the model's own
  double duration = 10;                 ///< [s] of simulation time, > 0
  uint64_t seed = 1;                    ///< of everything random
  SourceLoc loc = {};
};

/// [render]: how pictures are made.
struct RenderOptions {
  std::string tier = "path";    ///< path | fast | direct (docs/light.md)
  std::optional<int> spp = {};  ///< samples per pixel, 1 … 65536; with `error` at most, from 16
  /// Of the path tier: each pixel is sampled until its standard error is this share of its value,
  /// 0.0001 … 1 (docs/light.md); empty = as many samples in every pixel.
  std::optional<double> error = {};
  /// Path vertices after the camera, 1 … 64; empty = 5, where there are media 24: fog is white by
  /// light that it scatters many times.
  std::optional<int> max_depth = {};
  /// cpu | cuda | auto (an NVIDIA card where this build and this machine have one, else the CPU).
  std::string device = "auto";
  bool denoise = true;  ///< but of the fast tier, which has a filter of its own
  /// auto | studio | model: the light of models that bring none. studio: a soft sky, a key light
  /// and a floor, in colour pictures alone; model: what MuJoCo shows; auto: the studio for models
  /// without lamps and sky (docs/light.md).
  std::string look = "auto";
  std::optional<double> ev100 =
      {};  ///< exposure value at ISO 100; empty = the scene's rule (docs/light.md)
  /// Groups of geoms, skins, flexes, tendons and sites that are drawn, 0 … 5; empty = 0 to 2, and
  /// collision shapes of what has nothing else to show
  std::vector<int> groups = {};
  bool sites = false;  ///< sites are drawn: seen by cameras alone
  SourceLoc loc = {};

  /// spp, or where it is empty 4, with `error` 4096.
  int samples() const { return spp.value_or(error ? 4096 : 4); }
};

/// What can be recorded of a run: of all cameras, and of the rest.
inline constexpr auto kRecordOutputs = [] {
  constexpr std::array<std::string_view, 5> kRest = {"lidar", "metrics", "contact_sheet", "sensors",
                                                     "state"};
  std::array<std::string_view, kCameraOutputs.size() + kRest.size()> all;
  std::copy(kRest.begin(), kRest.end(),
            std::copy(kCameraOutputs.begin(), kCameraOutputs.end(), all.begin()));
  return all;
}();

/// [record]: what is written of a run.
struct RecordOptions {
  std::vector<std::string> outputs = {"video", "png", "lidar"};  ///< of kRecordOutputs
  SourceLoc loc = {};
};

struct Scene {
  std::string name = "scene";
  std::filesystem::path file = {};  ///< what it was read from; empty for scenes made in code
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
  std::vector<RgbdOptions> rgbd = {};      ///< likewise
  std::vector<SensorOptions> sensors = {};
  std::vector<TemperatureOptions> temperatures = {};
  std::vector<RandomizeOptions> randomize = {};  ///< empty in a compiled Scene
  SimOptions sim = {};
  RenderOptions render = {};
  RecordOptions record = {};
  /// A bare MJCF or URDF is used as it stands: no prefix, nothing added, options unchanged. Then
  /// this is its path and robots and environment are empty.
  std::filesystem::path bare_model = {};
};

/// Reads a scene (.toml) or wraps a bare model (.xml, .urdf). Every error names file and line.
Result<Scene> load_scene(const std::filesystem::path& path, const FileAccess& access = {});

/// Reads a scene from text, as if it were a file in `folder`: relative paths start there. Errors
/// name line and column.
Result<Scene> parse_scene(std::string_view toml, const std::filesystem::path& folder,
                          const FileAccess& access = {});

/// Overrides one option, as a line of the scene file would: `path` is "sim.duration",
/// "robot.NAME.controller.kp", "camera.NAME.width" …, `toml_value` is the text after "=". Quotes
/// around a string may be left out. The Scene is unchanged on error.
Status set_option(Scene& scene, std::string_view path, std::string_view toml_value);

/// JSON Schema (draft 7) of scene files, for editors: docs/scenes.md.
std::string scene_schema();

}  // namespace gloam
