// Limits of the network side: messages that are too long, clients that are too slow or too many.
#include "web/websocket_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "web/test/raw_client.h"

namespace gloam::web {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

const std::string kHeaders = "Host: localhost\r\nAuthorization: token secret\r\n";
const std::string kWatching = "Host: localhost\r\n";

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 1000 && !holds(); ++i) std::this_thread::sleep_for(milliseconds(5));
  return holds();
}

/// Two pages, a WebSocket for the owner of the token at /ws and one for anybody at /watch.
class TestEvents : public ServerEvents {
 public:
  Answer answer(const RequestFacts& request) override {
    const std::string_view path = target_path(request.target);
    if (path == "/watch" && why_malformed(request).empty()) return {.access = Access::kWatch};
    const Verdict verdict = judge(request, "secret", "cookie");
    if (verdict.status != 200) return {verdict.status, verdict.reason};
    if (request.websocket) return {.access = Access::kControl, .protocol = "test.v1"};
    return {200, path == "/a" ? "page a" : "page b", Access::kControl};
  }
  void on_open(const ClientPtr& client) override {
    const std::lock_guard lock(mutex_);
    clients_[client->id] = client;
    ++opened;
  }
  void on_text(const ClientPtr&, std::string_view text) override { bytes += text.size(); }
  void on_binary(const ClientPtr&, std::span<const uint8_t> data) override { bytes += data.size(); }
  void on_close(const ClientPtr&) override { ++closed; }
  void on_tick() override { ++ticks; }

  /// Clients are kept when they have gone.
  ClientPtr client(int64_t id) const {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    return found != clients_.end() ? found->second : nullptr;
  }
  std::atomic<int> opened = 0, closed = 0, ticks = 0;
  std::atomic<size_t> bytes = 0;

 private:
  mutable std::mutex mutex_;
  std::map<int64_t, ClientPtr> clients_;
};

Frame text_of(std::string text) { return {std::move(text), nullptr, true}; }

class WebSocketServerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Status status = server_.listen();
    ASSERT_TRUE(status.ok()) << status.error().to_string();
  }
  int port() const { return server_.port(); }
  /// The server's end of a new connection.
  ClientPtr open(RawClient& client) {
    const int before = events_.opened;
    EXPECT_EQ(client.upgrade(kHeaders), 101);
    EXPECT_TRUE(eventually([&] { return events_.opened > before; }));
    return events_.client(before + 1);
  }

  explicit WebSocketServerTest(const ServerOptions& times = {})
      : server_({.max_clients = 32,
                 .outbox = {.kept_bytes = size_t{64} << 10, .slots = {0, 2}},
                 .message_bytes = size_t{64} << 10,
                 .watcher_bytes = 100,
                 .accepts_binary = times.accepts_binary,
                 .request_time = times.request_time,
                 .idle_time = times.idle_time,
                 .tick = times.tick},
                events_) {}

  TestEvents events_;
  WebSocketServer server_;
};

/// With little patience, so that the tests need not have more.
class WebSocketServerTimesTest : public WebSocketServerTest {
 protected:
  WebSocketServerTimesTest()
      : WebSocketServerTest({.request_time = milliseconds(1000),
                             .idle_time = milliseconds(1600),
                             .tick = milliseconds(10)}) {}
};

class TextOnlyServerTest : public WebSocketServerTest {
 protected:
  TextOnlyServerTest() : WebSocketServerTest({.accepts_binary = false}) {}
};

TEST_F(WebSocketServerTest, HeadersOver8KiBAreRefused) {
  EXPECT_EQ(
      RawClient(port()).request("GET", "/", kHeaders + "X: " + std::string(7000, 'x') + "\r\n"),
      200);
  EXPECT_EQ(
      RawClient(port()).request("GET", "/", kHeaders + "X: " + std::string(9000, 'x') + "\r\n"),
      431);
  EXPECT_EQ(RawClient(port()).request("GET", "/" + std::string(100000, 'x'), kHeaders), 431);
}

TEST_F(WebSocketServerTest, MessagesOver64KiBEndTheConnection) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  client.send_text(std::string(65536, 'x'));
  EXPECT_TRUE(eventually([&] { return events_.bytes == 65536; }));
  client.send_text(std::string(65537, 'x'));
  EXPECT_EQ(client.wait_for_close(), 1009);
  EXPECT_TRUE(eventually([&] { return events_.closed == 1; }));
  EXPECT_EQ(events_.bytes, 65536u);
}

TEST_F(TextOnlyServerTest, BinaryMessagesEndTheConnection) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  client.send_frame(2, "xyz");
  EXPECT_EQ(client.wait_for_close(), 1003);
  EXPECT_EQ(events_.bytes, 0u);
}

TEST_F(WebSocketServerTimesTest, GarbageAfterTheHandshakeEndsTheConnection) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  client.send_bytes(std::string(50, '\xff'));
  EXPECT_TRUE(client.closed_within(3));
  EXPECT_TRUE(eventually([&] { return events_.closed == 1; }));
}

TEST_F(WebSocketServerTimesTest, AHeaderByDropsRunsOutOfTime) {
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

TEST_F(WebSocketServerTimesTest, AClientThatSaysNothingIsSentAway) {
  RawClient client(port());
  EXPECT_TRUE(client.closed_within(3));
  RawClient after_an_answer(port());
  after_an_answer.send_bytes("GET / HTTP/1.1\r\n" + kHeaders + "\r\n");
  EXPECT_TRUE(after_an_answer.closed_within(3));
}

TEST_F(WebSocketServerTimesTest, AHalfOpenWebSocketEnds) {
  RawClient dead(port()), alive(port());
  ASSERT_EQ(dead.upgrade(kHeaders), 101);
  ASSERT_EQ(alive.upgrade(kHeaders), 101);
  // One never answers a ping, the other does nothing else.
  const auto start = Clock::now();
  while (Clock::now() - start < milliseconds(4500)) (void)alive.read_frame(0.1);
  EXPECT_EQ(events_.closed, 1);
  EXPECT_TRUE(dead.closed_within(0.5));
  EXPECT_TRUE(alive.send_text("x"));
  EXPECT_TRUE(eventually([&] { return events_.bytes == 1; }));
}

TEST_F(WebSocketServerTest, BinaryMessagesArrive) {
  RawClient client(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  EXPECT_TRUE(client.send_frame(2, "xyz"));
  EXPECT_TRUE(eventually([&] { return events_.bytes == 3; }));
}

TEST_F(WebSocketServerTest, AnswersWithTheSubprotocolAndSafetyFields) {
  RawClient client(port()), page(port()), stranger(port());
  ASSERT_EQ(client.upgrade(kHeaders), 101);
  EXPECT_NE(client.answer().find("Sec-WebSocket-Protocol: test.v1\r\n"), std::string::npos);
  EXPECT_EQ(page.request("GET", "/a", kHeaders), 200);
  EXPECT_TRUE(page.answer().ends_with("\r\n\r\npage a"));
  EXPECT_EQ(stranger.request("GET", "/a", "Host: localhost\r\n"), 401);
  for (const RawClient* each : {&page, &stranger})
    EXPECT_NE(each->answer().find("X-Frame-Options: DENY\r\n"), std::string::npos);
  EXPECT_EQ(RawClient(port()).request("POST", "/a", kHeaders), 405);
}

TEST_F(WebSocketServerTest, ForeignHostsOriginsAndTokensAreRefused) {
  const auto status = [&](const std::string& headers) {
    return RawClient(port()).upgrade(headers);
  };
  const std::string token = "Authorization: token secret\r\n";
  EXPECT_EQ(status("Host: evil.example\r\n" + token), 403);
  EXPECT_EQ(status(token), 400) << "no Host";
  EXPECT_EQ(status(kHeaders + "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(status("Host: localhost\r\nAuthorization: token other\r\n"), 401);
  EXPECT_EQ(events_.opened, 0);
}

TEST_F(WebSocketServerTest, RequestsWithABodyAreRefused) {
  EXPECT_EQ(RawClient(port()).upgrade(kHeaders + "Content-Length: 5\r\n"), 413);
  EXPECT_EQ(RawClient(port()).request("GET", "/a", kHeaders + "Content-Length: 5\r\n"), 413);
}

TEST_F(WebSocketServerTest, WatchersHaveLimitsOfTheirOwn) {
  std::vector<std::unique_ptr<RawClient>> watchers;
  for (int i = 0; i < 33; ++i) {
    watchers.push_back(std::make_unique<RawClient>(port()));
    EXPECT_EQ(watchers.back()->upgrade(kWatching, "/watch"), i < 32 ? 101 : 503);
  }
  RawClient owner(port());
  EXPECT_EQ(owner.upgrade(kHeaders), 101);
  EXPECT_TRUE(owner.send_text(std::string(101, 'x')));
  EXPECT_TRUE(eventually([&] { return events_.bytes == 101; }));
  EXPECT_TRUE(watchers[0]->send_text(std::string(101, 'x')));
  EXPECT_EQ(watchers[0]->wait_for_close(), 1009);
  watchers[0].reset();
  EXPECT_TRUE(eventually([&] { return events_.closed == 1; }));
  EXPECT_EQ(RawClient(port()).upgrade(kWatching, "/watch"), 101) << "the place is free again";
}

TEST_F(WebSocketServerTest, AClientThatDoesNotReadIsDisconnectedWhenTextsPileUp) {
  RawClient slow(port()), quick(port());
  const ClientPtr slow_end = open(slow), quick_end = open(quick);
  for (int i = 0; i < 400; ++i) slow_end->outbox.send(text_of(std::string(100000, 'x')));
  quick_end->outbox.send(text_of(R"({"type":"hello"})"));
  EXPECT_TRUE(quick.wait_for("hello").has_value());
  EXPECT_TRUE(eventually([&] { return events_.closed == 1; }));
  EXPECT_FALSE(slow_end->outbox.next()) << "an outbox without a connection is empty";
}

TEST_F(WebSocketServerTest, ReplacedFramesDoNotPileUp) {
  RawClient client(port());
  const ClientPtr end = open(client);
  const auto picture = std::make_shared<const std::vector<uint8_t>>(1 << 18, uint8_t{'p'});
  const std::string padding(1 << 18, ' ');
  for (int i = 0; i < 100; ++i) {
    end->outbox.replace(1, {"", picture});
    end->outbox.replace(0, text_of(R"({"type":"state","n":)" + std::to_string(i) + padding + "}"));
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

TEST_F(WebSocketServerTimesTest, TicksWhileThereAreClients) {
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(events_.ticks, 0);
  RawClient client(port());
  open(client);
  EXPECT_TRUE(eventually([&] { return events_.ticks > 2; }));
}

TEST_F(WebSocketServerTest, SixtyFourConnectionsAreHeldToTheLimit) {
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
  EXPECT_TRUE(eventually([&] { return events_.closed == 32; }));
  EXPECT_EQ(RawClient(port()).upgrade(kHeaders), 101);
}

// Ten connections every tenth of a second that say nothing once kept the owner out.
TEST_F(WebSocketServerTest, HalfOpenConnectionsKeepNobodyOut) {
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
  EXPECT_TRUE(eventually([&] { return events_.bytes == 1; }));
}

TEST_F(WebSocketServerTest, RequestsThatTwoReadersWouldReadTwiceAreRefused) {
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

TEST_F(WebSocketServerTest, StopsInTimeWithClientsThatDoNotRead) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(std::make_unique<RawClient>(port()));
    ASSERT_EQ(clients.back()->upgrade(kHeaders), 101);
  }
  RawClient silent(port());
  ASSERT_TRUE(eventually([&] { return events_.opened == 8; }));
  const auto picture = std::make_shared<const std::vector<uint8_t>>(8 << 20, uint8_t{'p'});
  for (int id = 1; id <= 8; ++id) events_.client(id)->outbox.replace(1, {"", picture});
  const auto start = Clock::now();
  server_.stop();
  EXPECT_LT(Clock::now() - start, milliseconds(2000));
  EXPECT_TRUE(silent.closed_within(1));
  events_.client(1)->outbox.send(text_of("to nobody"));  // the outbox outlives its server
}

TEST_F(WebSocketServerTest, ClientsLearnOfTheEnd) {
  RawClient client(port()), shaking_hands(port());
  open(client);
  shaking_hands.send_bytes("GET /ws HTTP/1.1\r\nHost: localhost\r\n");
  std::thread stopping([this] { server_.stop(); });
  EXPECT_EQ(client.wait_for_close(), 1001);
  EXPECT_TRUE(shaking_hands.closed_within(2));
  client.send_frame(8, "");
  stopping.join();
  EXPECT_FALSE(RawClient(port()).connected());
}

TEST_F(WebSocketServerTest, SeveralRequestsShareAConnection) {
  RawClient client(port());
  client.send_bytes("GET /a HTTP/1.1\r\n" + kHeaders + "\r\nGET /b HTTP/1.1\r\n" + kHeaders +
                    "\r\n");
  const std::string answers = client.read_all(2);
  EXPECT_NE(answers.find("page a"), std::string::npos);
  EXPECT_NE(answers.find("page b"), std::string::npos);
}

}  // namespace
}  // namespace gloam::web
