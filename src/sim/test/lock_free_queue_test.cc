// Nothing is lost, doubled or reordered between many threads.

#include "sim/commands/lock_free_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

namespace gloam {
namespace {

TEST(LockFreeQueue, IsFirstInFirstOutAndRefusesWhenFull) {
  LockFreeQueue<int> queue(3);
  for (int round = 0; round < 10; ++round) {
    for (int i = 1; i <= 3; ++i) EXPECT_TRUE(queue.try_push(i));
    int extra = 9;
    EXPECT_FALSE(queue.try_push(extra));
    EXPECT_EQ(extra, 9);
    EXPECT_EQ(queue.size(), 3);
    for (int i = 1, out = 0; i <= 3; ++i) {
      EXPECT_TRUE(queue.try_pop(out));
      EXPECT_EQ(out, i);
    }
    int none = 0;
    EXPECT_FALSE(queue.try_pop(none));
  }
}

TEST(LockFreeQueue, LosesAndDoublesNothingBetweenThreads) {
  constexpr int kProducers = 3, kConsumers = 2, kEach = 20000;
  LockFreeQueue<int> queue(16);
  std::vector<std::vector<int>> got(kConsumers);
  std::atomic<int> taken{0};
  std::vector<std::thread> threads;
  for (int p = 0; p < kProducers; ++p) {
    threads.emplace_back([&, p] {
      for (int i = 0; i < kEach; ++i) {
        int item = p * kEach + i;
        while (!queue.try_push(item)) std::this_thread::yield();
      }
    });
  }
  for (int c = 0; c < kConsumers; ++c) {
    threads.emplace_back([&, c] {
      for (int item = 0; taken.load() < kProducers * kEach;) {
        if (queue.try_pop(item)) {
          got[static_cast<size_t>(c)].push_back(item);
          ++taken;
        } else {
          std::this_thread::yield();
        }
      }
    });
  }
  for (std::thread& t : threads) t.join();
  std::vector<int> count(kProducers * kEach);
  for (const auto& items : got) {
    std::vector<int> last(kProducers, -1);
    for (const int item : items) {
      ++count[static_cast<size_t>(item)];
      int& previous = last[static_cast<size_t>(item / kEach)];
      EXPECT_GT(item, previous);  // each producer's items come in its order
      previous = item;
    }
  }
  EXPECT_EQ(std::count(count.begin(), count.end(), 1), kProducers * kEach);
}

}  // namespace
}  // namespace gloam
