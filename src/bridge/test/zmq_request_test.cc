// Requests as bytes: what is read, and what is refused and how.

#include <gmock/gmock.h>

#include <random>

#include "bridge/test/zmq_fixture.h"
#include "bridge/zmq/operations/arguments.h"
#include "bridge/zmq/operations/operation.h"
#include "bridge/zmq/request.h"

namespace gloam::bridge::zeromq {
namespace {

using testing::HasSubstr;

std::span<const uint8_t> bytes_of(const PackBuffer& buffer) {
  return {reinterpret_cast<const uint8_t*>(buffer.data()), buffer.size()};
}

std::string parse_error(std::span<const uint8_t> bytes) {
  const auto request = parse_request(bytes);
  return request.ok() ? std::string() : request.error().message;
}

template <class Write>
std::string parse_error_of(Write write) {
  PackBuffer buffer;
  Packer packer(buffer);
  write(packer);
  return parse_error(bytes_of(buffer));
}

TEST(ZmqRequest, IsReadWhole) {
  const PackBuffer buffer =
      make_request("step", 1, [](Packer& packer) { pack_pair(packer, "n", 3); });
  const auto request = parse_request(bytes_of(buffer));
  ASSERT_TRUE(request.ok()) << request.error().to_string();
  EXPECT_EQ(request->operation, "step");
  EXPECT_EQ(request->token, kTestToken);
  EXPECT_EQ(request->id.as<int>(), 7);
  const Argument list[] = {{"n", ArgumentType::kInteger}};
  const auto arguments = Arguments::check(request->arguments, list);
  ASSERT_TRUE(arguments.ok());
  EXPECT_EQ(arguments->integer("n"), 3);
}

TEST(ZmqRequest, ItsTokenIsFoundWithoutItsValues) {
  const PackBuffer buffer = make_request("step", 1, [](Packer& packer) {
    packer.pack(std::string_view("token"));
    packer.pack_array(3);
    for (int i = 0; i < 3; ++i) packer.pack(std::string_view("another"));
  });
  EXPECT_EQ(peek_token(bytes_of(buffer)), kTestToken);
  EXPECT_EQ(peek_token({}), "");
  const std::vector<uint8_t> deep(100000, 0x91), text = {0xa5, 't', 'o', 'k', 'e', 'n'};
  EXPECT_EQ(peek_token(deep), "");
  EXPECT_EQ(peek_token(text), "");
  PackBuffer inner;
  Packer packer(inner);
  packer.pack_map(1);
  packer.pack(std::string_view("args"));
  packer.pack_map(1);
  pack_pair(packer, "token", std::string_view(kTestToken));
  EXPECT_EQ(peek_token(bytes_of(inner)), "") << "of the request alone";
}

TEST_F(ZmqBridgeTest, LongRequestsNeedTheTokenBeforeTheyAreRead) {
  start_default();
  RawClient client(operations_address());
  for (const std::string_view token : {std::string_view(""), std::string_view("wrong")}) {
    client.send(make_request(
        "ping", 1,
        [](Packer& packer) {
          packer.pack(std::string_view("nothing"));
          packer.pack_array(100000);
          for (int i = 0; i < 100000; ++i) packer.pack_nil();
        },
        token));
    const auto reply = client.receive();
    ASSERT_TRUE(reply);
    EXPECT_THAT((*reply)["error"].to_string(), HasSubstr("requires the token"));
  }
  client.call("ping");
}

TEST(ZmqRequest, OfAnotherFormIsRefused) {
  EXPECT_THAT(parse_error({}), HasSubstr("truncated"));
  EXPECT_THAT(parse_error_of([](Packer& p) { p.pack(3); }), HasSubstr("not a map"));
  EXPECT_THAT(parse_error_of([](Packer& p) { p.pack_map(0); }), HasSubstr("request has no 'op'"));
  EXPECT_THAT(parse_error_of([](Packer& p) {
                p.pack_map(1);
                pack_pair(p, "op", 3);
              }),
              HasSubstr("'op' is not a string"));
  EXPECT_THAT(parse_error_of([](Packer& p) {
                p.pack_map(2);
                pack_pair(p, "op", std::string("a"));
                pack_pair(p, "op", std::string("b"));
              }),
              HasSubstr("twice"));
  EXPECT_THAT(parse_error_of([](Packer& p) {
                p.pack_map(2);
                pack_pair(p, "op", std::string("a"));
                pack_pair(p, "arg", 1);
              }),
              HasSubstr("unknown request key 'arg'"));
  EXPECT_THAT(parse_error_of([](Packer& p) {
                p.pack_map(2);
                pack_pair(p, "op", std::string("a"));
                pack_pair(p, "args", 1);
              }),
              HasSubstr("'args' is not a map"));
  EXPECT_THAT(parse_error_of([](Packer& p) {
                p.pack_map(2);
                pack_pair(p, "op", std::string("a"));
                pack_pair(p, "id", 1.5);
              }),
              HasSubstr("'id'"));
  EXPECT_THAT(parse_error_of([](Packer& p) {
                p.pack_map(1);
                pack_pair(p, "op", std::string(5000, 'a'));
              }),
              HasSubstr("more than 4096 bytes"));
  EXPECT_THAT(parse_error_of([](Packer& p) {
                p.pack_map(1);
                pack_pair(p, "op", std::string("a"));
                p.pack(1);
              }),
              HasSubstr("extra bytes after"));
}

// A header that promises 2^32 elements must not take memory for them.
TEST(ZmqRequest, BombsAreRefused) {
  const uint8_t array[] = {0xdd, 0xff, 0xff, 0xff, 0xff};
  const uint8_t map[] = {0xdf, 0xff, 0xff, 0xff, 0xff};
  const uint8_t text[] = {0xdb, 0xff, 0xff, 0xff, 0xff, 'a'};
  const uint8_t extension[] = {0xc9, 0xff, 0xff, 0xff, 0xff, 1};
  EXPECT_NE(parse_error(array), "");
  EXPECT_NE(parse_error(map), "");
  EXPECT_NE(parse_error(text), "");
  EXPECT_NE(parse_error(extension), "");
  const std::vector<uint8_t> deep(100000, 0x91);
  EXPECT_THAT(parse_error(deep), HasSubstr("nested more than"));
  EXPECT_THAT(parse_error(std::vector<uint8_t>(kMaxRequestBytes + 1)), HasSubstr("bytes"));
}

TEST(ZmqRequest, DamagedBytesNeverCrash) {
  std::mt19937 random(5);
  const PackBuffer whole = make_request("controls", 2, [](Packer& packer) {
    packer.pack(std::string_view("values"));
    packer.pack(std::vector<double>{1, 2, 3});
    pack_pair(packer, "robot", std::string("cart"));
  });
  int read = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<uint8_t> bytes(bytes_of(whole).begin(), bytes_of(whole).end());
    for (int change = 0; change < 1 + i % 4; ++change)
      bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
    if (i % 3 == 0) bytes.resize(random() % bytes.size());
    const auto request = parse_request(bytes);
    if (!request.ok()) continue;
    ++read;
    for (const Operation& operation : all_operations())
      (void)Arguments::check(request->arguments, operation.arguments).ok();
  }
  EXPECT_GT(read, 100);
}

class ZmqArguments : public testing::Test {
 protected:
  template <class Write>
  std::string check(uint32_t pairs, Write write) {
    PackBuffer buffer;
    Packer packer(buffer);
    packer.pack_map(pairs);
    write(packer);
    const auto memory = msgpack::unpack(buffer.data(), buffer.size());
    const auto arguments = Arguments::check(memory.get(), kList);
    return arguments.ok() ? std::string() : arguments.error().to_string();
  }
  const std::vector<Argument> kList = {
      {"speed", ArgumentType::kNumber, true, "m/s"},
      {"where", ArgumentType::kNumbers, false, "m", "x y z", 3},
      {"all", ArgumentType::kNumberMap},
  };
};

TEST_F(ZmqArguments, AreCheckedAgainstTheirList) {
  EXPECT_EQ(check(1, [](Packer& p) { pack_pair(p, "speed", 1); }), "");
  EXPECT_THAT(check(0, [](Packer&) {}), HasSubstr("'speed' is missing"));
  EXPECT_THAT(check(1, [](Packer& p) { pack_pair(p, "sped", 1); }), HasSubstr("'speed'"));
  EXPECT_THAT(check(1, [](Packer& p) { pack_pair(p, "speed", std::string("fast")); }),
              HasSubstr("is not number"));
  EXPECT_THAT(check(1, [](Packer& p) { pack_pair(p, "speed", std::nan("")); }),
              HasSubstr("is not number"));
  EXPECT_THAT(check(2,
                    [](Packer& p) {
                      pack_pair(p, "speed", 1);
                      pack_pair(p, "where", std::vector<double>{1, 2});
                    }),
              HasSubstr("has 2 numbers, expected 3"));
  EXPECT_THAT(check(2,
                    [](Packer& p) {
                      pack_pair(p, "speed", 1);
                      pack_pair(p, "speed", 2);
                    }),
              HasSubstr("twice"));
}

TEST_F(ZmqArguments, NumbersMayComeAsBytes) {
  const double values[] = {1, -2, 0.5};
  const auto with_bytes = [&](size_t size) {
    return [&values, size](Packer& p) {
      pack_pair(p, "speed", 1);
      p.pack(std::string_view("where"));
      pack_bytes(p, {reinterpret_cast<const uint8_t*>(values), size});
    };
  };
  EXPECT_EQ(check(2, with_bytes(24)), "");
  EXPECT_NE(check(2, with_bytes(23)), "");
}

TEST(ZmqErrors, QuoteStrangersInValidUtf8) {
  EXPECT_EQ(valid_text("Größe 3 m²"), "Größe 3 m²");
  EXPECT_EQ(valid_text("a\xff\xc3"), "a??");
  EXPECT_EQ(valid_text("\xc0\x80\xed\xa0\x80\xf4\x90\x80\x80"), "?????????");
  EXPECT_EQ(valid_text("\xe2\x82"), "??");
}

TEST(ZmqOperations, HaveDistinctNamesAndExplainThemselves) {
  std::string last;
  for (const Operation& operation : all_operations()) {
    EXPECT_LT(last, operation.name);
    last = operation.name;
    EXPECT_FALSE(operation.about.empty()) << operation.name;
    EXPECT_NE(operation.run, nullptr) << operation.name;
  }
  EXPECT_THAT(find_operation("stepp").error().hint, HasSubstr("'step'"));
}

}  // namespace
}  // namespace gloam::bridge::zeromq
