#include "world/compile/progress/long_wait.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace gloam {
namespace {

using ::testing::HasSubstr;

std::string said_in(double seconds, double expected) {
  ::testing::internal::CaptureStderr();
  {
    const LongWait wait("reading m.xml", expected);
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }
  return ::testing::internal::GetCapturedStderr();
}

TEST(LongWait, TellsFromTwoSecondsOn) {
  EXPECT_EQ(said_in(0.1, 20), "");
  EXPECT_THAT(said_in(2.3, 20), HasSubstr("reading m.xml: 2 s, about 18 s left"));
}

}  // namespace
}  // namespace gloam
