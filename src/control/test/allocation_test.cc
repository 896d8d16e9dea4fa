// control() must not allocate.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "allocation_count.h"
#include "control/inverse_kinematics.h"
#include "control/operational_space.h"
#include "control/trot.h"
#include "control/trot_options.h"
#include "ik_models.h"
#include "trot_robots.h"

namespace gloam {
namespace {

class Allocation : public testing::Test {
 protected:
  void SetUp() override {
    if (!counts_allocations()) GTEST_SKIP() << "malloc cannot be counted here";
    const long before = allocation_count();
    delete new int(1);
    Eigen::MatrixXd heap(8, 8);
    ASSERT_GE(allocation_count() - before, 1) << "the counter does not count";
  }

  /// Allocations in the calls of a controller while its robot moves.
  static long of_control(const mjModel& model, mjData& data, Controller& controller,
                         const auto& inputs_at) {
    long inside = 0;
    for (int step = 0; step < 1500; ++step) {
      const ControlInputs inputs = inputs_at(step);
      const long before = allocation_count();
      controller.control(inputs);
      inside += allocation_count() - before;
      mj_step(&model, &data);
    }
    return inside;
  }
};

TEST_F(Allocation, TrotNeverAllocates) {
  const ModelPtr model = load_quadruped();
  auto trot = make_trot_controller(*model, robot_instance(*model), TrotOptions{});
  ASSERT_TRUE(trot.ok());
  TestData data(mj_makeData(model.get()));
  mj_resetDataKeyframe(model.get(), data.get(), 0);
  mj_forward(model.get(), data.get());
  (*trot)->reset(model.get(), data.get());
  EXPECT_EQ(of_control(*model, *data, **trot,
                       [&](int step) {
                         return ControlInputs{model.get(), data.get(),
                                              {},          step,
                                              0.002,       {step < 1000 ? 0.5 : 0.0, 0, 0.3}};
                       }),
            0);
}

using MakeController = Result<std::unique_ptr<Controller>> (*)(const CompiledWorld&,
                                                               const RobotInstance&);

// A goal that is reached and a distance that limits the way: with it, the library of quadratic
// programs and MuJoCo's distances may allocate memory of their own.
TEST_F(Allocation, TaskSpaceControllersNeverAllocate) {
  for (const auto& [make, distance] :
       {std::pair<MakeController, double>{make_inverse_kinematics_controller, 0},
        {make_inverse_kinematics_controller, 0.02},
        {make_operational_space_controller, 0}}) {
    CompiledWorld world;
    world.model = compile_model(
        planar_arm(kMotors, "<geom name='post' type='sphere' size='.08' pos='.55 .35 0'/>"));
    RobotInstance robot;
    robot.name = "arm";
    robot.root_body = mj_name2id(world.model.get(), mjOBJ_BODY, "upper");
    robot.options.controller.task.frame = "site tip";
    robot.options.controller.task.orientation_cost = 0;
    robot.options.controller.task.collision_distance = distance;
    const auto controller = make(world, robot);
    ASSERT_TRUE(controller.ok()) << controller.error().to_string();
    TestData data(mj_makeData(world.model.get()));
    mj_forward(world.model.get(), data.get());
    (*controller)->reset(world.model.get(), data.get());
    const Pose goal{{0.4, 0.6, 0}, {}};
    const auto inputs_of = [&](int step) {
      ControlInputs inputs{world.model.get(), data.get(), {}, step, 0.002, {}};
      inputs.pose_goal = &goal;
      return inputs;
    };
    // The post blocks the way, which the controller reports once.
    const auto first = of_control(*world.model, *data, **controller, inputs_of);
    EXPECT_TRUE(distance > 0 || first == 0);
    EXPECT_EQ(of_control(*world.model, *data, **controller, inputs_of), 0) << distance;
  }
}

}  // namespace
}  // namespace gloam
