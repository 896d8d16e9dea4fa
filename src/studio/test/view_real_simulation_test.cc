// The view of a real simulation: watching changes nothing, and what its user does is a Command.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include "gloam/log_player.h"
#include "gloam/view.h"
#include "web/test/raw_client.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using web::RawClient;

const char* const kTumbling = R"(
<mujoco><option timestep="0.002"/>
  <worldbody><light pos="0 0 3"/><geom name="floor" type="plane" size="3 3 0.1"/>
    <camera name="side" pos="0 -2 1" xyaxes="1 0 0 0 0.5 1"/>
    <body name="box" pos="0 0 1" quat="0.9 0.3 0.2 0.1"><freejoint/>
      <geom type="box" size="0.2 0.1 0.15"/></body>
  </worldbody></mujoco>)";

class ViewOfARealSimulation : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / ("gloam_view_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    ::setenv("GLOAM_CACHE", (folder_ / "cache").c_str(), 1);
    std::ofstream(folder_ / "model.xml") << kTumbling;
  }
  void TearDown() override { fs::remove_all(folder_); }

  static World compile(const fs::path& file) {
    const Result<Scene> scene = load_scene(file);
    EXPECT_TRUE(scene.ok()) << scene.error().to_string();
    auto world = World::compile(*scene);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return *world;
  }

  static uint64_t hash_alone(const World& world, int64_t steps) {
    auto simulation = Simulation::create(world, {});
    EXPECT_TRUE((*simulation)->run_until(steps).ok());
    return (*simulation)->latest().hash();
  }

  /// The same with `clients` pages that show pictures, at ten times real time.
  static uint64_t hash_watched(const World& world, int64_t steps, int clients) {
    auto simulation = Simulation::create(world, {});
    auto server = ViewServer::start(**simulation, {.port = 0, .width = 48, .height = 36});
    EXPECT_TRUE(server.ok()) << server.error().to_string();
    const std::string url = (*server)->url();
    const std::string headers = "Host: 127.0.0.1:" + std::to_string((*server)->port()) +
                                "\r\nAuthorization: token " + url.substr(url.find("token=") + 6) +
                                "\r\n";
    std::vector<std::thread> pages;
    std::atomic<int> pictures{0};
    std::atomic<bool> over{false};
    for (int i = 0; i < clients; ++i) {
      pages.emplace_back([&] {
        RawClient client((*server)->port());
        EXPECT_EQ(client.upgrade(headers), 101);
        while (!over) pictures += client.wait_for_picture(0.5).has_value();
      });
    }
    while (pictures < clients) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    (*simulation)->set_pace(Pace::kRealTime, 10);
    EXPECT_TRUE((*simulation)->run_until(steps).ok());
    const uint64_t hash = (*simulation)->latest().hash();
    over = true;
    for (std::thread& page : pages) page.join();
    EXPECT_GT(pictures, clients) << "it was watched while it ran";
    (*server)->stop();
    return hash;
  }

  fs::path folder_;
};

TEST_F(ViewOfARealSimulation, WatchingChangesNothing) {
  const World world = compile(folder_ / "model.xml");
  EXPECT_EQ(hash_watched(world, 1000, 2), hash_alone(world, 1000));
}

TEST_F(ViewOfARealSimulation, ALogIsGoneAboutIn) {
  RunRequest request{.duration = 0.4};
  request.log = {.file = folder_ / "run.mcap", .topics = {"/clock"}};
  ASSERT_TRUE(run_and_record(compile(folder_ / "model.xml"), request, {}).ok());
  auto player = LogPlayer::open({.log = folder_ / "run.mcap"});
  ASSERT_TRUE(player.ok()) << player.error().to_string();
  auto server = ViewServer::start((*player)->simulation(),
                                  {.port = 0, .width = 48, .height = 36, .player = player->get()});
  ASSERT_TRUE(server.ok()) << server.error().to_string();
  const std::string url = (*server)->url();
  RawClient client((*server)->port());
  ASSERT_EQ(
      client.upgrade("Host: 127.0.0.1:" + std::to_string((*server)->port()) +
                     "\r\nAuthorization: token " + url.substr(url.find("token=") + 6) + "\r\n"),
      101);
  const auto hello = client.wait_for("hello");
  ASSERT_TRUE(hello);
  EXPECT_DOUBLE_EQ((*hello)["log_end"], 0.4);
  for (const double time : {0.3, 0.1, 9.0}) {  // beyond the end: its end
    client.send_text(R"({"type":"seek","time":)" + std::to_string(time) + "}");
    double shown = -1;
    for (int i = 0; i < 100 && std::abs(shown - std::min(time, 0.4)) > 1e-9; ++i)
      if (const auto state = client.wait_for("state")) shown = (*state)["time"];
    EXPECT_NEAR(shown, std::min(time, 0.4), 1e-9);
  }
  (*server)->stop();
}

/// A page that looks at the tumbling box, paused at its start.
struct Visit {
  explicit Visit(const World& world)
      : simulation(*Simulation::create(world, {})),
        server(*ViewServer::start(*simulation, {.port = 0, .width = 48, .height = 36})),
        client(server->port()) {
    const std::string url = server->url();
    EXPECT_EQ(
        client.upgrade("Host: 127.0.0.1:" + std::to_string(server->port()) +
                       "\r\nAuthorization: token " + url.substr(url.find("token=") + 6) + "\r\n"),
        101);
  }
  /// Values of a field in the next binary message with this id.
  std::vector<float> field(int id, const std::string& name) {
    for (int i = 0; i < 500; ++i) {
      const auto frame = client.read_frame();
      if (!frame) break;
      if (frame->opcode != 2) continue;
      if (frame->payload.substr(0, 4) != "GLF1") {
        client.send_text(R"({"type":"seen"})");
        continue;
      }
      uint32_t length = 0;
      std::memcpy(&length, frame->payload.data() + 4, 4);
      const auto head = nlohmann::json::parse(frame->payload.substr(8, length));
      size_t at = 8 + length;
      for (const auto& entry : head["fields"]) {
        std::vector<float> values(entry["count"].get<size_t>());
        std::memcpy(values.data(), frame->payload.data() + at, 4 * values.size());
        if (head["id"] == id && entry["name"] == name) return values;
        at += 4 * values.size();
      }
    }
    return {};
  }
  nlohmann::json state_at_step(int64_t step) {
    for (int i = 0; i < 200; ++i)
      if (const auto state = client.wait_for("state"); state && (*state)["step"] == step)
        return *state;
    return {};
  }

  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<ViewServer> server;
  RawClient client;
};

TEST_F(ViewOfARealSimulation, ThePageReadsTheModelAndSetsItsState) {
  Visit page(compile(folder_ / "model.xml"));
  page.client.send_text(R"({"type":"describe"})");
  const auto model = page.client.wait_for("model");
  ASSERT_TRUE(model);
  EXPECT_EQ((*model)["bodies"], nlohmann::json::array({"world", "box"}));
  EXPECT_EQ((*model)["geoms"].size(), 2u);
  EXPECT_EQ((*model)["serial"], page.simulation->world().serial());

  page.client.send_text(R"({"type":"get","id":3,"fields":["geom_size","nothing"]})");
  const auto notice = page.client.wait_for("notice");
  ASSERT_TRUE(notice);
  EXPECT_NE((*notice)["text"].get<std::string>().find("nothing"), std::string::npos);
  EXPECT_EQ(page.field(3, "geom_size").size(), 6u);

  // While it is paused, a joint is set without a step.
  page.client.send_text(R"({"type":"watch","fields":["qpos"],"rate":30})");
  EXPECT_EQ(page.field(0, "qpos").at(2), 1);
  page.client.send_text(R"({"type":"set_joint","joint":0,"qpos":[0,0,2.5,1,0,0,0]})");
  EXPECT_EQ(page.field(0, "qpos").at(2), 2.5);
  EXPECT_EQ(page.simulation->latest().step(), 0);

  page.client.send_text(R"({"type":"copy_state"})");
  const auto copied = page.client.wait_for("copied");
  ASSERT_TRUE(copied);
  EXPECT_TRUE((*copied)["text"].get<std::string>().starts_with("<key qpos=\"0 0 2.5 1 0 0 0\""));
  page.server->stop();
}

TEST_F(ViewOfARealSimulation, ThePageStepsBackToTheSameState) {
  Visit page(compile(folder_ / "model.xml"));
  const auto start = page.state_at_step(0);
  page.client.send_text(R"({"type":"step","count":40})");
  const auto there = page.state_at_step(40);
  page.client.send_text(R"({"type":"step","count":30})");
  ASSERT_FALSE(page.state_at_step(70).is_null());
  page.client.send_text(R"({"type":"back","count":30})");
  const auto again = page.state_at_step(40);
  ASSERT_FALSE(again.is_null());
  EXPECT_EQ(again["hash"], there["hash"]);
  EXPECT_EQ(again["history_start"], 0);
  EXPECT_GT(again["run"], there["run"]);
  page.client.send_text(R"({"type":"seek","time":0})");
  EXPECT_EQ(page.state_at_step(0)["hash"], start["hash"]);
  page.client.send_text(R"({"type":"back","count":1})");
  const auto notice = page.client.wait_for("notice");
  ASSERT_TRUE(notice);
  EXPECT_NE((*notice)["text"].get<std::string>().find("beginning"), std::string::npos);
  page.server->stop();
}

TEST_F(ViewOfARealSimulation, AWatchingPageReadsButChangesNothing) {
  Visit page(compile(folder_ / "model.xml"));
  ASSERT_TRUE(page.client.wait_for("hello"));
  page.client.send_text(R"({"type":"release"})");
  page.client.send_text(R"({"type":"set_joint","joint":0,"qpos":[0,0,2,1,0,0,0]})");
  const auto notice = page.client.wait_for("notice");
  ASSERT_TRUE(notice);
  EXPECT_NE((*notice)["text"].get<std::string>().find("watching"), std::string::npos);
  page.client.send_text(R"({"type":"get","id":1,"fields":["qpos"]})");
  EXPECT_EQ(page.field(1, "qpos").at(2), 1);
  page.server->stop();
}

TEST_F(ViewOfARealSimulation, WatchingAThirdPartyRobotChangesNothing) {
  const char* data = std::getenv("GLOAM_TEST_DATA");
  const fs::path robots = fs::path(data != nullptr ? data : "") / "mjlab/mjlab/asset_zoo/robots";
  if (data == nullptr || !fs::is_directory(robots)) GTEST_SKIP() << "run tests/fetch_data.py";
  for (const char* name :
       {"unitree_go1/xmls/go1.xml", "unitree_g1/xmls/g1.xml", "i2rt_yam/xmls/yam.xml"}) {
    const World world = compile(robots / name);
    EXPECT_EQ(hash_watched(world, 2000, 1), hash_alone(world, 2000)) << name;
  }
}

TEST_F(ViewOfARealSimulation, AnUnknownCameraIsAnError) {
  auto simulation = Simulation::create(compile(folder_ / "model.xml"), {});
  const auto server = ViewServer::start(**simulation, {.port = 0, .camera = "sid"});
  ASSERT_FALSE(server.ok());
  EXPECT_NE(server.error().to_string().find("side"), std::string::npos);
}

}  // namespace
}  // namespace gloam
