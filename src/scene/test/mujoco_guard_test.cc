#include "scene/files/mujoco_guard.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <filesystem>
#include <thread>

namespace gloam {
namespace {

TEST(MujocoGuard, TurnsAnErrorIntoAValue) {
  const Status status = guarded([] { mju_error("joint %d is bad", 7); });
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "joint 7 is bad");
  EXPECT_TRUE(guarded([] { mju_norm3((const mjtNum[3]){1, 2, 3}); }).ok());
}

TEST(MujocoGuard, CatchesARealEngineError) {
  char error[500] = "";
  mjModel* model = nullptr;
  const char* xml =
      "<mujoco><size memory='1K'/><worldbody><geom type='plane' size='1 1 1'/>"
      "<body pos='0 0 .09'><freejoint/><geom size='.1'/></body></worldbody></mujoco>";
  ASSERT_TRUE(try_mujoco([&] {
    mjSpec* spec = mj_parseXMLString(xml, nullptr, error, sizeof(error));
    model = mj_compile(spec, nullptr);
    mj_deleteSpec(spec);
  }));
  ASSERT_NE(model, nullptr) << error;
  mjData* data = nullptr;
  ASSERT_TRUE(try_mujoco([&] { data = mj_makeData(model); }));
  const Status status = guarded([&] { mj_stackAllocNum(data, size_t{1} << 40); });
  ASSERT_FALSE(status.ok());
  EXPECT_FALSE(status.error().message.empty());
  mj_deleteData(data);
  mj_deleteModel(model);
}

TEST(MujocoGuard, Nests) {
  bool inner_failed = false, after_inner = false;
  const bool ok = try_mujoco([&] {
    inner_failed = !try_mujoco([] { mju_error("inner"); });
    after_inner = true;
    mju_error("outer");
  });
  EXPECT_FALSE(ok);
  EXPECT_TRUE(inner_failed);
  EXPECT_TRUE(after_inner);
  EXPECT_STREQ(mujoco_error_message(), "outer");
}

TEST(MujocoGuard, RecoversOnTheThreadThatFailed) {
  std::vector<std::thread> threads;
  std::vector<std::string> messages(4);
  for (size_t i = 0; i < messages.size(); ++i) {
    threads.emplace_back([&messages, i] {
      for (int repeat = 0; repeat < 200; ++repeat) {
        const Status status = guarded([i] { mju_error("thread %d", static_cast<int>(i)); });
        messages[i] = status.ok() ? "no error" : status.error().message;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t i = 0; i < messages.size(); ++i)
    EXPECT_EQ(messages[i], "thread " + std::to_string(i));
}

TEST(MujocoGuard, WarningsAreCapturedAndNeverWrittenToMujocosLogFile) {
  const int64_t before = mujoco_warning_count();
  {
    MujocoWarningCapture capture;
    mju_warning("careful: %d", 3);
    ASSERT_EQ(capture.messages().size(), 1u);
    EXPECT_EQ(capture.messages()[0], "careful: 3");
  }
  EXPECT_EQ(mujoco_warning_count(), before + 1);
  EXPECT_FALSE(guarded([] { mju_error("for the log"); }).ok());
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST(MujocoGuardDeathTest, AnErrorOutsideAGuardIsABug) {
  install_mujoco_handler();
  EXPECT_DEATH(mju_error("nobody is listening"), "nobody is listening");
}

}  // namespace
}  // namespace gloam
