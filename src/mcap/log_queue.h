#pragma once
// Bounded queue in front of a McapWriter, which works on a thread of its own. In a batch run the
// producer waits while the queue is full and nothing is lost; in real time the oldest messages are
// dropped and counted, so a slow disk never holds up physics.

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <variant>
#include <vector>

#include "base/threads/bounded_queue.h"
#include "gloam/result.h"
#include "mcap/mcap_records.h"
#include "mcap/mcap_writer.h"

namespace gloam {

struct LogQueueOptions {
  Overflow overflow = Overflow::kWait;
  uint64_t most_bytes = uint64_t{64} << 20;        ///< of messages that wait
  size_t most_messages = 16384;                    ///< that wait
  std::chrono::milliseconds flush_interval{1000};  ///< wall time; a killed process loses that much
};

/// Message that owns its data.
struct LogQueueMessage {
  uint16_t channel = 0;
  uint32_t sequence = 0;
  uint64_t log_time = 0, publish_time = 0;  ///< [ns]
  std::vector<uint8_t> data;
};

/// Mark in the queue: what was pushed before it is handed to the operating system.
struct LogQueueFlush {};

/// All calls may come from any thread.
class LogQueue {
 public:
  explicit LogQueue(std::unique_ptr<McapWriter> writer, const LogQueueOptions& options = {});
  /// Drains and finishes the log; the error, if there is one, is in the program's log.
  ~LogQueue();
  LogQueue(const LogQueue&) = delete;
  LogQueue& operator=(const LogQueue&) = delete;

  /// An empty buffer, with memory of a message that was written before if there is one.
  std::vector<uint8_t> take_buffer();
  /// Errors: the writer's; the message is dropped then. A message larger than the whole queue is
  /// taken when the queue is empty.
  Status push(LogQueueMessage message);
  /// These are never dropped, keep their order with messages, and wait for no room.
  Status push(McapSchema schema) { return push(std::move(schema), kRecord); }
  Status push(McapChannel channel) { return push(std::move(channel), kRecord); }
  Status push(McapAttachment attachment) { return push(std::move(attachment), kRecord); }
  Status push(McapMetadata metadata) { return push(std::move(metadata), kRecord); }
  Status push(LogQueueFlush flush) { return push(flush, kRecord); }

  /// First error of the writer.
  Status status() const;
  uint64_t dropped() const;
  std::map<uint16_t, uint64_t> dropped_by_channel() const;
  /// Writes what waits, finishes the log and ends the thread. May be called twice. After it push()
  /// is an error.
  Status close();

 private:
  using Item = std::variant<LogQueueMessage, McapSchema, McapChannel, McapAttachment, McapMetadata,
                            LogQueueFlush>;

  static constexpr ItemOptions kRecord = {.is_kept = true};

  Status push(Item item, const ItemOptions& options);
  void count_dropped_locked(LogQueueMessage message);
  void recycle_locked(std::vector<uint8_t> buffer);
  void run();
  Status write(const Item& item);

  std::unique_ptr<McapWriter> writer_;
  const std::chrono::milliseconds flush_interval_;
  BoundedQueue<Item> items_;
  mutable std::mutex mutex_;                   // guards the next three
  std::vector<std::vector<uint8_t>> buffers_;  // to use again
  std::map<uint16_t, uint64_t> dropped_;
  Status status_;
  std::mutex close_mutex_;
  std::thread thread_;
};

}  // namespace gloam
