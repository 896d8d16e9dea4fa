#include "world/compile/progress/compile_progress.h"
#include "gloam/model_tools.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>

#include "base/cache_writer.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using Clock = std::chrono::steady_clock;
using testing::AnyOf;
using testing::HasSubstr;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class CompileProgressTest : public testing::Test {
 protected:
  CompileProgressTest() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    // A closed tube with bumps, which CoACD takes seconds for.
    std::string text;
    constexpr int kRing = 40, kTube = 16;
    for (int i = 0; i < kRing; ++i) {
      for (int j = 0; j < kTube; ++j) {
        const double u = 2 * M_PI * i / kRing, v = 2 * M_PI * j / kTube;
        const double tube = 0.1 + 0.03 * std::sin(9 * u) * std::cos(3 * v);
        const double r = 0.4 + tube * std::cos(v);
        text += fmt::format("v {} {} {}\n", r * std::cos(u), r * std::sin(u), tube * std::sin(v));
      }
    }
    const auto at = [](int i, int j) { return i % kRing * kTube + j % kTube + 1; };
    for (int i = 0; i < kRing; ++i)
      for (int j = 0; j < kTube; ++j)
        text +=
            fmt::format("f {} {} {} {}\n", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    folder_.write("ring.obj", text);
    folder_.write("box.obj",
                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  }
  ~CompileProgressTest() override {
    finish_cache_writes();
    ::unsetenv("GLOAM_CACHE");
  }
  Scene scene(const std::string& text) {
    folder_.write("scene.toml", text);
    return load_scene(folder_.path() / "scene.toml").value();
  }
  Scene boxes() {
    std::string text;
    for (int i = 0; i < 6; ++i)
      text += fmt::format("[[object]]\nname = 'b{}'\nfile = 'box.obj'\nposition = [{}, 0, 1]\n", i,
                          2 * i);
    return scene(text);
  }
  Scene ring() {
    return scene(
        "[[object]]\nname = 'ring'\nfile = 'ring.obj'\ncolliders = 'hulls'\n"
        "concavity = 0.04\nmax_hulls = 100\n");
  }
  TempFolder folder_;
};

TEST_F(CompileProgressTest, GrowsToOneAndSaysWhatIsMade) {
  std::vector<Progress> told;
  const Result<World> world = World::compile(boxes(), [&](const Progress& progress) {
    told.push_back(progress);
    return true;
  });
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  ASSERT_GE(told.size(), 2u);  // at once, and at the end
  EXPECT_LT(told[0].done, 1);
  for (size_t i = 1; i < told.size(); ++i) {
    EXPECT_GE(told[i].done, told[i - 1].done);
    EXPECT_GE(told[i].seconds, told[i - 1].seconds);
    EXPECT_FALSE(told[i].what.empty());
  }
  EXPECT_EQ(told.back().done, 1);
}

TEST_F(CompileProgressTest, MovesOnWhenAStageTakesLongerThanExpected) {
  std::vector<Progress> told;
  const ProgressCallback keep = [&](const Progress& progress) {
    told.push_back(progress);
    return true;
  };
  {
    CompileProgress progress(keep, 1);
    progress.begin("long", 1, 0.2);
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    progress.finish();
  }
  ASSERT_GE(told.size(), 6u);
  for (size_t i = 1; i < told.size(); ++i) {
    EXPECT_GT(told[i].done, told[i - 1].done) << i;
    if (i + 1 < told.size()) {
      EXPECT_LT(told[i].done, 1) << i;
      // `seconds` counts from before the stage began, so the two clocks differ at the boundary.
      if (std::abs(told[i].seconds - 0.2) > 0.02) {
        EXPECT_EQ(told[i].left > 0, told[i].seconds < 0.2)
            << "the time left of a late stage is unknown, at " << i;
      }
    }
  }
}

TEST_F(CompileProgressTest, OfStagesIsTheirWeightsAndNeverLess) {
  std::vector<Progress> told;
  const ProgressCallback keep = [&](const Progress& progress) {
    told.push_back(progress);
    return true;
  };
  {
    CompileProgress progress(keep, 4);
    progress.begin("one", 1);
    progress.report(0.5);
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    progress.report(0.2);
    progress.begin("two", 3);
    progress.report(0.5, "two and a half");
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    progress.finish();
  }
  ASSERT_GE(told.size(), 4u);
  EXPECT_EQ(told[1].what, "one");
  EXPECT_NEAR(told[1].done, 0.125, 1e-9);
  EXPECT_GT(told[1].left, 0);
  EXPECT_EQ(told[told.size() - 2].what, "two and a half");
  EXPECT_NEAR(told[told.size() - 2].done, 0.625, 1e-9);
  EXPECT_EQ(told.back().done, 1);
}

TEST_F(CompileProgressTest, StopsACompilationAtOnce) {
  const Scene slow = ring();
  Clock::time_point stopped;
  std::string what;
  const auto start = Clock::now();
  const Result<World> world = World::compile(slow, [&](const Progress& progress) {
    if (seconds_since(start) < 0.4) return true;
    what = progress.what;
    stopped = Clock::now();
    return false;
  });
  const double late = seconds_since(stopped);
  ASSERT_FALSE(world.ok()) << "CoACD was quick";
  if (world.error().kind == ErrorKind::kUnsupported) GTEST_SKIP() << world.error().to_string();
  EXPECT_EQ(world.error().kind, ErrorKind::kInterrupted) << world.error().to_string();
  EXPECT_THAT(what, HasSubstr("building colliders for 'ring'"));
  EXPECT_LT(late, 1.5) << "it waits for CoACD, whose search takes many seconds";
}

TEST_F(CompileProgressTest, StopsAConversionBeforeItBegins) {
  ObjectOptions object;
  object.name = "ring";
  object.file = folder_.path() / "ring.obj";
  object.colliders = "hulls";
  const Result<ObjectReport> made =
      convert_object(object, {}, [](const Progress&) { return false; });
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().kind, AnyOf(ErrorKind::kInterrupted, ErrorKind::kUnsupported));
}

TEST_F(CompileProgressTest, OfTwoAtATimeIsTheirOwn) {
  const Scene scene = boxes();
  const auto compile = [&] {
    double done = 0;
    const Result<World> world = World::compile(scene, [&](const Progress& progress) {
      done = progress.done;
      return true;
    });
    return world.ok() ? done : -1;
  };
  auto other = std::async(std::launch::async, compile);
  EXPECT_EQ(compile(), 1);
  EXPECT_EQ(other.get(), 1);
}

}  // namespace
}  // namespace gloam
