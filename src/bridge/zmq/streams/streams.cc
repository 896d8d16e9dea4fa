#include "bridge/zmq/streams/streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bridge/zmq/streams/subscription.h"

namespace gloam::bridge::zeromq {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRetryPeriod{1000};
constexpr size_t kMaxSubscriptions = 4096;
constexpr size_t kMaxSubscriptionBytes = 512;
constexpr size_t kMaxStateRates = 16;

PackBuffer state_header(const Snapshot& snapshot, uint64_t sequence) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  PackBuffer buffer;
  Packer packer(buffer);
  packer.pack_map(6);
  pack_pair(packer, "type", std::string_view("state"));
  pack_pair(packer, "step", snapshot.step());
  pack_pair(packer, "time", snapshot.time());
  pack_pair(packer, "encoding", std::string_view("msgpack"));
  pack_pair(packer, "sequence", sequence);
  pack_pair(packer, "sent_ns", static_cast<int64_t>(std::chrono::nanoseconds(now).count()));
  return buffer;
}

}  // namespace

Streams::Streams(Simulation& simulation, Outbox& outbox, StateLayouts& layouts, bool shared_memory)
    : simulation_(simulation), outbox_(outbox), layouts_(layouts), shared_memory_(shared_memory) {
  thread_ = std::thread([this] { run(); });
}

Streams::~Streams() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Streams::set_wanted(const std::string& subscription, bool is_wanted) {
  if (subscription.empty() || subscription.size() > kMaxSubscriptionBytes) return;
  {
    const std::lock_guard lock(mutex_);
    if (!is_wanted) {
      wanted_.erase(subscription);
    } else if (wanted_.contains(subscription)) {
      if (again_.size() < kMaxSubscriptions) again_.push_back(subscription);
    } else if (wanted_.size() < kMaxSubscriptions) {
      wanted_.insert(subscription);
    }
    has_work_ = true;
  }
  changed_.notify_one();
}

Streams::Plan Streams::wait_for_work() {
  std::unique_lock lock(mutex_);
  const auto is_due = [this] { return stopping_ || has_work_; };
  // Now and then also while something is open: for what it has lost, and topics that are gone.
  if (has_failed_ || !groups_.empty() || !states_.empty())
    changed_.wait_for(lock, kRetryPeriod, is_due);
  else
    changed_.wait(lock, is_due);
  has_work_ = false;
  return {wanted_, std::exchange(again_, {})};
}

void Streams::run() {
  for (;;) {
    const Plan plan = wait_for_work();
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) break;
    }
    follow(plan);
  }
  groups_.clear();  // waits for the last callbacks
  states_.clear();
}

void Streams::follow(const Plan& plan) {
  has_failed_ = false;
  close_ended();
  std::erase_if(told_, [&plan](const auto& told) { return !plan.wanted.contains(told.first); });
  for (const std::string& subscription : plan.again) {
    told_.erase(subscription);  // a new subscriber wants to know, too
    const auto form = parse_topic(subscription);
    if (form && sinks_.contains(form->topic)) sinks_[form->topic]->send_latched();
  }
  for (const std::string& subscription : plan.wanted)
    if (!is_state(subscription) && !parse_topic(subscription))
      tell(subscription, {ErrorKind::kUsage,
                          fmt::format("no stream '{}'", subscription),
                          {},
                          "use /TOPIC, decoded/TOPIC, shm/TOPIC or state"});
  follow_topics(plan);
  follow_states(plan);
}

void Streams::follow_topics(const Plan& plan) {
  TopicForms forms;
  for (const std::string& subscription : plan.wanted)
    if (const auto topic = parse_topic(subscription)) forms[topic->topic].insert(topic->form);
  const auto topics = forms.empty() ? std::vector<TopicInfo>() : simulation_.topics();
  if (!topics.ok()) {
    for (const auto& [topic, wanted] : forms)
      for (const StreamForm form : wanted) tell(name_of(topic, form), topics.error());
    return;
  }
  std::map<std::string, std::set<std::string>> groups;
  for (const auto& [topic, wanted] : forms) {
    const auto info = std::ranges::find(*topics, topic, &TopicInfo::name);
    const bool is_there = info != topics->end() && !info->is_input;
    tell_refused(topic, wanted, is_there);
    if (!is_there) continue;
    std::shared_ptr<TopicSink>& sink = sinks_[topic];
    if (sink == nullptr) sink = std::make_shared<TopicSink>(topic, outbox_);
    for (const StreamForm form : kAllForms)
      sink->want(form, wanted.contains(form) && may_send(form));
    groups[info->qos.is_latched ? topic : info->source].insert(topic);
  }
  close_if(groups_, [&groups](const auto& open) {
    const auto wanted = groups.find(open.first);
    return wanted == groups.end() || wanted->second != open.second->topics;
  });
  std::erase_if(sinks_, [&forms](const auto& sink) { return !forms.contains(sink.first); });
  for (const auto& [key, names] : groups)
    if (!groups_.contains(key)) open_group(key, names);
}

void Streams::tell_refused(const std::string& topic, const std::set<StreamForm>& forms,
                           bool is_there) {
  for (const StreamForm form : forms) {
    if (!is_there)
      tell(name_of(topic, form), {ErrorKind::kInput,
                                  fmt::format("no output topic '{}'", topic),
                                  {},
                                  "operation 'topics' lists all topics"});
    else if (!may_send(form))
      tell(name_of(topic, form),
           {ErrorKind::kUsage,
            "shared memory is disabled",
            {},
            "set [bridge.zmq] shared_memory = true, or subscribe without 'shm'"});
  }
}

void Streams::open_group(const std::string& key, const std::set<std::string>& topics) {
  auto group = std::make_unique<Group>();
  group->topics = topics;
  std::map<std::string, std::shared_ptr<TopicSink>> sinks;
  for (const std::string& topic : topics) sinks[topic] = sinks_[topic];
  const TopicRequest request{.topics = {topics.begin(), topics.end()},
                             .on_end = end_callback(group->has_ended)};
  auto stream =
      simulation_.open_topics(request, [sinks = std::move(sinks)](const TopicMessage& message) {
        const auto sink = sinks.find(message.topic.name);
        if (sink != sinks.end()) sink->second->take(message);
      });
  for (const std::string& topic : topics)
    for (const StreamForm form : kAllForms) {
      if (!sinks_[topic]->wants(form)) continue;
      if (stream.ok())
        told_.erase(name_of(topic, form));
      else
        tell(name_of(topic, form), stream.error());
    }
  if (!stream.ok()) return;
  group->stream = std::move(*stream);
  groups_[key] = std::move(group);
}

void Streams::follow_states(const Plan& plan) {
  close_if(states_, [&plan](const auto& open) { return !plan.wanted.contains(open.first); });
  for (const std::string& subscription : plan.wanted) {
    if (!is_state(subscription) || states_.contains(subscription)) continue;
    if (states_.size() >= kMaxStateRates) {
      tell(subscription, {ErrorKind::kUsage, "too many different state rates"});
      continue;
    }
    auto feed = std::make_unique<StateFeed>();
    auto stream = open_state(subscription, feed.get());
    if (!stream.ok()) {
      tell(subscription, stream.error());
      continue;
    }
    told_.erase(subscription);
    feed->stream = std::move(*stream);
    states_[subscription] = std::move(feed);
  }
}

Result<std::unique_ptr<SnapshotStream>> Streams::open_state(const std::string& subscription,
                                                            StateFeed* feed) {
  GLOAM_TRY(const Rational rate, parse_rate(subscription));
  const SnapshotRequest request{.rate = rate, .on_end = end_callback(feed->has_ended)};
  return simulation_.open_snapshots(
      request, [this, subscription, sequence = uint64_t{0}](const Snapshot& snapshot) mutable {
        const auto layout = layouts_.of(snapshot);
        if (!layout.ok()) return;
        PackBuffer body;
        Packer packer(body);
        packer.pack_map(kStatePairs);
        pack_state(packer, snapshot, *layout);
        const PackBuffer header = state_header(snapshot, sequence++);
        outbox_.publish({subscription, zmq::message_t(header.data(), header.size()),
                         zmq::message_t(body.data(), body.size())});
      });
}

EndCallback Streams::end_callback(std::atomic<bool>& has_ended) {
  return [this, &has_ended](const Error&) { note_end(has_ended); };
}

void Streams::note_end(std::atomic<bool>& has_ended) {
  has_ended = true;
  {
    const std::lock_guard lock(mutex_);
    has_work_ = true;
  }
  changed_.notify_one();
}

void Streams::close_ended() {
  const auto has_ended = [](const auto& open) { return open.second->has_ended.load(); };
  close_if(groups_, has_ended);
  close_if(states_, has_ended);
  int64_t lost = lost_before_;
  for (const auto& [key, group] : groups_) lost += group->stream->dropped();
  for (const auto& [key, state] : states_) lost += state->stream->dropped();
  dropped_ = lost;
}

void Streams::tell(const std::string& subscription, const Error& error) {
  has_failed_ = true;
  std::string& told = told_[subscription];
  if (told == error.message) return;
  told = error.message;
  outbox_.publish(error_publication(subscription, error));
}

}  // namespace gloam::bridge::zeromq
