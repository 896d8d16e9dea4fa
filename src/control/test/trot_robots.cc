#include "trot_robots.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/test/source_dir.h"

namespace gloam {

ModelPtr load_quadruped(double friction, const std::function<void(mjSpec*)>& change) {
  char error[1024] = "";
  const std::string file = source_dir() / "assets/robots/quadruped/quadruped.xml";
  SpecPtr spec(mj_parseXML(file.c_str(), nullptr, error, sizeof error));
  if (!spec) {
    ADD_FAILURE() << error;
    return nullptr;
  }
  mjsGeom* floor = mjs_addGeom(mjs_findBody(spec.get(), "world"), nullptr);
  floor->type = mjGEOM_PLANE;
  floor->size[2] = 0.1;
  if (change) change(spec.get());
  ModelPtr model(mj_compile(spec.get(), nullptr));
  if (!model) {
    ADD_FAILURE() << mjs_getError(spec.get());
    return nullptr;
  }
  for (int g = 0; g < model->ngeom; ++g) model->geom_friction[3 * g] = friction;
  return model;
}

std::string other_quadruped_xml() {
  std::string legs, motors;
  // The hinge's zero is bent: thigh 0.9 and calf -1.8 (mirrored behind) are built into the frames.
  for (const char* name : {"rear_left", "front_right", "front_left", "rear_right"}) {
    const std::string leg = name;
    const bool front = leg[0] == 'f', left = leg.find("left") != std::string::npos;
    const double sx = front ? 1 : -1, sy = left ? 1 : -1, bend = front ? -1 : 1;
    legs += fmt::format(
        R"(<body name="{0}_a" pos="{1} {2} 0" euler="0 {4} 0">
          <joint name="{0}_1" pos="0 {7} 0" axis="{8} 0 {9}" range="-0.8 0.8"/>
          <joint name="{0}_2" axis="0 1 0" range="-2 2"/>
          <geom type="capsule" fromto="0 0 0 0 0 -0.32" size="0.03" mass="2.4"/>
          <body name="{0}_b" pos="0 0 -0.32" euler="0 {5} 0">
            <joint name="{0}_3" axis="0 -1 0" range="-0.9 0.9"/>
            <geom type="capsule" fromto="0 0 0 0 0 -0.28" size="0.018" mass="0.4"/>
            <body name="{0}_c" pos="0 0 -0.31"><geom name="{0}_foot" type="sphere" size="0.03" mass="0.15"/></body>
          </body></body>)",
        leg, sx * 0.28, sy * 0.19, 0, bend * 0.85, -bend * 1.7, 0, -sy * 0.11,
        std::cos(bend * 0.85), std::sin(bend * 0.85));
    for (const int j : {3, 1, 2})
      motors =
          fmt::format(R"(<motor name="{0}_m{1}" joint="{0}_{1}" gear="-8" ctrlrange="-{2} {2}"/>)",
                      leg, j, j == 3 ? 14 : 10) +
          motors;
  }
  return R"(<mujoco><compiler angle="radian" autolimits="true"/>
    <option timestep="0.001" integrator="implicitfast"/>
    <default><joint armature="0.02" damping="0.1"/><geom friction="0.9"/></default>
    <worldbody><geom type="plane" size="0 0 1"/>
      <body name="trunk" pos="0 0 0.45"><freejoint/>
        <geom type="box" size="0.3 0.12 0.08" mass="18"/>
        <body pos="0.35 0 0.05"><geom type="sphere" size="0.06" mass="1.5"/></body>)" +
         legs + "</body></worldbody><actuator>" + motors + "</actuator></mujoco>";
}

ModelPtr compile_text(const std::string& xml) {
  char error[1024] = "";
  SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
  if (!spec) {
    ADD_FAILURE() << error;
    return nullptr;
  }
  ModelPtr model(mj_compile(spec.get(), nullptr));
  if (!model) ADD_FAILURE() << mjs_getError(spec.get());
  return model;
}

ModelPtr load_other_quadruped() { return compile_text(other_quadruped_xml()); }

RobotInstance robot_instance(const mjModel& model) {
  RobotInstance robot;
  robot.name = "quadruped";
  robot.root_body = mj_name2id(&model, mjOBJ_BODY, "trunk");
  return robot;
}

}  // namespace gloam
