#include "test_world.h"

#include "scene/files/mujoco_guard.h"

namespace gloam {

std::shared_ptr<CompiledWorld> world_from_mjcf(const std::string& xml) {
  install_mujoco_handler();
  char error[1000] = "";
  auto world = std::make_shared<CompiledWorld>();
  const SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error)));
  if (!spec) {
    ADD_FAILURE() << error;
    abort();
  }
  world->model.reset(mj_compile(spec.get(), nullptr));
  if (!world->model) {
    ADD_FAILURE() << mjs_getError(spec.get());
    abort();
  }
  RobotInstance robot;
  robot.name = "robot";
  robot.root_body = world->model->nbody > 1 ? 1 : 0;
  world->robots.push_back(robot);
  return world;
}

const char* const kRichModel = R"(
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom type="plane" size="5 5 .1"/>
    <body name="base" pos="0 0 0.4">
      <freejoint name="base"/>
      <geom name="trunk" type="box" size=".2 .1 .05" mass="5"/>
      <site name="imu"/>
      <body name="thigh" pos=".2 0 0">
        <joint name="hip" type="hinge" axis="0 1 0" damping=".1" stiffness="2"/>
        <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".03" mass=".5"/>
        <body name="shank" pos="0 0 -.2">
          <joint name="knee" type="hinge" axis="0 1 0" range="-120 10" limited="true"/>
          <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".03" mass=".3"/>
        </body>
      </body>
    </body>
    <body name="arm" pos="1 0 1">
      <joint name="shoulder" type="ball"/>
      <geom type="capsule" fromto="0 0 0 .3 0 0" size=".03" mass="1"/>
      <body name="fore" pos=".3 0 0">
        <joint name="elbow" type="hinge" axis="0 1 0" frictionloss=".02"/>
        <geom type="capsule" fromto="0 0 0 .3 0 0" size=".03" mass="1"/>
      </body>
    </body>
    <body name="hand" mocap="true" pos="-1 0 1"><geom type="sphere" size=".05" contype="0" conaffinity="0"/></body>
    <body name="held" pos="-1 0 1">
      <freejoint/>
      <geom type="box" size=".05 .05 .05" mass=".2"/>
    </body>
    <body name="ball" pos="0.05 0.02 1"><freejoint/><geom type="sphere" size=".08" mass=".4"/></body>
  </worldbody>
  <equality>
    <weld body1="hand" body2="held"/>
    <joint joint1="elbow" polycoef="0.1 0 0 0 0"/>
  </equality>
  <tendon><fixed name="t" springlength="0.1" stiffness="1"><joint joint="hip" coef="1"/><joint joint="knee" coef="-1"/></fixed></tendon>
  <actuator>
    <motor name="hip" joint="hip" gear="10" ctrlrange="-1 1"/>
    <general name="knee" joint="knee" dyntype="filter" dynprm="0.05" gainprm="5"/>
    <position name="elbow" joint="elbow" kp="20" delay="0.006" nsample="4"/>
    <intvelocity name="t" tendon="t" kp="3" actrange="-1 1"/>
  </actuator>
  <sensor>
    <framepos name="base_pos" objtype="body" objname="base"/>
    <gyro name="gyro" site="imu" delay="0.004" nsample="3"/>
    <accelerometer name="acc" site="imu"/>
    <jointpos name="elbow_pos" joint="elbow"/>
    <clock name="clock"/>
  </sensor>
</mujoco>)";

std::unique_ptr<Simulator> make_simulator(std::shared_ptr<const CompiledWorld> world,
                                          SimulatorOptions options) {
  auto simulator = Simulator::create(std::move(world), std::move(options));
  if (!simulator) {
    ADD_FAILURE() << simulator.error().to_string();
    abort();
  }
  return std::move(*simulator);
}

double random_control(int64_t step, int i) {
  constexpr RandomStream stream{7, stream_id("test.control")};
  return 2 * stream.uniform(static_cast<uint64_t>(step), static_cast<uint32_t>(i)) - 1;
}

}  // namespace gloam
