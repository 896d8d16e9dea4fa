#include "scene/validate/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/text.h"
#include "places/generators.h"
#include "scene/camera_lens.h"
#include "scene/options/option_fields.h"
#include "scene/overrides.h"
#include "scene/randomize/randomize.h"
#include "scene/validate/validate_actuator.h"
#include "scene/validate/validate_agent.h"
#include "scene/validate/validate_effect.h"
#include "scene/validate/validate_imager.h"
#include "scene/validate/validate_lidar.h"
#include "scene/validate/validate_light.h"
#include "scene/validate/validate_planner.h"
#include "scene/validate/validate_probe.h"

namespace gloam {
namespace {

// Checks the rule of every field of one option struct.
class FieldChecker {
 public:
  FieldChecker(std::string where, SourceLoc loc, Status* status)
      : where_(std::move(where)), loc_(std::move(loc)), status_(status) {}

  template <class T>
  void operator()(std::string_view key, const T& value, const FieldRule& rule) {
    if (status_->ok()) check(key, value, rule);
  }

 private:
  void fail(std::string_view key, const std::string& what) {
    *status_ = Error{ErrorKind::kInput, fmt::format("'{}' of {} {}", key, where_, what), loc_};
  }
  void number(std::string_view key, double value, const FieldRule& rule) {
    const bool inside =
        rule.open ? value > rule.min && value < rule.max : value >= rule.min && value <= rule.max;
    if (!std::isfinite(value) || !inside)
      fail(key, fmt::format("is {}, outside {} … {}", value, rule.min, rule.max));
  }
  void check(std::string_view key, double value, const FieldRule& rule) {
    number(key, value, rule);
  }
  void check(std::string_view key, int value, const FieldRule& rule) { number(key, value, rule); }
  void check(std::string_view, uint64_t, const FieldRule&) {}
  void check(std::string_view, bool, const FieldRule&) {}
  void check(std::string_view, const TomlText&, const FieldRule&) {}
  void check(std::string_view key, const Rational& value, const FieldRule& rule) {
    if (value.den <= 0) return fail(key, "must have a positive denominator");
    number(key, value.value(), rule);
  }
  void check(std::string_view key, const Vec3& v, const FieldRule& rule) {
    for (const double x : {v.x, v.y, v.z}) {
      number(key, x, rule);
      // A mesh's size: negative factors mirror it.
      if (status_->ok() && rule.one_for_three && !(std::abs(x) >= 1e-6))
        fail(key, "has a number that is zero or nearly zero");
    }
  }
  void check(std::string_view key, const std::array<double, 2>& v, const FieldRule& rule) {
    for (const double x : v) number(key, x, rule);
  }
  void check(std::string_view, const CalendarDate&, const FieldRule&) {}  // validate_light.h
  void check(std::string_view, const ClockTime&, const FieldRule&) {}
  void check(std::string_view key, const Quat& q, const FieldRule&) {
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (!(std::abs(square - 1) < 1e-6)) fail(key, "is not a unit quaternion");
  }
  void check(std::string_view key, const std::string& text, const FieldRule& rule) {
    if (rule.required && text.empty()) return fail(key, "is empty");
    if (rule.may_be_empty && text.empty()) return;
    if (rule.identifier && (text.empty() || text.find('/') != std::string::npos))
      return fail(key, fmt::format("must be a name without '/', not '{}'", text));
    if (!rule.choices.empty() &&
        std::find(rule.choices.begin(), rule.choices.end(), text) == rule.choices.end()) {
      const std::vector<std::string> choices(rule.choices.begin(), rule.choices.end());
      fail(key, fmt::format("cannot be '{}'; {}", text, suggest_name(text, choices)));
    }
  }
  template <NamedEnum Enum>
  void check(std::string_view key, const Enum& value, const FieldRule& rule) {
    check(key, std::string(to_string(value)), rule);
  }
  template <NamedEnum Enum>
  void check(std::string_view key, const std::optional<Enum>& value, const FieldRule& rule) {
    check(key, std::string(to_string(value)), rule);
  }
  void check(std::string_view key, const std::filesystem::path& path, const FieldRule& rule) {
    if (rule.required && path.empty()) fail(key, "is empty");
  }
  template <class T>
  void check(std::string_view key, const std::optional<T>& value, const FieldRule& rule) {
    if (value) check(key, *value, rule);
  }
  void check(std::string_view, const std::vector<OverrideOptions>&, const FieldRule&) {
    // validate_overrides
  }

  template <class T>
  void check(std::string_view key, const std::vector<T>& values, const FieldRule& rule) {
    for (const T& value : values) {
      if (status_->ok()) check(key, value, rule);
    }
  }
  template <class Options>
    requires requires(FieldChecker& v, Options& o) { visit_fields(v, o); }
  void check(std::string_view key, const Options& options, const FieldRule&) {
    SourceLoc loc = loc_;
    if constexpr (requires { options.loc; }) loc = options.loc;
    std::string where = fmt::format("[{}]", key);
    if constexpr (requires { options.name; }) {
      if (!options.name.empty()) where = fmt::format("{} '{}'", key, options.name);
    }
    FieldChecker inner(where, loc, status_);
    visit_fields(inner, const_cast<Options&>(options));  // visitors that read do not write
  }

  std::string where_;
  SourceLoc loc_;
  Status* status_;
};

template <class Options>
Status refuse_duplicates(const std::vector<Options>& options, std::string_view kind) {
  std::map<std::string, SourceLoc> seen;
  for (const Options& option : options) {
    const auto [first, is_new] = seen.emplace(option.name, option.loc);
    if (is_new) continue;
    const std::string hint =
        first->second.line > 0 ? fmt::format("the first is on line {}", first->second.line) : "";
    return Error{ErrorKind::kInput, fmt::format("there are two {}s named '{}'", kind, option.name),
                 option.loc, hint};
  }
  return {};
}

// An object's name is used for its body and in segmentation.
Status validate_object_names(const Scene& scene) {
  for (const ObjectOptions& object : scene.objects) {
    const auto clash = [&](const auto& others, std::string_view kind) -> Status {
      for (const auto& other : others) {
        if (other.name != object.name) continue;
        return Error{ErrorKind::kInput,
                     fmt::format("object '{}' and {} '{}' have the same name", object.name, kind,
                                 other.name),
                     object.loc, "rename one of them"};
      }
      return {};
    };
    GLOAM_TRY_STATUS(clash(scene.props, "prop"));
    GLOAM_TRY_STATUS(clash(scene.robots, "robot"));
  }
  return {};
}

Status validate_camera(const CameraOptions& camera) {
  const auto both = [&](const char* a, const char* b) {
    return Error{ErrorKind::kInput,
                 fmt::format("camera '{}' has both '{}' and '{}'", camera.name, a, b), camera.loc,
                 "specify only one of them"};
  };
  if (camera.look_at && camera.orientation) return both("look_at", "orientation");
  if (!camera.body.empty() && !camera.track.empty()) return both("body", "track");
  if (camera.look_at && *camera.look_at == camera.position) {
    return Error{ErrorKind::kInput,
                 fmt::format("camera '{}' looks at its own position", camera.name), camera.loc,
                 "change 'look_at' or 'position'"};
  }
  return validate_lens(camera);
}

Status validate_render(const RenderOptions& render) {
  if (!render.error) return {};
  if (render.tier_or_default(false) != RenderTier::kPath) {
    return Error{
        ErrorKind::kInput,
        fmt::format("'error' of [render] requires the path tier, not '{}'", to_string(render.tier)),
        render.loc, "use 'spp' alone, or set tier = \"path\""};
  }
  if (render.samples() < 16) {
    return Error{ErrorKind::kInput,
                 fmt::format("'spp' of [render] is {}, which is too few to estimate an error",
                             render.samples()),
                 render.loc,
                 "with 'error' it is the maximum number of samples per pixel: 16 … 65536"};
  }
  return {};
}

}  // namespace

Status validate_scene(const Scene& scene) {
  Status status;
  FieldChecker checker("the scene", {scene.file.string(), 0, 0}, &status);
  SceneHeader header{scene.name};
  visit_tables(checker, header, const_cast<Scene&>(scene));  // visitors that read do not write
  GLOAM_TRY_STATUS(std::move(status));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.props, "prop"));
  GLOAM_TRY_STATUS(validate_environment(scene));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.objects, "object"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.robots, "robot"));
  GLOAM_TRY_STATUS(validate_object_names(scene));
  GLOAM_TRY_STATUS(validate_overrides(scene));
  GLOAM_TRY_STATUS(validate_randomize(scene));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.cameras, "camera"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.hfields, "hfield"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.visuals, "visual"));
  GLOAM_TRY_STATUS(validate_render(scene.render));
  for (const CameraOptions& camera : scene.cameras) {
    GLOAM_TRY_STATUS(validate_camera(camera));
    GLOAM_TRY_STATUS(validate_sensing(camera.name, camera.sensing));
  }
  GLOAM_TRY_STATUS(refuse_duplicates(scene.stereo, "stereo rig"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.rgbd, "rgbd rig"));
  GLOAM_TRY_STATUS(validate_rigs(scene));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.lidars, "lidar"));
  for (const LidarOptions& lidar : scene.lidars) GLOAM_TRY_STATUS(validate_lidar(lidar));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.probes, "probe"));
  for (const ProbeOptions& probe : scene.probes) GLOAM_TRY_STATUS(validate_probe(probe));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.lights, "light"));
  for (const LightOptions& light : scene.lights) GLOAM_TRY_STATUS(validate_light(light));
  if (scene.sky) GLOAM_TRY_STATUS(validate_sky(*scene.sky));
  if (scene.planner) GLOAM_TRY_STATUS(validate_planner(*scene.planner, scene.robots));
  if (scene.blackout) GLOAM_TRY_STATUS(validate_blackout(*scene.blackout));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.volumes, "volume"));
  for (const VolumeOptions& volume : scene.volumes) GLOAM_TRY_STATUS(validate_volume(volume));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.gases, "gas"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.fires, "fire"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.waters, "water"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.soils, "soil"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.agents, "agent"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.crowds, "crowd"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.smokes, "smoke"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.rotors, "rotor"));
  GLOAM_TRY_STATUS(refuse_duplicates(scene.dusts, "dust"));
  GLOAM_TRY_STATUS(validate_effects(scene));
  GLOAM_TRY_STATUS(validate_agents(scene));
  for (const RobotOptions& robot : scene.robots) {
    GLOAM_TRY_STATUS(validate_actuators(robot));
    GLOAM_TRY_STATUS(refuse_duplicates(robot.parts, "part"));
    for (const RobotPart& part : robot.parts) {
      if (part.controller.goals.empty()) continue;
      return Error{ErrorKind::kInput, "velocity goals belong to the robot, not to a part of it",
                   part.controller.loc, "write them in [robot.controller]"};
    }
    for (size_t i = 1; i < robot.controller.goals.size(); ++i) {
      const VelocityGoal& goal = robot.controller.goals[i];
      if (goal.time >= robot.controller.goals[i - 1].time) continue;
      return Error{ErrorKind::kInput,
                   fmt::format("the goal at {} s follows the goal at {} s", goal.time,
                               robot.controller.goals[i - 1].time),
                   goal.loc, "sort the goals by time"};
    }
  }
  return {};
}

}  // namespace gloam
