#include "mcap/log_queue.h"

#include <algorithm>
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
    : writer_(std::move(writer)), options_(options), thread_([this] { run(); }) {}

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
  const uint64_t bytes = message.data.size();
  std::unique_lock lock(mutex_);
  if (options_.policy == LogQueuePolicy::kWait) {
    room_.wait(lock, [&] { return closing_ || !status_ || !is_full_locked(bytes); });
  } else {
    while (is_full_locked(bytes)) drop_oldest_locked();
  }
  GLOAM_TRY_STATUS(refuse_locked());
  waiting_bytes_ += bytes;
  ++waiting_messages_;
  items_.push_back(std::move(message));
  work_.notify_one();
  return {};
}

template <class T>
Status LogQueue::push_record(T record) {
  const std::lock_guard lock(mutex_);
  GLOAM_TRY_STATUS(refuse_locked());
  items_.push_back(std::move(record));
  work_.notify_one();
  return {};
}
template Status LogQueue::push_record(McapSchema);
template Status LogQueue::push_record(McapChannel);
template Status LogQueue::push_record(McapAttachment);
template Status LogQueue::push_record(McapMetadata);
template Status LogQueue::push_record(LogQueueFlush);

Status LogQueue::refuse_locked() const {
  GLOAM_TRY_STATUS(status_);
  if (closing_) return Error{ErrorKind::kUsage, "the log is closed", {}, {}};
  return {};
}

bool LogQueue::is_full_locked(uint64_t more) const {
  if (waiting_messages_ == 0) return false;
  return waiting_messages_ >= options_.most_messages || waiting_bytes_ + more > options_.most_bytes;
}

void LogQueue::drop_oldest_locked() {
  const auto oldest = std::find_if(items_.begin(), items_.end(), [](const Item& item) {
    return std::holds_alternative<LogQueueMessage>(item);
  });
  auto& message = std::get<LogQueueMessage>(*oldest);
  ++dropped_[message.channel];
  --waiting_messages_;
  waiting_bytes_ -= message.data.size();
  recycle_locked(std::move(message.data));
  items_.erase(oldest);
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
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    work_.notify_all();
    room_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
  return status();
}

void LogQueue::run() {
  auto next_flush = std::chrono::steady_clock::now() + options_.flush_interval;
  std::unique_lock lock(mutex_);
  while (true) {
    work_.wait_until(lock, next_flush, [&] { return closing_ || !items_.empty(); });
    if (items_.empty() && closing_) break;
    std::optional<Item> item;
    if (!items_.empty()) {
      item = std::move(items_.front());
      items_.pop_front();
      if (const auto* message = std::get_if<LogQueueMessage>(&*item)) {
        --waiting_messages_;
        waiting_bytes_ -= message->data.size();
        room_.notify_all();
      }
    }
    const bool broken = !status_;
    lock.unlock();
    Status written;
    if (item && !broken) written = write(*item);
    if (const auto now = std::chrono::steady_clock::now(); now >= next_flush) {
      if (written.ok() && !broken) written = writer_->flush();
      next_flush = now + options_.flush_interval;
    }
    lock.lock();
    if (!written && status_.ok()) status_ = written;
    if (!written) room_.notify_all();
    if (auto* message = item ? std::get_if<LogQueueMessage>(&*item) : nullptr) {
      if (broken || !written) ++dropped_[message->channel];
      recycle_locked(std::move(message->data));
    }
  }
  const bool broken = !writer_->status();
  lock.unlock();
  Status finished = broken ? Status() : writer_->finish();
  lock.lock();
  if (!finished && status_.ok()) status_ = std::move(finished);
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
