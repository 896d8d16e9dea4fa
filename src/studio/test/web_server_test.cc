// Limits of the network side: what is too long, too slow, too much.
#include "studio/web_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "raw_client.h"

namespace gloam::studio {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

const std::string kHeaders = "Host: localhost\r\nAuthorization: token secret\r\n";

class Counter : public WebEvents {
 public:
  void on_open(int64_t) override { ++opened; }
  void on_text(int64_t, std::string_view text) override { bytes += text.size(); }
  void on_close(int64_t) override { ++closed; }
  std::atomic<int> opened = 0, closed = 0;
  std::atomic<size_t> bytes = 0;
};

class WebServerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Status status = server_.listen();
    ASSERT_TRUE(status.ok()) << status.error().to_string();
  }
  int port() const { return server_.port(); }
  static bool eventually(const std::function<bool()>& holds) {
    for (int i = 0; i < 1000 && !holds(); ++i) std::this_thread::sleep_for(milliseconds(5));
    return holds();
  }

  explicit WebServerTest(milliseconds request_time = milliseconds(5000),
                         milliseconds idle_time = milliseconds(30000))
      : server_({.max_connections = 32,
                 .token = "secret",
                 .request_time = request_time,
                 .idle_time = idle_time},
                counter_) {}

  Counter counter_;
  WebServer server_;
};

/// With little patience, so that the tests need not have more.
class WebServerTimesTest : public WebServerTest {
 protected:
  WebServerTimesTest() : WebServerTest(milliseconds(1000), milliseconds(1600)) {}
};

TEST_F(WebServerTest, HeadersOver8KiBAreRefused) {
  EXPECT_EQ(
      RawClient(port()).request("GET", "/", kHeaders + "X: " + std::string(7000, 'x') + "\r\n"),
      200);
  EXPECT_EQ(
      RawClient(port()).request("GET", "/", kHeaders + "X: " + std::string(9000, 'x') + "\r\n"),
      431);
  EXPECT_EQ(RawClient(port()).request("GET", "/" + std::string(100000, 'x'), kHeaders), 431);
}

TEST_F(WebServerTest, MessagesOver64KiBEndTheConnection) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  client.send_text(std::string(65536, 'x'));
  EXPECT_TRUE(eventually([&] { return counter_.bytes == 65536; }));
  client.send_text(std::string(65537, 'x'));
  EXPECT_EQ(client.wait_for_close(), 1009);
  EXPECT_TRUE(eventually([&] { return counter_.closed == 1; }));
  EXPECT_EQ(counter_.bytes, 65536u);
}

TEST_F(WebServerTest, BinaryMessagesEndTheConnection) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  client.send_frame(2, "xyz");
  EXPECT_EQ(client.wait_for_close(), 1003);
  EXPECT_EQ(counter_.bytes, 0u);
}

TEST_F(WebServerTimesTest, GarbageAfterTheHandshakeEndsTheConnection) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  client.send_bytes(std::string(50, '\xff'));
  EXPECT_TRUE(client.closed_within(3));
  EXPECT_TRUE(eventually([&] { return counter_.closed == 1; }));
}

TEST_F(WebServerTimesTest, AHeaderByDropsRunsOutOfTime) {
  RawClient client(port());
  const auto start = Clock::now();
  std::string request = "GET / HTTP/1.1\r\n" + kHeaders + "X: ";
  bool open = true;
  for (int i = 0; open && i < 100; ++i) {
    client.send_bytes(request.empty() ? "x" : request);
    request.clear();
    open = !client.closed_within(0.05);
  }
  EXPECT_FALSE(open);
  EXPECT_LT(Clock::now() - start, milliseconds(4000));
}

TEST_F(WebServerTimesTest, AClientThatSaysNothingIsSentAway) {
  RawClient client(port());
  EXPECT_TRUE(client.closed_within(3));
  RawClient after_an_answer(port());
  after_an_answer.send_bytes("GET / HTTP/1.1\r\n" + kHeaders + "\r\n");
  EXPECT_TRUE(after_an_answer.closed_within(3));
}

TEST_F(WebServerTimesTest, AHalfOpenWebSocketEnds) {
  RawClient dead(port()), alive(port());
  ASSERT_EQ(dead.upgrade(kHeaders), 101);
  ASSERT_EQ(alive.upgrade(kHeaders), 101);
  // One never answers a ping, the other does nothing else.
  const auto start = Clock::now();
  while (Clock::now() - start < milliseconds(4500)) (void)alive.read_frame(0.1);
  EXPECT_EQ(counter_.closed, 1);
  EXPECT_TRUE(dead.closed_within(0.5));
  EXPECT_TRUE(alive.send_text("x"));
  EXPECT_TRUE(eventually([&] { return counter_.bytes == 1; }));
}

TEST_F(WebServerTest, AClientThatDoesNotReadIsDisconnectedWhenTextsPileUp) {
  RawClient slow(port()), quick(port());
  ASSERT_EQ(slow.upgrade(kHeaders), 101);
  ASSERT_TRUE(eventually([&] { return counter_.opened == 1; }));
  ASSERT_EQ(quick.upgrade(kHeaders), 101);
  ASSERT_TRUE(eventually([&] { return counter_.opened == 2; }));
  const std::string text(100000, 'x');
  for (int i = 0; i < 400; ++i) server_.send(1, text);
  server_.send(2, R"({"type":"hello"})");
  EXPECT_TRUE(quick.wait_for("hello").has_value());
  EXPECT_TRUE(eventually([&] { return counter_.closed >= 1; }));
}

TEST_F(WebServerTest, StatesAndPicturesDoNotPileUp) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  ASSERT_TRUE(eventually([&] { return counter_.opened == 1; }));
  const auto picture = std::make_shared<const std::string>(1 << 18, 'p');
  const std::string padding(1 << 18, ' ');
  for (int i = 0; i < 100; ++i) {
    server_.send_picture(picture);
    server_.send_state(R"({"type":"state","n":)" + std::to_string(i) + padding + "}");
  }
  int states = 0;
  for (int n = -1; n != 99; ++states) {
    const auto state = client.wait_for("state");
    ASSERT_TRUE(state.has_value());
    EXPECT_GT((*state)["n"], n);
    n = (*state)["n"];
  }
  EXPECT_LT(states, 60);
}

TEST_F(WebServerTest, SixtyFourConnectionsAreHeldToTheLimit) {
  std::vector<std::unique_ptr<RawClient>> clients;
  int let_in = 0, turned_away = 0;
  for (int i = 0; i < 64; ++i) {
    clients.push_back(std::make_unique<RawClient>(port()));
    const int status = clients.back()->upgrade(kHeaders);
    let_in += status == 101;
    turned_away += status == 503 || status == 0;
  }
  EXPECT_EQ(let_in, 32);
  EXPECT_EQ(turned_away, 32);
  clients.clear();
  EXPECT_TRUE(eventually([&] { return counter_.closed == 32; }));
  EXPECT_EQ(RawClient(port()).upgrade(kHeaders), 101);
}

// Ten connections every tenth of a second that say nothing once kept the owner out.
TEST_F(WebServerTest, HalfOpenConnectionsKeepNobodyOut) {
  std::vector<std::unique_ptr<RawClient>> silent;
  RawClient owner(port());
  ASSERT_EQ(owner.upgrade(kHeaders), 101);
  for (int i = 0; i < 300; ++i) {
    silent.push_back(std::make_unique<RawClient>(port()));
    if (i % 3 == 0) silent.back()->send_bytes("GET / HTTP/1.1\r\nHost: loc");
    if (i % 3 == 1) silent.back()->send_bytes("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    if (i % 10 != 9) continue;
    EXPECT_EQ(RawClient(port()).request("GET", "/", kHeaders), 200) << i;
  }
  EXPECT_TRUE(silent.front()->closed_within(1)) << "the oldest made room";
  EXPECT_TRUE(owner.send_text("x"));
  EXPECT_TRUE(eventually([&] { return counter_.bytes == 1; }));
}

TEST_F(WebServerTest, RequestsThatTwoReadersWouldReadTwiceAreRefused) {
  const auto status = [&](const std::string& more) {
    return RawClient(port()).upgrade(kHeaders + more);
  };
  const std::string own = "Origin: http://localhost\r\n";
  EXPECT_EQ(status(own), 101);
  for (const std::string& more :
       {own + "Origin: http://evil.example\r\n", std::string("Host: localhost\r\n"),
        std::string("Authorization: token other\r\n"), std::string("Sec-WebSocket-Key: abc\r\n"),
        std::string("Sec-WebSocket-Version: 8\r\n")})
    EXPECT_EQ(status(more), 400) << more;
  RawClient bad_key(port());
  bad_key.send_bytes("GET /ws HTTP/1.1\r\n" + kHeaders +
                     "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                     "Sec-WebSocket-Key: abc\r\n\r\n");
  EXPECT_NE(bad_key.read_all(1).find(" 400 "), std::string::npos);
  EXPECT_EQ(
      RawClient(port()).request("GET", "/", "Host: localhost:1\r\nAuthorization: token secret\r\n"),
      403);
}

TEST_F(WebServerTest, StopsInTimeWithClientsThatDoNotRead) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(std::make_unique<RawClient>(port()));
    ASSERT_EQ(clients.back()->upgrade(kHeaders), 101);
  }
  RawClient silent(port());
  const auto picture = std::make_shared<const std::string>(8 << 20, 'p');
  server_.send_picture(picture);
  const auto start = Clock::now();
  server_.stop();
  EXPECT_LT(Clock::now() - start, milliseconds(2000));
  EXPECT_TRUE(silent.closed_within(1));
}

TEST_F(WebServerTest, SeveralRequestsShareAConnection) {
  RawClient client(port());
  client.send_bytes("GET /style.css HTTP/1.1\r\n" + kHeaders + "\r\nGET /app.js HTTP/1.1\r\n" +
                    kHeaders + "\r\n");
  const std::string answers = client.read_all(2);
  EXPECT_NE(answers.find("text/css"), std::string::npos);
  EXPECT_NE(answers.find("text/javascript"), std::string::npos);
}

}  // namespace
}  // namespace gloam::studio
