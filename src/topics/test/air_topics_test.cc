// Topics of the air and of diagnostics: weather, gases, MuJoCo's warnings.

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "ros/messages/diagnostic_msgs.h"
#include "ros/messages/gloam_msgs.h"
#include "scene/test/temp_folder.h"
#include "sim/effects/wind/wind.h"
#include "topics/test/topic_inbox.h"
#include "topics/topic_table.h"

namespace gloam {
namespace {

using diagnostic_msgs::DiagnosticArray;
using diagnostic_msgs::DiagnosticStatus;

constexpr const char* kPole = R"(<mujoco><option timestep="0.01"/><worldbody>
<geom type="plane" size="5 5 .1"/><body name="pole" pos="0 0 1"><joint name="swing" axis="0 1 0"/>
<geom type="capsule" size=".02" fromto="0 0 0 0 0 .5" mass="1"/></body></worldbody>
<actuator><motor joint="swing"/></actuator></mujoco>)";
constexpr const char* kPoleScene = "[[robot]]\nname = \"pole\"\nfile = \"pole.xml\"\n";

class AirTopics : public testing::Test {
 protected:
  AirTopics() { folder_.write("pole.xml", kPole); }
  World world_of(const std::string& more) {
    const auto scene = parse_scene(kPoleScene + more, folder_.path());
    EXPECT_TRUE(scene.ok()) << scene.error().to_string();
    const auto world = World::compile(*scene);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return *world;
  }
  std::set<std::string> names_of(const std::string& more) {
    std::set<std::string> names;
    const auto topics = *list_topics(world_of(more));
    for (const TopicInfo& topic : topics) names.insert(topic.name);
    return names;
  }

  TempFolder folder_;
};

TEST_F(AirTopics, WeatherIsThatOfTheScene) {
  const World world = world_of(
      "[sky]\nsun_elevation = 40\n[weather]\nrain = 4\nvisibility = 300\nwind = 6\ngusts = "
      "0.2\nwind_from = 180\n");
  TopicInbox inbox;
  record_topics(world, {"/weather"}, 100, &inbox);
  const auto messages = inbox.all<gloam_msgs::Weather>("/weather");
  ASSERT_EQ(messages.size(), 11u);  // 10 Hz
  const Wind wind(world.compiled()->wind);
  double mean = 0;
  for (const auto& weather : messages) {
    EXPECT_EQ(weather.visibility, 300);
    EXPECT_EQ(weather.rain, 4);
    EXPECT_EQ(weather.snow, 0);
    EXPECT_EQ(weather.mean_wind, 6);
    EXPECT_EQ(weather.header.frame_id, "world");
    mean += weather.wind.y / static_cast<double>(messages.size());
  }
  EXPECT_NEAR(mean, 6, 3);                        // from the south: it blows to the north, +y
  EXPECT_NE(messages[0].wind, messages[5].wind);  // gusts
  EXPECT_NEAR(messages[5].wind.x, wind.at(0.5, 10).x, 1e-12);
  TopicInbox again;
  record_topics(world, {"/weather"}, 100, &again);
  EXPECT_EQ(again.messages, inbox.messages);
}

TEST_F(AirTopics, FairWeatherIsClear) {
  TopicInbox inbox;
  record_topics(world_of("[sky]\nsun_elevation = 40\n[weather]\nsnow = 1\n"), {"/weather"}, 1,
                &inbox);
  const auto weather = inbox.all<gloam_msgs::Weather>("/weather").at(0);
  EXPECT_EQ(weather.visibility, std::numeric_limits<double>::infinity());
  EXPECT_EQ(weather.snow, 1);
  EXPECT_EQ(weather.wind, geometry_msgs::Vector3());
  EXPECT_FALSE(names_of("").contains("/weather"));
}

constexpr const char* kClosedRoom = R"(
[[gas]]
name = "air"
position = [0, 0, 1]
size = [2, 2, 2]
voxel = 0.1
rate = 20
fuel = "propane"
closed = ["-x", "+x", "-y", "+y", "-z", "+z"]
)";

TEST_F(AirTopics, MassOfSmokeIsWhatWasGiven) {
  const World world =
      world_of(std::string(kClosedRoom) +
               "[[smoke]]\nname = \"machine\"\nposition = [0.5, 0, 0.5]\nrate = 1e-3\n");
  TopicInbox inbox;
  record_topics(world, {"/air/gas"}, 100, &inbox);
  const auto messages = inbox.all<gloam_msgs::Gas>("/air/gas");
  ASSERT_EQ(messages.size(), 11u);
  EXPECT_EQ(messages[0].name, "air");
  EXPECT_EQ(messages[0].medium_mass, 0);
  EXPECT_NEAR(messages[5].medium_mass, 0.5e-3, 0.05e-3);
  EXPECT_NEAR(messages[10].medium_mass, 1e-3, 0.05e-3);
  EXPECT_EQ(messages[10].heat_release, 0);
  EXPECT_NEAR(messages[10].mean_temperature, 293, 1);
}

TEST_F(AirTopics, HeatAndFuelAreThoseOfTheFiresInTheGas) {
  const World world = world_of(
      std::string(kClosedRoom) +
      "[[fire]]\nname = \"pan\"\nposition = [0.5, 0, 0.4]\nsize = [0.4, 0.4, 0.2]\npower = 20e3\n"
      "start = 0.2\nstop = 0.8\n");
  TopicInbox inbox;
  record_topics(world, {"/air/gas"}, 100, &inbox);
  const auto messages = inbox.all<gloam_msgs::Gas>("/air/gas");
  ASSERT_EQ(messages.size(), 11u);
  EXPECT_EQ(messages[0].heat_release, 0);
  EXPECT_NEAR(messages[5].heat_release, 20e3, 1e-3);
  EXPECT_NEAR(messages[5].heat_released, 20e3 * 0.3, 1e-2);
  EXPECT_EQ(messages[10].heat_release, 0);
  EXPECT_NEAR(messages[10].heat_released, 20e3 * 0.6, 1e-2);
  const double heat = double{world.compiled()->gases.gases[0].fuel.heat_of_combustion};
  EXPECT_NEAR(messages[10].fuel_burned, 12e3 / heat, 1e-9);
  EXPECT_GT(messages[8].highest_temperature, 400);
  EXPECT_GT(messages[8].mean_temperature, messages[0].mean_temperature);
}

// The closed form is the sum over the rate, for a fire that grows until it has its power.
TEST_F(AirTopics, HeatOfAGrowingFireIsTheSumOfItsRate) {
  const World world = world_of(std::string(kClosedRoom) +
                               "[[fire]]\nname = \"pan\"\nposition = [0.5, 0, 0.4]\nsize = [0.4, "
                               "0.4, 0.2]\npower = 60\ngrowth = \"ultrafast\"\n");
  TopicInbox inbox;
  record_topics(world, {"/air/gas"}, 100, &inbox);
  double sum = 0, before = 0;
  bool has_grown = false;
  for (const auto& gas : inbox.all<gloam_msgs::Gas>("/air/gas")) {
    EXPECT_NEAR(gas.heat_released, sum, 1.0);
    has_grown = has_grown || gas.heat_release >= 59.9;
    EXPECT_GE(gas.heat_release, before);
    const auto& fire = world.compiled()->gases.sources[0];
    const double time = gas.header.stamp.sec + 1e-9 * gas.header.stamp.nanosec;
    for (int i = 0; i < 1000; ++i) sum += 1e-4 * double{fire.power_at(time + 1e-4 * (i + 0.5))};
    before = gas.heat_release;
  }
  EXPECT_TRUE(has_grown);
  EXPECT_GT(sum, 10);
}

std::map<std::string, std::string> values_of(const DiagnosticStatus& status) {
  std::map<std::string, std::string> values;
  for (const auto& one : status.values) values[one.key] = one.value;
  return values;
}

TEST_F(AirTopics, DiagnosticsTellOfMuJoCosWarnings) {
  const World world = world_of("");
  const auto run = [&](TopicInbox* inbox) {
    auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
    EXPECT_TRUE(simulation
                    ->set_step_hook([](const mjModel*, mjData* data) {
                      data->ctrl[0] = data->time > 1.495 && data->time < 1.525 ? std::nan("") : 0;
                    })
                    .ok());
    auto stream = *simulation->open_topics(
        {.topics = {"/diagnostics", "/diagnostics/performance"}, .required = true},
        inbox->callback());
    ASSERT_TRUE(simulation->step(201).ok());
  };
  TopicInbox inbox, again;
  run(&inbox);
  run(&again);
  const auto messages = inbox.all<DiagnosticArray>("/diagnostics");
  ASSERT_EQ(messages.size(), 3u);  // 1 Hz
  ASSERT_EQ(messages[0].status.size(), 1u);
  for (const size_t i : {size_t{0}, size_t{1}}) {
    EXPECT_EQ(messages[i].status[0].level, DiagnosticStatus::OK);
    EXPECT_EQ(messages[i].status[0].message, "OK");
  }
  const DiagnosticStatus& last = messages[2].status[0];
  EXPECT_EQ(last.level, DiagnosticStatus::WARN);
  EXPECT_THAT(last.message, testing::HasSubstr("bad_control"));
  EXPECT_EQ(values_of(last).at("bad_control"), "3");
  EXPECT_EQ(values_of(last).at("bad_position"), "0");
  EXPECT_EQ(values_of(last).at("step"), "200");
  // Nothing of it depends on the wall clock; what does is elsewhere.
  EXPECT_EQ(again.messages["/diagnostics"], inbox.messages["/diagnostics"]);
  const auto live = inbox.all<DiagnosticArray>("/diagnostics/performance");
  ASSERT_EQ(live.size(), 3u);
  EXPECT_TRUE(values_of(live[0].status[0]).contains("realtime_factor"));
  EXPECT_EQ(values_of(live[0].status[1]).at("dropped_snapshots"), "0");
}

TEST_F(AirTopics, NothingOfTheWallClockIsLoggedUnasked) {
  const auto topics = *list_topics(world_of(""));
  const auto is_logged = [&](const char* name) {
    const auto found = std::ranges::find(topics, name, &TopicInfo::name);
    return found != topics.end() && found->is_logged;
  };
  EXPECT_TRUE(is_logged("/diagnostics"));
  EXPECT_FALSE(is_logged("/diagnostics/performance"));
}

}  // namespace
}  // namespace gloam
