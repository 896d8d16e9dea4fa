#include "web/outbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace gloam::web {
namespace {

Frame frame_of(size_t bytes, char mark) { return {std::string(bytes, mark)}; }

std::string marks(Outbox& outbox) {
  std::string marks;
  while (const auto frame = outbox.next()) marks += frame->head[0];
  return marks;
}

TEST(Outbox, DropsTheOldestDataAndKeepsTheRest) {
  int wakes = 0;
  Outbox outbox([&] { ++wakes; }, {.data_bytes = 1000, .kept_bytes = 1000});
  outbox.offer(frame_of(300, 'a'));
  outbox.send(frame_of(300, 'K'));
  for (const char mark : {'b', 'c', 'd'}) outbox.offer(frame_of(300, mark));
  EXPECT_EQ(wakes, 1);
  EXPECT_EQ(outbox.dropped(), 2);
  EXPECT_EQ(marks(outbox), "Kcd");
  outbox.offer(frame_of(5000, 'L'));
  EXPECT_EQ(wakes, 2);
  EXPECT_EQ(marks(outbox), "L") << "one message may be larger";
}

TEST(Outbox, OldDataAreNotSent) {
  Outbox outbox([] {}, {.data_age = std::chrono::milliseconds(20)});
  outbox.offer(frame_of(10, 'a'));
  outbox.send(frame_of(10, 'K'));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  outbox.offer(frame_of(10, 'b'));
  EXPECT_EQ(marks(outbox), "Kb");
  EXPECT_EQ(outbox.dropped(), 1);
}

TEST(Outbox, OverflowsByWhatMustArrive) {
  Outbox outbox([] {}, {.kept_bytes = 1000});
  outbox.send(frame_of(5000, 'a'));
  EXPECT_FALSE(outbox.overflowed()) << "one may be larger";
  outbox.send(frame_of(1, 'b'));
  EXPECT_TRUE(outbox.overflowed());
  outbox.close();
  outbox.send(frame_of(1, 'c'));
  EXPECT_FALSE(outbox.next());
}

TEST(Outbox, SlotsHoldTheNewestFrameBehindAllElse) {
  int wakes = 0;
  Outbox outbox([&] { ++wakes; }, {.slots = {0, 0}});
  outbox.replace(1, frame_of(1, 'p'));
  outbox.replace(0, frame_of(1, 's'));
  outbox.replace(1, frame_of(1, 'P'));
  outbox.send(frame_of(1, 'K'));
  EXPECT_EQ(wakes, 1);
  EXPECT_EQ(marks(outbox), "KsP");
  EXPECT_EQ(outbox.dropped(), 0);
}

TEST(Outbox, LimitedSlotsWaitForAcknowledgements) {
  int wakes = 0;
  Outbox outbox([&] { ++wakes; }, {.slots = {2}});
  for (const char mark : {'a', 'b'}) {
    outbox.replace(0, frame_of(1, mark));
    EXPECT_EQ(marks(outbox), std::string(1, mark));
  }
  outbox.replace(0, frame_of(1, 'c'));
  EXPECT_EQ(marks(outbox), "");
  outbox.send(frame_of(1, 'K'));
  EXPECT_EQ(marks(outbox), "K") << "other messages pass";
  wakes = 0;
  outbox.acknowledge(0);
  EXPECT_EQ(wakes, 1);
  EXPECT_EQ(marks(outbox), "c");
  for (int i = 0; i < 5; ++i) outbox.acknowledge(0);  // more than were sent
  for (const char mark : {'d', 'e', 'f'}) {
    outbox.replace(0, frame_of(1, mark));
    EXPECT_EQ(marks(outbox), mark == 'f' ? "" : std::string(1, mark));
  }
}

}  // namespace
}  // namespace gloam::web
