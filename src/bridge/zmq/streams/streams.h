#pragma once
// Streams: opens topics when their first subscriber comes and closes them with the last, on a
// thread of its own, since a camera's first picture takes a renderer.

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "bridge/zmq/outbox.h"
#include "bridge/zmq/streams/state_pack.h"
#include "bridge/zmq/streams/topic_sink.h"
#include "gloam/simulation.h"

namespace gloam::bridge::zeromq {

class Streams {
 public:
  Streams(Simulation& simulation, Outbox& outbox, StateLayouts& layouts, bool shared_memory);
  ~Streams();
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  /// Any thread; never blocks. `subscription` is a topic in one of its forms, "state" or
  /// "state/RATE"; others get an error message.
  void set_wanted(const std::string& subscription, bool is_wanted);
  /// Messages that the simulation's streams lost.
  int64_t dropped() const { return dropped_; }

 private:
  /// Topics that one stream serves: those of one camera are one rendering.
  struct Group {
    std::set<std::string> topics;
    std::unique_ptr<TopicStream> stream;
    std::atomic<bool> has_ended{false};
  };
  struct StateFeed {
    std::unique_ptr<SnapshotStream> stream;
    std::atomic<bool> has_ended{false};
  };
  using TopicForms = std::map<std::string, std::set<StreamForm>>;
  /// Copy of what is wanted, made at one moment.
  struct Plan {
    std::set<std::string> wanted;
    std::vector<std::string> again;  ///< subscribed to by one more
  };

  void run();
  Plan wait_for_work();
  void follow(const Plan& plan);
  void follow_topics(const Plan& plan);
  void tell_refused(const std::string& topic, const std::set<StreamForm>& forms, bool is_there);
  bool may_send(StreamForm form) const { return form != StreamForm::kShared || shared_memory_; }
  void follow_states(const Plan& plan);
  void open_group(const std::string& key, const std::set<std::string>& topics);
  Result<std::unique_ptr<SnapshotStream>> open_state(const std::string& subscription,
                                                     StateFeed* feed);
  void close_ended();
  /// Closes what `closes` says, and keeps count of what it has lost.
  template <class Streams, class Closes>
  void close_if(Streams& streams, const Closes& closes) {
    std::erase_if(streams, [&](const auto& open) {
      if (!closes(open)) return false;
      lost_before_ += open.second->stream->dropped();
      return true;
    });
  }
  void tell(const std::string& subscription, const Error& error);
  void note_end(std::atomic<bool>& has_ended);
  EndCallback end_callback(std::atomic<bool>& has_ended);

  Simulation& simulation_;
  Outbox& outbox_;
  StateLayouts& layouts_;
  const bool shared_memory_;
  std::atomic<int64_t> dropped_{0};

  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false, has_work_ = false;
  std::set<std::string> wanted_;
  std::vector<std::string> again_;

  // The thread's own.
  std::map<std::string, std::shared_ptr<TopicSink>> sinks_;  // by topic
  std::map<std::string, std::unique_ptr<Group>> groups_;
  std::map<std::string, std::unique_ptr<StateFeed>> states_;
  std::map<std::string, std::string> told_;  // errors by subscription
  int64_t lost_before_ = 0;                  // by streams that are closed
  bool has_failed_ = false;                  // something wanted is not open: tried again
  std::thread thread_;
};

}  // namespace gloam::bridge::zeromq
