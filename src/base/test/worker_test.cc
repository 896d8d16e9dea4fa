#include "base/threads/worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "base/threads/bounded_queue.h"

namespace gloam {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

std::string all_of(BoundedQueue<std::string>& queue) {
  const std::vector<std::string> all = queue.take_all();
  return std::accumulate(all.begin(), all.end(), std::string());
}

TEST(BoundedQueue, RejectsTheNewestWhenFull) {
  BoundedQueue<std::string> queue({.items = 2}, Overflow::kReject);
  EXPECT_EQ(queue.push("a"), PushResult::kAdded);
  EXPECT_EQ(queue.push("b"), PushResult::kAdded);
  EXPECT_EQ(queue.push("c"), PushResult::kFull);
  EXPECT_EQ(queue.try_pop(), "a");
  EXPECT_EQ(queue.push("d"), PushResult::kAdded);
  EXPECT_EQ(all_of(queue), "bd");
  EXPECT_EQ(queue.dropped(), 0u) << "a refused item is the producer's";
}

TEST(BoundedQueue, DropsTheOldestAndHandsThemToTheProducer) {
  BoundedQueue<std::string> queue({.items = 3}, Overflow::kDropOldest);
  for (const char* item : {"a", "b", "c"}) queue.push(item);
  std::vector<std::string> dropped;
  EXPECT_EQ(queue.push("d", {}, &dropped), PushResult::kAdded);
  EXPECT_EQ(dropped, std::vector<std::string>{"a"});
  EXPECT_EQ(queue.dropped(), 1u);
  EXPECT_EQ(all_of(queue), "bcd");
}

TEST(BoundedQueue, LimitsBytesButTakesOneLargeItem) {
  BoundedQueue<std::string> queue({.bytes = 10}, Overflow::kDropOldest);
  queue.push("a", {.bytes = 4});
  queue.push("b", {.bytes = 6});
  EXPECT_EQ(queue.dropped(), 0u);
  queue.push("L", {.bytes = 1000});
  EXPECT_EQ(queue.dropped(), 2u);
  queue.push("c", {.bytes = 1});
  EXPECT_EQ(queue.dropped(), 3u) << "the large one fills the queue";
  queue.push("d", {.bytes = 9});
  EXPECT_EQ(all_of(queue), "cd");

  BoundedQueue<std::string> strict({.bytes = 10}, Overflow::kReject);
  EXPECT_EQ(strict.push("L", {.bytes = 1000}), PushResult::kAdded);
  EXPECT_EQ(strict.push("a", {.bytes = 1}), PushResult::kFull);
  EXPECT_EQ(strict.try_pop(), "L");
  EXPECT_EQ(strict.push("a", {.bytes = 1}), PushResult::kAdded);
}

TEST(BoundedQueue, KeptItemsAreOutsideOfTheLimits) {
  BoundedQueue<std::string> queue({.items = 2}, Overflow::kDropOldest);
  for (const char* item : {"K", "L"}) queue.push(item, {.is_kept = true});
  for (const char* item : {"a", "b", "c"}) queue.push(item);
  queue.push("M", {.is_kept = true});
  EXPECT_EQ(queue.dropped(), 1u);
  EXPECT_EQ(all_of(queue), "KLbcM") << "in the order of their arrival";
  BoundedQueue<std::string> strict({.items = 1}, Overflow::kReject);
  strict.push("a");
  EXPECT_EQ(strict.push("K", {.is_kept = true}), PushResult::kAdded);
}

TEST(BoundedQueue, ReplacesTheNewestItemOfTheSameKey) {
  BoundedQueue<std::string> queue({.items = 4, .bytes = 10}, Overflow::kReject);
  for (const char* item : {"a", "b", "c"}) queue.push(item, {.bytes = 4, .key = 5});
  queue.push("x");
  queue.push("d", {.bytes = 4, .key = 5});
  EXPECT_EQ(queue.push("e", {.bytes = 3, .key = 6}), PushResult::kFull);
  EXPECT_EQ(queue.push("f", {.bytes = 4, .key = 5}), PushResult::kAdded) << "needs no room";
  EXPECT_EQ(all_of(queue), "cxf");
  EXPECT_EQ(queue.push("g", {.bytes = 10}), PushResult::kAdded) << "all bytes are free again";
}

TEST(BoundedQueue, AProducerWaitsForRoomAndLosesNothing) {
  BoundedQueue<int> queue({.items = 2}, Overflow::kWait);
  std::atomic<int> pushed = 0;
  std::thread producer([&] {
    for (int i = 0; i < 1000; ++i, ++pushed) queue.push(i);
    queue.close();
  });
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(pushed, 2);
  int next = 0;
  while (const auto item = queue.pop()) EXPECT_EQ(*item, next++);
  EXPECT_EQ(next, 1000);
  EXPECT_EQ(queue.dropped(), 0u);
  producer.join();
}

TEST(BoundedQueue, ClosingReleasesAWaitingProducerAndKeepsTheItems) {
  BoundedQueue<std::string> queue({.items = 1}, Overflow::kWait);
  queue.push("a");
  PushResult result = PushResult::kAdded;
  std::thread producer([&] { result = queue.push("b"); });
  std::this_thread::sleep_for(milliseconds(50));
  queue.close();
  producer.join();
  EXPECT_EQ(result, PushResult::kClosed);
  EXPECT_EQ(queue.push("c"), PushResult::kClosed);
  EXPECT_EQ(queue.push("d", {.is_kept = true}), PushResult::kClosed);
  EXPECT_EQ(queue.pop(), "a");
  EXPECT_FALSE(queue.pop());
}

TEST(BoundedQueue, ClosingReleasesWaitingConsumers) {
  BoundedQueue<int> queue({}, Overflow::kWait);
  std::thread consumer([&] { EXPECT_FALSE(queue.pop()); });
  std::this_thread::sleep_for(milliseconds(20));
  queue.close();
  consumer.join();
}

TEST(BoundedQueue, AConsumerWaitsUntilATime) {
  BoundedQueue<int> queue({}, Overflow::kWait);
  const auto start = Clock::now();
  EXPECT_FALSE(queue.pop_until(start + milliseconds(30)));
  EXPECT_GE(Clock::now() - start, milliseconds(30));
  queue.push(1);
  EXPECT_EQ(queue.pop_until(start), 1) << "an item that waits is given at any time";
}

TEST(BoundedQueue, AProducerCanWaitUntilItsItemIsTaken) {
  BoundedQueue<int> queue({.items = 1}, Overflow::kWait);
  std::atomic<bool> is_taken = false;
  queue.push(1);
  std::thread producer([&] {
    queue.wait_until_empty();
    EXPECT_TRUE(is_taken);
  });
  std::this_thread::sleep_for(milliseconds(20));
  is_taken = true;
  queue.pop();
  producer.join();
}

TEST(BoundedQueue, ManyProducersAndConsumersLoseAndDoubleNothing) {
  BoundedQueue<int> queue({.items = 8}, Overflow::kWait);
  std::vector<std::atomic<int>> seen(4000);
  std::vector<std::thread> producers, consumers;
  for (int p = 0; p < 4; ++p)
    producers.emplace_back([&, p] {
      for (int i = 0; i < 1000; ++i) queue.push(1000 * p + i);
    });
  for (int c = 0; c < 3; ++c)
    consumers.emplace_back([&] {
      while (const auto item = queue.pop()) ++seen[static_cast<size_t>(*item)];
    });
  for (std::thread& producer : producers) producer.join();
  queue.close();
  for (std::thread& consumer : consumers) consumer.join();
  for (const auto& count : seen) ASSERT_EQ(count, 1);
}

/// Uses the queue in its destructor, as jobs that own clients do.
struct Poster {
  explicit Poster(BoundedQueue<std::shared_ptr<Poster>>* to) : queue(to) {}
  ~Poster() { queue->push(nullptr, {.is_kept = true}); }
  BoundedQueue<std::shared_ptr<Poster>>* queue;
};

TEST(BoundedQueue, ItemsAreDestroyedWithoutTheLock) {
  BoundedQueue<std::shared_ptr<Poster>> queue({.items = 1}, Overflow::kDropOldest);
  queue.push(std::make_shared<Poster>(&queue), {.key = 1});
  queue.push(std::make_shared<Poster>(&queue), {.key = 1});  // replaces
  queue.push(std::make_shared<Poster>(&queue));              // drops
  queue.take_all();
  queue.close();
  queue.push(std::make_shared<Poster>(&queue));  // is refused
  EXPECT_EQ(queue.take_all().size(), 1u);
}

/// A worker whose first job waits for open().
class BlockedWorker {
 public:
  BlockedWorker(size_t most, Overflow overflow) : worker(most, overflow) {
    worker.post_always([this] {
      begun_ = true;
      while (!open_ && !worker.stopping()) std::this_thread::yield();
    });
    while (!begun_) std::this_thread::yield();
  }
  void open() { open_ = true; }
  Worker::Job mark(char letter) {
    return [this, letter] { done += letter; };
  }
  std::string done;

 private:
  std::atomic<bool> begun_ = false, open_ = false;

 public:
  Worker worker;  // last: its jobs use the others
};

TEST(Worker, RunsJobsInOrderAndFinishesThemInClose) {
  BlockedWorker blocked(8, Overflow::kWait);
  for (const char letter : {'a', 'b', 'c'}) EXPECT_TRUE(blocked.worker.post(blocked.mark(letter)));
  EXPECT_FALSE(blocked.worker.is_idle());
  blocked.open();
  blocked.worker.close();
  blocked.worker.close();
  EXPECT_EQ(blocked.done, "abc");
  EXPECT_FALSE(blocked.worker.post(blocked.mark('d')));
  EXPECT_FALSE(blocked.worker.post_always(blocked.mark('d')));
}

TEST(Worker, KeyedJobsInARowAreOne) {
  BlockedWorker blocked(8, Overflow::kReject);
  for (const char letter : {'a', 'b', 'c'}) blocked.worker.post(blocked.mark(letter), 5);
  blocked.worker.post(blocked.mark('x'));
  blocked.worker.post(blocked.mark('d'), 5);
  blocked.open();
  blocked.worker.close();
  EXPECT_EQ(blocked.done, "cxd");
}

TEST(Worker, RejectsOrDropsJobsByItsPolicy) {
  BlockedWorker rejecting(2, Overflow::kReject), dropping(2, Overflow::kDropOldest);
  for (const char letter : {'a', 'b', 'c'}) {
    EXPECT_EQ(rejecting.worker.post(rejecting.mark(letter)), letter != 'c');
    EXPECT_TRUE(dropping.worker.post(dropping.mark(letter)));
  }
  EXPECT_TRUE(rejecting.worker.post_always(rejecting.mark('K')));
  for (BlockedWorker* each : {&rejecting, &dropping}) {
    each->open();
    each->worker.close();
  }
  EXPECT_EQ(rejecting.done, "abK");
  EXPECT_EQ(dropping.done, "bc");
  EXPECT_EQ(rejecting.worker.dropped(), 0u);
  EXPECT_EQ(dropping.worker.dropped(), 1u);
}

TEST(Worker, StopDiscardsJobsThatWaitAndTheRunningOneCanNotice) {
  BlockedWorker blocked(8, Overflow::kReject);
  const auto held = std::make_shared<int>(0);
  blocked.worker.post([&blocked, held] { blocked.done += 'a'; });
  blocked.worker.stop();
  EXPECT_EQ(blocked.done, "");
  EXPECT_EQ(held.use_count(), 1) << "the job and its data are gone";
}

TEST(Worker, JobsMayPostJobsToTheirOwnFullWorker) {
  std::atomic<bool> has_ended = false;
  BlockedWorker blocked(1, Overflow::kWait);
  blocked.worker.post([&] {
    for (const char letter : {'a', 'b', 'c'}) blocked.worker.post(blocked.mark(letter));
    blocked.worker.post([&has_ended] { has_ended = true; });
  });
  blocked.open();
  while (!has_ended) std::this_thread::yield();
  EXPECT_EQ(blocked.done, "abc");
}

}  // namespace
}  // namespace gloam
