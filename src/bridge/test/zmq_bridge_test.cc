// The bridge to ZeroMQ with a client over bare sockets: every operation, streams, claims, access.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <set>
#include <thread>

#include "bridge/test/zmq_fixture.h"
#include "bridge/zmq/address_file.h"
#include "bridge/zmq/operations/operation.h"
#include "gloam/log.h"
#include "ros/codec.h"
#include "ros/messages/geometry_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/std_msgs.h"

namespace gloam::bridge::zeromq {
namespace {

using testing::Contains;
using testing::HasSubstr;
using namespace std::chrono_literals;

ArgumentWriter one(std::string_view key, const auto& value) {
  return [key, value](Packer& packer) { pack_pair(packer, key, value); };
}

std::vector<double> numbers_of(const Value& value) { return value.as<std::vector<double>>(); }

TEST_F(ZmqBridgeTest, HelloTellsStrangersLittleAndHoldersOfTheTokenAll) {
  start_default();
  RawClient client(operations_address());
  client.send(make_request("hello", 1, one("machine", machine_id()), ""));
  const Value little = (*client.receive())["result"];
  EXPECT_EQ(little["protocol"].as<int>(), 1);
  EXPECT_TRUE(little["token_needed"].as<bool>());
  EXPECT_FALSE(little.has("topics"));
  EXPECT_TRUE(little["shared_memory"].as<bool>());
  const Value all = client.call("hello", 1, one("machine", std::string("another:0")));
  EXPECT_FALSE(all["shared_memory"].as<bool>());
  EXPECT_EQ(all["step_rate"].number(), 500);
  for (const Operation& operation : all_operations())
    EXPECT_TRUE(all["operations"].has(operation.name)) << operation.name;
  EXPECT_EQ(all["operations"]["wrench"]["args"]["force"]["unit"].text(), "N, (3)");
  EXPECT_THAT(all["types"]["sensor_msgs/msg/Image"]["ros2msg"].text(), HasSubstr("uint8[] data"));
  EXPECT_THAT(all["cameras"].as<std::vector<std::string>>(), Contains("front"));
  EXPECT_THAT(all["actuators"].as<std::vector<std::string>>(), Contains("cart/push"));
  EXPECT_EQ(all["live_fields"]["gravity"]["count"].as<int>(), 3);
}

TEST_F(ZmqBridgeTest, NothingElseIsDoneWithoutTheToken) {
  start_default();
  RawClient client(operations_address());
  for (const Operation& operation : all_operations()) {
    if (operation.name == "hello") continue;
    EXPECT_THAT(client.refused(operation.name, 0, {}, "")["message"].text(), HasSubstr("no token"));
    EXPECT_THAT(client.refused(operation.name, 0, {}, "0123456789abcdef")["message"].text(),
                HasSubstr("wrong"));
  }
  EXPECT_THAT(client.refused("hello", 0, {}, "wrong")["message"].text(), HasSubstr("wrong"));
  EXPECT_FALSE(operator_->end_asked());
  EXPECT_EQ(simulation_->latest().step(), 0);
}

TEST_F(ZmqBridgeTest, ErrorsTellWhatToDo) {
  start_default();
  RawClient client(operations_address());
  const Value unknown = client.refused("stat");
  EXPECT_EQ(unknown["kind"].text(), "usage");
  EXPECT_THAT(unknown["remedy"].text(), HasSubstr("'state'"));
  EXPECT_THAT(client.refused("controls", 1, one("valeus", 1))["remedy"].text(),
              HasSubstr("'values'"));
  EXPECT_THAT(client.refused("controls")["message"].text(), HasSubstr("nothing to set"));
  client.send_bytes("\x81\xff garbage");
  const std::optional<Value> damaged = client.receive();
  ASSERT_TRUE(damaged);
  EXPECT_TRUE(damaged->has("error"));
  EXPECT_FALSE(damaged->has("id"));
  EXPECT_GT(bridge_->stats().refused, 3);
}

TEST_F(ZmqBridgeTest, LockstepAnswersWithTheStateAfterTheSteps) {
  start_default();
  RawClient client(operations_address());
  client.call("controls", 1, [](Packer& packer) {
    packer.pack(std::string_view("actuators"));
    packer.pack_map(1);
    pack_pair(packer, "cart/push", 2.0);
  });
  const Value state = client.call("step", 1, one("n", 50));
  EXPECT_EQ(state["step"].as<int>(), 50);
  EXPECT_NEAR(state["time"].number(), 0.1, 1e-12);
  EXPECT_EQ(state["hash"].as<uint64_t>(), simulation_->latest().hash());
  EXPECT_EQ(numbers_of(state["ctrl"]), (std::vector<double>{2, 0}));
  const Joint slide = *simulation_->world().find_joint("cart/slide");
  EXPECT_THAT(numbers_of(state["qpos"]), Contains(simulation_->latest()[slide].position()));
  EXPECT_THAT(numbers_of(state["qvel"]), Contains(simulation_->latest()[slide].velocity()));
  EXPECT_GT(simulation_->latest()[slide].position(), 0.005);
  EXPECT_THAT(client.refused("step", 1, one("n", 0))["message"].text(), HasSubstr("1 or more"));
}

TEST_F(ZmqBridgeTest, AnotherSimulationWithTheSameCommandsHasTheSameHash) {
  start_default();
  RawClient client(operations_address());
  auto other = *Simulation::create(simulation_->world(), {});
  const Robot cart = *other->world().find_robot("cart");
  for (int i = 0; i < 5; ++i) {
    const std::vector<double> values = {0.5 * i, 0.1 * i};
    client.call("controls", 1, one("values", values));
    const Value state = client.call("step", 1, one("n", 20));
    ASSERT_TRUE(other->post({.what = SetControls{cart, values}}).ok());
    ASSERT_TRUE(other->step(20).ok());
    EXPECT_EQ(state["hash"].as<uint64_t>(), other->latest().hash());
  }
}

TEST_F(ZmqBridgeTest, ARunGoesOnAndPausesAndGoesBack) {
  start_default();
  RawClient client(operations_address());
  client.call("pace");
  client.call("resume");
  while (client.call("state")["step"].as<int>() < 10) std::this_thread::sleep_for(1ms);
  EXPECT_FALSE(client.call("state")["paused"].as<bool>());
  EXPECT_EQ(client.refused("step")["kind"].text(), "usage");
  client.call("pause");
  const Value paused = client.call("state");
  EXPECT_TRUE(paused["paused"].as<bool>());
  const int64_t id = client.call("checkpoint")["id"].as<int64_t>();
  const Value later = client.call("step", 1, one("n", 5));
  EXPECT_EQ(client.call("restore", 1, one("id", id))["hash"].as<uint64_t>(),
            paused["hash"].as<uint64_t>());
  EXPECT_EQ(client.call("step", 1, one("n", 5))["hash"].as<uint64_t>(),
            later["hash"].as<uint64_t>());
  EXPECT_EQ(client.call("checkpoints").as<std::vector<msgpack::object>>().size(), 1u);
  client.call("forget_checkpoint", 1, one("id", id));
  EXPECT_THAT(client.refused("restore", 1, one("id", id))["message"].text(),
              HasSubstr("no checkpoint"));
  client.call("reset");
  EXPECT_EQ(client.call("step")["step"].as<int>(), 1);
  EXPECT_EQ(client.refused("seek", 1, one("time", 0.0))["kind"].text(), "usage");
  EXPECT_EQ(client.refused("pace", 1, one("speed", -1.0))["kind"].text(), "input");
  client.call("pace", 1, one("pace", std::string("sensors")));
  EXPECT_EQ(client.call("state")["pace"].text(), "sensors");
  EXPECT_EQ(client.refused("pace", 1, one("pace", std::string("sensor")))["kind"].text(), "usage");
}

TEST_F(ZmqBridgeTest, CommandsMoveWhatTheyName) {
  start_default();
  RawClient client(operations_address());
  client.call("joint_states", 1, [](Packer& packer) {
    packer.pack(std::string_view("positions"));
    packer.pack_map(1);
    pack_pair(packer, "cart/lift", std::vector<double>{0.5});
  });
  client.call("mocap_pose", 2, [](Packer& packer) {
    pack_pair(packer, "body", std::string("ghost"));
    pack_pair(packer, "position", std::vector<double>{1, 2, 3});
  });
  client.call("live_field", 2, [](Packer& packer) {
    pack_pair(packer, "field", std::string("gravity"));
    pack_pair(packer, "values", std::vector<double>{0, 0, 0});
  });
  client.call("add_velocity", 2, [](Packer& packer) {
    pack_pair(packer, "body", std::string("ball"));
    pack_pair(packer, "velocity", std::vector<double>{0, 1, 0});
  });
  client.call("step", 1, one("n", 1));
  const auto lift = simulation_->latest()[*simulation_->world().find_joint("cart/lift")];
  EXPECT_NEAR(lift.position(), 0.5, 0.01);
  EXPECT_EQ(simulation_->body_pose(*simulation_->world().find_body("ghost"))->p, (Vec3{1, 2, 3}));
  const std::vector<double> ball = numbers_of(client.call("value", 2, [](Packer& packer) {
    pack_pair(packer, "field", std::string("cvel"));
    pack_pair(packer, "element", std::string("ball"));
  })["values"]);
  EXPECT_NEAR(ball.at(4), 1, 1e-9);
  EXPECT_NEAR(ball.at(5), 0, 1e-9) << "no gravity any more";
  client.call("wrench", 2, [](Packer& packer) {
    pack_pair(packer, "body", std::string("ball"));
    pack_pair(packer, "force", std::vector<double>{0, 0, 1});
  });
  client.call("step", 1, one("n", 10));
  EXPECT_GT(simulation_->body_pose(*simulation_->world().find_body("ball"))->p.z, 1);
  EXPECT_THAT(client
                  .refused("joint_goals", 1,
                           [](Packer& packer) {
                             packer.pack(std::string_view("joints"));
                             packer.pack_map(1);
                             pack_pair(packer, "cart/lfit", 0.0);
                           })["remedy"]
                  .text(),
              HasSubstr("cart/lift"));
  client.refused("velocity_goal", 1, one("robot", std::string("nobody")));
  static_cast<void>(simulation_->take_command_log());
  client.call("pose_goal", 3, [](Packer& packer) {
    pack_pair(packer, "robot", std::string("cart"));
    pack_pair(packer, "position", std::vector<double>{0.1, 0.2, 0.3});
    pack_pair(packer, "orientation", std::vector<double>{0, 0, 1, 0});
  });
  client.call("step", 1, one("n", 1));
  const auto log = simulation_->take_command_log();
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(std::get<SetPoseGoal>(log[0].command.what).X_WF, (Pose{{0.1, 0.2, 0.3}, {0, 0, 1, 0}}));
}

TEST_F(ZmqBridgeTest, MessagesToInputTopicsAreObeyed) {
  start_default();
  RawClient client(operations_address());
  std::vector<uint8_t> bytes;
  std_msgs::Float64MultiArray message;
  message.data = {3, 0};
  encode(message, &bytes);
  const auto publish = [&](std::string_view topic) {
    return [topic = std::string(topic), &bytes](Packer& packer) {
      pack_pair(packer, "topic", topic);
      packer.pack(std::string_view("data"));
      pack_bytes(packer, bytes);
    };
  };
  client.call("publish", 2, publish("/cart/controls"));
  EXPECT_EQ(numbers_of(client.call("step")["ctrl"]), (std::vector<double>{3, 0}));
  client.refused("publish", 2, publish("/nothing"));
  bytes.resize(7);
  client.refused("publish", 2, publish("/cart/controls"));
}

TEST_F(ZmqBridgeTest, AClaimedRobotObeysItsHolderAloneUntilItIsGone) {
  start_default();
  RawClient other(operations_address());
  const auto drive = one("values", std::vector<double>{1, 0});
  {
    RawClient holder(operations_address());
    holder.call("claim");
    holder.call("controls", 1, drive);
    EXPECT_THAT(holder.call("state")["claims"].as<std::vector<std::string>>(), Contains("cart"));
    other.refused("controls", 1, drive);
    other.refused("claim");
    holder.call("release");
    other.call("controls", 1, drive);
    holder.call("claim");
    other.refused("controls", 1, drive);
  }  // gone without a word
  const auto begin = std::chrono::steady_clock::now();
  for (;;) {
    other.send(make_request("controls", 1, drive));
    if (!(*other.receive()).has("error")) break;
    ASSERT_LT(std::chrono::steady_clock::now() - begin, 8s);
    std::this_thread::sleep_for(100ms);
  }
}

TEST_F(ZmqBridgeTest, TheWorldChangesWhileItRuns) {
  start_default();
  RawClient client(operations_address());
  client.call("step", 1, one("n", 5));
  EXPECT_EQ(
      client.call("get_option", 1, one("path", std::string("camera.front.width")))["value"].text(),
      "64");
  client.call("set_options", 1, [](Packer& packer) {
    packer.pack(std::string_view("options"));
    packer.pack_map(1);
    pack_pair(packer, "camera.front.width", std::string("32"));
  });
  EXPECT_EQ(simulation_->world().scene().cameras[0].width, 32);
  EXPECT_EQ(simulation_->latest().step(), 5) << "the run goes on";
  client.refused("set_options", 1, [](Packer& packer) {
    packer.pack(std::string_view("options"));
    packer.pack_map(1);
    pack_pair(packer, "camera.front.witdh", std::string("32"));
  });
  const Value spawned = client.call("spawn", 3, [](Packer& packer) {
    pack_pair(packer, "text",
              std::string("<mujoco><worldbody><body><freejoint/><geom size='.1'/></body>"
                          "</worldbody></mujoco>"));
    pack_pair(packer, "name", std::string("newcomer"));
    pack_pair(packer, "position", std::vector<double>{0, 3, 1});
  });
  EXPECT_EQ(spawned["name"].text(), "newcomer");
  EXPECT_NEAR(numbers_of(client.call("entity_state", 1,
                                     one("name", std::string("newcomer")))["position"])[1],
              3, 1e-6);
  EXPECT_THAT(client.call("entities").to_string(), HasSubstr("newcomer"));
  client.call("remove", 1, one("name", std::string("newcomer")));
  client.refused("remove", 1, one("name", std::string("newcomer")));
  client.call("options");
  client.call("spawnables");
  client.call("worlds");
  client.call("named_poses");
  client.refused("recompile", 1, one("toml", std::string("[[robot]]\nnme = 1\n")));
}

TEST_F(ZmqBridgeTest, PicturesAndRecordsAreMade) {
  start_default();
  RawClient client(operations_address());
  const Value picture = client.call("picture", 2, [](Packer& packer) {
    pack_pair(packer, "camera", std::string("front"));
    pack_pair(packer, "outputs", std::vector<std::string>{"rgb", "depth"});
  });
  EXPECT_EQ(picture["width"].as<int>(), 64);
  EXPECT_EQ(picture["rgb"]["shape"].as<std::vector<int>>(), (std::vector<int>{48, 64, 3}));
  EXPECT_EQ(picture["rgb"]["data"].as<std::vector<char>>().size(), 64u * 48 * 3);
  EXPECT_EQ(picture["depth"]["data"].as<std::vector<char>>().size(), 64u * 48 * 4);
  client.refused("picture", 1, one("width", 100000));
  client.refused("picture", 1, one("camera", std::string("nowhere")));
  client.call("labels");
  const std::string file =
      client.call("record_start", 1, one("name", std::string("run")))["file"].text();
  client.call("step", 1, one("n", 20));
  EXPECT_EQ(client.call("record_stop")["file"].text(), file);
  const auto verified = verify_log(file, {}, {});
  ASSERT_TRUE(verified.ok()) << verified.error().to_string();
  EXPECT_TRUE(verified->is_equal()) << verified->where;
  EXPECT_EQ(verified->steps, 20);
  client.refused("record_start", 1, one("name", std::string("../run")));
}

TEST_F(ZmqBridgeTest, TheAddressFileIsPrivateAndGoesWithTheServer) {
  start_default();
  const std::string address = operations_address();
  const std::filesystem::path file =
      folder_ / "gloam" / ("zmq-" + address.substr(address.rfind(':') + 1) + ".json");
  struct stat about = {};
  ASSERT_EQ(stat(file.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0600u);
  ASSERT_EQ(stat(file.parent_path().c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0700u);
  std::ifstream stream(file);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  EXPECT_THAT(text, HasSubstr(kTestToken));
  EXPECT_THAT(text, HasSubstr(address));
  bridge_.reset();
  EXPECT_FALSE(std::filesystem::exists(file));
  std::filesystem::permissions(file.parent_path(), std::filesystem::perms(0755));
  EXPECT_THAT(start().error().message, HasSubstr("accessible by others"));
}

TEST_F(ZmqBridgeTest, APortInUseAndTheOpenNetworkAreRefused) {
  start_default();
  const std::string address = operations_address();
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  const auto second = start({.port = port});
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().message, HasSubstr("in use"));
  EXPECT_EQ(second.error().kind, ErrorKind::kIo);
  const auto open = start({.host = "0.0.0.0", .port = 0});
  ASSERT_FALSE(open.ok());
  EXPECT_THAT(open.error().hint, HasSubstr("curve_secret"));
  EXPECT_FALSE(start({.host = "203.0.113.1", .port = 0}).ok());
}

TEST_F(ZmqBridgeTest, CurveLetsThoseInWhoKnowTheKey) {
  char public_key[41], secret_key[41], my_public[41], my_secret[41];
  ASSERT_EQ(zmq_curve_keypair(public_key, secret_key), 0);
  ASSERT_EQ(zmq_curve_keypair(my_public, my_secret), 0);
  const std::string file = (folder_ / "server.key").string();
  std::ofstream(file) << "curve\n    public-key = \"" << public_key << "\"\n    secret-key = \""
                      << secret_key << "\"\n";
  std::filesystem::permissions(file, std::filesystem::perms(0644));
  EXPECT_THAT(start({.port = 0, .curve_secret = file}).error().message, HasSubstr("by others"));
  std::filesystem::permissions(file, std::filesystem::perms(0600));
  auto started = start({.host = "0.0.0.0", .port = 0, .curve_secret = file});
  ASSERT_TRUE(started.ok()) << started.error().to_string();
  bridge_ = std::move(*started);
  std::string address = operations_address();
  address.replace(address.find("0.0.0.0"), 7, "127.0.0.1");
  RawClient plain(address);
  plain.send(make_request("ping"));
  EXPECT_FALSE(plain.receive(500)) << "without a key";
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::rcvtimeo, 20000);
  socket.set(zmq::sockopt::curve_serverkey, std::string(public_key));
  socket.set(zmq::sockopt::curve_publickey, std::string(my_public));
  socket.set(zmq::sockopt::curve_secretkey, std::string(my_secret));
  socket.connect(address);
  const PackBuffer request = make_request("ping");
  socket.send(zmq::buffer(request.data(), request.size()));
  zmq::message_t reply;
  ASSERT_TRUE(socket.recv(reply));
  EXPECT_TRUE(unpack_value(reply).has("result"));
}

TEST_F(ZmqBridgeTest, EndAsksTheProgramToEnd) {
  start_default();
  RawClient client(operations_address());
  client.call("end");
  EXPECT_TRUE(operator_->end_asked());
}

}  // namespace
}  // namespace gloam::bridge::zeromq
