// Streams of the bridge to ZeroMQ: states, topics in all their forms, what is not there.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/mman.h>
#include <unistd.h>

#include <map>
#include <set>

#include "bridge/test/zmq_fixture.h"
#include "ros/codec.h"
#include "ros/messages/sensor_msgs.h"

namespace gloam::bridge::zeromq {
namespace {

using testing::HasSubstr;

ArgumentWriter steps_of(int64_t n) {
  return [n](Packer& packer) { pack_pair(packer, "n", n); };
}

TEST_F(ZmqBridgeTest, StatesStreamAtTheRateThatIsAskedFor) {
  start_default();
  RawSubscriber subscriber(streams_address());
  subscriber.subscribe("state/250");
  RawClient client(operations_address());
  std::vector<int64_t> steps;
  for (int i = 0; i < 200 && steps.size() < 5; ++i) {
    client.call("step", 1, steps_of(4));
    while (const auto message = subscriber.receive(i == 0 ? 200 : 5)) {
      EXPECT_EQ(message->topic, "state/250");
      const Value state = unpack_value(message->payload);
      EXPECT_EQ(state["step"].as<int64_t>(), message->header["step"].as<int64_t>());
      EXPECT_TRUE(state.has("qpos"));
      steps.push_back(state["step"].as<int64_t>());
    }
  }
  ASSERT_GE(steps.size(), 5u);
  for (size_t i = 1; i < steps.size(); ++i) EXPECT_EQ(steps[i] - steps[i - 1], 2);
}

TEST_F(ZmqBridgeTest, TopicsComeInCdrDecodedAndThroughSharedMemoryAlike) {
  start_default();
  RawSubscriber subscriber(streams_address());
  const std::string topic = "/front/image_raw";
  for (const char* form : {"", "decoded", "shm"}) subscriber.subscribe(form + topic);
  RawClient client(operations_address());
  std::map<std::string, std::map<int64_t, std::string>> pictures;  // by form, by step
  std::set<int64_t> common;
  for (int i = 0; i < 100 && common.empty(); ++i) {
    client.call("step", 1, steps_of(25));
    while (const auto message = subscriber.receive(200)) {
      const auto step = message->header["step"].as<int64_t>();
      ASSERT_FALSE(message->header.has("error")) << message->header.to_string();
      EXPECT_EQ(message->header["type"].text(), "sensor_msgs/msg/Image");
      std::string cdr(message->payload.to_string());
      if (message->topic.starts_with("decoded")) {
        const Value image = unpack_value(message->payload);
        EXPECT_EQ(image["width"].as<int>(), 64);
        EXPECT_EQ(image["encoding"].text(), "rgb8");
        pictures["decoded"][step] = image["data"].text();
        continue;
      }
      if (message->topic.starts_with("shm")) {
        const Value place = message->header["shm"];
        const int fd = shm_open(place["name"].text().c_str(), O_RDONLY, 0);
        ASSERT_GE(fd, 0);
        cdr.resize(place["bytes"].as<size_t>());
        EXPECT_EQ(pread(fd, cdr.data(), cdr.size(), place["offset"].as<off_t>()), std::ssize(cdr));
        close(fd);
      }
      const auto image =
          decode<sensor_msgs::Image>({reinterpret_cast<const uint8_t*>(cdr.data()), cdr.size()});
      ASSERT_TRUE(image.ok()) << image.error().to_string();
      const auto data = image->data.span();
      pictures[message->topic.starts_with("shm") ? "shm" : "cdr"][step] = {data.begin(),
                                                                           data.end()};
    }
    for (const auto& [step, picture] : pictures["cdr"])
      if (pictures["decoded"].contains(step) && pictures["shm"].contains(step)) common.insert(step);
  }
  ASSERT_FALSE(common.empty());
  for (const int64_t step : common) {
    EXPECT_EQ(pictures["cdr"][step].size(), 64u * 48 * 3);
    EXPECT_EQ(pictures["cdr"][step], pictures["decoded"][step]);
    EXPECT_EQ(pictures["cdr"][step], pictures["shm"][step]);
  }
}

TEST_F(ZmqBridgeTest, LatchedTopicsComeToLateSubscribers) {
  start_default();
  const std::string address = streams_address();
  RawSubscriber first(address), second(address);
  first.subscribe("decoded/cart/robot_description");
  const auto message = first.receive();
  ASSERT_TRUE(message);
  EXPECT_THAT(unpack_value(message->payload)["data"].text(), HasSubstr("<robot"));
  second.subscribe("decoded/cart/robot_description");
  EXPECT_TRUE(second.receive());
}

TEST_F(ZmqBridgeTest, AStreamThatIsNotThereSaysSo) {
  start_default();
  RawSubscriber subscriber(streams_address());
  for (const char* topic : {"/frnt/image_raw", "nonsense", "state/fast", "/cart/controls"}) {
    subscriber.subscribe(topic);
    const auto message = subscriber.receive();
    ASSERT_TRUE(message) << topic;
    EXPECT_EQ(message->topic, topic);
    EXPECT_EQ(message->header["type"].text(), "error");
    EXPECT_FALSE(message->header["error"]["message"].text().empty());
    subscriber.unsubscribe(topic);
  }
}

TEST_F(ZmqBridgeTest, ATopicComesAndGoesWithItsRobot) {
  start_default();
  RawSubscriber subscriber(streams_address());
  subscriber.subscribe("decoded/newcomer/joint_states");
  auto message = subscriber.receive();
  ASSERT_TRUE(message);
  EXPECT_TRUE(message->header.has("error")) << "not there yet";
  RawClient client(operations_address());
  client.call("spawn", 2, [](Packer& packer) {
    pack_pair(packer, "text",
              std::string("<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body>"
                          "</worldbody></mujoco>"));
    pack_pair(packer, "name", std::string("newcomer"));
  });
  message.reset();
  for (int i = 0; i < 100 && !message; ++i) {
    client.call("step", 1, steps_of(10));
    message = subscriber.receive(100);
  }
  ASSERT_TRUE(message);
  EXPECT_THAT(unpack_value(message->payload).to_string(), HasSubstr("hinge"));
  client.call("remove", 1,
              [](Packer& packer) { pack_pair(packer, "name", std::string("newcomer")); });
  do message = subscriber.receive();
  while (message && !message->header.has("error"));
  EXPECT_TRUE(message) << "it has not been told that the topic is gone";
}

TEST_F(ZmqBridgeTest, SharedMemoryMayBeOff) {
  bridge_ = *start({.port = 0, .shared_memory = false});
  RawSubscriber subscriber(streams_address());
  subscriber.subscribe("shm/front/image_raw");
  const auto message = subscriber.receive();
  ASSERT_TRUE(message);
  EXPECT_THAT(message->header["error"]["message"].text(), HasSubstr("disabled"));
}

}  // namespace
}  // namespace gloam::bridge::zeromq
