#include "topics/robot_urdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "topics/model_frames.h"
#include "world/model_names.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

// URDF asks for limits of effort and speed; these stand for none [N, N m], [m/s, rad/s].
constexpr double kAnyEffort = 1e6, kAnySpeed = 1e3, kAnyTravel = 1e6;
// Mass [kg] and inertia [kg m²] of links between two joints: loaders refuse moving links without.
constexpr double kBetweenMass = 1e-6, kBetweenInertia = 1e-9;
constexpr double kRoundOff = 1e-15;

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

double clean(double x) { return std::abs(x) < kRoundOff ? 0.0 : x; }

std::string numbers(const Vec3& v) {
  return fmt::format("{} {} {}", clean(v.x), clean(v.y), clean(v.z));
}

// Roll, pitch and yaw: R = Rz(yaw) Ry(pitch) Rx(roll). Pitch and roll are taken of what is left
// after the yaw, so that they make up for its round-off near a pitch of 90 degrees.
Vec3 roll_pitch_yaw(const Quat& q) {
  const mjtNum wxyz[4] = {q.w, q.x, q.y, q.z};
  mjtNum R[9];
  mju_quat2Mat(R, wxyz);
  const double yaw = std::atan2(R[3], R[0]), s = std::sin(yaw), c = std::cos(yaw);
  return {std::atan2(s * R[2] - c * R[5], c * R[4] - s * R[1]),
          std::atan2(-R[6], c * R[0] + s * R[3]), yaw};
}

std::string origin(const Pose& X) {
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", numbers(X.p), numbers(roll_pitch_yaw(X.q)));
}

Quat rotation_about(const mjtNum axis[3], double angle) {
  mjtNum q[4];
  mju_axisAngle2Quat(q, axis, angle);
  return {q[0], q[1], q[2], q[3]};
}

Pose pose_at(const mjtNum* p, const mjtNum* q) {
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

class UrdfWriter {
 public:
  UrdfWriter(const mjModel& model, const RobotInstance& robot) : m_(model), robot_(robot) {}

  std::string write() {
    line("<?xml version=\"1.0\"?>");
    line("<robot name=\"{}\">", xml_text(robot_.name));
    for (int body = robot_.root_body; body < static_cast<int>(m_.nbody); ++body) {
      if (!is_part_of(m_, body, robot_.root_body)) continue;
      add_link(body);
      if (body != robot_.root_body || has_own_joints(body)) add_joints(body);
    }
    line("</robot>");
    return std::move(text_);
  }

 private:
  template <class... T>
  void line(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
    text_ += '\n';
  }

  // A root that joints hold, not a floating or fixed one, hangs on a link for the world.
  bool has_own_joints(int body) const {
    if (m_.body_jntnum[body] == 0 || m_.jnt_type[m_.body_jntadr[body]] == mjJNT_FREE) return false;
    return true;
  }

  std::string frame(int body) const { return xml_text(body_frame(m_, body)); }

  void add_link(int body) {
    if (body == robot_.root_body && has_own_joints(body)) line("  <link name=\"world\"/>");
    line("  <link name=\"{}\">", frame(body));
    add_inertia(body);
    const int first = m_.body_geomadr[body];
    for (int geom = first; geom < first + m_.body_geomnum[body]; ++geom) add_geom(geom);
    line("  </link>");
  }

  void add_inertia(int body) {
    if (m_.body_mass[body] <= 0) return;
    const mjtNum* I = m_.body_inertia + 3 * body;
    const Pose X_BI = pose_at(m_.body_ipos + 3 * body, m_.body_iquat + 4 * body);
    mjtNum R[9];
    mju_quat2Mat(R, m_.body_iquat + 4 * body);
    const auto about = [&](int i, int j) {  // row i, column j of R diag(I) R^T
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += R[3 * i + k] * I[k] * R[3 * j + k];
      return clean(sum);
    };
    line(
        "    <inertial>{}<mass value=\"{}\"/><inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" "
        "iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/></inertial>",
        origin({X_BI.p, {}}), m_.body_mass[body], about(0, 0), about(0, 1), about(0, 2),
        about(1, 1), about(1, 2), about(2, 2));
  }

  void add_geom(int geom) {
    const mjtNum *size = m_.geom_size + 3 * geom, *box = m_.geom_aabb + 6 * geom;
    const Pose X_BG = pose_at(m_.geom_pos + 3 * geom, m_.geom_quat + 4 * geom);
    const auto cylinder = [&] {
      add_shape(geom, X_BG,
                fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", size[0], 2 * size[1]));
    };
    const auto sphere = [&](double z) {
      add_shape(geom, product(X_BG, {{0, 0, z}, {}}),
                fmt::format("<sphere radius=\"{}\"/>", size[0]));
    };
    switch (m_.geom_type[geom]) {
      case mjGEOM_PLANE:
        return;
      case mjGEOM_SPHERE:
        return sphere(0);
      case mjGEOM_CYLINDER:
        return cylinder();
      case mjGEOM_CAPSULE:
        cylinder();
        sphere(size[1]);
        return sphere(-size[1]);
      default:  // its bounds, which for a box is itself
        add_shape(geom, product(X_BG, {{box[0], box[1], box[2]}, {}}),
                  fmt::format("<box size=\"{} {} {}\"/>", 2 * box[3], 2 * box[4], 2 * box[5]));
    }
  }

  // MuJoCo's groups 0 to 2 are shown.
  void add_shape(int geom, const Pose& X_BS, const std::string& shape) {
    const bool collides = m_.geom_contype[geom] != 0 || m_.geom_conaffinity[geom] != 0;
    const std::string what = origin(X_BS) + "<geometry>" + shape + "</geometry>";
    if (collides) line("    <collision>{}</collision>", what);
    if (m_.geom_group[geom] > 2) return;
    const int material = m_.geom_matid[geom];
    const float* rgba = material >= 0 ? m_.mat_rgba + 4 * material : m_.geom_rgba + 4 * geom;
    const std::string color = fmt::format("{} {} {} {}", rgba[0], rgba[1], rgba[2], rgba[3]);
    line("    <visual>{}<material name=\"rgba {}\"><color rgba=\"{}\"/></material></visual>", what,
         color, color);
  }

  // Joints of a body act one after the other, each about its anchor in the body as moved so far.
  void add_joints(int body) {
    std::string parent = frame(m_.body_parentid[body]);
    Pose X_PC = pose_at(m_.body_pos + 3 * body, m_.body_quat + 4 * body);
    const int first = m_.body_jntadr[body], count = m_.body_jntnum[body];
    for (int joint = first; joint < first + count; ++joint) {
      const mjtNum *at = m_.jnt_pos + 3 * joint, *axis = m_.jnt_axis + 3 * joint;
      const double reference = m_.qpos0[m_.jnt_qposadr[joint]];
      Vec3 anchor = {at[0], at[1], at[2]};
      const bool is_slide = m_.jnt_type[joint] == mjJNT_SLIDE;
      if (is_slide) anchor = {};
      Pose X_AJ;  // takes back the position that the model's poses are for
      if (is_slide) X_AJ.p = {-reference * axis[0], -reference * axis[1], -reference * axis[2]};
      if (m_.jnt_type[joint] == mjJNT_HINGE) X_AJ.q = rotation_about(axis, -reference);
      const bool is_at_origin = anchor.x == 0 && anchor.y == 0 && anchor.z == 0;
      const bool is_last = joint + 1 == first + count && is_at_origin;
      const std::string name = xml_text(joint_label(m_, joint, robot_.prefix));
      const std::string child = is_last ? frame(body) : frame(body) + "_" + name;
      if (!is_last) add_link_between(child);
      add_joint(joint, name, parent, child, product(product(X_PC, {anchor, {}}), X_AJ));
      X_PC = {{-anchor.x, -anchor.y, -anchor.z}, {}};
      parent = child;
    }
    if (parent == frame(body)) return;
    line(
        "  <joint name=\"{}_fixed\" type=\"fixed\"><parent link=\"{}\"/><child link=\"{}\"/>{}"
        "</joint>",
        frame(body), parent, frame(body), origin(X_PC));
  }

  void add_link_between(const std::string& name) {
    line(
        "  <link name=\"{}\"><inertial><mass value=\"{}\"/><inertia ixx=\"{}\" ixy=\"0\" "
        "ixz=\"0\" iyy=\"{}\" iyz=\"0\" izz=\"{}\"/></inertial></link>",
        name, kBetweenMass, kBetweenInertia, kBetweenInertia, kBetweenInertia);
  }

  void add_joint(int joint, const std::string& name, const std::string& parent,
                 const std::string& child, const Pose& X_PC) {
    const bool is_limited = m_.jnt_limited[joint] != 0;
    const char* type = "floating";
    if (m_.jnt_type[joint] == mjJNT_SLIDE) type = "prismatic";
    if (m_.jnt_type[joint] == mjJNT_HINGE) type = is_limited ? "revolute" : "continuous";
    line("  <joint name=\"{}\" type=\"{}\">", name, type);
    line("    <parent link=\"{}\"/><child link=\"{}\"/>{}", parent, child, origin(X_PC));
    if (m_.jnt_type[joint] != mjJNT_BALL) add_motion(joint, is_limited);
    line("  </joint>");
  }

  void add_motion(int joint, bool is_limited) {
    const mjtNum *axis = m_.jnt_axis + 3 * joint, *range = m_.jnt_range + 2 * joint;
    const int dof = m_.jnt_dofadr[joint];
    std::string travel;
    if (is_limited)
      travel = fmt::format("lower=\"{}\" upper=\"{}\" ", range[0], range[1]);
    else if (m_.jnt_type[joint] == mjJNT_SLIDE)
      travel = fmt::format("lower=\"{}\" upper=\"{}\" ", -kAnyTravel, kAnyTravel);
    line("    <axis xyz=\"{}\"/><limit {}effort=\"{}\" velocity=\"{}\"/>",
         numbers({axis[0], axis[1], axis[2]}), travel, most_effort(joint), kAnySpeed);
    line("    <dynamics damping=\"{}\" friction=\"{}\"/>", m_.dof_damping[dof],
         m_.dof_frictionloss[dof]);
  }

  // Limit of the joint's own, else of the actuators on it that have one.
  double most_effort(int joint) const {
    const mjtNum* own = m_.jnt_actfrcrange + 2 * joint;
    if (m_.jnt_actfrclimited[joint]) return std::max(std::abs(own[0]), std::abs(own[1]));
    double effort = 0;
    for (int i = 0; i < static_cast<int>(m_.nactuator); ++i) {
      const int transmission = m_.actuator_trntype[i];
      if (transmission != mjTRN_JOINT && transmission != mjTRN_JOINTINPARENT) continue;
      if (m_.actuator_trnid[2 * i] != joint || !m_.actuator_forcelimited[i]) continue;
      const mjtNum* force = m_.actuator_forcerange + 2 * i;
      effort +=
          std::max(std::abs(force[0]), std::abs(force[1])) * std::abs(m_.actuator_gear[6 * i]);
    }
    return effort > 0 ? effort : kAnyEffort;
  }

  const mjModel& m_;
  const RobotInstance& robot_;
  std::string text_;
};

}  // namespace

std::string robot_urdf(const mjModel& model, const RobotInstance& robot) {
  return UrdfWriter(model, robot).write();
}

}  // namespace gloam
