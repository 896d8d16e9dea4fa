#pragma once
// TopicHub: readers that share the streams of a simulation's topics. One thread opens and closes
// the streams, tries again where one cannot be opened, and follows recompiles.

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "topics/hub/topic_group.h"

namespace gloam {

class TopicHub {
 public:
  /// `simulation` must outlive it.
  explicit TopicHub(Simulation& simulation);
  /// Its subscriptions must have ended.
  ~TopicHub();
  TopicHub(const TopicHub&) = delete;
  TopicHub& operator=(const TopicHub&) = delete;

  /// As Simulation::subscribe().
  Result<std::unique_ptr<TopicSubscription>> subscribe(TopicSink& sink);

 private:
  class Subscription;
  struct Entry {
    std::shared_ptr<SharedSink> reader;
    std::shared_ptr<const CompiledWorld> world;  // whose topics it has got
    std::set<std::string> wanted;
    std::map<std::string, std::string> reported;  // errors by topic
    std::map<std::string, int64_t> lost_at_join;  // by its groups until then
    int64_t lost_before = 0;                      // by groups that it has left
  };
  using Groups = std::map<std::string, std::shared_ptr<TopicGroup>>;  // by key
  /// Readers by group and topic.
  using Plan = std::map<std::string, std::map<std::string, SharedSinks>>;

  void set_topics(int64_t id, std::vector<std::string> names);
  void repeat(int64_t id, const std::string& topic, const TopicCallback& visit);
  int64_t dropped(int64_t id) const;
  void end(int64_t id);

  void run();
  void wake();
  Status follow_world();
  void settle();
  Plan make_plan() const;
  void set_readers(const Plan& plan);
  void count_losses(const Plan& plan);
  void report_errors();
  std::optional<Error> error_of(const std::string& topic) const;
  static std::string key_of(const TopicInfo& topic);

  Simulation& simulation_;

  mutable std::mutex mutex_;  // guards these
  std::condition_variable changed_;
  bool is_stopping_ = false, has_work_ = false;
  int64_t last_id_ = 0;
  std::map<int64_t, Entry> entries_;
  Groups groups_;  // the hub's thread alone changes it

  // The hub's thread.
  std::shared_ptr<const CompiledWorld> world_;
  std::map<std::string, TopicInfo> topics_;  // outputs of the World
  std::thread thread_;
};

}  // namespace gloam
