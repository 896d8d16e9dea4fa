// Actions of the ROS node without DDS: goals, feedback, cancels and results of SimulateSteps and
// FollowJointTrajectory.

#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <thread>

#include "bridge/ros2/services/actions.h"
#include "bridge/test/lab.h"
#include "ros/codec.h"
#include "ros/messages/action_msgs.h"
#include "ros/messages/control_msgs_5.h"
#include "ros/messages/simulation_interfaces.h"

namespace gloam::bridge {
namespace {

namespace sa = simulation_interfaces::action;
namespace ca = control_msgs::action;
using GoalStatus = action_msgs::GoalStatus;
using Cancel = action_msgs::srv::CancelGoal_Response;
using Fjt = ca::FollowJointTrajectory_Result;

constexpr auto kLongest = std::chrono::seconds(30);

/// A client of one action.
class Client {
 public:
  template <class Make>
  explicit Client(Make&& make)
      : action_(make([this](const std::string& topic, auto data) {
          const std::lock_guard lock(mutex_);
          (topic.ends_with("feedback") ? feedback_ : status_)
              .emplace_back(data.begin(), data.end());
        })) {}

  template <Message Response, Message Request>
  Response ask(size_t service, const Request& request) {
    std::vector<uint8_t> bytes;
    encode(request, &bytes);
    return decode<Response>(action_.services.at(service).answer(bytes).value()).value();
  }
  template <Message Response>
  std::future<Response> result(uint8_t goal) {
    const auto promise = std::make_shared<std::promise<Response>>();
    std::vector<uint8_t> bytes;
    encode(sa::SimulateSteps_GetResult_Request{{{goal}}}, &bytes);
    action_.services.at(2).answer_later(bytes, [promise](std::vector<uint8_t> reply) {
      promise->set_value(decode<Response>(reply).value());
    });
    return promise->get_future();
  }
  Cancel cancel(uint8_t goal) {
    return ask<Cancel>(1, action_msgs::srv::CancelGoal_Request{{{{goal}}, {}}});
  }
  template <Message T>
  std::vector<T> feedback() {
    const std::lock_guard lock(mutex_);
    std::vector<T> all;
    for (const auto& bytes : feedback_) all.push_back(decode<T>(bytes).value());
    return all;
  }
  /// Statuses of the newest GoalStatusArray.
  std::vector<int> statuses() {
    const std::lock_guard lock(mutex_);
    std::vector<int> all;
    if (status_.empty()) return all;
    const auto newest = decode<action_msgs::GoalStatusArray>(status_.back()).value();
    for (const auto& goal : newest.status_list) all.push_back(goal.status);
    return all;
  }
  const Ros2Action& action() const { return action_; }

 private:
  std::mutex mutex_;
  std::vector<std::vector<uint8_t>> feedback_, status_;
  Ros2Action action_;  // ends first: it publishes
};

class Ros2Actions : public Lab {
 protected:
  std::unique_ptr<Client> steps() {
    return std::make_unique<Client>(
        [this](Ros2Publish publish) { return simulate_steps_action(op(), "/sim", publish); });
  }
  bool send_steps(Client& client, uint8_t id, uint64_t count) {
    return client
        .ask<sa::SimulateSteps_SendGoal_Response>(
            0, sa::SimulateSteps_SendGoal_Request{{{id}}, {count}})
        .accepted;
  }
  std::unique_ptr<Client> follower(int interfaces = 2) {
    return std::make_unique<Client>([&](Ros2Publish publish) {
      return trajectory_action(*simulation_, "arm", interfaces, publish);
    });
  }
  static ca::FollowJointTrajectory_Goal bend(double to, double seconds) {
    ca::FollowJointTrajectory_Goal goal;
    goal.trajectory.joint_names = {"elbow"};
    goal.trajectory.points.resize(1);
    goal.trajectory.points[0].positions = {to};
    goal.trajectory.points[0].time_from_start.sec = static_cast<int32_t>(seconds);
    goal.trajectory.points[0].time_from_start.nanosec =
        static_cast<uint32_t>(1e9 * (seconds - std::floor(seconds)));
    return goal;
  }
  static bool send(Client& client, uint8_t id, const ca::FollowJointTrajectory_Goal& goal) {
    return client
        .ask<ca::FollowJointTrajectory_SendGoal_Response>(
            0, ca::FollowJointTrajectory_SendGoal_Request{{{id}}, goal})
        .accepted;
  }
  static ca::FollowJointTrajectory_GetResult_Response outcome(Client& client, uint8_t id) {
    auto result = client.result<ca::FollowJointTrajectory_GetResult_Response>(id);
    if (result.wait_for(kLongest) != std::future_status::ready) {
      ADD_FAILURE() << "no result";
      return {};
    }
    return result.get();
  }
  // Publishes the trajectory and takes steps until the goal has a result: its server may read the
  // step of the simulation late, and then waits for a later one.
  ca::FollowJointTrajectory_GetResult_Response outcome_beside(std::span<const uint8_t> trajectory,
                                                              Client& client, uint8_t id) {
    auto result = client.result<ca::FollowJointTrajectory_GetResult_Response>(id);
    const auto end = std::chrono::steady_clock::now() + kLongest;
    while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      EXPECT_TRUE(simulation_->publish("/arm/joint_trajectory", trajectory).ok());
      EXPECT_TRUE(op().step(100).ok());
      if (std::chrono::steady_clock::now() < end) continue;
      ADD_FAILURE() << "no result";
      return {};
    }
    return result.get();
  }
  double elbow() {
    return simulation_->latest()[simulation_->world().find_joint("arm/elbow").value()].position();
  }
};

using StepsResult = sa::SimulateSteps_GetResult_Response;

TEST_F(Ros2Actions, StepsAreTakenAndTold) {
  const auto client = steps();
  EXPECT_EQ(client->action().name, "/sim/simulate_steps");
  // As rosidl of Kilted describes them.
  EXPECT_EQ(client->action().services[0].hash,
            "RIHS01_504407b9ff5617a737df8222cf581452b4f2e699e11e940d8d36590c5fb07d01");
  EXPECT_EQ(client->action().services[1].hash,
            "RIHS01_573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a");
  EXPECT_EQ(client->action().services[2].hash,
            "RIHS01_a1dae0516ab5c70d6d797e1bcd55c9448dfbb1966643f1ebd3e3f153d8169ae0");
  ASSERT_TRUE(send_steps(*client, 1, 300));
  const StepsResult result = client->result<StepsResult>(1).get();
  EXPECT_EQ(result.status, GoalStatus::STATUS_SUCCEEDED);
  EXPECT_EQ(result.result.result.result, simulation_interfaces::Result::RESULT_OK);
  EXPECT_EQ(simulation_->latest().step(), 300);
  const auto feedback = client->feedback<sa::SimulateSteps_FeedbackMessage>();
  ASSERT_FALSE(feedback.empty());
  EXPECT_EQ(feedback.back().feedback.completed_steps, 300u);
  EXPECT_EQ(feedback.back().feedback.remaining_steps, 0u);
  EXPECT_EQ(feedback.back().goal_id.uuid[0], 1);
  EXPECT_EQ(client->statuses(), (std::vector<int>{GoalStatus::STATUS_SUCCEEDED}));
  EXPECT_FALSE(send_steps(*client, 1, 3)) << "an id is used once";
  EXPECT_FALSE(send_steps(*client, 2, 0));
  EXPECT_EQ(client->result<StepsResult>(9).get().status, GoalStatus::STATUS_UNKNOWN);
  EXPECT_FALSE(client->action().services[0].answer({}).ok());
}

TEST_F(Ros2Actions, StepsAreCancelledAndRefusedWhileOthersRun) {
  const auto client = steps();
  ASSERT_TRUE(send_steps(*client, 1, 1'000'000'000));
  auto result = client->result<StepsResult>(1);
  EXPECT_FALSE(send_steps(*client, 2, 1));
  EXPECT_EQ(client->cancel(7).return_code, Cancel::ERROR_UNKNOWN_GOAL_ID);
  const Cancel cancelled = client->cancel(1);
  EXPECT_EQ(cancelled.return_code, Cancel::ERROR_NONE);
  ASSERT_EQ(cancelled.goals_canceling.size(), 1u);
  ASSERT_EQ(result.wait_for(kLongest), std::future_status::ready);
  EXPECT_EQ(result.get().status, GoalStatus::STATUS_CANCELED);
  EXPECT_EQ(client->cancel(1).return_code, Cancel::ERROR_GOAL_TERMINATED);
  EXPECT_EQ(client->cancel(0).return_code, Cancel::ERROR_NONE);  // all of none
  EXPECT_LT(simulation_->latest().step(), 1'000'000'000);
  ASSERT_TRUE(op().play().ok());
  ASSERT_TRUE(send_steps(*client, 3, 5));
  EXPECT_EQ(client->result<StepsResult>(3).get().status, GoalStatus::STATUS_ABORTED);
}

TEST_F(Ros2Actions, AServerThatEndsStopsItsGoal) {
  auto client = steps();
  ASSERT_TRUE(send_steps(*client, 1, 1'000'000'000));
  while (simulation_->latest().step() == 0) std::this_thread::yield();
  client.reset();
  const int64_t step = simulation_->latest().step();
  EXPECT_TRUE(op().step(1).ok());
  EXPECT_EQ(simulation_->latest().step(), step + 1);
}

TEST_F(Ros2Actions, JointsFollowTrajectories) {
  EXPECT_EQ(trajectory_robots(*simulation_), std::vector<std::string>{"arm"});
  const auto client = follower();
  EXPECT_EQ(client->action().name, "/arm/follow_joint_trajectory");
  ca::FollowJointTrajectory_Goal goal = bend(0.5, 1.5);
  goal.goal_tolerance = {{"elbow", 0.1, 0, 0}};
  ASSERT_TRUE(send(*client, 1, goal));
  ASSERT_TRUE(op().play().ok());
  const auto result = outcome(*client, 1);
  EXPECT_EQ(result.status, GoalStatus::STATUS_SUCCEEDED) << result.result.error_string;
  EXPECT_NEAR(elbow(), 0.5, 0.1);
  const auto feedback = client->feedback<ca::FollowJointTrajectory_FeedbackMessage>();
  ASSERT_GT(feedback.size(), 10u);
  const auto& last = feedback.back().feedback;
  EXPECT_NEAR(last.desired.positions.at(0) - last.actual.positions.at(0),
              last.error.positions.at(0), 1e-12);
}

TEST_F(Ros2Actions, TrajectoriesFailByTheirTolerances) {
  const auto client = follower(1);
  ca::FollowJointTrajectory_Goal goal = bend(1.2, 0.05);
  goal.path_tolerance = {{"elbow", 0.002, 0, 0}};  // the servo follows to 0.01 rad
  // While it runs: time passes between the acceptance of a goal and its first look at the joints.
  ASSERT_TRUE(op().play().ok());
  ASSERT_TRUE(send(*client, 1, goal));
  EXPECT_EQ(outcome(*client, 1).result.error_code, Fjt::PATH_TOLERANCE_VIOLATED);
  goal = bend(-0.6, 0.2);
  goal.goal_tolerance = {{"elbow", 1e-9, 0, 0}};
  goal.goal_time_tolerance.nanosec = 200'000'000;
  ASSERT_TRUE(send(*client, 2, goal));
  EXPECT_EQ(outcome(*client, 2).result.error_code, Fjt::GOAL_TOLERANCE_VIOLATED);
  goal = bend(0.1, 0.01);
  goal.trajectory.header.stamp.nanosec = 1;
  ASSERT_GT(simulation_->latest().time(), 0.02);
  ASSERT_TRUE(send(*client, 3, goal));
  EXPECT_EQ(outcome(*client, 3).result.error_code, Fjt::OLD_HEADER_TIMESTAMP);
  using Old = control_msgs_5::action::FollowJointTrajectory_FeedbackMessage;
  EXPECT_FALSE(client->feedback<Old>().empty());
}

TEST_F(Ros2Actions, ANewTrajectoryReplacesTheOld) {
  const auto client = follower();
  ASSERT_TRUE(send(*client, 1, bend(1, 50)));
  ASSERT_TRUE(op().play().ok());
  ASSERT_TRUE(send(*client, 2, bend(0.2, 0.2)));
  const auto replaced = outcome(*client, 1);
  EXPECT_EQ(replaced.status, GoalStatus::STATUS_ABORTED);
  EXPECT_EQ(replaced.result.error_code, Fjt::INVALID_GOAL);
  EXPECT_EQ(replaced.result.error_string, "a newer goal has replaced it");
  EXPECT_EQ(outcome(*client, 2).status, GoalStatus::STATUS_SUCCEEDED);
  ASSERT_TRUE(send(*client, 3, bend(1, 50)));
  EXPECT_EQ(client->cancel(3).return_code, Cancel::ERROR_NONE);
  EXPECT_EQ(outcome(*client, 3).status, GoalStatus::STATUS_CANCELED);
}

TEST_F(Ros2Actions, AMessageOfTheTopicReplacesTheTrajectoryOfAGoal) {
  const auto client = follower();
  std::vector<uint8_t> message;
  encode(bend(0.3, 0.4).trajectory, &message);
  const Robot arm = simulation_->world().find_robot("arm").value();
  ASSERT_TRUE(send(*client, 1, bend(1, 50)));
  const auto followed = [&] { return simulation_->latest().trajectory(arm); };
  while (followed() == nullptr || followed()->tag != 1) ASSERT_TRUE(op().step(1).ok());
  ASSERT_TRUE(simulation_->publish("/arm/joint_trajectory", message).ok());
  auto end = outcome_beside(message, *client, 1);
  EXPECT_EQ(end.status, GoalStatus::STATUS_ABORTED);
  EXPECT_EQ(end.result.error_code, Fjt::INVALID_GOAL);
  EXPECT_EQ(end.result.error_string, "another command has ended the trajectory");
  ASSERT_TRUE(op().step(200).ok());
  ASSERT_NE(followed(), nullptr) << "the goal must not stop its successor";
  EXPECT_EQ(followed()->tag, 0);
  EXPECT_NEAR(elbow(), 0.3, 0.1);
  // One that waits for its stamp.
  auto goal = bend(1, 1);
  goal.trajectory.header.stamp.sec = 2;
  ASSERT_TRUE(send(*client, 2, goal));
  while (simulation_->latest().time() < 2.1) {
    ASSERT_TRUE(simulation_->publish("/arm/joint_trajectory", message).ok());
    ASSERT_TRUE(op().step(20).ok());
  }
  end = outcome_beside(message, *client, 2);
  EXPECT_EQ(end.status, GoalStatus::STATUS_ABORTED);
  EXPECT_EQ(end.result.error_string, "another command has ended the trajectory");
  ASSERT_NE(followed(), nullptr);
  EXPECT_EQ(followed()->tag, 0);
}

TEST_F(Ros2Actions, CancellingHoldsTheJointsAlsoWhileAnotherClientHasTheRobot) {
  const auto client = follower();
  const Robot arm = simulation_->world().find_robot("arm").value();
  ASSERT_TRUE(send(*client, 1, bend(1, 50)));
  while (simulation_->latest().trajectory(arm) == nullptr) ASSERT_TRUE(op().step(1).ok());
  const auto lease = simulation_->claim(arm);
  ASSERT_TRUE(lease.ok()) << "a goal does not claim the robot";
  EXPECT_EQ(client->cancel(1).return_code, Cancel::ERROR_NONE);
  EXPECT_EQ(outcome(*client, 1).status, GoalStatus::STATUS_CANCELED);
  ASSERT_TRUE(op().step(1).ok());
  EXPECT_EQ(simulation_->latest().trajectory(arm), nullptr);
}

TEST_F(Ros2Actions, AGoalThatIsCancelledBeforeItsStampNeverStarts) {
  const auto client = follower();
  auto goal = bend(0.4, 0.1);
  goal.trajectory.header.stamp.nanosec = 500'000'000;
  ASSERT_TRUE(send(*client, 1, goal));
  while (client->statuses().back() != GoalStatus::STATUS_EXECUTING) std::this_thread::yield();
  ASSERT_TRUE(op().step(100).ok());
  EXPECT_EQ(client->cancel(1).return_code, Cancel::ERROR_NONE);
  EXPECT_EQ(outcome(*client, 1).status, GoalStatus::STATUS_CANCELED);
  const Robot arm = simulation_->world().find_robot("arm").value();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(op().step(100).ok());
    EXPECT_EQ(simulation_->latest().trajectory(arm), nullptr);
  }
  EXPECT_GT(simulation_->latest().time(), 0.6);
}

TEST_F(Ros2Actions, JointsThatAreWrongAbortTheirGoalAndNoOther) {
  const auto client = follower();
  ASSERT_TRUE(send(*client, 1, bend(0.2, 0.5)));
  const std::vector<std::vector<std::string>> wrong = {
      {"elbow", "elbow"}, {"elbow", "arm/elbow"}, {"knee"}, {""}, {}};
  uint8_t id = 2;
  for (const auto& names : wrong) {
    auto goal = bend(1, 1);
    goal.trajectory.joint_names = names;
    goal.trajectory.points[0].positions.assign(names.size(), 0.1);
    ASSERT_TRUE(send(*client, id, goal));
    const auto end = outcome(*client, id++);
    EXPECT_EQ(end.status, GoalStatus::STATUS_ABORTED);
    EXPECT_EQ(end.result.error_code, Fjt::INVALID_JOINTS);
    EXPECT_FALSE(end.result.error_string.empty());
  }
  ASSERT_TRUE(op().play().ok());
  EXPECT_EQ(outcome(*client, 1).status, GoalStatus::STATUS_SUCCEEDED) << "it went on";
}

TEST_F(Ros2Actions, BadTrajectoriesAreRefused) {
  const auto client = follower();
  ca::FollowJointTrajectory_Goal goal = bend(1, 1);
  goal.trajectory.points[0].positions.clear();
  EXPECT_FALSE(send(*client, 2, goal));
  goal = bend(std::nan(""), 1);
  EXPECT_FALSE(send(*client, 3, goal));
  goal = bend(1, 1);
  goal.trajectory.points.push_back(goal.trajectory.points[0]);
  EXPECT_FALSE(send(*client, 4, goal));
  goal = bend(1, 1);
  goal.trajectory.points.clear();
  EXPECT_FALSE(send(*client, 5, goal));
  goal = bend(1, 1);
  goal.trajectory.points[0].velocities = {1, 2};
  EXPECT_FALSE(send(*client, 5, goal));
  goal = bend(1, 1);
  goal.trajectory.points[0].accelerations = {1, 2};
  EXPECT_FALSE(send(*client, 5, goal));
  goal = bend(1, 1);
  goal.trajectory.points[0].effort = {std::nan("")};
  EXPECT_FALSE(send(*client, 5, goal));
  goal = bend(1, 1);
  goal.trajectory.points[0].time_from_start.sec = -1;
  EXPECT_FALSE(send(*client, 5, goal));
  // A robot that somebody else drives is theirs.
  const auto lease = simulation_->claim(simulation_->world().find_robot("arm").value());
  ASSERT_TRUE(lease.ok());
  ASSERT_TRUE(send(*client, 6, bend(1, 1)));
  EXPECT_EQ(outcome(*client, 6).status, GoalStatus::STATUS_ABORTED);
}

}  // namespace
}  // namespace gloam::bridge
