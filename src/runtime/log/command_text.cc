#include "runtime/log/command_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/nesting.h"
#include "gloam/controller.h"
#include "sim/commands/live_fields.h"

namespace gloam {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 vec3(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

/// Writes or reads one Command, key by key, by the same list of keys.
class Writer {
 public:
  Writer(Json& json, const CompiledWorld& world) : json_(json), world_(world) {}
  template <class Kind>
  void handle(const char* key, const Handle<Kind>& handle, mjtObj type) {
    json_[key] = handle.id;
    const char* name =
        type == mjOBJ_UNKNOWN ? nullptr : mj_id2name(world_.model.get(), type, handle.id);
    if (name != nullptr && *name != 0) json_["name"] = name;
  }
  void value(const char* key, double v) { json_[key] = v; }
  /// A key that logs of earlier versions lack: left out while it is zero.
  void added(const char* key, double v) {
    if (v != 0) json_[key] = v;
  }
  void added(const char* key, int64_t v) {
    if (v != 0) json_[key] = v;
  }
  void added(const char* key, const std::vector<Joint>& v) {
    if (!v.empty()) value(key, v);
  }
  void value(const char* key, int v) { json_[key] = v; }
  void value(const char* key, bool v) { json_[key] = v; }
  void value(const char* key, const Vec3& v) { json_[key] = numbers(v); }
  void value(const char* key, const Pose& X) {
    json_[key] = {{"p", numbers(X.p)}, {"q", {X.q.w, X.q.x, X.q.y, X.q.z}}};
  }
  void value(const char* key, const Quat& q) { json_[key] = {q.w, q.x, q.y, q.z}; }
  void value(const char* key, const LiveFieldId& v) { json_[key] = live_field_name(v); }
  void value(const char* key, const ControllerOptions& v) { json_[key] = to_toml(v); }
  void value(const char* key, const TrajectoryProfile& v) { json_[key] = profile_name(v); }
  template <class T>
  void value(const char* key, const std::vector<T>& v) {
    json_[key] = v;
  }
  void value(const char* key, const std::vector<Joint>& v) {
    Json& ids = json_[key] = Json::array();
    for (const Joint joint : v) ids.push_back(joint.id);
  }
  void value(const char* key, const std::vector<TrajectoryPoint>& v) {
    Json& points = json_[key] = Json::array();
    for (const TrajectoryPoint& point : v)
      points.push_back({point.time, point.positions, point.velocities, point.accelerations});
  }

 private:
  Json& json_;
  const CompiledWorld& world_;
};

class Reader {
 public:
  explicit Reader(const Json& json) : json_(json) {}
  template <class Kind>
  void handle(const char* key, Handle<Kind>& handle, mjtObj) {
    handle = {json_.at(key).get<int>(), 0};
  }
  void value(const char* key, double& v) { v = json_.at(key).get<double>(); }
  void added(const char* key, double& v) { v = json_.value(key, 0.0); }
  void added(const char* key, int64_t& v) { v = json_.value(key, int64_t{0}); }
  void added(const char* key, std::vector<Joint>& v) {
    if (json_.contains(key)) value(key, v);
  }
  void value(const char* key, int& v) { v = json_.at(key).get<int>(); }
  void value(const char* key, bool& v) { v = json_.at(key).get<bool>(); }
  void value(const char* key, Vec3& v) { v = vec3(json_.at(key)); }
  void value(const char* key, Pose& X) {
    const Json &pose = json_.at(key), &q = pose.at("q");
    X = {vec3(pose.at("p")), {q.at(0), q.at(1), q.at(2), q.at(3)}};
  }
  void value(const char* key, Quat& v) {
    const Json& q = json_.at(key);
    v = {q.at(0), q.at(1), q.at(2), q.at(3)};
  }
  void value(const char* key, LiveFieldId& v) {
    const auto name = json_.at(key).get<std::string>();
    const Result<LiveFieldId> field = find_live_field(name);
    if (!field.ok()) throw std::out_of_range(fmt::format("there is no live field '{:.40}'", name));
    v = *field;
  }
  void value(const char* key, ControllerOptions& v) {
    Result<ControllerOptions> options = parse_controller(json_.at(key).get<std::string>());
    if (!options.ok()) throw std::out_of_range(options.error().to_string());
    v = std::move(*options);
  }
  void value(const char* key, TrajectoryProfile& v) {
    const Result<TrajectoryProfile> profile = profile_named(json_.at(key).get<std::string>());
    if (!profile.ok()) throw std::out_of_range(profile.error().to_string());
    v = *profile;
  }
  template <class T>
  void value(const char* key, std::vector<T>& v) {
    v = json_.at(key).get<std::vector<T>>();
  }
  // JSON has no NaN: null.
  void value(const char* key, std::vector<double>& v) {
    v.clear();
    for (const Json& number : json_.at(key))
      v.push_back(number.is_null() ? JointTarget::kNone : number.get<double>());
  }
  void value(const char* key, std::vector<Joint>& v) {
    v.clear();
    for (const Json& id : json_.at(key)) v.push_back({id.get<int>(), 0});
  }
  void value(const char* key, std::vector<TrajectoryPoint>& v) {
    using Numbers = std::vector<double>;
    v.clear();
    for (const Json& point : json_.at(key))
      v.push_back({point.at(0).get<double>(), point.at(1).get<Numbers>(),
                   point.at(2).get<Numbers>(), point.at(3).get<Numbers>()});
  }

 private:
  const Json& json_;
};

// The keys of each Command. A new one is a line in kNames and a function here.
template <class V>
void visit(V& v, auto& c, const SetControl*) {
  v.handle("actuator", c.actuator, mjOBJ_ACTUATOR), v.value("value", c.value);
}
template <class V>
void visit(V& v, auto& c, const SetVelocityGoal*) {
  v.handle("robot", c.robot, mjOBJ_UNKNOWN);
  v.value("vx", c.vx), v.value("vy", c.vy), v.value("yaw_rate", c.yaw_rate);
  v.added("vz", c.vz);
}
template <class V>
void visit(V& v, auto& c, const SetMocapPose*) {
  v.handle("body", c.body, mjOBJ_BODY), v.value("pose", c.X_WB);
}
template <class V>
void visit(V& v, auto& c, const SetWrench*) {
  v.handle("body", c.body, mjOBJ_BODY), v.value("force", c.force), v.value("torque", c.torque);
}
template <class V>
void visit(V& v, auto& c, const AddVelocity*) {
  v.handle("body", c.body, mjOBJ_BODY), v.value("velocity", c.velocity);
}
template <class V>
void visit(V& v, auto& c, const DragBody*) {
  v.handle("body", c.body, mjOBJ_BODY), v.value("point", c.point_B);
  v.value("target", c.target_W), v.value("active", c.active);
}
template <class V>
void visit(V&, auto&, const ResetSim*) {}
template <class V>
void visit(V& v, auto& c, const SetLiveField*) {
  v.value("field", c.field), v.value("first", c.first), v.value("values", c.values);
}
template <class V>
void visit(V& v, auto& c, const SetJointState*) {
  v.handle("joint", c.joint, mjOBJ_JOINT), v.value("qpos", c.qpos), v.value("qvel", c.qvel);
}
template <class V>
void visit(V& v, auto& c, const SetControls*) {
  v.handle("robot", c.robot, mjOBJ_UNKNOWN), v.value("values", c.values);
}
template <class V>
void visit(V& v, auto& c, const SetJointGoal*) {
  v.handle("joint", c.joint, mjOBJ_JOINT), v.value("position", c.position);
}
template <class V>
void visit(V& v, auto& c, const SetPoseGoal*) {
  v.handle("robot", c.robot, mjOBJ_UNKNOWN), v.value("pose", c.X_WF);
}

template <class V>
void visit(V& v, auto& c, const SetJointCommand*) {
  v.handle("robot", c.robot, mjOBJ_UNKNOWN), v.value("joints", c.joints);
  v.value("position", c.position), v.value("velocity", c.velocity), v.value("effort", c.effort);
  v.value("kp", c.kp), v.value("kd", c.kd);
}
template <class V>
void visit(V& v, auto& c, const SetController*) {
  v.handle("robot", c.robot, mjOBJ_UNKNOWN), v.value("controller", c.controller);
}
template <class V>
void visit(V& v, auto& c, const FollowTrajectory*) {
  v.handle("robot", c.robot, mjOBJ_UNKNOWN), v.value("joints", c.joints);
  v.value("profile", c.trajectory.profile), v.value("points", c.trajectory.points);
  v.value("max_velocity", c.trajectory.max_velocity);
  v.value("max_acceleration", c.trajectory.max_acceleration);
  v.added("tag", c.tag);
}
template <class V>
void visit(V& v, auto& c, const StopTrajectory*) {
  v.handle("robot", c.robot, mjOBJ_UNKNOWN), v.added("joints", c.joints);
}

template <class V>
void visit(V& v, auto& c, const TurnBody*) {
  v.handle("body", c.body, mjOBJ_BODY), v.value("target", c.target_WB);
  v.value("active", c.active);
}
template <class V>
void visit(V& v, auto& c, const SetEquality*) {
  v.handle("equality", c.equality, mjOBJ_EQUALITY), v.value("active", c.active);
}

using What = decltype(Command::what);
constexpr const char* kNames[] = {"set_control",    "set_velocity_goal", "set_mocap_pose",
                                  "set_wrench",     "add_velocity",      "drag_body",
                                  "reset",          "set_live_field",    "set_joint_state",
                                  "set_controls",   "set_joint_goal",    "set_joint_command",
                                  "set_controller", "follow_trajectory", "stop_trajectory",
                                  "set_pose_goal",  "turn_body",         "set_equality"};
static_assert(std::size(kNames) == std::variant_size_v<What>);

template <size_t I = 0>
bool read_as(size_t index, Reader& reader, What* what) {
  if constexpr (I < std::variant_size_v<What>) {
    if (I != index) return read_as<I + 1>(index, reader, what);
    std::variant_alternative_t<I, What> command;
    visit(reader, command, &command);
    *what = std::move(command);
    return true;
  } else {
    return false;
  }
}

}  // namespace

std::string command_text(const LoggedCommand& logged, const CompiledWorld& world) {
  Json json = {{"run", logged.run},
               {"step", logged.command.step},
               {"command", kNames[logged.command.what.index()]}};
  Writer writer(json, world);
  std::visit([&writer](const auto& command) { visit(writer, command, &command); },
             logged.command.what);
  return json.dump();
}

Result<LoggedCommand> parse_command(std::string_view text) {
  GLOAM_TRY_STATUS(check_excess(json_excess(text), text, "a command in the log"));
  try {
    const Json json = Json::parse(text);
    LoggedCommand logged;
    logged.run = json.at("run").get<int64_t>();
    logged.command.step = json.at("step").get<int64_t>();
    const auto name = json.at("command").get<std::string>();
    const auto found = std::find(std::begin(kNames), std::end(kNames), name);
    Reader reader(json);
    const auto index = static_cast<size_t>(found - std::begin(kNames));
    if (!read_as(index, reader, &logged.command.what))
      return Error{ErrorKind::kInput, fmt::format("there is no command '{:.40}'", name)};
    return logged;
  } catch (const std::exception& error) {
    return Error{ErrorKind::kInput, fmt::format("a command in the log: {:.200}", error.what())};
  }
}

}  // namespace gloam
