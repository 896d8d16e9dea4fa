// What the trot controller believes about a robot, against MuJoCo.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "control/trot_legs.h"
#include "control/trot_state.h"
#include "trot_robots.h"

namespace gloam {
namespace {

using Row3 = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

/// Random joints, base pose and velocities, without contacts, friction or damping.
struct Shaken {
  ModelPtr model;
  TestData data;
  Quadruped robot;
  TrotState state;

  explicit Shaken(ModelPtr made, uint32_t seed) : model(std::move(made)) {
    auto found = find_quadruped(*model, robot_instance(*model));
    EXPECT_TRUE(found.ok()) << found.error().to_string();
    robot = found.value();
    model->opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_DAMPER | mjDSBL_SPRING;
    data.reset(mj_makeData(model.get()));
    const RandomStream random{seed, stream_id("trot.model_test")};
    for (int i = 0; i < model->nq; ++i) data->qpos[i] += 0.5 * (2 * random.uniform(0, i) - 1);
    mju_normalize4(data->qpos + robot.base_qpos + 3);
    for (int i = 0; i < model->nv; ++i) data->qvel[i] = 2 * random.uniform(1, i) - 1;
    mj_forward(model.get(), data.get());
    measure(robot, *data, {}, state);
  }
};

class TrotModel : public testing::TestWithParam<bool> {
 protected:
  static ModelPtr make() { return GetParam() ? load_other_quadruped() : load_quadruped(); }
};

TEST_P(TrotModel, FindsFourCornersInOrder) {
  const ModelPtr model = make();
  const auto found = find_quadruped(*model, robot_instance(*model));
  ASSERT_TRUE(found.ok()) << found.error().to_string();
  const Quadruped& robot = found.value();
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(robot.legs[k].anchor_B[0].x() > 0, k < 2);
    EXPECT_EQ(robot.legs[k].anchor_B[0].y() > 0, k % 2 == 0);
    EXPECT_EQ(model->geom_type[robot.legs[k].foot_geom], mjGEOM_SPHERE);
    for (int i = 0; i < 3; ++i) {
      const int actuator = robot.legs[k].actuator[i];
      EXPECT_EQ(model->jnt_dofadr[model->actuator_trnid[2 * actuator]], robot.legs[k].dof[i]);
    }
  }
  EXPECT_NEAR(robot.mass, mj_getTotalmass(model.get()), 1e-9);
  EXPECT_NEAR(robot.leg_length, GetParam() ? 0.63 : 0.426, 1e-9);
  EXPECT_NEAR(robot.legs[0].torque_limit[0], GetParam() ? 80 : 23.7, 1e-9);
  EXPECT_NEAR(robot.legs[0].torque_limit[2], GetParam() ? 112 : 35.55, 1e-9);
}

TEST_P(TrotModel, FootPositionAndJacobianAreMujocos) {
  for (uint32_t seed = 0; seed < 5; ++seed) {
    Shaken s(make(), seed);
    for (int k = 0; k < 4; ++k) {
      const Leg& leg = s.robot.legs[k];
      const mjtNum* foot = s.data->geom_xpos + 3 * leg.foot_geom;
      EXPECT_LT((s.state.foot_W[k] - Vector3d(foot[0], foot[1], foot[2])).norm(), 1e-12);
      Row3 J(3, s.model->nv);
      mj_jacGeom(s.model.get(), s.data.get(), J.data(), nullptr, leg.foot_geom);
      for (int i = 0; i < 3; ++i)
        EXPECT_LT((s.state.R_WB * s.state.pose[k].J.col(i) - J.col(leg.dof[i])).norm(), 1e-12);
      const Vector3d v = J * Eigen::Map<Eigen::VectorXd>(s.data->qvel, s.model->nv);
      EXPECT_LT((s.state.foot_velocity_W[k] - v).norm(), 1e-12);
    }
    const mjtNum* com = s.data->subtree_com + 3 * s.robot.base_body;
    EXPECT_LT((s.state.com_W - Vector3d(com[0], com[1], com[2])).norm(), 1e-12);
  }
}

TEST_P(TrotModel, LegTorquesAreMujocosInverseDynamics) {
  for (uint32_t seed = 0; seed < 5; ++seed) {
    Shaken s(make(), seed);
    for (int i = 0; i < 6; ++i) s.data->qvel[s.robot.base_dof + i] = 0;
    mju_zero(s.data->qacc, s.model->nv);
    const RandomStream random{seed, stream_id("trot.qdd")};
    std::array<Vector3d, 4> qdd;
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 3; ++i)
        s.data->qacc[s.robot.legs[k].dof[i]] = qdd[k][i] = 20 * (random.uniform(k, i) - 0.5);
    mj_inverse(s.model.get(), s.data.get());
    Vector3d force = Vector3d(0, 0, s.robot.base_mass * s.robot.gravity);
    for (int k = 0; k < 4; ++k) {
      const LegDynamics got =
          leg_dynamics(s.robot.legs[k], s.state.pose[k], s.state.qd[k], qdd[k], s.state.gravity_B);
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(got.torque[i], s.data->qfrc_inverse[s.robot.legs[k].dof[i]], 1e-9);
      force += s.state.R_WB * got.force;
    }
    // What holds the base still is the sum over legs and base.
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(force[i], s.data->qfrc_inverse[s.robot.base_dof + i], 1e-8);
  }
}

TEST_P(TrotModel, FootBiasAccelerationIsTheDerivativeOfVelocity) {
  Shaken s(make(), 3);
  const double h = 1e-6;
  for (int k = 0; k < 4; ++k) {
    const Leg& leg = s.robot.legs[k];
    const Vector3d before = leg_pose(leg, s.state.q[k] - h * s.state.qd[k]).J * s.state.qd[k];
    const Vector3d after = leg_pose(leg, s.state.q[k] + h * s.state.qd[k]).J * s.state.qd[k];
    const Vector3d bias = foot_bias_acceleration(s.state.pose[k], s.state.qd[k]);
    EXPECT_LT((bias - (after - before) / (2 * h)).norm(), 1e-6);
  }
}

TEST_P(TrotModel, CompositeInertiaIsMujocos) {
  Shaken s(make(), 4);
  const int nv = s.model->nv, dof = s.robot.base_dof;
  std::vector<mjtNum> M(static_cast<size_t>(nv) * nv);
  mj_fullM(s.model.get(), s.data.get(), M.data());
  Matrix3d about_base;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) about_base(i, j) = M[(dof + 3 + i) * nv + dof + 3 + j];
  const Vector3d r = s.state.R_WB.transpose() * (s.state.com_W - s.state.p_WB);
  const Matrix3d about_com =
      about_base - s.robot.mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  EXPECT_LT((composite_inertia(s.robot, s.state) - about_com).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Robots, TrotModel, testing::Values(false, true),
                         [](const auto& param) { return param.param ? "other" : "own"; });

std::string refusal(const std::string& xml) {
  const ModelPtr model = compile_text(xml);
  auto found = find_quadruped(*model, robot_instance(*model));
  return found.ok() ? "" : found.error().to_string();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(TrotModelErrors, SaysWhatIsMissing) {
  const std::string good = other_quadruped_xml();
  EXPECT_EQ(refusal(good), "");
  EXPECT_THAT(refusal(replaced(good, "<freejoint/>", "")), testing::HasSubstr("no free joint"));
  EXPECT_THAT(refusal(replaced(good, "<motor name=", "<position kp=\"50\" name=")),
              testing::HasSubstr("is not a torque motor"));
  const size_t motor = good.find("<motor");
  EXPECT_THAT(refusal(std::string(good).erase(motor, good.find("/>", motor) + 2 - motor)),
              testing::HasSubstr("has no actuator"));
  EXPECT_THAT(
      refusal(replaced(good, "<geom friction", "<geom contype=\"0\" conaffinity=\"0\" friction")),
      testing::HasSubstr("no collision geom to stand on"));
  EXPECT_THAT(refusal(R"(<mujoco><worldbody><body name="trunk"><freejoint/><geom size="0.1"/></body>
                         </worldbody></mujoco>)"),
              testing::HasSubstr("0 legs"));
}

}  // namespace
}  // namespace gloam
