#include "bridge/ros2/service_server.h"

#include "bridge/ros2/ros2_names.h"

namespace gloam::bridge {
namespace {

constexpr size_t kMaxQueuedRequests = 256;  // requests; further ones are dropped

}  // namespace

Status ServiceServer::add(Ros2Service service) {
  auto entry = std::make_unique<Entry>();
  const TopicQos qos{.is_reliable = true, .depth = 100};
  GLOAM_TRY(entry->writer, node_.add_writer({.topic = dds_reply(service.name),
                                             .type = dds_type(service.type, "_Response"),
                                             .type_hash = service.hash,
                                             .qos = qos}));
  entry->service = std::move(service);
  const Entry* const self = entry.get();
  GLOAM_TRY(
      entry->reader,
      node_.add_reader({.topic = dds_request(entry->service.name),
                        .type = dds_type(entry->service.type, "_Request"),
                        .type_hash = entry->service.hash,
                        .qos = qos},
                       [this, self](const DdsSample& sample) {
                         const std::lock_guard lock(mutex_);
                         if (queue_.size() >= kMaxQueuedRequests) {
                           ++refused_;
                           return;
                         }
                         queue_.push_back(
                             {self, {sample.data.begin(), sample.data.end()}, sample.request});
                         came_.notify_one();
                       }));
  entries_.push_back(std::move(entry));
  return {};
}

void ServiceServer::start() {
  thread_ = std::thread([this] { run(); });
}

void ServiceServer::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  came_.notify_all();
  if (thread_.joinable()) thread_.join();
  for (const auto& entry : entries_) entry->reader.reset();
}

void ServiceServer::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    came_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
    if (stopping_) return;
    const Waiting waiting = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    answer(waiting);
    lock.lock();
  }
}

void ServiceServer::answer(const Waiting& waiting) {
  const Entry& entry = *waiting.entry;
  if (entry.service.answer_later) {
    entry.service.answer_later(
        waiting.bytes, [writer = entry.writer, request = waiting.request](
                           const std::vector<uint8_t>& bytes) { writer->reply(bytes, request); });
    ++answered_;
    return;
  }
  const auto bytes = entry.service.answer(waiting.bytes);
  const bool is_sent = bytes.ok() && entry.writer->reply(*bytes, waiting.request);
  ++(is_sent ? answered_ : refused_);
}

}  // namespace gloam::bridge
