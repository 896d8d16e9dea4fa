#pragma once
// TimedSimulation: notes when a topic's messages leave a simulation. Physics, rendering and
// encoding come before, the bridge after it.

#include <functional>
#include <utility>

#include "topics/hub/forwarding_simulation.h"
#include "topics/hub/topic_hub.h"

namespace gloam::latency {

class TimedSimulation final : public ForwardingSimulation {
 public:
  /// Called with each message of a topic before its reader.
  using Note = std::function<void(const TopicMessage&)>;
  TimedSimulation(Simulation& real, Note note)
      : ForwardingSimulation(real), note_(std::move(note)) {}

  Result<std::unique_ptr<TopicStream>> open_topics(const TopicRequest& request,
                                                   TopicCallback on_message) override {
    return ForwardingSimulation::open_topics(
        request, [note = note_, on_message = std::move(on_message)](const TopicMessage& message) {
          note(message);
          on_message(message);
        });
  }
  Result<std::unique_ptr<TopicSubscription>> subscribe(TopicSink& sink) override {
    return hub_.subscribe(sink);
  }

 private:
  const Note note_;
  TopicHub hub_{*this};
};

}  // namespace gloam::latency
