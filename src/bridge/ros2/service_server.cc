#include "bridge/ros2/service_server.h"

#include "bridge/ros2/ros2_names.h"

namespace gloam::bridge {

Status ServiceServer::add(Ros2Service service) {
  auto entry = std::make_unique<Entry>();
  const TopicQos qos{.is_reliable = true, .depth = 100};
  GLOAM_TRY(entry->writer, node_.add_writer({.topic = dds_reply(service.name),
                                             .type = dds_type(service.type, "_Response"),
                                             .type_hash = service.hash,
                                             .qos = qos}));
  entry->service = std::move(service);
  const Entry* const self = entry.get();
  GLOAM_TRY(entry->reader,
            node_.add_reader(
                {.topic = dds_request(entry->service.name),
                 .type = dds_type(entry->service.type, "_Request"),
                 .type_hash = entry->service.hash,
                 .qos = qos},
                [this, self](const DdsSample& sample) {
                  const PushResult pushed =
                      queue_.push({self, {sample.data.begin(), sample.data.end()}, sample.request});
                  if (pushed == PushResult::kFull) ++refused_;
                }));
  entries_.push_back(std::move(entry));
  return {};
}

void ServiceServer::start() {
  thread_ = std::thread([this] { run(); });
}

void ServiceServer::stop() {
  queue_.close();
  queue_.take_all();
  if (thread_.joinable()) thread_.join();
  for (const auto& entry : entries_) entry->reader.reset();
}

void ServiceServer::run() {
  while (const auto waiting = queue_.pop()) answer(*waiting);
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
