#include "policy/test/leg_robot.h"

#include "base/check.h"

namespace gloam {

LegRobot::LegRobot(const std::string& actuators) {
  const std::string xml = R"(<mujoco model="leg">
  <option timestep="0.005" gravity="0 0 -9.81"/>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 .1"/>
    <geom name="step" type="box" size=".5 5 .1" pos="1 0 0"/>
    <body name="base" pos="0 0 1">
      <freejoint name="root"/>
      <geom name="trunk" type="box" size=".1 .1 .1" mass="5"/>
      <site name="imu"/>
      <camera name="down" pos="0 0 -.1"/>
      <body name="thigh" pos="0 0 -.1">
        <joint name="hip" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".03" mass="1"/>
        <body name="shank" pos="0 0 -.25">
          <joint name="knee" axis="0 1 0"/>
          <geom name="foot" type="capsule" fromto="0 0 0 0 0 -.2" size=".03" mass="1"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>)" + actuators +
                          R"(</actuator>
  <sensor><gyro name="gyro" site="imu"/></sensor>
</mujoco>)";
  char error[500] = "";
  mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error);
  GLOAM_CHECK(spec != nullptr, error);
  const SpecPtr owner(spec);
  model.reset(mj_compile(spec, nullptr));
  GLOAM_CHECK(model != nullptr, mjs_getError(spec));
  data.reset(mj_makeData(model.get()));
  mj_forward(model.get(), data.get());
  robot.name = "bot";
  robot.root_body = mj_name2id(model.get(), mjOBJ_BODY, "base");
}

}  // namespace gloam
