// Turns of sensors at one renderer: who goes first, and work that is cut between two turns.
#include "render/turns.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include "render/slices.h"

namespace gloam {
namespace {

using namespace std::chrono_literals;

/// A sensor that asks for a turn on a thread of its own and notes when it had it.
class Sensor {
 public:
  Sensor(RenderTurns& turns, std::vector<int>* order, int name, double used)
      : use_{.used = used}, done_(std::async(std::launch::async, [this, &turns, order, name] {
          const RenderTurn turn(turns, use_);
          order->push_back(name);  // turns exclude one another
        })) {}
  void wait() { done_.get(); }

 private:
  RenderUse use_;
  std::future<void> done_;
};

// Waits for a sensor that has a reason to go first.
void wait_until_wanted(const RenderTurns& turns) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (!turns.is_wanted() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(1ms);
  ASSERT_TRUE(turns.is_wanted());
}

TEST(RenderTurns, TheOneThatHasUsedLeastGoesFirst) {
  RenderTurns turns;
  std::vector<int> order;
  RenderUse first;
  turns.take(first);
  Sensor heavy(turns, &order, 2, 5.0);
  std::this_thread::sleep_for(20ms);  // it came earlier
  Sensor light(turns, &order, 1, 1.0);
  std::this_thread::sleep_for(20ms);
  turns.give();
  heavy.wait();
  light.wait();
  EXPECT_EQ(order, (std::vector{1, 2}));
}

TEST(RenderTurns, ALongTurnIsPassedOnToOneThatHasUsedLessAndComesBack) {
  RenderTurns turns;
  std::vector<int> order;
  RenderUse mine{.used = 10};
  turns.take(mine);
  EXPECT_FALSE(turns.is_wanted());
  EXPECT_FALSE(turns.pass()) << "nobody waits";
  std::this_thread::sleep_for(30ms);
  Sensor light(turns, &order, 1, 0);
  wait_until_wanted(turns);
  EXPECT_TRUE(turns.pass());
  EXPECT_EQ(order, (std::vector{1})) << "it had its turn";
  EXPECT_GT(mine.used, 10);
  EXPECT_GT(mine.waited, 0);
  turns.give();
  light.wait();
}

TEST(RenderTurns, APauseEarnsNoMoreThanASlice) {
  RenderTurns turns;
  RenderUse busy{.used = 100}, idle;
  turns.take(busy);
  turns.give();
  turns.take(idle);
  EXPECT_GT(idle.used, 99.9);
  EXPECT_LT(idle.used, 100);
  turns.give();
}

TEST(RenderSlices, EachTaskIsDoneOnceAndTheSceneIsReadAgainAfterATurnOfAnother) {
  RenderTurns turns;
  std::vector<int> order;
  RenderUse mine{.used = 10};
  turns.take(mine);
  std::this_thread::sleep_for(30ms);
  Sensor light(turns, &order, 1, 0);
  wait_until_wanted(turns);
  int again = 0;
  RenderSlices slices(&turns, [&again] { ++again; });
  std::vector<std::atomic<int>> done(1000);
  slices.run("test", 1000, [&](int64_t i) { ++done[static_cast<size_t>(i)]; });
  EXPECT_EQ(again, 1);
  for (const auto& count : done) EXPECT_EQ(count, 1);
  EXPECT_EQ(order, (std::vector{1}));
  turns.give();
  light.wait();
}

TEST(RenderSlices, TurnsAreLongWhereTheUpdateOfTheSceneIsSlow) {
  RenderTurns turns;
  std::vector<int> order;
  RenderUse mine{.used = 10}, pause{.used = 20};
  turns.take(mine);
  std::this_thread::sleep_for(30ms);
  Sensor first(turns, &order, 1, 0);
  wait_until_wanted(turns);
  RenderSlices slices(&turns, [] { std::this_thread::sleep_for(50ms); });
  slices.pause();
  first.wait();
  EXPECT_EQ(order, (std::vector{1}));
  turns.give();
  turns.take(pause);  // 10 s ahead of `mine`, which gets no more than a slice of that
  turns.give();
  turns.take(mine);
  EXPECT_LT(mine.used, 20 - 0.19) << "four times the update";
  EXPECT_GT(mine.used, 10 + 1) << "no more than that";
  turns.give();
}

TEST(RenderSlices, WithoutOthersTheyAreALoop) {
  RenderSlices slices(nullptr, {});
  std::atomic<int> sum{0};
  slices.run("test", 10, [&](int64_t i) { sum += static_cast<int>(i); });
  slices.pause();
  EXPECT_EQ(sum, 45);
}

}  // namespace
}  // namespace gloam
