#include "web/access.h"

#include <gtest/gtest.h>

#include <set>

namespace gloam::web {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef0123456789abcdef";
const std::string kCookie = cookie_name(8080) + "=" + kToken;

/// A request that is let in; tests spoil one thing.
RequestFacts good() {
  return {.method = "GET",
          .target = "/",
          .host = "127.0.0.1:8080",
          .cookie = kCookie,
          .websocket_key = "dGhlIHNhbXBsZSBub25jZQ==",
          .websocket_version = "13",
          .hosts = 1,
          .port = 8080};
}
Verdict verdict(const RequestFacts& request) { return judge(request, kToken, "gloam_view_8080"); }

TEST(Access, TokensAre192RandomBitsInHex) {
  std::set<std::string> seen;
  for (int i = 0; i < 64; ++i) {
    const auto token = make_token();
    ASSERT_TRUE(token.ok());
    EXPECT_EQ(token->size(), 48u);
    EXPECT_EQ(token->find_first_not_of("0123456789abcdef"), std::string::npos);
    seen.insert(*token);
  }
  EXPECT_EQ(seen.size(), 64u);
}

TEST(Access, ComparisonIsExact) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abd", "abc"));
  EXPECT_FALSE(equal_in_constant_time("ab", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abcabc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("", "abc"));
  EXPECT_FALSE(equal_in_constant_time("", ""));
}

TEST(Access, LoopbackNames) {
  for (const char* name : {"127.0.0.1", "127.255.0.3", "localhost", "LocalHost", "::1", "[::1]"})
    EXPECT_TRUE(is_loopback_name(name)) << name;
  for (const char* name :
       {"0.0.0.0", "", "128.0.0.1", "127.0.0", "127.0.0.1.evil.com", "127.0.0.256", "127.0.0.1 ",
        "localhost.evil.com", "evil", "::", "[::]", "127.0.0.+1", "127.0.0.0001", "192.168.0.1"})
    EXPECT_FALSE(is_loopback_name(name)) << name;
}

TEST(Access, LetsInWhoHasTheToken) {
  EXPECT_EQ(verdict(good()).status, 200);
  RequestFacts request = good();
  request.cookie = "";
  EXPECT_EQ(verdict(request).status, 401);
  const std::string authorization = std::string("token ") + kToken;
  request.authorization = authorization;
  EXPECT_EQ(verdict(request).status, 200);
  const std::string wrong = authorization.substr(0, authorization.size() - 1) + "0";
  request.authorization = wrong;
  EXPECT_EQ(verdict(request).status, 401);
  request.authorization = "";
  const std::string other_port = cookie_name(8081) + "=" + kToken;
  request.cookie = other_port;
  EXPECT_EQ(verdict(request).status, 401);
  const std::string among_others = "a=b; " + kCookie + ";c=d";
  request.cookie = among_others;
  EXPECT_EQ(verdict(request).status, 200);
}

TEST(Access, TheAddressBecomesACookieOnThePageOnly) {
  RequestFacts request = good();
  request.cookie = "";
  const std::string page = std::string("/?token=") + kToken;
  request.target = page;
  EXPECT_EQ(verdict(request).status, 200);
  EXPECT_TRUE(verdict(request).set_cookie);
  request.target = "/?token=0123";
  EXPECT_EQ(verdict(request).status, 401);
  const std::string socket = std::string("/ws?token=") + kToken;
  request.target = socket;
  EXPECT_EQ(verdict(request).status, 401);
  request.target = page;
  request.websocket = true;
  EXPECT_EQ(verdict(request).status, 401);
  request.websocket = false;
  request.method = "POST";
  EXPECT_EQ(verdict(request).status, 405);
}

TEST(Access, ForeignHostsAreRefused) {
  for (const char* host :
       {"evil.com", "evil.com:8080", "127.0.0.1.evil.com", "", "localhost:", "localhost:80a",
        "localhost:123456", "[::1", "[::1]x", "user@localhost"}) {
    RequestFacts request = good();
    request.host = host;
    EXPECT_EQ(verdict(request).status, 403) << host;
  }
  for (const char* host : {"localhost", "localhost:8080", "[::1]:8080", "127.0.0.2"}) {
    RequestFacts request = good();
    request.host = host;
    EXPECT_EQ(verdict(request).status, 200) << host;
  }
  for (const char* host : {"localhost:9000", "[::1]:80", "127.0.0.2:1", "127.0.0.1:08081"}) {
    RequestFacts request = good();
    request.host = host;
    EXPECT_EQ(verdict(request).status, 403) << host;
  }
  RequestFacts request = good();
  request.hosts = 2;
  EXPECT_EQ(verdict(request).status, 400);
}

TEST(Access, FieldsThatDecideAreThereOnce) {
  RequestFacts request = good();
  request.repeated = "Origin";
  EXPECT_EQ(verdict(request).status, 400);
}

TEST(Access, KeysOfWebSocketsAre16BytesInBase64) {
  for (const char* key :
       {"dGhlIHNhbXBsZSBub25jZQ==", "AAAAAAAAAAAAAAAAAAAAAA==", "/+/+/+/+/+/+/+/+/+/+/w=="})
    EXPECT_TRUE(is_websocket_key(key)) << key;
  for (const char* key :
       {"", "abc",
        "dGhlIHNhbXBsZSBub25jZQ=", "dGhlIHNhbXBsZSBub25jZR==", "dGhlIHNhbXBsZSBub25jZQAA",
        "dGhlIHNhbXBsZSBub25j ZQ==", "dGhlIHNhbXBsZSBub25jZQ== ", "\x80GhlIHNhbXBsZSBub25jZQ=="})
    EXPECT_FALSE(is_websocket_key(key)) << key;
  RequestFacts request = good();
  request.target = "/ws";
  request.websocket = true;
  EXPECT_EQ(verdict(request).status, 200);
  request.websocket_key = "abc";
  EXPECT_EQ(verdict(request).status, 400);
  request = good();
  request.websocket = true;
  request.websocket_version = "8";
  EXPECT_EQ(verdict(request).status, 400);
}

TEST(Access, ForeignOriginsAreRefused) {
  RequestFacts request = good();
  request.origin = "http://127.0.0.1:8080";
  EXPECT_EQ(verdict(request).status, 200);
  for (const char* origin : {"http://evil.com", "https://127.0.0.1:8080", "http://127.0.0.1:9999",
                             "http://localhost:8080", "null", "http://127.0.0.1:8080.evil.com"}) {
    for (const char* method : {"GET", "POST"}) {
      request.origin = origin;
      request.method = method;
      EXPECT_EQ(verdict(request).status, 403) << origin;
    }
  }
}

TEST(Access, OtherSitesMayNotFetch) {
  RequestFacts request = good();
  for (const char* site : {"same-origin", "none"}) {
    request.sec_fetch_site = site;
    EXPECT_EQ(verdict(request).status, 200) << site;
  }
  for (const char* site : {"cross-site", "same-site", "other"}) {
    request.sec_fetch_site = site;
    EXPECT_EQ(verdict(request).status, 403) << site;
  }
  // But the printed address may be opened from anywhere: it proves itself.
  const std::string page = std::string("/?token=") + kToken;
  request.target = page;
  EXPECT_EQ(verdict(request).status, 200);
}

TEST(Access, PathsOfTargets) {
  EXPECT_EQ(target_path("/"), "/");
  EXPECT_EQ(target_path("/a?b=/c"), "/a");
  EXPECT_EQ(target_path("http://evil/"), "");
  EXPECT_EQ(target_path(""), "");
}

}  // namespace
}  // namespace gloam::web
