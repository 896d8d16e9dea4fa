#include "mcap/log_queue.h"

#include <numeric>
#include <optional>
#include <utility>

#include "base/log.h"

namespace gloam {
namespace {

constexpr size_t kMostBuffers = 256;
constexpr uint64_t kLargestKept = 16 << 20;  // [bytes] of a buffer that is used again

}  // namespace

LogQueue::LogQueue(std::unique_ptr<McapWriter> writer, const LogQueueOptions& options)
    : writer_(std::move(writer)),
      flush_interval_(options.flush_interval),
      items_({.items = options.most_messages, .bytes = options.most_bytes}, options.overflow),
      thread_([this] { run(); }) {}

LogQueue::~LogQueue() {
  if (Status closed = close(); !closed) log_error("{}", closed.error().to_string());
}

std::vector<uint8_t> LogQueue::take_buffer() {
  const std::lock_guard lock(mutex_);
  if (buffers_.empty()) return {};
  std::vector<uint8_t> buffer = std::move(buffers_.back());
  buffers_.pop_back();
  return buffer;
}

Status LogQueue::push(LogQueueMessage message) {
  const size_t bytes = message.data.size();
  return push(std::move(message), {.bytes = bytes});
}

Status LogQueue::push(Item item, const ItemOptions& options) {
  GLOAM_TRY_STATUS(status());
  std::vector<Item> dropped;
  const PushResult pushed = items_.push(std::move(item), options, &dropped);
  const std::lock_guard lock(mutex_);
  for (Item& oldest : dropped) count_dropped_locked(std::get<LogQueueMessage>(std::move(oldest)));
  if (status_.ok() && pushed == PushResult::kClosed)
    return Error{ErrorKind::kUsage, "the log is closed", {}, {}};
  return status_;
}

void LogQueue::count_dropped_locked(LogQueueMessage message) {
  ++dropped_[message.channel];
  recycle_locked(std::move(message.data));
}

void LogQueue::recycle_locked(std::vector<uint8_t> buffer) {
  if (buffers_.size() >= kMostBuffers || buffer.capacity() > kLargestKept) return;
  buffer.clear();
  buffers_.push_back(std::move(buffer));
}

Status LogQueue::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::map<uint16_t, uint64_t> LogQueue::dropped_by_channel() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

uint64_t LogQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return std::accumulate(dropped_.begin(), dropped_.end(), uint64_t{0},
                         [](uint64_t sum, const auto& entry) { return sum + entry.second; });
}

Status LogQueue::close() {
  const std::lock_guard closing(close_mutex_);
  items_.close();
  if (thread_.joinable()) thread_.join();
  return status();
}

void LogQueue::run() {
  auto next_flush = std::chrono::steady_clock::now() + flush_interval_;
  while (!items_.has_ended()) {
    std::optional<Item> item = items_.pop_until(next_flush);
    Status written = status();
    const bool was_broken = !written;
    if (item && !was_broken) written = write(*item);
    if (const auto now = std::chrono::steady_clock::now(); now >= next_flush) {
      if (written.ok()) written = writer_->flush();
      next_flush = now + flush_interval_;
    }
    const std::lock_guard lock(mutex_);
    if (!was_broken) status_ = written;
    auto* const message = item ? std::get_if<LogQueueMessage>(&*item) : nullptr;
    if (message == nullptr) continue;
    if (written.ok())
      recycle_locked(std::move(message->data));
    else
      count_dropped_locked(std::move(*message));
  }
  if (!writer_->status()) return;
  Status finished = writer_->finish();
  const std::lock_guard lock(mutex_);
  if (status_.ok()) status_ = std::move(finished);
}

Status LogQueue::write(const Item& item) {
  struct Visitor {
    McapWriter* to;
    Status operator()(const LogQueueMessage& m) const {
      return to->add_message({m.channel, m.sequence, m.log_time, m.publish_time, m.data});
    }
    Status operator()(const McapSchema& schema) const { return to->add_schema(schema); }
    Status operator()(const McapChannel& channel) const { return to->add_channel(channel); }
    Status operator()(const McapAttachment& file) const { return to->add_attachment(file); }
    Status operator()(const McapMetadata& metadata) const { return to->add_metadata(metadata); }
    Status operator()(const LogQueueFlush&) const { return to->flush(); }
  };
  return std::visit(Visitor{writer_.get()}, item);
}

}  // namespace gloam
