#include "bridge/zmq/streams/streams.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace gloam::bridge::zeromq {
namespace {

constexpr size_t kMaxSubscriptions = 4096;
constexpr size_t kMaxSubscriptionBytes = 512;

}  // namespace

Status Streams::open() {
  GLOAM_TRY(topics_, simulation_.subscribe(*this));
  return {};
}

// A client that subscribes to a stream which others have subscribed to before is reported, too.
void Streams::set_wanted(const std::string& subscription, bool is_wanted) {
  if (subscription.empty() || subscription.size() > kMaxSubscriptionBytes) return;
  {
    const std::lock_guard lock(mutex_);
    if (!is_wanted)
      wanted_.erase(subscription);
    else if (!wanted_.contains(subscription) && wanted_.size() >= kMaxSubscriptions)
      return;
    else
      wanted_.insert(subscription);
  }
  if (is_state(subscription)) return states_.set_wanted(subscription, is_wanted);
  if (const auto topic = parse_topic(subscription)) return set_wanted(*topic, is_wanted);
  if (is_wanted)
    outbox_.publish(
        error_publication(subscription, {ErrorKind::kUsage,
                                         fmt::format("no stream '{}'", subscription),
                                         {},
                                         "use /TOPIC, decoded/TOPIC, shm/TOPIC or state"}));
}

void Streams::set_wanted(const TopicInForm& topic, bool is_wanted) {
  if (topic.form == StreamForm::kShared && !shared_memory_) {
    if (is_wanted)
      outbox_.publish(
          error_publication(name_of(topic.topic, topic.form),
                            {ErrorKind::kUsage,
                             "shared memory is disabled",
                             {},
                             "set [bridge.zmq] shared_memory = true, or subscribe without 'shm'"}));
    return;
  }
  std::shared_ptr<TopicEncoder> encoder;
  bool is_new = false;
  std::vector<std::string> names;
  {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<TopicEncoder>& kept = encoders_[topic.topic];
    is_new = kept == nullptr;
    if (is_new) kept = std::make_shared<TopicEncoder>(topic.topic, outbox_);
    encoder = kept;
    encoder->want(topic.form, is_wanted);
    if (!encoder->is_wanted()) encoders_.erase(topic.topic);
    for (const auto& [name, wanted] : encoders_) names.push_back(name);
    topics_->set_topics(std::move(names));
  }
  if (is_wanted && !is_new)
    topics_->repeat(topic.topic, [&encoder](const TopicMessage& last) { encoder->take(last); });
}

std::shared_ptr<TopicEncoder> Streams::encoder_of(const std::string& topic) {
  const std::lock_guard lock(mutex_);
  const auto encoder = encoders_.find(topic);
  return encoder != encoders_.end() ? encoder->second : nullptr;
}

void Streams::on_message(const TopicMessage& message) {
  if (const auto encoder = encoder_of(message.topic.name)) encoder->take(message);
}

void Streams::on_error(const std::string& topic, const Error& why) {
  const auto encoder = encoder_of(topic);
  if (encoder == nullptr) return;
  for (const StreamForm form : kAllForms)
    if (encoder->wants(form)) outbox_.publish(error_publication(name_of(topic, form), why));
}

}  // namespace gloam::bridge::zeromq
