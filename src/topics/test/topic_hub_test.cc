// Subscriptions that share streams: one stream per source, topics that come and go without
// reopening it, the time that it lingers, errors and retries, recompiles, latched topics.

#include "topics/hub/topic_hub.h"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "scene/test/temp_folder.h"
#include "topics/hub/forwarding_simulation.h"

namespace gloam {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kHubModel = R"(<mujoco model="room"><option timestep="0.002"/>
<worldbody><geom name="ground" type="plane" size="5 5 .1"/><light pos="0 0 3"/>
<body name="ball" pos="0 0 1"><freejoint/><geom size=".2"/></body></worldbody></mujoco>)";
constexpr const char* kHubScene = R"(
[[robot]]
name = "ball"
file = "room.xml"
[[camera]]
name = "eye"
position = [-2, 0, 1]
look_at = [0, 0, 1]
width = 16
height = 12
rate = 50
outputs = ["rgb", "depth"]
[render]
tier = "direct"
denoise = false
)";

/// A sink that keeps the messages and errors of its topics.
class Inbox : public TopicSink {
 public:
  void on_message(const TopicMessage& message) override {
    const std::lock_guard lock(mutex_);
    steps_[message.topic.name].push_back(message.step);
  }
  void on_topics(std::span<const TopicInfo> topics) override {
    const std::lock_guard lock(mutex_);
    names_.clear();
    for (const TopicInfo& topic : topics) names_.push_back(topic.name);
    ++lists_;
  }
  void on_error(const std::string& topic, const Error& why) override {
    const std::lock_guard lock(mutex_);
    errors_.push_back(topic + ": " + why.message);
  }

  std::vector<int64_t> steps(const std::string& topic) {
    const std::lock_guard lock(mutex_);
    return steps_[topic];
  }
  std::vector<std::string> errors() {
    const std::lock_guard lock(mutex_);
    return errors_;
  }
  std::vector<std::string> names() {
    const std::lock_guard lock(mutex_);
    return names_;
  }
  int lists() {
    const std::lock_guard lock(mutex_);
    return lists_;
  }
  bool wait(const std::function<bool()>& is_there) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!is_there()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return true;
  }
  bool wait_for(const std::string& topic, size_t more = 1) {
    const size_t count = steps(topic).size() + more;
    return wait([&] { return steps(topic).size() >= count; });
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::vector<int64_t>> steps_;
  std::vector<std::string> errors_, names_;
  int lists_ = 0;
};

/// Counts the streams that are opened and their changes; opening can fail.
class CountedSimulation final : public ForwardingSimulation {
 public:
  using ForwardingSimulation::ForwardingSimulation;

  struct Counts {
    std::atomic<int> opened{0}, changed{0}, closed{0};
  };
  class CountedStream final : public TopicStream {
   public:
    CountedStream(std::unique_ptr<TopicStream> real, Counts& counts)
        : real_(std::move(real)), counts_(counts) {}
    ~CountedStream() override { ++counts_.closed; }
    Status set_topics(std::span<const std::string> names) override {
      ++counts_.changed;
      return real_->set_topics(names);
    }
    int64_t dropped() const override { return real_->dropped(); }
    int64_t complete_at(int64_t from) const override { return real_->complete_at(from); }
    void flush() override { real_->flush(); }
    Status status() const override { return real_->status(); }

   private:
    std::unique_ptr<TopicStream> real_;
    Counts& counts_;
  };

  Result<std::unique_ptr<TopicStream>> open_topics(const TopicRequest& request,
                                                   TopicCallback on_message) override {
    if (failures > 0 && failures-- > 0) return Error{ErrorKind::kIo, "no memory"};
    GLOAM_TRY(auto real, ForwardingSimulation::open_topics(request, std::move(on_message)));
    ++counts.opened;
    return std::unique_ptr<TopicStream>(std::make_unique<CountedStream>(std::move(real), counts));
  }
  Result<std::unique_ptr<TopicSubscription>> subscribe(TopicSink& sink) override {
    return hub_.subscribe(sink);
  }

  std::atomic<int> failures{0};
  Counts counts;

 private:
  TopicHub hub_{*this};
};

class TopicHubTest : public testing::Test {
 protected:
  TopicHubTest() {
    folder_.write("room.xml", kHubModel);
    real_ = *Simulation::create(world(kHubScene), {.pace = Pace::kRealTime});
    simulation_ = std::make_unique<CountedSimulation>(*real_);
    real_->resume();
  }
  World world(const std::string& scene) {
    return *World::compile(*parse_scene(scene, folder_.path()));
  }

  static constexpr const char* kImage = "/eye/image_raw";
  static constexpr const char* kInfo = "/eye/camera_info";
  static constexpr const char* kDepth = "/eye/depth/image_rect_raw";
  TempFolder folder_;
  std::unique_ptr<Simulation> real_;
  std::unique_ptr<CountedSimulation> simulation_;
};

TEST_F(TopicHubTest, SinksShareTheStreamOfACamera) {
  Inbox a, b;
  auto first = *simulation_->subscribe(a);
  EXPECT_THAT(a.names(), testing::IsSupersetOf({kImage, kInfo, kDepth}));
  first->set_topics({kImage});
  ASSERT_TRUE(a.wait_for(kImage));
  auto second = *simulation_->subscribe(b);
  second->set_topics({kImage, kInfo});
  ASSERT_TRUE(b.wait_for(kInfo, 3));
  EXPECT_EQ(simulation_->counts.opened, 1);
  EXPECT_TRUE(a.steps(kInfo).empty());
  const std::vector<int64_t> seen = b.steps(kImage), all = a.steps(kImage);
  ASSERT_FALSE(seen.empty());
  for (const int64_t step : seen) EXPECT_EQ(std::ranges::count(a.steps(kImage), step), 1) << step;
}

TEST_F(TopicHubTest, ACameraGainsAndLosesTopicsWithoutBeingReopened) {
  Inbox inbox;
  auto subscription = *simulation_->subscribe(inbox);
  subscription->set_topics({kImage});
  ASSERT_TRUE(inbox.wait_for(kImage, 2));
  subscription->set_topics({kImage, kDepth});
  ASSERT_TRUE(inbox.wait_for(kDepth, 2));
  subscription->set_topics({kDepth});
  ASSERT_TRUE(inbox.wait([&] { return simulation_->counts.changed >= 2; }));
  ASSERT_TRUE(inbox.wait_for(kDepth, 2));
  EXPECT_EQ(simulation_->counts.opened, 1);
  EXPECT_EQ(simulation_->counts.closed, 0);
  for (const char* topic : {kImage, kDepth}) {
    const std::vector<int64_t> steps = inbox.steps(topic);
    EXPECT_TRUE(std::ranges::adjacent_find(steps, std::greater_equal<>()) == steps.end()) << topic;
  }
  const size_t count = inbox.steps(kImage).size();
  ASSERT_TRUE(inbox.wait_for(kDepth, 5));
  EXPECT_EQ(inbox.steps(kImage).size(), count) << "nobody subscribes to it";
  EXPECT_TRUE(inbox.errors().empty());
}

TEST_F(TopicHubTest, AStreamLingersForTwoSeconds) {
  Inbox inbox;
  auto subscription = *simulation_->subscribe(inbox);
  subscription->set_topics({"/clock"});
  ASSERT_TRUE(inbox.wait_for("/clock"));
  subscription->set_topics({});
  std::this_thread::sleep_for(milliseconds(500));
  const size_t count = inbox.steps("/clock").size();
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_EQ(inbox.steps("/clock").size(), count) << "a stream that lingers delivers nothing";
  subscription->set_topics({"/clock"});
  ASSERT_TRUE(inbox.wait_for("/clock"));
  EXPECT_EQ(simulation_->counts.opened, 1) << "it came back in time";
  const auto begin = std::chrono::steady_clock::now();
  subscription->set_topics({});
  ASSERT_TRUE(inbox.wait([&] { return simulation_->counts.closed == 1; }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(1900));
}

TEST_F(TopicHubTest, AStreamThatCannotBeOpenedIsTriedAgain) {
  Inbox inbox;
  auto subscription = *simulation_->subscribe(inbox);
  simulation_->failures = 2;
  const auto begin = std::chrono::steady_clock::now();
  subscription->set_topics({"/clock"});
  ASSERT_TRUE(inbox.wait_for("/clock"));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(1900));
  EXPECT_THAT(inbox.errors(), ElementsAre("/clock: no memory")) << "each cause once";
}

TEST_F(TopicHubTest, ErrorsAndLatchedMessagesAreRepeatedForAnotherReader) {
  Inbox inbox;
  auto subscription = *simulation_->subscribe(inbox);
  subscription->set_topics({"/tf_static", "/nowhere"});
  ASSERT_TRUE(inbox.wait([&] { return !inbox.errors().empty(); }));
  EXPECT_THAT(inbox.errors(), ElementsAre("/nowhere: there is no output topic '/nowhere'"));
  ASSERT_TRUE(inbox.wait([&] { return inbox.steps("/tf_static").size() == 1; }));
  int visits = 0;
  subscription->repeat("/tf_static", [&](const TopicMessage& last) {
    ++visits;
    EXPECT_EQ(last.topic.name, "/tf_static");
    EXPECT_FALSE(last.data.empty());
  });
  EXPECT_EQ(visits, 1);
  subscription->repeat("/nowhere", [&](const TopicMessage&) { ++visits; });
  ASSERT_TRUE(inbox.wait([&] { return inbox.errors().size() == 2; }));
  EXPECT_EQ(visits, 1);
  Inbox late;
  auto second = *simulation_->subscribe(late);
  second->set_topics({"/tf_static"});
  ASSERT_TRUE(late.wait([&] { return late.steps("/tf_static").size() == 1; }));
  EXPECT_EQ(inbox.steps("/tf_static").size(), 1u) << "only the new sink gets it";
}

TEST_F(TopicHubTest, FollowsRecompiles) {
  Inbox inbox;
  auto subscription = *simulation_->subscribe(inbox);
  subscription->set_topics({kImage, "/clock"});
  ASSERT_TRUE(inbox.wait_for(kImage) && inbox.wait_for("/clock"));
  EXPECT_EQ(inbox.lists(), 1);
  const std::string other =
      std::string(kHubScene) + "[[topic]]\nname = '" + kImage + "'\noff = true\n";
  ASSERT_TRUE(real_->recompile(world(other)).ok());
  ASSERT_TRUE(inbox.wait([&] { return inbox.lists() == 2; }));
  EXPECT_THAT(inbox.names(), testing::Not(testing::Contains(kImage)));
  ASSERT_TRUE(inbox.wait([&] { return !inbox.errors().empty(); }));
  EXPECT_THAT(inbox.errors()[0], HasSubstr("there is no output topic '/eye/image_raw'"));
  ASSERT_TRUE(inbox.wait_for("/clock", 2));
  ASSERT_TRUE(real_->recompile(world(kHubScene)).ok());
  ASSERT_TRUE(inbox.wait_for(kImage)) << "it is there again";
}

TEST_F(TopicHubTest, NoCallbackComesAfterASubscriptionHasEnded) {
  for (int i = 0; i < 20; ++i) {
    auto inbox = std::make_unique<Inbox>();
    auto subscription = *simulation_->subscribe(*inbox);
    subscription->set_topics({"/clock", "/tf", kImage});
    if (i % 2 == 0) {
      ASSERT_TRUE(inbox->wait_for("/clock"));
    }
    subscription.reset();
    inbox.reset();  // the sanitizers find a late call
  }
}

TEST_F(TopicHubTest, CountsTheLossesOfItsOwnTopics) {
  class SlowInbox : public Inbox {
   public:
    void on_message(const TopicMessage& message) override {
      std::this_thread::sleep_for(milliseconds(100));  // the clock ticks every 10 ms
      Inbox::on_message(message);
    }
  };
  SlowInbox slow;
  Inbox other, late;
  auto first = *simulation_->subscribe(slow), elsewhere = *simulation_->subscribe(other);
  first->set_topics({"/clock"});
  elsewhere->set_topics({"/tf"});
  ASSERT_TRUE(slow.wait([&] { return first->dropped() >= 5; }));
  EXPECT_EQ(elsewhere->dropped(), 0) << "of another stream";
  auto second = *simulation_->subscribe(late);
  second->set_topics({"/clock"});
  ASSERT_TRUE(late.wait_for("/clock"));
  EXPECT_LT(second->dropped(), first->dropped()) << "only since it joined";
  const int64_t lost = first->dropped();
  first->set_topics({});
  ASSERT_TRUE(late.wait_for("/clock"));
  EXPECT_GE(first->dropped(), lost) << "kept after it has left";
}

}  // namespace
}  // namespace gloam
