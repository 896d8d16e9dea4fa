#include "topics/hub/topic_group.h"

#include <algorithm>
#include <utility>

namespace gloam {
namespace {

// A reader that comes back soon finds the stream as it was: its exposure, its encoder.
constexpr std::chrono::seconds kLingerTime{2};
constexpr std::chrono::seconds kRetryPeriod{1};

}  // namespace

void TopicGroup::set_readers(const std::string& topic, const SharedSinks& readers) {
  std::shared_ptr<const Kept> last;
  SharedSinks added;
  {
    const std::lock_guard lock(mutex_);
    Outlet& outlet = outlets_[topic];
    for (const auto& reader : readers)
      if (std::ranges::count(outlet.readers, reader) == 0) added.push_back(reader);
    outlet.readers = readers;
    last = outlet.last;
  }
  if (last == nullptr || added.empty()) return;
  const std::lock_guard one_at_a_time(latched_mutex_);
  for (const auto& reader : added)
    reader->with_sink([&last](TopicSink& sink) { sink.on_message(last->message()); });
}

void TopicGroup::remove(const std::string& topic) {
  const std::lock_guard lock(mutex_);
  outlets_.erase(topic);
}

std::vector<std::string> TopicGroup::topics() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> topics;
  for (const auto& [topic, outlet] : outlets_) topics.push_back(topic);
  return topics;
}

SharedSinks TopicGroup::readers_of(const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  const auto outlet = outlets_.find(topic);
  return outlet != outlets_.end() ? outlet->second.readers : SharedSinks();
}

void TopicGroup::deliver(const TopicMessage& message) {
  if (message.topic.qos.is_latched) return deliver_latched(message);
  for (const auto& reader : readers_of(message.topic.name))
    reader->with_sink([&message](TopicSink& sink) { sink.on_message(message); });
}

void TopicGroup::deliver_latched(const TopicMessage& message) {
  auto kept = std::make_shared<const Kept>(
      Kept{message.topic, message.run, message.step, message.time, message.delivery,
           std::vector<uint8_t>(message.data.begin(), message.data.end())});
  const std::lock_guard one_at_a_time(latched_mutex_);
  SharedSinks readers;
  {
    const std::lock_guard lock(mutex_);
    const auto outlet = outlets_.find(message.topic.name);
    if (outlet == outlets_.end()) return;
    outlet->second.last = std::move(kept);
    readers = outlet->second.readers;
  }
  for (const auto& reader : readers)
    reader->with_sink([&message](TopicSink& sink) { sink.on_message(message); });
}

bool TopicGroup::visit_last(const std::string& topic, const TopicCallback& visit) {
  const std::lock_guard one_at_a_time(latched_mutex_);
  std::shared_ptr<const Kept> last;
  {
    const std::lock_guard lock(mutex_);
    const auto outlet = outlets_.find(topic);
    if (outlet != outlets_.end()) last = outlet->second.last;
  }
  if (last == nullptr) return false;
  visit(last->message());
  return true;
}

void TopicGroup::settle(Clock::time_point now) {
  take_end(now);
  const std::vector<std::string> wanted = wanted_topics(now);
  if (wanted == open_) {
    error_.reset();
    return;
  }
  if (wanted.empty()) {
    error_.reset();
    return close();
  }
  if (now < next_try_) return;
  const Status opened = open(wanted);
  error_ = opened.ok() ? std::nullopt : std::optional(opened.error());
  if (opened.ok())
    open_ = wanted;
  else
    next_try_ = now + kRetryPeriod;
}

void TopicGroup::take_end(Clock::time_point now) {
  std::optional<Error> ended;
  {
    const std::lock_guard lock(mutex_);
    ended = std::exchange(ended_, std::nullopt);
  }
  if (!ended) return;
  close();
  error_ = std::move(ended);
  next_try_ = now + kRetryPeriod;
}

std::vector<std::string> TopicGroup::wanted_topics(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  for (auto& [topic, outlet] : outlets_)
    if (!outlet.readers.empty()) outlet.wanted = now;
  std::erase_if(outlets_,
                [now](const auto& item) { return now - item.second.wanted >= kLingerTime; });
  std::vector<std::string> wanted;
  for (const auto& [topic, outlet] : outlets_) wanted.push_back(topic);
  return wanted;
}

Status TopicGroup::open(const std::vector<std::string>& topics) {
  if (stream_ != nullptr) return stream_->set_topics(topics);
  TopicRequest request{.topics = topics};
  request.on_end = [this](const Error& why) {
    {
      const std::lock_guard lock(mutex_);
      if (!ended_) ended_ = why;
    }
    on_end_();
  };
  const auto on_message = [this](const TopicMessage& message) { deliver(message); };
  GLOAM_TRY(auto stream, simulation_.open_topics(request, on_message));
  const std::lock_guard lock(mutex_);
  stream_ = std::move(stream);
  return {};
}

const Error* TopicGroup::error_of(const std::string& topic) const {
  return error_ && std::ranges::count(open_, topic) == 0 ? &*error_ : nullptr;
}

// Outside of the lock: the last callback may wait for it.
void TopicGroup::close() {
  std::shared_ptr<TopicStream> stream;
  {
    const std::lock_guard lock(mutex_);
    stream = std::exchange(stream_, nullptr);
    if (stream != nullptr) lost_before_ += stream->dropped();
  }
  open_.clear();
}

int64_t TopicGroup::dropped() const {
  const std::lock_guard lock(mutex_);
  return lost_before_ + (stream_ != nullptr ? stream_->dropped() : 0);
}

}  // namespace gloam
