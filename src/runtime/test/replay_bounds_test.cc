// Logs whose numbers have been changed: whoever steps them again ends soon, with an error.

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "gloam/log.h"
#include "gloam/log_replay.h"
#include "gloam/run.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_writer.h"
#include "ros/codec.h"
#include "runtime/log/run_text.h"
#include "runtime/log/state_order.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
constexpr double kBoundsStep = 0.002;  // [s]

gloam_msgs::State state_at(int64_t run, int64_t step, double time) {
  gloam_msgs::State out;
  out.run = run;
  out.step = step;
  out.state = {time};
  return out;
}

TEST(StateOrders, TakeStatesAsRunsMakeThem) {
  StateOrder order("log");
  for (const int64_t step : {0, 1, 5, 1000, 2'000'000})
    EXPECT_TRUE(
        order.check(state_at(0, step, static_cast<double>(step) * kBoundsStep), kBoundsStep, false)
            .ok());
  EXPECT_TRUE(order.check(state_at(1, 0, 12.5), kBoundsStep, false).ok())
      << "a keyframe sets the clock";
  EXPECT_TRUE(order.check(state_at(1, 10, 12.5 + 10 * kBoundsStep), kBoundsStep, false).ok());
  EXPECT_TRUE(order.check(state_at(4, 700, 700 * kBoundsStep), kBoundsStep, false).ok())
      << "from a checkpoint";
  EXPECT_TRUE(order.check(state_at(4, 701, -3), kBoundsStep, true).ok())
      << "a program sets the time";
}

TEST(StateOrders, FindNumbersThatNoRunMakes) {
  const auto refused = [](const gloam_msgs::State& next) {
    StateOrder order("log");
    EXPECT_TRUE(order.check(state_at(2, 100, 100 * kBoundsStep), kBoundsStep, false).ok());
    const Status status = order.check(next, kBoundsStep, false);
    return status.ok() ? "taken" : status.error().message;
  };
  constexpr int64_t kFar = int64_t{1} << 40, kMost = std::numeric_limits<int64_t>::max();
  EXPECT_THAT(refused(state_at(2, 101 + kFar, 101 * kBoundsStep)), HasSubstr("more than 10000000"));
  EXPECT_THAT(refused(state_at(2, kFar, static_cast<double>(kFar) * kBoundsStep)),
              HasSubstr("more than"));
  EXPECT_THAT(refused(state_at(2, 5000, 101 * kBoundsStep)), HasSubstr("do not match"));
  EXPECT_THAT(refused(state_at(2, 101, 7)), HasSubstr("do not match"));
  EXPECT_THAT(refused(state_at(2, 101, std::nan(""))), HasSubstr("do not match"));
  EXPECT_THAT(refused(state_at(2, 100, 100 * kBoundsStep)),
              HasSubstr("follows a state at step 100"));
  EXPECT_THAT(refused(state_at(2, -1, 0)), HasSubstr("follows a state at step 100"));
  EXPECT_THAT(refused(state_at(1, 0, 0)), HasSubstr("follows a state of run 2"));
  EXPECT_THAT(refused(state_at(-1, 0, 0)), HasSubstr("run -1"));
  EXPECT_THAT(refused(state_at(3, kMost, 0)), HasSubstr("more than"));
  EXPECT_THAT(refused(state_at(3, 1000, kBoundsStep)), HasSubstr("do not match"));
}

constexpr const char* kBoundsBall = R"(<mujoco model="ball"><option timestep="0.002"/>
<worldbody><light pos="0 0 3"/><geom type="plane" size="3 3 .1"/>
<body name="ball" pos="0 0 .5"><freejoint/><geom size=".1"/></body></worldbody></mujoco>)";

class ChangedLogs : public testing::Test {
 protected:
  ChangedLogs() {
    folder_.write("ball.xml", kBoundsBall);
    folder_.write("s.toml", "[[robot]]\nname = \"b\"\nfile = \"ball.xml\"\n");
    RunRequest request;
    request.log.file = log_;
    request.log.topics = {"/tf"};
    request.duration = 0.5;
    EXPECT_TRUE(
        run_and_record(*World::compile(*load_scene(folder_.path() / "s.toml")), request, {}).ok());
  }

  /// A copy of the log, whose states are what `change` makes of them.
  fs::path changed(const std::function<void(int64_t place, gloam_msgs::State*)>& change) {
    const McapReader log = *McapReader::open(log_);
    const fs::path out = folder_.path() / "changed.mcap";
    McapWriter writer(*FileSink::create(out));
    for (const auto& [id, schema] : log.schemas()) EXPECT_TRUE(writer.add_schema(schema).ok());
    for (const auto& [id, channel] : log.channels()) EXPECT_TRUE(writer.add_channel(channel).ok());
    int64_t place = 0;
    McapMessages messages = log.messages();
    while (const McapMessage* message = *messages.next()) {
      McapMessage copy = *message;
      std::vector<uint8_t> bytes;
      if (log.channels().at(copy.channel).topic == kStateTopic) {
        auto state = *decode<gloam_msgs::State>(copy.data);
        change(place++, &state);
        encode(state, &bytes);
        copy.data = bytes;
      }
      EXPECT_TRUE(writer.add_message(copy).ok());
    }
    for (const McapMetadataIndex& index : log.metadata())
      EXPECT_TRUE(writer.add_metadata(*log.read_metadata(index)).ok());
    EXPECT_TRUE(writer.finish().ok());
    return out;
  }

  TempFolder folder_;
  fs::path log_ = folder_.path() / "run.mcap";
};

TEST_F(ChangedLogs, OfAFarStepAreRefusedByAllThatStepThem) {
  const fs::path far = changed([](int64_t place, gloam_msgs::State* s) {
    if (place == 20) s->step += int64_t{1} << 40;
  });
  const auto verified = verify_log(far, {}, {});
  ASSERT_FALSE(verified.ok());
  EXPECT_THAT(verified.error().message, HasSubstr("damaged"));
  LogReplay replay{.log = far};
  replay.request.out = folder_.path() / "out";
  for (const auto motion : {ReplayMotion::kStepped, ReplayMotion::kPoses, ReplayMotion::kNewRun}) {
    replay.motion = motion;
    EXPECT_FALSE(replay_log(replay, {}).ok());
  }
  EXPECT_FALSE(log_checkpoint(far, {}, 0, 0.3).ok());
}

TEST_F(ChangedLogs, ThatGoToAndFroBetweenRunsAreRefused) {
  const fs::path mixed = changed([](int64_t place, gloam_msgs::State* s) { s->run = place % 2; });
  const auto verified = verify_log(mixed, {}, {});
  ASSERT_FALSE(verified.ok());
  EXPECT_THAT(verified.error().message, HasSubstr("follows a state of run 1"));
}

// A log may leave out states; stopping does not wait for the next one.
TEST_F(ChangedLogs, AreVerifiedInStretchesThatCanBeStopped) {
  int64_t calls = 0;
  const auto whole = verify_log(log_, {}, [&](const Progress&) { return ++calls > 0; });
  ASSERT_TRUE(whole.ok()) << whole.error().to_string();
  EXPECT_TRUE(whole->is_equal());
  EXPECT_GE(calls, whole->states);
  const auto stopped = verify_log(log_, {}, [](const Progress& now) { return now.done < 0.5; });
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
}

TEST_F(ChangedLogs, AreNotReplacedByTheirReplay) {
  LogReplay replay{.log = log_};
  replay.request.log.file = folder_.path() / "." / "run.mcap";
  replay.request.log.overwrite = true;
  const auto itself = replay_log(replay, {});
  ASSERT_FALSE(itself.ok());
  EXPECT_THAT(itself.error().message, HasSubstr("would overwrite"));
  replay.request.log.file.clear();
  replay.request.out = folder_.path();
  replay.request.overwrite = true;
  EXPECT_FALSE(replay_log(replay, {}).ok());
  EXPECT_TRUE(verify_log(log_, {}, {}).ok()) << "it is still there";
}

}  // namespace
}  // namespace gloam
