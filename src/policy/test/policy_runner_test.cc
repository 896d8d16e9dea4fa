#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "policy/test/leg_robot.h"
#include "policy/test/linear_network.h"

namespace gloam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A network whose outputs are constants.
LinearNetwork constant(size_t inputs, std::vector<float> outputs,
                       const std::string& name = "actions") {
  const size_t rows = outputs.size();
  return {{{"obs", inputs}}, {{name, rows}}, std::vector<float>(rows * inputs), std::move(outputs)};
}

class PolicyRunnerTest : public ::testing::Test {
 protected:
  Result<std::unique_ptr<PolicyRunner>> make(const std::string& tables,
                                             const LinearNetwork& network,
                                             const std::string& policy = kLegPolicy) {
    folder_.add("p.onnx", network);
    const auto settings = folder_.write("p.toml", policy + tables);
    GLOAM_TRY(auto loaded, Policy::load(folder_.path("p.onnx"), settings, PolicyFolder::load));
    return leg_.run(loaded);
  }
  PolicyFault act(PolicyRunner& runner, std::array<double, 3> command = {}) {
    return runner.act(*leg_.model, *leg_.data, {}, command);
  }
  std::vector<float> seen(const PolicyRunner& runner, size_t network = 0) {
    const auto values = runner.observation(network);
    return {values.begin(), values.end()};
  }

  PolicyFolder folder_;
  LegRobot leg_;
};

TEST_F(PolicyRunnerTest, ObservesATurnedAndMovingRobot) {
  std::string tables;
  for (const char* term : {"base_lin_vel", "base_ang_vel", "projected_gravity", "joint_pos",
                           "joint_vel", "last_action", "command"})
    tables += std::string("[[observation]]\nterm = \"") + term + "\"\n";
  auto runner = make(tables, constant(18, {0.375f, -0.625f}));
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  const double half = std::sqrt(0.5);  // a quarter turn about x: the base's y is the world's z
  const double pose[7] = {0, 0, 1, half, half, 0, 0}, velocity[6] = {1, 2, 3, 0.1, 0.2, 0.3};
  std::copy_n(pose, 7, leg_.data->qpos);
  std::copy_n(velocity, 6, leg_.data->qvel);
  leg_.q("knee") = 0.7, leg_.qd("knee") = 0.5;
  ASSERT_EQ(act(**runner, {0.1, -0.2, 0.3}).kind, PolicyFault::Kind::kNone);
  const float expected[18] = {1,    3,    -2,   0.1f, 0.2f, 0.3f, 0,    -1,    0,
                              0.4f, 0.2f, 0.5f, 0,    0,    0,    0.1f, -0.2f, 0.3f};
  const std::vector<float> first = seen(**runner);
  for (size_t i = 0; i < 18; ++i) EXPECT_NEAR(first[i], expected[i], 1e-6) << i;
  EXPECT_THAT((*runner)->targets(), ElementsAre(0.3 + 0.5 * 0.375, -0.2 - 0.5 * 0.625));
  ASSERT_EQ(act(**runner).kind, PolicyFault::Kind::kNone);
  EXPECT_EQ(seen(**runner)[13], 0.375f);
}

TEST_F(PolicyRunnerTest, FeedbackAddsTheIntegralOfTheVelocitysError) {
  const std::string keys =
      std::string(kLegPolicy) + "velocity_feedback = 2\ncommand_ranges = { vx = [-1, 1] }\n";
  auto runner = make("[[observation]]\nterm = \"command\"\n", constant(3, {0.0f, 0.0f}), keys);
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  // Heading along the world's y, nose down by 60 degrees: the heading frame stays level.
  const double yaw = std::sqrt(0.5), cosine = std::cos(std::numbers::pi / 6), sine = 0.5;
  const double pose[7] = {0, 0, 1, yaw * cosine, -yaw * sine, yaw * sine, yaw * cosine};
  const double velocity[6] = {-0.1, 0.4, 3, 0, 0, 0};  // 0.4 ahead, 0.1 to the left
  std::copy_n(pose, 7, leg_.data->qpos);
  std::copy_n(velocity, 6, leg_.data->qvel);
  for (int period = 1; period <= 3; ++period) {
    ASSERT_EQ(act(**runner, {0.5, 0, 0}).kind, PolicyFault::Kind::kNone);
    EXPECT_NEAR(seen(**runner)[0], 0.5 + period * 2.0 / 50 * 0.1, 1e-6);
    EXPECT_NEAR(seen(**runner)[1], -period * 2.0 / 50 * 0.1, 1e-6);
    EXPECT_NEAR(seen(**runner)[2], 0, 1e-6);
  }
  auto copy = (*runner)->clone();
  ASSERT_EQ(act(*copy, {0.5, 0, 0}).kind, PolicyFault::Kind::kNone);
  EXPECT_NEAR(seen(*copy)[0], 0.5 + 4 * 2.0 / 50 * 0.1, 1e-6);
  ASSERT_EQ(act(**runner, {-0.7, 0, 0}).kind, PolicyFault::Kind::kNone);
  EXPECT_NEAR(seen(**runner)[0], -0.7 + 3 * 2.0 / 50 * 0.1, 1e-6) << "an error above 1 m/s";
  for (int period = 0; period < 500; ++period) act(**runner, {0.9, 0.05, 0});
  EXPECT_NEAR(seen(**runner)[0], 1, 1e-6) << "the end of the command range";
  EXPECT_NEAR(seen(**runner)[1], 0.05 - 0.4, 1e-6) << "the largest correction";
  act(**runner, {});
  EXPECT_THAT(seen(**runner), ElementsAre(0, 0, 0));
  act(**runner, {0.5, 0, 0});
  EXPECT_NEAR(seen(**runner)[0], 0.5 + 2.0 / 50 * 0.1, 1e-6);
}

TEST_F(PolicyRunnerTest, ClipsThenScalesThenRemembersOldestFirst) {
  auto runner = make(
      "[[observation]]\nterm = \"command\"\nclip = [-1, 0.5]\nscale = [1, 10, 100]\n"
      "history = 3\n",
      constant(9, {0, 0}));
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  act(**runner, {0.25, -0.5, 0.0625});
  EXPECT_THAT(seen(**runner), ElementsAre(0.25, -5, 6.25, 0.25, -5, 6.25, 0.25, -5, 6.25));
  act(**runner, {5, 0, 0});
  EXPECT_THAT(seen(**runner), ElementsAre(0.25, -5, 6.25, 0.25, -5, 6.25, 0.5, 0, 0));
  (*runner)->reset();
  act(**runner, {0.125, 0, 0});
  EXPECT_THAT(seen(**runner), ElementsAre(0.125, 0, 0, 0.125, 0, 0, 0.125, 0, 0));
}

TEST_F(PolicyRunnerTest, HistoryOfWholeObservationsMayBeginWithTheNewest) {
  const std::string policy =
      std::string(kLegPolicy) +
      "history = 3\nhistory_order = \"newest_first\"\nhistory_start = \"zeros\"\n";
  auto runner = make(
      "[[observation]]\nterm = \"command_ang_vel\"\n[[observation]]\n"
      "term = \"command_lin_vel\"\n",
      constant(9, {0, 0}), policy);
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  act(**runner, {1, 2, 3});
  act(**runner, {4, 5, 6});
  EXPECT_THAT(seen(**runner), ElementsAre(6, 4, 5, 3, 1, 2, 0, 0, 0));
}

// Walk-These-Ways, equations of its gait: a foot's phase is warped so that it stands for the first
// half of the circle whatever its duration is.
TEST_F(PolicyRunnerTest, GaitClockFollowsOffsetsAndDuration) {
  const std::string policy = std::string(kLegPolicy) +
                             "[policy.gait]\nfrequency = 2.5\nphase = 0.5\noffset = 0.1\n"
                             "bound = 0.2\nduration = 0.4\nparameters = [\"frequency\", \"aux\"]\n";
  auto runner = make(
      "[[observation]]\nterm = \"gait_clock\"\n[[observation]]\n"
      "term = \"gait_parameters\"\n",
      constant(6, {0, 0}), policy);
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  for (int k = 1; k <= 60; ++k) {
    act(**runner);
    const double shifts[4] = {0.8, 0.2, 0.1, 0.5};
    for (int foot = 0; foot < 4; ++foot) {
      const double f = std::fmod(k * 2.5 / 50 + shifts[foot], 1.0);
      if (std::min({f, 1 - f, std::abs(f - 0.4)}) < 1e-9) continue;
      const double w = f < 0.4 ? f / 0.8 : 0.5 + (f - 0.4) / 1.2;
      EXPECT_NEAR(seen(**runner)[static_cast<size_t>(foot)], std::sin(2 * std::numbers::pi * w),
                  1e-6)
          << k << " " << foot;
    }
    EXPECT_EQ(seen(**runner)[4], 2.5f);
  }
}

TEST_F(PolicyRunnerTest, ScansHeightsAroundTheHeading) {
  auto runner = make(
      "[[observation]]\nterm = \"height_scan\"\nsize = [2, 0]\nresolution = 1\n"
      "offset = 0.5\n",
      constant(3, {0, 0}));
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  act(**runner);  // the step, 0.1 m high, is 1 m ahead; the base is at 1 m
  EXPECT_NEAR(seen(**runner)[0], 0.5, 1e-6);
  EXPECT_NEAR(seen(**runner)[1], 0.5, 1e-6);
  EXPECT_NEAR(seen(**runner)[2], 0.4, 1e-6);
  leg_.data->qpos[3] = 0, leg_.data->qpos[6] = 1;  // turned around
  act(**runner);
  EXPECT_NEAR(seen(**runner)[0], 0.4, 1e-6);
  EXPECT_NEAR(seen(**runner)[2], 0.5, 1e-6);
}

TEST_F(PolicyRunnerTest, SeesDepthsAlongTheOpticalAxis) {
  auto runner = make(
      "[[observation]]\nterm = \"depth_image\"\ncamera = \"down\"\nwidth = 3\n"
      "height = 2\nfar = 2\nnormalized = true\n",
      constant(6, {0, 0}));
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  act(**runner);  // the camera looks down from 0.9 m; its own leg does not hide the ground
  for (const float depth : seen(**runner)) EXPECT_NEAR(depth, 0.9 / 2 - 0.5, 1e-6);
}

TEST_F(PolicyRunnerTest, NetworksReadOutputsOfOthers) {
  // "half" runs in every second period; "main" reads one of its outputs and its own last one.
  folder_.add("half.onnx", LinearNetwork({{"obs", 1}}, {{"a", 1}, {"b", 2}}, {1, 2, 3}, {0, 0, 1}));
  const std::string tables =
      "[[network]]\nname = \"half\"\nfile = \"half.onnx\"\nevery = 2\n"
      "[[network.observation]]\nterm = \"command_ang_vel\"\n"
      "[[network]]\nname = \"main\"\n"
      "[[network.observation]]\nfrom = \"half.b\"\nfirst = 1\n"
      "[[network.observation]]\nfrom = \"main.state\"\ninput = \"memory\"\n";
  const LinearNetwork main({{"obs", 1}, {"memory", 1}}, {{"actions", 2}, {"state", 1}},
                           {1, 0, 0, 1, 0, 1}, {0, 0, 1});
  auto runner = make(tables, main);
  ASSERT_TRUE(runner.ok()) << runner.error().to_string();
  const auto action = [&](double yaw_rate) {
    EXPECT_EQ(act(**runner, {0, 0, yaw_rate}).kind, PolicyFault::Kind::kNone);
    return std::vector<double>((*runner)->action().begin(), (*runner)->action().end());
  };
  EXPECT_THAT(action(1), ElementsAre(4, 0));   // 3 * 1 + 1; its state is 0 at first
  EXPECT_THAT(action(10), ElementsAre(4, 1));  // "half" did not run
  EXPECT_THAT(action(10), ElementsAre(31, 2));
  const auto copy = (*runner)->clone();
  EXPECT_THAT(action(2), ElementsAre(31, 3));
  EXPECT_EQ(copy->act(*leg_.model, *leg_.data, {}, {0, 0, 2}).kind, PolicyFault::Kind::kNone);
  EXPECT_THAT(copy->action(), ElementsAre(31, 3));
}

TEST_F(PolicyRunnerTest, NetworksOutsideTheFolderOfTheSettingsAreRejected) {
  for (const char* file : {"../p.onnx", "/etc/passwd", "a/../../p.onnx"}) {
    const auto runner = make(std::string("[[network]]\nname = \"half\"\nfile = \"") + file +
                                 "\"\n[[network.observation]]\nterm = \"command_ang_vel\"\n",
                             constant(2, {0, 0}));
    ASSERT_FALSE(runner.ok()) << file;
    EXPECT_NE(runner.error().to_string().find("outside of the folder"), std::string::npos)
        << runner.error().to_string();
  }
}

TEST_F(PolicyRunnerTest, DrivesMotorsAndServosWithTheSameTorque) {
  const auto torques = [&](const std::string& actuators) {
    LegRobot leg(actuators);
    folder_.add("p.onnx", constant(2, {1, -1}));
    const auto settings = folder_.write(
        "p.toml", std::string(kLegPolicy) + "[[observation]]\nterm = \"joint_pos\"\n");
    auto policy = Policy::load(folder_.path("p.onnx"), settings, PolicyFolder::load);
    auto runner = leg.run(*policy);
    EXPECT_TRUE(runner.ok()) << runner.error().to_string();
    leg.q("hip") = 0.1, leg.qd("hip") = -1, leg.q("knee") = 0.5, leg.qd("knee") = 2;
    (*runner)->act(*leg.model, *leg.data, {}, {});
    (*runner)->robot().drive((*runner)->targets(), leg.data.get());
    mj_forward(leg.model.get(), leg.data.get());
    const double* torque = leg.data->qfrc_actuator;
    return std::vector<double>{torque[6], torque[7]};
  };
  const double hip = 20 * (-0.7 - 0.1) + 0.5, knee = 10 * (0.8 - 0.5) - 0.5 * 2;
  for (
      const char* actuators :
      {kLegActuators,
       R"(<position name="a" joint="hip" kp="20" kv="0.5"/><position name="b" joint="knee" kp="10" kv="0.5"/>)",
       R"(<position name="a" joint="hip" kp="7" kv="1"/><motor name="b" joint="knee"/>)"}) {
    const std::vector<double> found = torques(actuators);
    EXPECT_NEAR(found[0], hip, 1e-9) << actuators;
    EXPECT_NEAR(found[1], knee, 1e-9) << actuators;
  }
}

TEST_F(PolicyRunnerTest, ReportsWhatIsNotFinite) {
  LinearNetwork bad = constant(2, {0, std::numeric_limits<float>::quiet_NaN()});
  auto runner = make("[[observation]]\nterm = \"joint_pos\"\n", bad);
  ASSERT_TRUE(runner.ok());
  const PolicyFault fault = act(**runner);
  EXPECT_EQ(fault.kind, PolicyFault::Kind::kAction);
  EXPECT_THAT(describe((*runner)->policy(), fault), HasSubstr("action for 'hip' is not finite"));
  leg_.q("knee") = std::numeric_limits<double>::infinity();
  (*runner)->reset();
  EXPECT_THAT(describe((*runner)->policy(), act(**runner)), HasSubstr("'joint_pos'"));
}

TEST_F(PolicyRunnerTest, ErrorsNameEverythingThatIsMissing) {
  const auto error_of = [&](const std::string& tables, size_t size, const std::string& policy) {
    auto runner = make(tables, constant(size, {0, 0}), policy);
    return runner.ok() ? "" : runner.error().to_string();
  };
  const std::string term = "[[observation]]\nterm = \"joint_pos\"\n", policy = kLegPolicy;
  std::string others = policy;
  others.replace(others.find("\"knee\", \"hip\""), 13, "\"kneee\", \"hop\"");
  EXPECT_THAT(error_of(term, 2, others), HasSubstr("has no joint kneee, hop"));
  EXPECT_THAT(error_of(term, 7, policy),
              HasSubstr("terms have 2 numbers, but the network takes 7"));
  EXPECT_THAT(error_of(term, 7, policy), HasSubstr("joint_pos 2"));
  EXPECT_THAT(error_of(term + "sensor = \"giro\"\n", 2, policy), HasSubstr("has no sensor giro"));
  EXPECT_THAT(error_of(term + "sensor = \"gyro\"\n", 2, policy), HasSubstr("has 3 numbers"));
  EXPECT_THAT(error_of(term + "input = \"observation\"\n", 2, policy), HasSubstr("no input"));
  EXPECT_THAT(
      error_of("[[observation]]\nterm = \"depth_image\"\ncamera = \"dawn\"\n", 87 * 58, policy),
      HasSubstr("no camera 'dawn'"));
  folder_.add("p.onnx", constant(2, {0, 0, 0}));
  const auto loaded = Policy::load(folder_.path("p.onnx"), folder_.write("p.toml", policy + term),
                                   PolicyFolder::load);
  EXPECT_THAT(loaded.error().message, HasSubstr("2 joints, but the network outputs 3"));
}

}  // namespace
}  // namespace gloam
