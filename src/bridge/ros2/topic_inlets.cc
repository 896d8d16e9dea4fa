#include "bridge/ros2/topic_inlets.h"

#include <algorithm>

#include "bridge/ros2/ros2_names.h"

namespace gloam::bridge {
namespace {

constexpr auto kLeaseTimeout = std::chrono::seconds(1);

// The robot that goals are for; others' commands (a pose, a push, a reset) have no master.
const SetVelocityGoal* velocity_goal(const Command& command) {
  return std::get_if<SetVelocityGoal>(&command.what);
}

bool is_drive(const Command& command) {
  return std::visit(
      [](const auto& what) {
        using T = std::decay_t<decltype(what)>;
        if constexpr (std::is_same_v<T, StopTrajectory>) return false;
        return requires { what.robot; } || std::is_same_v<T, SetControl> ||
               std::is_same_v<T, SetJointGoal>;
      },
      command.what);
}

// The robot that an input drives; "" = none.
std::string robot_of(const TopicInfo& topic) {
  return topic.source.kind == TopicSource::Kind::kRobot ? topic.source.name : std::string();
}

}  // namespace

Status TopicInlets::set_topics(const std::vector<TopicInfo>& topics) {
  std::erase_if(inlets_, [&](const auto& inlet) {
    return std::ranges::none_of(topics, [&](const TopicInfo& t) {
      return t.name == inlet.first && t.type == inlet.second.topic.type;
    });
  });
  for (const TopicInfo& topic : topics) {
    if (inlets_.contains(topic.name)) continue;
    GLOAM_TRY(const MessageInfo type, message_info(topic.type));
    const DdsEndpoint endpoint{.topic = dds_topic(topic.name),
                               .type = type.dds_name,
                               .type_hash = type.hash,
                               // Best effort matches every publisher.
                               .qos = {.is_reliable = false, .depth = 10}};
    Inlet inlet{topic, nullptr};
    GLOAM_TRY(inlet.reader, node_.add_reader(endpoint, [this, topic](const DdsSample& sample) {
      take(topic, sample);
    }));
    inlets_.emplace(topic.name, std::move(inlet));
  }
  return {};
}

void TopicInlets::take(const TopicInfo& topic, const DdsSample& sample) {
  const Status status = obey(topic, sample);
  ++(status.ok() ? heard_ : refused_);
  if (status.ok()) return;
  const std::lock_guard lock(mutex_);
  refusal_ = topic.name + ": " + status.error().to_string();
}

Status TopicInlets::obey(const TopicInfo& topic, const DdsSample& sample) {
  GLOAM_TRY(const auto commands, simulation_.decode_input(topic.name, sample.data));
  const std::string robot = robot_of(topic);
  if (robot.empty() || !std::ranges::any_of(commands, is_drive)) return simulation_.post(commands);
  return obey_as_master(robot, sample.writer, commands);
}

Status TopicInlets::obey_as_master(const std::string& robot, const std::string& writer,
                                   const std::vector<Command>& commands) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  Master& master = masters_[robot];
  const bool is_free = master.lease == nullptr || now - master.last > kLeaseTimeout;
  if (!is_free && master.writer != writer)
    return Error{ErrorKind::kUsage,
                 "robot '" + robot + "' is controlled by another publisher",
                 {},
                 "it is released one second after the last message of that publisher"};
  if (master.lease == nullptr) {
    GLOAM_TRY(const Robot handle, simulation_.world().find_robot(robot));
    GLOAM_TRY(master.lease, simulation_.claim(handle));
  }
  if (master.writer != writer) master.has_velocity = false;
  master.writer = writer;
  master.last = now;
  GLOAM_TRY_STATUS(master.lease->post(commands));
  for (const Command& command : commands)
    if (const SetVelocityGoal* goal = velocity_goal(command))
      master.has_velocity = goal->vx != 0 || goal->vy != 0 || goal->yaw_rate != 0 || goal->vz != 0;
  return {};
}

void TopicInlets::release_silent() {
  const std::lock_guard lock(mutex_);
  const bool is_paused = simulation_.paused();
  const auto now = Clock::now();
  for (auto it = masters_.begin(); it != masters_.end();) {
    Master& master = it->second;
    if (is_paused && master.lease != nullptr) master.last = now;  // time rests
    if (master.lease != nullptr && now - master.last <= kLeaseTimeout) {
      ++it;
      continue;
    }
    if (master.lease != nullptr && master.has_velocity) {
      if (const auto robot = simulation_.world().find_robot(it->first); robot.ok())
        static_cast<void>(master.lease->post(Command{.what = SetVelocityGoal{*robot, 0, 0, 0}}));
    }
    it = masters_.erase(it);
  }
}

std::string TopicInlets::take_refusal() {
  const std::lock_guard lock(mutex_);
  return std::exchange(refusal_, {});
}

}  // namespace gloam::bridge
