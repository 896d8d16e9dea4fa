// The whole server with a made-up simulation behind it, talked to through sockets.
#include "gloam/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "fake_simulation.h"
#include "studio/free_camera.h"
#include "studio/messages.h"
#include "studio/picture.h"
#include "web/test/raw_client.h"

namespace gloam {
namespace {

using namespace studio;
using nlohmann::json;
using web::RawClient;

/// Small pictures, since the made-up renderer is slow, in a tier that needs no preview of them.
ViewOptions small() {
  return {.port = 0, .render = {.tier = RenderTier::kPath}, .width = 64, .height = 48};
}

/// Waits until something happens on another thread.
bool eventually(const std::function<bool()>& holds, double seconds = 5) {
  for (int i = 0; i < seconds * 200; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return holds();
}

class ViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto server = ViewServer::start(simulation_, small());
    ASSERT_TRUE(server.ok()) << server.error().to_string();
    server_ = std::move(server).value();
    const std::string url = server_->url();
    token_ = url.substr(url.find("token=") + 6);
    host_ = "Host: 127.0.0.1:" + std::to_string(server_->port()) + "\r\n";
    headers_ = host_ + "Authorization: token " + token_ + "\r\n";
  }

  int port() const { return server_->port(); }

  /// A client that has been greeted and told the state.
  std::unique_ptr<RawClient> join() {
    auto client = std::make_unique<RawClient>(port());
    EXPECT_EQ(client->upgrade(headers_), 101);
    const auto hello = client->wait_for("hello");
    EXPECT_TRUE(hello.has_value());
    if (hello) last_hello_ = *hello;
    return client;
  }
  bool called(const std::string& what, int times = 1) {
    return eventually([&] {
      const auto calls = simulation_.calls();
      return std::count(calls.begin(), calls.end(), what) >= times;
    });
  }
  /// Waits for a state that satisfies a condition.
  static std::optional<json> state_where(RawClient& client,
                                         const std::function<bool(const json&)>& holds) {
    for (int i = 0; i < 60; ++i) {
      const auto state = client.wait_for("state");
      if (!state || holds(*state)) return state;
    }
    return {};
  }

  FakeSimulation simulation_;
  std::unique_ptr<ViewServer> server_;
  std::string token_, host_, headers_;
  json last_hello_;
};

TEST_F(ViewTest, TheAddressHoldsAToken) {
  EXPECT_EQ(token_.size(), 48u);
  EXPECT_EQ(server_->url(), "http://127.0.0.1:" + std::to_string(port()) + "/?token=" + token_);
}

TEST_F(ViewTest, ThePageNeedsTheTokenAndBringsItBackAsACookie) {
  EXPECT_EQ(RawClient(port()).request("GET", "/", host_), 401);
  EXPECT_EQ(RawClient(port()).request("GET", "/?token=" + std::string(48, '0'), host_), 401);

  RawClient client(port());
  ASSERT_EQ(client.request("GET", "/?token=" + token_, host_), 200);
  const std::string& answer = client.answer();
  EXPECT_NE(answer.find("<!doctype html>"), std::string::npos);
  EXPECT_NE(answer.find("Content-Security-Policy: default-src 'self'"), std::string::npos);
  EXPECT_EQ(answer.find("Access-Control-"), std::string::npos);
  const auto at = answer.find("Set-Cookie: ");
  ASSERT_NE(at, std::string::npos);
  const std::string cookie = answer.substr(at + 12, answer.find("\r\n", at) - at - 12);
  EXPECT_NE(cookie.find("HttpOnly"), std::string::npos);
  EXPECT_NE(cookie.find("SameSite=Strict"), std::string::npos);

  const std::string with_cookie = host_ + "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n";
  for (const char* file : {"/", "/app.js", "/style.css", "/icon.svg"})
    EXPECT_EQ(RawClient(port()).request("GET", file, with_cookie), 200) << file;
  EXPECT_EQ(RawClient(port()).request("GET", "/../etc/passwd", with_cookie), 404);
  EXPECT_EQ(RawClient(port()).upgrade(with_cookie), 101);
}

TEST_F(ViewTest, HeadGivesTheHeaderOnly) {
  RawClient client(port());
  EXPECT_EQ(client.request("HEAD", "/app.js", headers_), 200);
  EXPECT_EQ(client.answer().substr(client.answer().size() - 4), "\r\n\r\n");
}

TEST_F(ViewTest, ForeignHostsOriginsAndMethodsAreRefused) {
  const std::string token = "Authorization: token " + token_ + "\r\n";
  EXPECT_EQ(RawClient(port()).request("GET", "/", token + "Host: evil.com\r\n"), 403);
  EXPECT_EQ(RawClient(port()).request("GET", "/", token), 400);
  EXPECT_EQ(RawClient(port()).request("GET", "/", headers_ + host_), 400);
  EXPECT_EQ(RawClient(port()).request("POST", "/", headers_ + "Origin: http://evil.com\r\n"), 403);
  EXPECT_EQ(RawClient(port()).request("POST", "/", headers_ + "Content-Length: 3\r\n"), 405);
  EXPECT_EQ(RawClient(port()).request("GET", "/", headers_ + "Content-Length: 3\r\n"), 413);
  EXPECT_EQ(RawClient(port()).request("OPTIONS", "/", headers_), 405);
  EXPECT_EQ(RawClient(port()).request("GET", "/", headers_ + "Sec-Fetch-Site: cross-site\r\n"),
            403);
  EXPECT_EQ(RawClient(port()).request("GET", "/nothing", headers_), 404);
  EXPECT_EQ(RawClient(port()).request("\x16\x03\x01", "/", headers_), 400);
}

TEST_F(ViewTest, WebSocketsNeedTokenAndOwnOrigin) {
  const std::string origin = "Origin: http://127.0.0.1:" + std::to_string(port()) + "\r\n";
  EXPECT_EQ(RawClient(port()).upgrade(host_), 401);
  EXPECT_EQ(RawClient(port()).upgrade(host_, "/ws?token=" + token_), 401);
  EXPECT_EQ(RawClient(port()).upgrade(host_, "/?token=" + token_), 401);
  EXPECT_EQ(RawClient(port()).upgrade(headers_ + "Origin: http://evil.com\r\n"), 403);
  EXPECT_EQ(RawClient(port()).upgrade(headers_ + "Origin: null\r\n"), 403);
  EXPECT_EQ(RawClient(port()).upgrade(headers_, "/other"), 404);
  EXPECT_EQ(RawClient(port()).upgrade(headers_ + origin), 101);
  EXPECT_EQ(RawClient(port()).upgrade(headers_), 101);  // a program, not a page
}

TEST_F(ViewTest, AClientIsGreetedAndSeesPictures) {
  const auto client = join();
  EXPECT_EQ(last_hello_["cameras"], json::array({"free", "front", "robot/head"}));
  EXPECT_EQ(last_hello_["step_rate"], 500);
  const auto picture = client->wait_for_picture();
  ASSERT_TRUE(picture.has_value());
  EXPECT_EQ(picture->substr(0, 4), "GLV1");
  EXPECT_EQ(picture->substr(kPictureHeaderSize, 2), "\xff\xd8");
  const auto state = client->wait_for("state");
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ((*state)["controller"], last_hello_["client"]);
  EXPECT_EQ((*state)["camera"], "free");
  EXPECT_EQ((*state)["error"], "");
  EXPECT_EQ((*state)["hash"].get<std::string>().size(), 16u);
}

/// Width of a picture, from the frame header of its JPEG (ITU T.81, B.2.2).
int width_of(const std::string& picture) {
  const size_t frame = picture.find("\xff\xc0", kPictureHeaderSize);
  if (frame == std::string::npos || frame + 9 > picture.size()) return 0;
  return 256 * static_cast<uint8_t>(picture[frame + 7]) + static_cast<uint8_t>(picture[frame + 8]);
}

/// Widths of the first pictures of a server that shows pictures of `width` by `height`, and the
/// cameras that it opened for them.
std::pair<std::vector<int>, std::vector<std::string>> first_widths(ViewOptions options) {
  FakeSimulation simulation;
  const auto server = ViewServer::start(simulation, options);
  if (!server.ok()) return {};
  const std::string url = (*server)->url();
  RawClient client((*server)->port());
  if (client.upgrade("Host: localhost\r\nAuthorization: token " +
                     url.substr(url.find("token=") + 6) + "\r\n") != 101)
    return {};
  std::vector<int> widths;
  for (int i = 0; i < 2; ++i) {
    const auto picture = client.wait_for_picture();
    widths.push_back(picture ? width_of(*picture) : 0);
  }
  return {widths, simulation.calls()};
}

TEST(ViewPreview, ASmallPictureComesBeforeTheFirst) {
  const auto [widths, calls] =
      first_widths({.port = 0, .render = {.tier = RenderTier::kPath}, .width = 320, .height = 240});
  EXPECT_EQ(widths, (std::vector<int>{80, 320}));
}

TEST(ViewPreview, APathTracedPictureComesBeforeTheFirstInteractiveOne) {
  const auto [widths, calls] = first_widths(
      {.port = 0, .render = {.tier = RenderTier::kInteractive}, .width = 64, .height = 48});
  EXPECT_EQ(widths, (std::vector<int>{64, 64}));
  EXPECT_EQ(std::count(calls.begin(), calls.end(), "open free"), 2);
}

TEST_F(ViewTest, PicturesAreNewAndInOrder) {
  simulation_.resume();
  const auto client = join();
  uint64_t last_sequence = 0;
  double last_time = -1;
  for (int i = 0; i < 5; ++i) {
    const auto picture = client->wait_for_picture();
    ASSERT_TRUE(picture.has_value());
    uint64_t sequence = 0;
    double time = 0;
    std::memcpy(&sequence, picture->data() + 8, 8);
    std::memcpy(&time, picture->data() + 24, 8);
    EXPECT_GT(sequence, last_sequence);
    EXPECT_GE(time, last_time);
    last_sequence = sequence;
    last_time = time;
  }
  EXPECT_GT(last_time, 0);
}

TEST_F(ViewTest, AClientThatShowsNothingGetsNoMorePictures) {
  simulation_.resume();
  const auto client = join();
  int pictures = 0, states = 0;
  while (states < 8) {
    const auto frame = client->read_frame();
    ASSERT_TRUE(frame.has_value());
    pictures += frame->opcode == 2;
    states += frame->opcode == 1;
  }
  EXPECT_EQ(pictures, kPicturesInFlight);
  EXPECT_TRUE(client->send_text(R"({"type":"seen"})"));
  EXPECT_TRUE(eventually([&] { return client->read_frame()->opcode == 2; }));
}

TEST_F(ViewTest, TheFirstClientMayComeLongAfterThePausedPicture) {
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_TRUE(join()->wait_for_picture().has_value());
}

TEST_F(ViewTest, ALateClientSeesThePausedPicture) {
  const auto first = join();
  ASSERT_TRUE(first->wait_for_picture().has_value());
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_TRUE(join()->wait_for_picture(1).has_value());
}

TEST_F(ViewTest, ControlMessagesReachTheSimulation) {
  EXPECT_EQ(simulation_.calls(), (std::vector<std::string>{"open free", "speed 1"}));
  const auto client = join();
  client->send_json({{"type", "resume"}});
  EXPECT_TRUE(called("resume"));
  EXPECT_TRUE(state_where(*client, [](const json& s) { return s["paused"] == false; }));
  client->send_json({{"type", "pause"}});
  EXPECT_TRUE(called("pause"));
  client->send_json({{"type", "speed"}, {"value", 0.25}});
  EXPECT_TRUE(called("speed 0.25"));
  EXPECT_TRUE(state_where(*client, [](const json& s) { return s["speed"] == 0.25; }));
  client->send_json({{"type", "reset"}});
  EXPECT_TRUE(called("reset"));
  client->send_json({{"type", "step"}, {"count", 3}});
  EXPECT_TRUE(called("step", 3));
  EXPECT_TRUE(state_where(*client, [](const json& s) { return s["step"] == 3; }));
}

TEST_F(ViewTest, ChangesOfAPausedSimulationAreShown) {
  const auto client = join();
  ASSERT_TRUE(client->wait_for_picture().has_value());
  while (client->wait_for_picture(0.3)) {
  }
  client->send_json({{"type", "orbit"}, {"dx", 0.1}, {"dy", 0}});
  EXPECT_TRUE(client->wait_for_picture().has_value());
  while (client->wait_for_picture(0.3)) {
  }
  client->send_json({{"type", "step"}, {"count", 1}});
  EXPECT_TRUE(client->wait_for_picture().has_value());
}

TEST_F(ViewTest, CamerasAreSwitched) {
  simulation_.resume();
  const auto client = join();
  client->send_json({{"type", "camera"}, {"name", "robot/head"}});
  EXPECT_TRUE(called("open robot/head"));
  EXPECT_TRUE(state_where(*client, [](const json& s) { return s["camera"] == "robot/head"; }));
  bool seen = false;
  for (int i = 0; i < 10 && !seen; ++i) {
    const auto picture = client->wait_for_picture();
    ASSERT_TRUE(picture.has_value());
    seen = (*picture)[36] == 2;
  }
  EXPECT_TRUE(seen);
  client->send_json({{"type", "camera"}, {"name", "nowhere"}});
  const auto notice = client->wait_for("notice");
  ASSERT_TRUE(notice.has_value());
  EXPECT_NE((*notice)["text"].get<std::string>().find("nowhere"), std::string::npos);
  EXPECT_EQ(simulation_.open_streams(), 1);
}

/// Camera position of the next picture that is not at `before`.
std::optional<Vec3> moved_camera(RawClient& client, const Vec3& before) {
  for (int i = 0; i < 20; ++i) {
    const auto picture = client.wait_for_picture();
    if (!picture) return {};
    Vec3 p;
    std::memcpy(&p, picture->data() + 60, sizeof p);
    if (norm(p - before) > 1e-9) return p;
  }
  return {};
}

TEST_F(ViewTest, TheFreeCameraMovesAboutWhatItLooksAtAndKeepsItsPlace) {
  const auto client = join();
  const auto first = moved_camera(*client, {});
  ASSERT_TRUE(first.has_value());
  client->send_json({{"type", "orbit"}, {"dx", 0.25}, {"dy", 0}});
  const auto turned = moved_camera(*client, *first);
  ASSERT_TRUE(turned.has_value());
  // The globe in the middle of the picture stays where it was: about its front, 4 m away.
  EXPECT_NEAR(turned->z, first->z, 1e-9);
  const double chord = norm(*turned - *first);
  EXPECT_GT(chord, 2);
  EXPECT_LT(chord, 5);
  client->send_json({{"type", "camera"}, {"name", "front"}});
  const auto fixed = moved_camera(*client, *turned);
  ASSERT_TRUE(fixed.has_value());
  client->send_json({{"type", "orbit"}, {"dx", 0.25}, {"dy", 0}});  // nothing: not the free camera
  client->send_json({{"type", "camera"}, {"name", "free"}});
  const auto again = moved_camera(*client, *fixed);
  ASSERT_TRUE(again.has_value());
  EXPECT_LT(norm(*again - *turned), 1e-9) << "a picture from somewhere else flashed up";
}

TEST_F(ViewTest, ABodyIsPulledInThePlaneOfTheCamera) {
  const auto client = join();
  ASSERT_TRUE(client->wait_for_picture().has_value());
  client->send_json({{"type", "drag_start"}, {"u", 32}, {"v", 24}});  // the globe
  const auto picked = client->wait_for("picked");
  ASSERT_TRUE(picked.has_value());
  EXPECT_EQ((*picked)["body"], "globe");
  EXPECT_EQ((*picked)["dragging"], true);
  client->send_json({{"type", "drag_move"}, {"u", 42}, {"v", 24}});
  ASSERT_TRUE(eventually([&] { return simulation_.drags().size() == 2; }));
  client->send_json({{"type", "drag_end"}});
  ASSERT_TRUE(eventually([&] { return simulation_.drags().size() == 3; }));

  const auto drags = simulation_.drags();
  const Vec3 grabbed = {(*picked)["point"][0], (*picked)["point"][1], (*picked)["point"][2]};
  EXPECT_EQ(drags[0].body.id, 2);
  EXPECT_LT(norm(drags[0].target_W - grabbed), 1e-9);  // grabbing alone does not pull
  const Vec3 move = drags[1].target_W - grabbed;
  EXPECT_NEAR(move.z, 0, 1e-9);  // to the right in the picture is level
  // 10 px at focal length 57.6 px and the depth of the grabbed point.
  const Vec3 eye = {2.6, -2.8, 1.9}, middle = {0, 0, 0.35};
  const double depth = dot(grabbed - eye, (1 / norm(middle - eye)) * (middle - eye));
  EXPECT_NEAR(norm(move), 10 / 57.6 * depth, 1e-6);
  EXPECT_TRUE(drags[1].active);
  EXPECT_FALSE(drags[2].active);
  EXPECT_EQ(drags[2].body.id, 2);
}

TEST_F(ViewTest, TheClientIsToldWhereThePulledPointIs) {
  const auto client = join();
  ASSERT_TRUE(client->wait_for_picture().has_value());
  client->send_json({{"type", "drag_start"}, {"u", 32}, {"v", 24}});
  const auto picked = client->wait_for("picked");
  ASSERT_TRUE(picked.has_value());
  simulation_.resume();
  const auto pulled = client->wait_for("pulled");
  ASSERT_TRUE(pulled.has_value());
  for (int i = 0; i < 3; ++i)  // the globe does not move
    EXPECT_NEAR((*pulled)["point"][i], (*picked)["point"][i].get<double>(), 1e-9);
}

TEST_F(ViewTest, NothingAndTheWorldCannotBePulled) {
  const auto client = join();
  ASSERT_TRUE(client->wait_for_picture().has_value());
  client->send_json({{"type", "drag_start"}, {"u", 32}, {"v", -500}});  // the sky
  EXPECT_TRUE(client->wait_for("notice").has_value());
  client->send_json({{"type", "drag_start"}, {"u", 2}, {"v", 46}});  // the floor
  EXPECT_TRUE(client->wait_for("notice").has_value());
  client->send_json({{"type", "drag_move"}, {"u", 32}, {"v", 24}});
  client->send_json({{"type", "pick"}, {"u", 32}, {"v", 24}});
  const auto picked = client->wait_for("picked");
  ASSERT_TRUE(picked.has_value());
  EXPECT_EQ((*picked)["body"], "globe");
  EXPECT_EQ((*picked)["dragging"], false);
  client->send_json({{"type", "pick"}, {"u", 32}, {"v", -500}});
  const auto nothing = client->wait_for("picked");
  ASSERT_TRUE(nothing.has_value());
  EXPECT_EQ((*nothing)["found"], false);
  EXPECT_TRUE(simulation_.drags().empty());
}

TEST_F(ViewTest, SpectatorsWatchUntilTheyTakeControl) {
  const auto controller = join();
  const auto spectator = join();
  const int64_t spectator_number = last_hello_["client"];
  for (const char* type : {"resume", "pause", "reset", "drag_end", "release"})
    spectator->send_json({{"type", type}});
  spectator->send_json({{"type", "speed"}, {"value", 2}});
  spectator->send_json({{"type", "camera"}, {"name", "front"}});
  spectator->send_json({{"type", "step"}, {"count", 1}});
  for (int i = 0; i < 8; ++i) {
    const auto notice = spectator->wait_for("notice");
    ASSERT_TRUE(notice.has_value());
    EXPECT_NE((*notice)["text"].get<std::string>().find("Take control"), std::string::npos);
  }
  EXPECT_TRUE(spectator->wait_for_picture().has_value());
  EXPECT_EQ(simulation_.calls(), (std::vector<std::string>{"open free", "speed 1"}));

  spectator->send_json({{"type", "claim"}});
  EXPECT_TRUE(
      state_where(*controller, [&](const json& s) { return s["controller"] == spectator_number; }));
  spectator->send_json({{"type", "resume"}});
  EXPECT_TRUE(called("resume"));
  controller->send_json({{"type", "pause"}});
  EXPECT_TRUE(controller->wait_for("notice").has_value());
  spectator->send_json({{"type", "release"}});
  EXPECT_TRUE(state_where(*controller, [](const json& s) { return s["controller"] == 0; }));
}

TEST_F(ViewTest, WhoeverLosesControlLetsGo) {
  auto first = join();
  ASSERT_TRUE(first->wait_for_picture().has_value());
  first->send_json({{"type", "drag_start"}, {"u", 32}, {"v", 24}});
  ASSERT_TRUE(eventually([&] { return simulation_.drags().size() == 1; }));
  const auto second = join();
  second->send_json({{"type", "claim"}});
  ASSERT_TRUE(eventually([&] { return simulation_.drags().size() == 2; }));
  EXPECT_FALSE(simulation_.drags()[1].active);

  second->send_json({{"type", "drag_start"}, {"u", 32}, {"v", 24}});
  ASSERT_TRUE(eventually([&] { return simulation_.drags().size() == 3; }));
  server_->stop();
  ASSERT_EQ(simulation_.drags().size(), 4u);
  EXPECT_FALSE(simulation_.drags()[3].active);
}

TEST_F(ViewTest, AControllerThatVanishesLetsGoAndControlIsFree) {
  auto first = join();
  ASSERT_TRUE(first->wait_for_picture().has_value());
  first->send_json({{"type", "drag_start"}, {"u", 32}, {"v", 24}});
  ASSERT_TRUE(eventually([&] { return simulation_.drags().size() == 1; }));
  first.reset();  // a crash: no goodbye
  ASSERT_TRUE(eventually([&] { return simulation_.drags().size() == 2; }));
  EXPECT_FALSE(simulation_.drags()[1].active);
  const auto second = join();
  const int64_t number = last_hello_["client"];
  EXPECT_TRUE(state_where(*second, [&](const json& s) { return s["controller"] == number; }));
}

TEST_F(ViewTest, MalformedMessagesAreAnsweredAndHarmless) {
  const auto client = join();
  for (const char* text : {"", "{", "null", "[1]", R"({"type":"x"})", R"({"type":"speed"})"}) {
    client->send_text(text);
    EXPECT_TRUE(client->wait_for("notice").has_value()) << text;
  }
  client->send_json({{"type", "resume"}});
  EXPECT_TRUE(called("resume"));
}

TEST_F(ViewTest, FailuresOfThePhysicsAreTold) {
  const auto client = join();
  simulation_.fail({.kind = ErrorKind::kDiverged, .message = "the physics diverged"});
  EXPECT_TRUE(
      state_where(*client, [](const json& s) { return s["error"] == "the physics diverged"; }));
  client->send_json({{"type", "step"}, {"count", 1}});
  const auto notice = client->wait_for("notice");
  ASSERT_TRUE(notice.has_value());
  EXPECT_EQ((*notice)["text"], "the physics diverged");
  client->send_json({{"type", "reset"}});
  EXPECT_TRUE(state_where(*client, [](const json& s) { return s["error"] == ""; }));
}

TEST_F(ViewTest, SlowStepsDoNotHoldUpStopping) {
  const auto client = join();
  simulation_.step_milliseconds = 50;
  client->send_json({{"type", "step"}, {"count", 100}});
  EXPECT_TRUE(called("step"));
  const auto start = std::chrono::steady_clock::now();
  server_->stop();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(2500));
}

TEST_F(ViewTest, StopsWhileClientsAreConnectedAndSaysSo) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 6; ++i) clients.push_back(join());
  simulation_.resume();
  server_->stop();
  EXPECT_EQ(simulation_.open_streams(), 0);
  for (auto& client : clients) EXPECT_EQ(client->wait_for_close(), 1001);
  EXPECT_FALSE(RawClient(port()).connected());
  server_->stop();  // again: nothing
}

TEST_F(ViewTest, TheCameraClosesWhenNobodyLooks) {
  join();
  EXPECT_EQ(simulation_.open_streams(), 1);
  EXPECT_TRUE(eventually([&] { return simulation_.open_streams() == 0; }, 8));
  const auto client = join();
  simulation_.resume();
  EXPECT_TRUE(eventually([&] { return simulation_.open_streams() == 1; }));
  EXPECT_TRUE(client->wait_for_picture().has_value());
}

TEST(ViewStart, WrongOptionsAreUsageErrors) {
  FakeSimulation simulation;
  const auto kind_of = [&](const ViewOptions& options) {
    const auto server = ViewServer::start(simulation, options);
    return server.ok() ? ErrorKind::kPartial : server.error().kind;
  };
  for (const char* host : {"0.0.0.0", "example.com", "192.168.1.4", "::", ""})
    EXPECT_EQ(kind_of({.port = 0, .host = host}), ErrorKind::kUsage) << host;
  EXPECT_EQ(kind_of({.port = -1}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.port = 65536}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.port = 0, .max_clients = 0}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.port = 0, .rate = 0}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.port = 0, .rate = std::nan("")}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.port = 0, .width = -1}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.port = 0, .camera = "nowhere"}), ErrorKind::kInput);
  for (const char* host : {"localhost", "127.0.0.1"}) {
    const auto server = ViewServer::start(simulation, {.port = 0, .host = host});
    ASSERT_TRUE(server.ok()) << server.error().to_string();
    EXPECT_GT((*server)->port(), 0);
  }
}

TEST(ViewStart, APortInUseIsNamed) {
  FakeSimulation simulation;
  const auto first = ViewServer::start(simulation, small());
  ASSERT_TRUE(first.ok());
  ViewOptions options = small();
  options.port = (*first)->port();
  const auto second = ViewServer::start(simulation, options);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().kind, ErrorKind::kIo);
  EXPECT_EQ(second.error().to_string(),
            "port " + std::to_string(options.port) + " is in use (try --port 0)");
}

}  // namespace
}  // namespace gloam
