// Inverse kinematics against closed forms: a planar arm of two links, chains of slides.

#include <gmock/gmock.h>

#include <cmath>

#include "control/ik/lie.h"
#include "control/ik/program.h"
#include "ik_models.h"

namespace gloam::ik {
namespace {

using testing::HasSubstr;

const FrameName kTip{FrameKind::kSite, "tip"};

Eigen::Matrix2d planar_jacobian(double q1, double q2) {
  Eigen::Matrix2d J;
  J << -kUpper * std::sin(q1) - kFore * std::sin(q1 + q2), -kFore * std::sin(q1 + q2),
      kUpper * std::cos(q1) + kFore * std::cos(q1 + q2), kFore * std::cos(q1 + q2);
  return J;
}
Eigen::Vector2d planar_tip(double q1, double q2) {
  return {kUpper * std::cos(q1) + kFore * std::cos(q1 + q2),
          kUpper * std::sin(q1) + kFore * std::sin(q1 + q2)};
}

Program make_program(const mjModel& model, const Problem& problem) {
  Result<Program> made = Program::create(model, all_dofs(model), problem);
  EXPECT_TRUE(made.ok()) << made.error().to_string();
  return std::move(made).value();
}

Task position_task(double gain = 1) { return FrameTask{kTip, {1, 1, 1}, {0, 0, 0}, gain, 0}; }

TEST(InverseKinematics, JacobianOfAPlanarArm) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  Kinematics at(*model, all_dofs(*model));
  const FrameId tip = *find_frame(*model, kTip);
  MatrixXd J_B(6, 2);
  for (const auto& [q1, q2] : {std::pair{0.3, 0.9}, {-1.2, 0.4}, {2.0, -2.2}}) {
    const double q[] = {q1, q2};
    at.update(q);
    at.body_jacobian(tip, J_B);
    const Transform X_WB = at.pose(tip);
    EXPECT_LT((X_WB.p.head<2>() - planar_tip(q1, q2)).norm(), 1e-14);
    const MatrixXd J_W = X_WB.R * J_B.topRows<3>();
    EXPECT_LT((J_W.topRows<2>() - planar_jacobian(q1, q2)).norm(), 1e-14);
    EXPECT_LT((J_B.bottomRows<1>() - Eigen::RowVector2d(1, 1)).norm(), 1e-14);
  }
}

TEST(InverseKinematics, FrameTaskSolvesThePlanarJacobian) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  Program program = make_program(*model, {{position_task(0.5)}, {}, 1e-12});
  const double q[] = {0.3, 0.9};
  const Eigen::Vector2d goal = planar_tip(0.3, 0.9) + Eigen::Vector2d(0.02, -0.03);
  // The target keeps the tip's orientation, so that log has the translation alone.
  const double half = 0.5 * 1.2;
  ASSERT_TRUE(
      program.set_target(0, Pose{{goal.x(), goal.y(), 0}, {std::cos(half), 0, 0, std::sin(half)}})
          .ok());
  ASSERT_EQ(program.solve(q, 0.01), SolutionStatus::kSolved);
  const Eigen::Vector2d expected =
      planar_jacobian(0.3, 0.9).inverse() * (0.5 * Eigen::Vector2d(0.02, -0.03));
  EXPECT_LT((program.x() - expected).norm(), 1e-9);
}

TEST(InverseKinematics, DampingGivesTheDampedPseudoInverse) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  Program program = make_program(*model, {{position_task(), DampingTask{{0.3}}}, {}, 0});
  const double q[] = {0, 0};  // straight: singular along x
  ASSERT_TRUE(program.set_target(0, Pose{{kUpper + kFore, 0.05, 0}, {}}).ok());
  ASSERT_EQ(program.solve(q, 0.01), SolutionStatus::kSolved);
  const Eigen::Matrix2d J = planar_jacobian(0, 0);
  const Eigen::Vector2d expected =
      (J.transpose() * J + 0.09 * Eigen::Matrix2d::Identity()).inverse() * J.transpose() *
      Eigen::Vector2d(0, 0.05);
  EXPECT_LT((program.x() - expected).norm(), 1e-12);
}

// Three slides along x with masses m: the centre of mass has the Jacobian of the mass that each
// slide carries.
TEST(InverseKinematics, CentreOfMassOfAChain) {
  const ModelPtr model = compile_model(R"(<mujoco><worldbody>
    <body name="a"><joint type="slide" axis="1 0 0"/><geom size=".1" mass="1"/>
      <body><joint type="slide" axis="1 0 0"/><geom size=".1" mass="2"/>
        <body><joint type="slide" axis="1 0 0"/><geom size=".1" mass="5"/></body></body></body>
    </worldbody></mujoco>)");
  Program program = make_program(*model, {{ComTask{"a", {1, 1, 1}, 1, 0}}, {}, 1e-9});
  const double q[] = {0.1, 0.2, -0.3};
  const double com = (1 * 0.1 + 2 * 0.3 + 5 * 0.0) / 8;
  const std::array target = {com + 0.08, 0.0, 0.0};
  ASSERT_TRUE(program.set_target(0, target).ok());
  ASSERT_EQ(program.solve(q, 0.01), SolutionStatus::kSolved);
  const Eigen::Vector3d J(1, 7.0 / 8, 5.0 / 8);
  EXPECT_LT((program.x() - J / J.squaredNorm() * 0.08).norm(), 1e-7);
  EXPECT_NEAR(program.error(0)[0], -0.08, 1e-15);
}

TEST(InverseKinematics, PostureTaskMovesByItsGain) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  Program program = make_program(*model, {{PostureTask{{2, 0.5}, 0.25, 0}}, {}, 0});
  const std::array target = {0.4, -0.8};
  ASSERT_TRUE(program.set_target(0, target).ok());
  const double q[] = {0, 0};
  ASSERT_EQ(program.solve(q, 0.01), SolutionStatus::kSolved);
  EXPECT_NEAR(program.x()[0], 0.1, 1e-12);
  EXPECT_NEAR(program.x()[1], -0.2, 1e-12);
}

TEST(InverseKinematics, LimitsBoundEachStep) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  const Problem problem{
      {PostureTask{{1}, 1, 0}}, {ConfigurationLimit{0.5, 0.1}, VelocityLimit{{{"elbow", {3}}}}}, 0};
  Program program = make_program(*model, problem);
  const std::array target = {9.0, -9.0};
  ASSERT_TRUE(program.set_target(0, target).ok());
  const double q[] = {2, 0};
  ASSERT_EQ(program.solve(q, 0.01), SolutionStatus::kSolved);
  EXPECT_NEAR(program.x()[0], 0.5 * (2.5 - 0.1 - 2), 1e-12);
  EXPECT_NEAR(program.x()[1], -0.03, 1e-12);
}

// Two spheres on slides along x approach each other with the share 0.5 of the free distance.
TEST(InverseKinematics, CollisionLimitKeepsTheDistance) {
  const ModelPtr model = compile_model(R"(<mujoco><worldbody>
    <body name="a"><joint name="a" type="slide" axis="1 0 0"/><geom name="a" size=".1"/></body>
    <body name="b" pos="1 0 0"><joint name="b" type="slide" axis="1 0 0"/><geom name="b" size=".1"/></body>
    </worldbody></mujoco>)");
  CollisionLimit limit{{{{"a"}, {"b"}}}, 0.5, 0.05, 2, 0};
  Program program = make_program(*model, {{PostureTask{{1}, 1, 0}}, {limit}, 0});
  const std::array target = {3.0, -3.0};
  ASSERT_TRUE(program.set_target(0, target).ok());
  double q[] = {0, 0}, distance = 0.8;
  for (int step = 0; step < 60; ++step) {
    ASSERT_EQ(program.solve(q, 0.01), SolutionStatus::kSolved);
    for (int i = 0; i < 2; ++i) q[i] += program.x()[i];
    distance = 0.05 + 0.5 * (distance - 0.05);
    EXPECT_NEAR(1 + q[1] - q[0] - 0.2, distance, 1e-6) << step;
  }
  EXPECT_NEAR(distance, 0.05, 1e-9);
}

TEST(InverseKinematics, UnreachableTargetsLeaveAFiniteResidual) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  Program program = make_program(
      *model, {{FrameTask{kTip, {1, 1, 1}, {0, 0, 0}, 0.1, 10}}, {ConfigurationLimit{}}, 1e-6});
  // The orientation of the tip stretched towards the target.
  const double half = 0.5 * std::atan2(1, 2);
  ASSERT_TRUE(program.set_target(0, Pose{{2, 1, 0}, {std::cos(half), 0, 0, std::sin(half)}}).ok());
  double q[] = {0.1, 0.7};
  for (int step = 0; step < 400; ++step) {
    ASSERT_EQ(program.solve(q, 0.01), SolutionStatus::kSolved);
    for (int i = 0; i < 2; ++i) q[i] += program.x()[i];
  }
  EXPECT_LT(program.x().norm(), 1e-6);
  const Eigen::Vector2d tip = planar_tip(q[0], q[1]);
  EXPECT_LT((tip - 0.9 * Eigen::Vector2d(2, 1).normalized()).norm(), 1e-2) << "stretched out";
}

TEST(InverseKinematics, ContradictingLimitsAreInfeasible) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  const Problem problem{
      {PostureTask{{1}, 1, 0}}, {ConfigurationLimit{}, VelocityLimit{{{"shoulder", {1}}}}}, 0};
  Program program = make_program(*model, problem);
  const std::array target = {0.0, 0.0};
  ASSERT_TRUE(program.set_target(0, target).ok());
  const double outside[] = {4, 0};
  EXPECT_EQ(program.solve(outside, 0.01), SolutionStatus::kInfeasible);
  const double inside[] = {1, 0};
  EXPECT_EQ(program.solve(inside, 0.01), SolutionStatus::kSolved) << "and it recovers";
  EXPECT_NEAR(program.x()[0], -0.01, 1e-12);
}

TEST(InverseKinematics, AnUndeterminedMotionIsSingular) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  Program program = make_program(*model, {{FrameTask{kTip, {1, 0, 0}, {0, 0, 0}}}, {}, 0});
  ASSERT_TRUE(program.set_target(0, Pose{{0.4, 0, 0}, {}}).ok());
  const double q[] = {0, 0};
  EXPECT_EQ(program.solve(q, 0.01), SolutionStatus::kSingular);
  const double nan[] = {std::nan(""), 0};
  EXPECT_EQ(program.solve(nan, 0.01), SolutionStatus::kSingular);
}

TEST(InverseKinematics, LogarithmAndItsDerivative) {
  const Transform X{Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
                    {0.3, -0.2, 0.7}};
  const Vector3d turn = log(X).tail<3>();
  EXPECT_LT((turn - 1.1 * Vector3d(1, -2, 0.5).normalized()).norm(), 1e-12);
  const Transform pure{Matrix3d::Identity(), {0.3, -0.2, 0.7}};
  EXPECT_LT((log(pure).head<3>() - pure.p).norm(), 1e-15);
  const Matrix6d J = log_derivative(X);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const auto moved = [&](double d) {
      Transform step{Matrix3d::Identity(), Vector3d::Zero()};
      if (i < 3) step.p[i] = d;
      if (i >= 3) step.R = Eigen::AngleAxisd(d, Vector3d::Unit(i - 3)).toRotationMatrix();
      return log(X * step);
    };
    const Vector6d slope = (moved(kStep) - moved(-kStep)) / (2 * kStep);
    EXPECT_LT((slope - J.col(i)).norm(), 1e-8) << i;
  }
}

TEST(InverseKinematics, RepeatsBitByBit) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  const Problem problem{{position_task(), PostureTask{{0.01}, 1, 0}},
                        {ConfigurationLimit{}, VelocityLimit{{{"elbow", {1}}}}},
                        1e-9};
  Program first = make_program(*model, problem);
  const std::array rest = {0.2, 0.4};
  ASSERT_TRUE(first.set_target(0, Pose{{0.3, 0.5, 0}, {}}).ok());
  ASSERT_TRUE(first.set_target(1, rest).ok());
  double q[] = {0.1, 0.7};
  ASSERT_EQ(first.solve(q, 0.01), SolutionStatus::kSolved);
  Program second = first;
  const VectorXd x = first.x();
  for (Program* program : {&first, &second}) {
    const double other[] = {1, -1};
    ASSERT_EQ(program->solve(other, 0.01), SolutionStatus::kSolved);
    ASSERT_EQ(program->solve(q, 0.01), SolutionStatus::kSolved);
    EXPECT_TRUE(program->x() == x);
  }
}

TEST(InverseKinematics, RefusesWrongProblems) {
  const ModelPtr model = compile_model(planar_arm(kMotors));
  const auto error = [&](Problem problem) {
    const auto made = Program::create(*model, all_dofs(*model), problem);
    return made.ok() ? std::string() : made.error().to_string();
  };
  EXPECT_THAT(error({{FrameTask{{FrameKind::kSite, "tipp"}}}, {}, 0}), HasSubstr("'tip'"));
  EXPECT_THAT(error({{FrameTask{.frame = kTip, .gain = 1.5}}, {}, 0}), HasSubstr("0..1"));
  EXPECT_THAT(error({{PostureTask{{1, 2, 3}}}, {}, 0}), HasSubstr("3 values"));
  EXPECT_THAT(error({{PostureTask{{-1}}}, {}, 0}), HasSubstr("negative"));
  EXPECT_THAT(error({{}, {ConfigurationLimit{0}}, 0}), HasSubstr("(0, 1]"));
  EXPECT_THAT(error({{}, {VelocityLimit{{{"elbw", {1}}}}}, 0}), HasSubstr("'elbow'"));
  EXPECT_THAT(error({{}, {VelocityLimit{{{"elbow", {1, 2}}}}}, 0}), HasSubstr("2 values"));
  EXPECT_THAT(error({{}, {CollisionLimit{{{{"fore"}, {"wall"}}}}}, 0}), HasSubstr("'wall'"));
  EXPECT_THAT(error({{}, {}, -1}), HasSubstr("damping"));
  Program program = make_program(*model, {{position_task(), PostureTask{}}, {}, 1e-6});
  const std::array three = {1.0, 2.0, 3.0};
  EXPECT_FALSE(program.set_target(0, three).ok());
  EXPECT_FALSE(program.set_target(1, three).ok());
  EXPECT_FALSE(program.set_target(2, three).ok());
  EXPECT_FALSE(program.set_target(0, Pose{{}, {0, 0, 0, 0}}).ok());
  EXPECT_FALSE(program.has_targets());
}

TEST(InverseKinematics, FramesAreKindAndName) {
  EXPECT_EQ(parse_frame("geom left hand")->name, "left hand");
  EXPECT_EQ(parse_frame("site a/tip")->kind, FrameKind::kSite);
  for (const char* bad : {"", "site", "site ", "tip", "joint a"})
    EXPECT_FALSE(parse_frame(bad).ok()) << bad;
}

}  // namespace
}  // namespace gloam::ik
