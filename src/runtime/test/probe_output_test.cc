// Outputs of probes: tables, topics, metrics, lists; and scenes that are refused.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "gloam/run.h"
#include "ros/messages/gloam_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "runtime/test/probe_rig.h"
#include "topics/test/topic_inbox.h"

namespace gloam {
namespace {

using testing::HasSubstr;

const char* const kAll = R"(
[sky]
sun_elevation = 40
[weather]
wind = 5
gusts = 0
wind_from = 180
[[gas]]
name = "air"
position = [0, 0, 1]
size = [1, 1, 2]
temperature = 300
[[smoke]]
name = "pot"
position = [0, 0, 0.3]
[[camera]]
name = "eye"
position = [0, 0, 1]
look_at = [0, -1, 1]
[[probe]]
name = "mast"
quantity = "wind"
position = [0, 0, 10]
[[probe]]
name = "warm"
quantity = "gas_temperature"
position = [0.4, 0, 1]
[[probe]]
name = "lux"
quantity = "illuminance"
position = [0, 0, 5]
[[probe]]
name = "sun"
quantity = "sun_disc"
camera = "eye"
[[metric]]
name = "gale"
value = 'norm(sensor("mast"))'
unit = "m/s"
[[metric]]
name = "above"
value = 'sensor("sun")[1]'
)";

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST(ProbeOutputs, TablesHaveNamesAndUnits) {
  const TempFolder folder;
  const World world =
      probe_world(folder, std::string(kAll) + "[record]\noutputs = [\"sensors\", \"metrics\"]\n");
  RunRequest request;
  request.out = folder.path() / "run";
  request.duration = 0.5;
  const auto report = run_and_record(world, request, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  const auto mast = lines_of(request.out / "sensors" / "mast.csv");
  ASSERT_EQ(mast.size(), 7u);
  EXPECT_EQ(mast[0], "sample,step,time_s,delivery_s,x_mps,y_mps,z_mps");
  long sample = 0, step = 0;
  double time = 0, delivery = 0;
  ASSERT_EQ(std::sscanf(mast[2].c_str(), "%ld,%ld,%lf,%lf,", &sample, &step, &time, &delivery), 4);
  EXPECT_EQ(sample, 1);
  EXPECT_EQ(step, 50);
  EXPECT_NEAR(time, 0.1, 1e-9) << "its state's own, a sum of steps";
  EXPECT_EQ(delivery, time);
  EXPECT_EQ(lines_of(request.out / "sensors" / "warm.csv").at(0),
            "sample,step,time_s,delivery_s,temperature_K");
  EXPECT_EQ(lines_of(request.out / "sensors" / "sun.csv").at(0),
            "sample,step,time_s,delivery_s,u_px,v_px,in_picture,visible");
  const auto metrics = lines_of(request.out / "metrics.csv");
  EXPECT_EQ(metrics.at(0), "time_s,gale_mps,above");
  const auto gale =
      std::ranges::find(report->results, "gale_mean_mps", [](const auto& m) { return m.first; });
  ASSERT_NE(gale, report->results.end());
  EXPECT_NEAR(gale->second, 5, 1e-6);
}

TEST(ProbeOutputs, TopicsHaveTheTypesOfRos) {
  const TempFolder folder;
  const World world = probe_world(folder, kAll);
  TopicInbox inbox;
  record_topics(world, {"/mast", "/warm", "/lux", "/sun"}, 100, &inbox);
  const auto mast = inbox.all<geometry_msgs::Vector3Stamped>("/mast");
  ASSERT_EQ(mast.size(), 3u);
  EXPECT_NEAR(mast[2].vector.y, 5, 1e-9);
  EXPECT_EQ(mast[2].header.frame_id, "world");
  EXPECT_EQ(mast[2].header.stamp.nanosec, 200000000u);
  EXPECT_NEAR(inbox.all<sensor_msgs::Temperature>("/warm").at(0).temperature, 300 - 273.15, 1e-3);
  EXPECT_GT(inbox.all<sensor_msgs::Illuminance>("/lux").at(0).illuminance, 10e3);
  const auto sun = inbox.all<gloam_msgs::Probe>("/sun");
  ASSERT_EQ(sun.size(), 3u);
  EXPECT_EQ(sun[0].quantity, "sun_disc");
  EXPECT_EQ(sun[0].names, (std::vector<std::string>{"u", "v", "in_picture", "visible"}));
  EXPECT_EQ(sun[0].units, (std::vector<std::string>{"px", "px", "", ""}));
  TopicInbox again;
  record_topics(world, {"/mast", "/warm", "/lux", "/sun"}, 100, &again);
  EXPECT_EQ(again.messages, inbox.messages);
}

TEST(ProbeOutputs, AreListedAsSensors) {
  const TempFolder folder;
  const World world = probe_world(folder, kAll);
  const auto streams = world.streams();
  const auto mast = std::ranges::find(streams, "mast", &StreamInfo::name);
  ASSERT_NE(mast, streams.end());
  EXPECT_EQ(mast->kind, StreamKind::kSensor);
  EXPECT_EQ(mast->rate.value(), 10);
  EXPECT_EQ(mast->unit, "m/s");
  EXPECT_EQ(mast->outputs, (std::vector<std::string>{"x", "y", "z"}));
  EXPECT_EQ(mast->frame_id, "world");
  EXPECT_EQ(world.info().sensors.back().detail, "probe of sun_disc");
}

std::string refusal(const std::string& probe) {
  const TempFolder folder;
  folder.write("around.xml",
               "<mujoco><worldbody><body name='ball'><freejoint/><geom size='.1'/></body>"
               "<body name='bell'/></worldbody><sensor><framepos name='where' objtype='body' "
               "objname='ball'/></sensor></mujoco>");
  const auto scene = parse_scene(std::string("[environment]\nfile = \"around.xml\"\n") + kAll +
                                     "[[probe]]\nname = \"p\"\n" + probe,
                                 folder.path());
  if (!scene.ok()) return scene.error().to_string();
  const auto world = World::compile(*scene);
  return world.ok() ? "" : world.error().to_string();
}

TEST(ProbeErrors, SayWhatWouldBeRight) {
  EXPECT_EQ(refusal("quantity = \"wind\"\nposition = [0, 0, 1]\n"), "");
  const struct {
    const char *probe, *what, *remedy;
  } kRefused[] = {
      {"quantity = \"wnd\"\n", "wnd", "did you mean 'wind'"},
      {"quantity = \"exposure\"\nposition = [0, 0, 1]\n", "does not support 'position'",
       "specify 'camera'"},
      {"quantity = \"exposure\"\n", "does not specify a place", "specify 'camera'"},
      {"quantity = \"wind\"\ncamera = \"eye\"\n", "does not support 'camera'",
       "specify 'position'"},
      {"quantity = \"wind\"\nposition = [0, 0, 1]\nnormal = [0, 0, 1]\n",
       "does not support 'normal'", "specify"},
      {"quantity = \"contact_force\"\nposition = [0, 0, 1]\n", "does not support 'position'",
       "'agent'"},
      {"quantity = \"contact_force\"\nbody = \"ball\"\nagent = \"ada\"\n", "two places", "specify"},
      {"quantity = \"illuminance\"\nposition = [0, 0, 1]\nnormal = [0, 0, 0]\n", "of length 0",
       "'normal'"},
      {"quantity = \"exposure\"\ncamera = \"eyes\"\n", "no camera 'eyes'", "did you mean 'eye'"},
      {"quantity = \"contact_force\"\nbody = \"bal\"\n", "no body 'bal'", "did you mean 'ball'"},
      {"quantity = \"contact_force\"\nagent = \"ada\"\n", "no agent 'ada'", "no agents"},
      {"quantity = \"wind\"\nbody = \"b*\"\n", "matches 2 bodies", "specify the body"},
      {"quantity = \"water_height\"\nposition = [0, 0, 0]\n", "no [[water]]", "add a [[water]]"},
      {"quantity = \"sinkage\"\nbody = \"ball\"\n", "no [[soil]]", "add a [[soil]]"},
      {"quantity = \"gas_density\"\nposition = [7, 0, 1]\n", "no [[gas]] is at [7, 0, 1]",
       "move it into the [[gas]]"},
      {"quantity = \"wind\"\nposition = [0, 0, 1]\nrate = 0\n", "rate", "0"},
  };
  for (const auto& refused : kRefused) {
    const std::string said = refusal(refused.probe);
    EXPECT_THAT(said, HasSubstr(refused.what)) << refused.probe;
    EXPECT_THAT(said, HasSubstr(refused.remedy)) << refused.probe;
    EXPECT_THAT(said, testing::ContainsRegex(":[0-9]+:")) << refused.probe;
  }
}

TEST(ProbeErrors, ANameOfASensorIsTaken) {
  const TempFolder folder;
  folder.write("around.xml",
               "<mujoco><worldbody><body name='ball'><freejoint/><geom size='.1'/></body>"
               "</worldbody><sensor><framepos name='where' objtype='body' objname='ball'/></sensor>"
               "</mujoco>");
  const auto scene = parse_scene(
      "[environment]\nfile = \"around.xml\"\n[[probe]]\nname = \"where\"\nquantity = \"wind\"\n"
      "position = [0, 0, 1]\n",
      folder.path());
  ASSERT_TRUE(scene.ok());
  const auto world = World::compile(*scene);
  ASSERT_FALSE(world.ok());
  EXPECT_THAT(world.error().to_string(), HasSubstr("a sensor of the model has the same name"));
}

}  // namespace
}  // namespace gloam
