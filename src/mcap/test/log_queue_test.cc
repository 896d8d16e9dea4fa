// The queue in front of the writer: nothing lost where it waits, the oldest lost where it may not.

#include "mcap/log_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "mcap/test/mcap_test_log.h"

namespace gloam {
namespace {

/// Disk that stands still until it is let go.
class StuckSink final : public LogSink {
 public:
  StuckSink(std::shared_ptr<LogBytes> bytes, std::atomic<bool>* stuck)
      : inner_(std::move(bytes)), stuck_(stuck) {}
  Status write(std::span<const uint8_t> bytes) override {
    stuck_->wait(true);
    return inner_.write(bytes);
  }
  Status sync() override { return {}; }
  Status close() override { return {}; }

 private:
  MemorySink inner_;
  std::atomic<bool>* stuck_;
};

LogQueueMessage queued(uint32_t number, size_t size = 40) {
  TestMessage m = numbered(number, size);
  return {m.channel, m.sequence, m.log_time, m.log_time + 1, std::move(m.data)};
}

Status declare_two(LogQueue* queue) {
  GLOAM_TRY_STATUS(queue->push(test_schema()));
  GLOAM_TRY_STATUS(queue->push(test_channel(1)));
  return queue->push(test_channel(2));
}

TEST(LogQueue, KeepsEverythingWhereItWaits) {
  const auto bytes = std::make_shared<LogBytes>();
  LogQueue queue(std::make_unique<McapWriter>(std::make_unique<MemorySink>(bytes)),
                 {.most_bytes = 1000, .most_messages = 4});
  ASSERT_TRUE(declare_two(&queue).ok());
  for (uint32_t i = 0; i < 5000; ++i) ASSERT_TRUE(queue.push(queued(i)).ok());
  ASSERT_TRUE(queue.push(McapMetadata{"end", {}}).ok());
  EXPECT_TRUE(queue.close().ok());
  EXPECT_TRUE(queue.close().ok()) << "twice";
  EXPECT_FALSE(queue.push(queued(0)).ok()) << "after the end";
  EXPECT_EQ(queue.dropped(), 0u);
  std::string error;
  const auto found = read_log(*bytes, &error);
  EXPECT_EQ(found.size(), 5000u);
  EXPECT_TRUE(is_prefix(found, numbered_messages(5000)));
}

TEST(LogQueue, DropsTheOldestWithoutWaiting) {
  const auto bytes = std::make_shared<LogBytes>();
  std::atomic<bool> stuck = true;
  LogQueue queue(std::make_unique<McapWriter>(std::make_unique<StuckSink>(bytes, &stuck),
                                              McapWriterOptions{.chunk_size = 1}),
                 {.overflow = Overflow::kDropOldest, .most_messages = 100});
  ASSERT_TRUE(declare_two(&queue).ok());
  for (uint32_t i = 0; i < 1000; ++i) ASSERT_TRUE(queue.push(queued(i)).ok());  // the disk stands
  EXPECT_GE(queue.dropped(), 899u);
  const auto by_channel = queue.dropped_by_channel();
  EXPECT_NEAR(static_cast<double>(by_channel.at(1)), static_cast<double>(by_channel.at(2)), 2);
  stuck = false;
  stuck.notify_all();
  EXPECT_TRUE(queue.close().ok());
  std::string error;
  const auto found = read_log(*bytes, &error);
  EXPECT_EQ(found.size() + queue.dropped(), 1000u);
  ASSERT_GE(found.size(), 100u);
  for (uint32_t i = 0; i < 100; ++i)
    EXPECT_EQ(found[found.size() - 100 + i].sequence, 900 + i) << "the newest are there";
}

TEST(LogQueue, TellsAFullDiskAndNeverHangs) {
  for (const Overflow overflow : {Overflow::kWait, Overflow::kDropOldest}) {
    const auto bytes = std::make_shared<LogBytes>();
    LogQueue queue(std::make_unique<McapWriter>(std::make_unique<MemorySink>(bytes, 5),
                                                McapWriterOptions{.chunk_size = 200}),
                   {.overflow = overflow, .most_messages = 10});
    ASSERT_TRUE(declare_two(&queue).ok());
    uint32_t accepted = 0;
    while (accepted < 1000000 && queue.push(queued(accepted)).ok()) ++accepted;
    ASSERT_LT(accepted, 1000000u);
    EXPECT_THAT(queue.status().error().message, testing::HasSubstr("No space left"));
    EXPECT_FALSE(queue.close().ok());
    const Recovered out = recover_bytes(*bytes);
    ASSERT_TRUE(out.report.ok());
    EXPECT_GT(out.report->messages, 0u);
  }
}

TEST(LogQueue, FlushesByWallTimeWithoutFurtherMessages) {
  const auto bytes = std::make_shared<LogBytes>();
  LogQueue queue(std::make_unique<McapWriter>(std::make_unique<MemorySink>(bytes)),
                 {.flush_interval = std::chrono::milliseconds(10)});
  ASSERT_TRUE(declare_two(&queue).ok());
  ASSERT_TRUE(queue.push(queued(0)).ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  ASSERT_TRUE(queue.push(queued(1)).ok());
  EXPECT_TRUE(queue.close().ok());
  // Without a flush between them both messages would be in one chunk.
  EXPECT_EQ(McapReader::open(make_memory_source(*bytes))->statistics().chunks, 2u);
}

TEST(LogQueue, UsesBuffersAgain) {
  const auto bytes = std::make_shared<LogBytes>();
  LogQueue queue(std::make_unique<McapWriter>(std::make_unique<MemorySink>(bytes)));
  ASSERT_TRUE(declare_two(&queue).ok());
  ASSERT_TRUE(queue.push(queued(0, 5000)).ok());
  for (int i = 0; i < 1000; ++i) {
    const std::vector<uint8_t> buffer = queue.take_buffer();
    EXPECT_TRUE(buffer.empty());
    if (buffer.capacity() >= 5000) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  FAIL() << "no buffer came back";
}

TEST(LogQueue, TakesMessagesFromManyThreads) {
  const auto bytes = std::make_shared<LogBytes>();
  {
    LogQueue queue(std::make_unique<McapWriter>(std::make_unique<MemorySink>(bytes)),
                   {.most_messages = 16});
    ASSERT_TRUE(declare_two(&queue).ok());
    std::vector<std::thread> threads;
    for (uint32_t t = 0; t < 4; ++t) {
      threads.emplace_back([&queue, t] {
        for (uint32_t i = 0; i < 500; ++i) (void)queue.push(queued(500 * t + i)).ok();
      });
    }
    for (std::thread& thread : threads) thread.join();
  }  // the destructor drains
  std::string error;
  auto found = read_log(*bytes, &error);
  EXPECT_TRUE(found.size() == 2000 && is_prefix(found, numbered_messages(2000))) << error;
}

}  // namespace
}  // namespace gloam
