#include "topics/hub/topic_hub.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/log.h"

namespace gloam {
namespace {

constexpr std::chrono::milliseconds kPollPeriod{100};  // at recompiles and readers that are gone

}  // namespace

class TopicHub::Subscription final : public TopicSubscription {
 public:
  Subscription(TopicHub& hub, int64_t id) : hub_(hub), id_(id) {}
  ~Subscription() override { hub_.end(id_); }
  void set_topics(std::vector<std::string> names) override {
    hub_.set_topics(id_, std::move(names));
  }
  void repeat(const std::string& topic, const TopicCallback& visit) override {
    hub_.repeat(id_, topic, visit);
  }
  int64_t dropped() const override { return hub_.dropped(id_); }

 private:
  TopicHub& hub_;
  const int64_t id_;
};

TopicHub::TopicHub(Simulation& simulation) : simulation_(simulation) {
  thread_ = std::thread([this] { run(); });
}

// All groups at once: cameras that still run would keep the renderer from one that is closed.
TopicHub::~TopicHub() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
  std::vector<std::thread> closing;
  for (const auto& [key, group] : groups_) closing.emplace_back([&group] { group->close(); });
  for (std::thread& thread : closing) thread.join();
}

Result<std::unique_ptr<TopicSubscription>> TopicHub::subscribe(TopicSink& sink) {
  const auto world = simulation_.world().compiled();
  GLOAM_TRY(const std::vector<TopicInfo> topics, simulation_.topics());
  sink.on_topics(topics);
  int64_t id = 0;
  {
    const std::lock_guard lock(mutex_);
    id = ++last_id_;
    entries_[id] = {.reader = std::make_shared<SharedSink>(sink), .world = world};
  }
  wake();
  return std::unique_ptr<TopicSubscription>(std::make_unique<Subscription>(*this, id));
}

void TopicHub::set_topics(int64_t id, std::vector<std::string> names) {
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_.at(id);
    const std::set<std::string> wanted(std::make_move_iterator(names.begin()),
                                       std::make_move_iterator(names.end()));
    if (wanted == entry.wanted) return;
    entry.wanted = wanted;
    std::erase_if(entry.reported, [&entry](const auto& reported) {
      return !entry.wanted.contains(reported.first);
    });
  }
  wake();
}

void TopicHub::repeat(int64_t id, const std::string& topic, const TopicCallback& visit) {
  Groups groups;
  {
    const std::lock_guard lock(mutex_);
    entries_.at(id).reported.erase(topic);
    groups = groups_;
  }
  for (const auto& [key, group] : groups)
    if (group->visit_last(topic, visit)) break;
  wake();
}

int64_t TopicHub::dropped(int64_t id) const {
  const std::lock_guard lock(mutex_);
  const Entry& entry = entries_.at(id);
  int64_t dropped = entry.lost_before;
  for (const auto& [key, lost] : entry.lost_at_join)
    if (const auto group = groups_.find(key); group != groups_.end())
      dropped += group->second->dropped() - lost;
  return dropped;
}

void TopicHub::end(int64_t id) {
  std::shared_ptr<SharedSink> reader;
  {
    const std::lock_guard lock(mutex_);
    reader = entries_.at(id).reader;
    entries_.erase(id);
  }
  reader->end();
  wake();
}

void TopicHub::wake() {
  {
    const std::lock_guard lock(mutex_);
    has_work_ = true;
  }
  changed_.notify_all();
}

void TopicHub::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    const auto is_due = [this] { return is_stopping_ || has_work_; };
    if (entries_.empty() && groups_.empty())
      changed_.wait(lock, is_due);
    else
      changed_.wait_for(lock, kPollPeriod, is_due);
    if (is_stopping_) return;
    has_work_ = false;
    lock.unlock();
    if (const Status followed = follow_world(); !followed.ok())
      log_warning("topics: {}", followed.error().to_string());
    settle();
    lock.lock();
  }
}

Status TopicHub::follow_world() {
  const auto world = simulation_.world().compiled();
  std::vector<TopicInfo> topics;
  if (world != world_) {
    world_ = world;
    topics_.clear();
    GLOAM_TRY(topics, simulation_.topics());
    for (const TopicInfo& topic : topics)
      if (!topic.is_input) topics_.emplace(topic.name, topic);
  }
  SharedSinks readers;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, entry] : entries_)
      if (std::exchange(entry.world, world) != world) readers.push_back(entry.reader);
  }
  if (readers.empty()) return {};
  if (topics.empty()) {
    GLOAM_TRY(topics, simulation_.topics());
  }
  for (const auto& reader : readers)
    reader->with_sink([&topics](TopicSink& sink) { sink.on_topics(topics); });
  return {};
}

void TopicHub::settle() {
  const Plan plan = make_plan();
  set_readers(plan);
  count_losses(plan);
  const auto now = TopicGroup::Clock::now();
  Groups empty;
  for (const auto& [key, group] : groups_) {
    group->settle(now);
    if (group->is_empty()) empty.emplace(key, group);
  }
  report_errors();
  for (const auto& [key, group] : empty) {
    const std::lock_guard lock(mutex_);
    groups_.erase(key);
  }
}

// A latched topic is a group of its own: it is sent once, when its stream opens.
std::string TopicHub::key_of(const TopicInfo& topic) {
  return topic.qos.is_latched ? topic.name : to_string(topic.source);
}

TopicHub::Plan TopicHub::make_plan() const {
  const std::lock_guard lock(mutex_);
  Plan plan;
  for (const auto& [id, entry] : entries_)
    for (const std::string& name : entry.wanted)
      if (const auto topic = topics_.find(name); topic != topics_.end())
        plan[key_of(topic->second)][name].push_back(entry.reader);
  return plan;
}

void TopicHub::set_readers(const Plan& plan) {
  for (const auto& [key, group] : groups_) {
    const auto wanted = plan.find(key);
    for (const std::string& name : group->topics()) {
      const auto topic = topics_.find(name);
      if (topic == topics_.end() || key_of(topic->second) != key)
        group->remove(name);
      else if (wanted == plan.end() || !wanted->second.contains(name))
        group->set_readers(name, {});
    }
  }
  for (const auto& [key, topics] : plan) {
    std::shared_ptr<TopicGroup> group;
    {
      const std::lock_guard lock(mutex_);
      auto& kept = groups_[key];
      if (kept == nullptr) kept = std::make_shared<TopicGroup>(simulation_, [this] { wake(); });
      group = kept;
    }
    for (const auto& [name, readers] : topics) group->set_readers(name, readers);
  }
}

// A reader counts the losses of a shared stream from when it joined.
void TopicHub::count_losses(const Plan& plan) {
  const std::lock_guard lock(mutex_);
  for (auto& [id, entry] : entries_) {
    const auto has_joined = [&entry](const auto& topics) {
      return std::ranges::any_of(topics, [&entry](const auto& topic) {
        return std::ranges::count(topic.second, entry.reader) > 0;
      });
    };
    for (const auto& [key, topics] : plan)
      if (has_joined(topics)) entry.lost_at_join.emplace(key, groups_.at(key)->dropped());
    std::erase_if(entry.lost_at_join, [&](const auto& joined) {
      const auto topics = plan.find(joined.first);
      if (topics != plan.end() && has_joined(topics->second)) return false;
      if (const auto group = groups_.find(joined.first); group != groups_.end())
        entry.lost_before += group->second->dropped() - joined.second;
      return true;
    });
  }
}

std::optional<Error> TopicHub::error_of(const std::string& name) const {
  const auto topic = topics_.find(name);
  if (topic == topics_.end())
    return Error{ErrorKind::kInput, fmt::format("there is no output topic '{}'", name)};
  const auto group = groups_.find(key_of(topic->second));
  const Error* const error = group != groups_.end() ? group->second->error_of(name) : nullptr;
  return error != nullptr ? std::optional(*error) : std::nullopt;
}

void TopicHub::report_errors() {
  struct Report {
    std::shared_ptr<SharedSink> reader;
    std::string topic;
    Error error;
  };
  std::vector<Report> reports;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, entry] : entries_)
      for (const std::string& topic : entry.wanted) {
        const std::optional<Error> error = error_of(topic);
        if (!error) {
          entry.reported.erase(topic);
        } else if (std::string& reported = entry.reported[topic]; reported != error->message) {
          reported = error->message;
          reports.push_back({entry.reader, topic, *error});
        }
      }
  }
  for (const Report& report : reports)
    report.reader->with_sink(
        [&report](TopicSink& sink) { sink.on_error(report.topic, report.error); });
}

}  // namespace gloam
