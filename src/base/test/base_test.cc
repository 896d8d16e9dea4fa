#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/plain_text.h"
#include "base/rng.h"
#include "base/text.h"
#include "base/vec.h"
#include "gloam/result.h"
#include "gloam/text.h"

namespace gloam {
namespace {

TEST(PlainText, TakesWhatIsNotUtf8ForWindows1252) {
  const auto plain = [](std::string_view bytes) {
    const auto text = plain_text(bytes, "f");
    EXPECT_TRUE(text.ok());
    return text.ok() && *text ? **text : std::string(bytes);
  };
  EXPECT_EQ(plain("<body name='M\xFCller'/>"), "<body name='M\u00FCller'/>");
  EXPECT_EQ(plain("5 \x80, \x93quoted\x94, \x81"), "5 \u20AC, \u201Cquoted\u201D, \u0081");
  EXPECT_EQ(plain("M\u00FCller, \u20AC and \xE4 in one line, longer than eight bytes"),
            "M\u00FCller, \u20AC and \u00E4 in one line, longer than eight bytes");
  EXPECT_EQ(plain("\xEF\xBB\xBFr\xE4"), "r\u00E4") << "a mark before it";
  EXPECT_EQ(plain("cut off: \xC3"), "cut off: \u00C3");
  const auto ascii = plain_text("all of it is ASCII, \u00FC or UTF-8", "f");
  ASSERT_TRUE(ascii.ok());
  EXPECT_FALSE(ascii->has_value()) << "nothing was to be changed";
}

TEST(Error, NamesFileLineCauseAndWhatToDo) {
  const Error error{
      ErrorKind::kInput, "unknown key 'durration'", {"a.toml", 3, 1}, "did you mean 'duration'?"};
  EXPECT_EQ(error.to_string(), "a.toml:3:1: unknown key 'durration' (did you mean 'duration'?)");
  EXPECT_EQ(error.exit_code(), 1);
}

Result<int> half(int n) {
  if (n % 2 != 0) return Error{ErrorKind::kInput, "odd"};
  return n / 2;
}
Result<int> quarter(int n) {
  GLOAM_TRY(const int h, half(n));
  return half(h);
}

TEST(Result, TryReturnsTheFirstError) {
  EXPECT_EQ(quarter(12).value(), 3);
  EXPECT_FALSE(quarter(6).ok());
  EXPECT_EQ(quarter(7).error().message, "odd");
}

// Known-answer vectors of Random123 1.14 (kat_vectors, philox4x32 10 rounds).
TEST(Philox, MatchesThePublishedVectors) {
  const Philox4 zero = philox4x32(0, 0, 0);
  EXPECT_EQ(zero.v[0], 0x6627e8d5u);
  EXPECT_EQ(zero.v[1], 0xe169c58du);
  EXPECT_EQ(zero.v[2], 0xbc57ac4cu);
  EXPECT_EQ(zero.v[3], 0x9b00dbd8u);
  const Philox4 ones = philox4x32(~0ull, ~0ull, ~0ull);
  EXPECT_EQ(ones.v[0], 0x408f276du);
  EXPECT_EQ(ones.v[1], 0x41c83b0eu);
  EXPECT_EQ(ones.v[2], 0xa20bc7c6u);
  EXPECT_EQ(ones.v[3], 0x6d5451fdu);
}

TEST(Parallel, CoversEveryIndexOnceWhateverTheThreads) {
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    std::vector<int> hits(10007, 0);
    parallel_for("test", static_cast<int64_t>(hits.size()),
                 [&](int64_t i) { hits[static_cast<size_t>(i)] += 1; });
    EXPECT_EQ(std::accumulate(hits.begin(), hits.end(), 0), 10007) << threads << " threads";
    EXPECT_EQ(*std::max_element(hits.begin(), hits.end()), 1);
  }
  set_thread_count(0);
}

TEST(Text, SuggestsTheNearestName) {
  const std::vector<std::string> names = {"duration", "timestep", "seed"};
  EXPECT_EQ(suggest_name("durration", names), "did you mean 'duration'?");
  EXPECT_EQ(suggest_name("zzz", names), "one of: duration, timestep, seed");
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), names), "");
}

TEST(Affine, InverseUndoesScaleAndShear) {
  const Affine3f X{{2, 0.5f, 0}, {0, 3, 0.1f}, {0.2f, 0, -1}, {4, 5, 6}};
  const Vec3f p{0.3f, -0.7f, 1.1f};
  const Vec3f back = transform_point(inverse(X), transform_point(X, p));
  EXPECT_NEAR(length(back - p), 0, 1e-5);
}

TEST(Files, AtomicWriteReplacesTheWholeFileAndReportsFailure) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "gloam_files_test";
  ASSERT_TRUE(make_folder(folder).ok());
  ASSERT_TRUE(write_text_file_atomic(folder / "a.txt", "one").ok());
  ASSERT_TRUE(write_text_file_atomic(folder / "a.txt", "two").ok());
  EXPECT_EQ(read_text_file(folder / "a.txt").value(), "two");
  const Status status = write_text_file_atomic(folder / "missing" / "a.txt", "x");
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().to_string().find("cannot write"), std::string::npos);
  EXPECT_FALSE(read_text_file(folder).ok());
  EXPECT_FALSE(read_text_file(folder / "a.txt", 2).ok());
  std::filesystem::remove_all(folder);
}

TEST(Text, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(as_utf8("a \u00fc \u20ac \U0001F600"), "a \u00fc \u20ac \U0001F600");
  EXPECT_EQ(as_utf8("M\xfcller"), "M\uFFFDller");
  EXPECT_EQ(as_utf8("\xe2\x82"), "\uFFFD\uFFFD") << "cut off";
  EXPECT_EQ(as_utf8("\xc0\xaf"), "\uFFFD\uFFFD") << "longer than needed";
  EXPECT_EQ(as_utf8("\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD") << "half of a surrogate pair";
  EXPECT_EQ(as_utf8("\xf4\x90\x80\x80"), "\uFFFD\uFFFD\uFFFD\uFFFD") << "beyond Unicode";
}

TEST(Text, PrintableIsShownAndNotObeyed) {
  EXPECT_EQ(printable("plain ünï ☃ 🤖"), "plain ünï ☃ 🤖");
  EXPECT_EQ(printable("a\x1b[31mb\a\n\r\t"), "a\\x1b[31mb\\x07\\n\\r\\t");
  EXPECT_EQ(printable("\x7f\xc2\x9b\xe2\x80\xae\xe2\x81\xa6\xe2\x80\xa8\xd8\x9c"),
            "\\u007f\\u009b\\u202e\\u2066\\u2028\\u061c");
  EXPECT_EQ(printable("\x9b\xff\xc3"), "\\x9b\\xff\\xc3");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable("a\nb\x1b", "\n"), "a\nb\\x1b");
  EXPECT_EQ(printable(printable("\x1b\x9b")), printable("\x1b\x9b")) << "once is enough";
  const Error error{ErrorKind::kInput, "no \x1b[2J", {"a\nb", 1, 2}, "try \a"};
  EXPECT_EQ(error.to_string(), "a\\nb:1:2: no \\x1b[2J (try \\x07)");
}

}  // namespace
}  // namespace gloam
