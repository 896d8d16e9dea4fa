#pragma once
// Messages that a stream of topics has delivered, by topic.

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "gloam/simulation.h"
#include "ros/codec.h"

namespace gloam {

struct TopicInbox {
  std::mutex mutex;
  std::map<std::string, std::vector<std::vector<uint8_t>>> messages;
  std::map<std::string, std::vector<int64_t>> steps;

  TopicCallback callback() {
    return [this](const TopicMessage& message) {
      const std::lock_guard lock(mutex);
      messages[message.topic.name].emplace_back(message.data.begin(), message.data.end());
      steps[message.topic.name].push_back(message.step);
    };
  }

  /// All messages of a topic.
  template <class T>
  std::vector<T> all(const std::string& topic) const {
    std::vector<T> decoded;
    const auto found = messages.find(topic);
    if (found == messages.end()) return decoded;
    for (const auto& bytes : found->second) decoded.push_back(*decode<T>(bytes));
    return decoded;
  }
};

/// Messages of topics over `steps` steps of a new simulation in lockstep.
inline void record_topics(const World& world, const std::vector<std::string>& topics, int64_t steps,
                          TopicInbox* inbox) {
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  auto stream = *simulation->open_topics({.topics = topics, .required = true}, inbox->callback());
  ASSERT_TRUE(simulation->step(steps).ok());
  // Topics due at the last step come with the next.
  ASSERT_TRUE(simulation->step(1).ok());
  ASSERT_TRUE(stream->status().ok()) << stream->status().error().to_string();
}

}  // namespace gloam
