// Bytes of a terminal -> keys -> movements that are held.

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "teleop/held_keys.h"
#include "teleop/key_parser.h"

namespace gloam::teleop {
namespace {

using std::chrono::milliseconds;

Time at(int ms) { return Time() + std::chrono::hours(1) + milliseconds(ms); }

std::vector<Key> keys_of(KeyParser* parser, const std::string& bytes, int ms = 0) {
  return parser->feed({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, at(ms));
}

std::vector<Key> keys_of(const std::string& bytes) {
  KeyParser parser;
  return keys_of(&parser, bytes);
}

Deflection move_of(const std::string& bytes) {
  const std::vector<Key> keys = keys_of(bytes);
  return keys.size() == 1 ? keys[0].move : Deflection{};
}

TEST(KeyParser, LettersMoveInBothCases) {
  EXPECT_EQ(move_of("w"), (Deflection{.forward = 1}));
  EXPECT_EQ(move_of("S"), (Deflection{.forward = -1}));
  EXPECT_EQ(move_of("a"), (Deflection{.left = 1}));
  EXPECT_EQ(move_of("d"), (Deflection{.left = -1}));
  EXPECT_EQ(move_of("q"), (Deflection{.turn = 1}));
  EXPECT_EQ(move_of("e"), (Deflection{.turn = -1}));
  EXPECT_EQ(move_of("r"), (Deflection{.up = 1}));
  EXPECT_EQ(move_of("f"), (Deflection{.up = -1}));
}

TEST(KeyParser, ArrowsMoveInBothModesOfACursorKey) {
  EXPECT_EQ(move_of("\x1b[A"), (Deflection{.forward = 1}));
  EXPECT_EQ(move_of("\x1bOB"), (Deflection{.forward = -1}));
  EXPECT_EQ(move_of("\x1b[C"), (Deflection{.turn = -1}));
  EXPECT_EQ(move_of("\x1b[1;2D"), (Deflection{.turn = 1})) << "with Shift";
}

TEST(KeyParser, DigitsAndOtherKeysAreRequests) {
  const std::vector<Key> keys = keys_of("7 gh\t+-");
  ASSERT_EQ(keys.size(), 7U);
  EXPECT_EQ(keys[0].speed, 7);
  const Request requests[] = {Request::kStop,       Request::kGripper, Request::kHelp,
                              Request::kSwitchGoal, Request::kFaster,  Request::kSlower};
  for (size_t i = 0; i < std::size(requests); ++i) EXPECT_EQ(keys[i + 1].request, requests[i]) << i;
}

TEST(KeyParser, IgnoresOtherSequencesAndCharacters) {
  // F5, Delete, Home, focus, a mouse report, Alt-w, a letter beyond ASCII, Ctrl-A, 0.
  for (const char* text : {"\x1b[15~", "\x1b[3~", "\x1b[H", "\x1b[I", "\x1b[<0;10;20M", "\x1bw",
                           "\xc3\xa4", "\x01", "0"})
    EXPECT_TRUE(keys_of(text).empty()) << text + 1;
}

TEST(KeyParser, ReadsASequenceInPieces) {
  KeyParser parser;
  EXPECT_TRUE(keys_of(&parser, "\x1b", 0).empty());
  EXPECT_FALSE(parser.check_escape(at(40)));
  EXPECT_TRUE(keys_of(&parser, "[", 50).empty());
  const std::vector<Key> keys = keys_of(&parser, "A", 60);
  ASSERT_EQ(keys.size(), 1U);
  EXPECT_EQ(keys[0].move, (Deflection{.forward = 1}));
  EXPECT_FALSE(parser.check_escape(at(1000)));
}

TEST(KeyParser, ALoneEscapeEnds) {
  KeyParser parser;
  EXPECT_TRUE(keys_of(&parser, "\x1b", 0).empty());
  EXPECT_FALSE(parser.check_escape(at(99)));
  const auto key = parser.check_escape(at(100));
  ASSERT_TRUE(key);
  EXPECT_EQ(key->request, Request::kEnd);
  EXPECT_FALSE(parser.check_escape(at(200))) << "once";
  ASSERT_EQ(keys_of("\x1b\x1b").size(), 1U);
  EXPECT_EQ(keys_of("\x1b\x1b")[0].request, Request::kEnd);
}

TEST(KeyParser, AnUnfinishedSequenceDoesNotSwallowLaterKeys) {
  KeyParser parser;
  EXPECT_TRUE(keys_of(&parser, "\x1b[", 0).empty());
  EXPECT_FALSE(parser.check_escape(at(150))) << "it is not the key Esc";
  EXPECT_EQ(keys_of(&parser, "w", 160).size(), 1U);
  EXPECT_TRUE(keys_of(&parser, "\x1b[" + std::string(10000, '1'), 200).size() <= 10000U);
  EXPECT_FALSE(keys_of(&parser, "w", 210).empty()) << "a sequence of any length ends";
}

TEST(KeyParser, AnyBytesAreHarmless) {
  std::mt19937 random(1);
  KeyParser parser;
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 8, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random() % 3 == 0 ? 0x1b : random());
    for (const Key& key : keys_of(&parser, bytes, i)) {
      EXPECT_LE(key.speed, 9);
      EXPECT_EQ((key.speed != 0) + (key.request != Request::kNone) + !key.move.is_zero(), 1);
    }
    parser.check_escape(at(i));
  }
}

// Presses a key at a time, then every 33 ms from the end of the delay to `last`, as terminals do.
void hold(HeldKeys* keys, const Deflection& move, int from, int delay, int last, int period = 33) {
  keys->press(move, at(from));
  for (int ms = from + delay; ms <= last; ms += period) keys->press(move, at(ms));
}

const Deflection kForward{.forward = 1}, kBack{.forward = -1}, kLeft{.turn = 1};

TEST(HeldKeys, ATapMovesForTheFirstHold) {
  HeldKeys keys;
  EXPECT_TRUE(keys.at(at(0)).is_zero());
  EXPECT_FALSE(keys.next_end(at(0)));
  keys.press(kForward, at(0));
  EXPECT_EQ(keys.at(at(0)), kForward);
  EXPECT_EQ(keys.at(at(699)), kForward);
  EXPECT_TRUE(keys.at(at(700)).is_zero());
  EXPECT_EQ(keys.next_end(at(10)), at(700));
}

// Delay before the first repeat and period of X11, GNOME, the Linux console, macOS and `xset r rate
// 150 50`.
TEST(HeldKeys, ARepeatingKeyMovesWithoutGapsAndStopsSoonAfterItsRelease) {
  struct Rate {
    int delay, period;
  };
  for (const Rate rate :
       {Rate{660, 40}, Rate{500, 30}, Rate{250, 92}, Rate{375, 90}, Rate{150, 20}}) {
    HeldKeys keys;
    keys.press(kForward, at(0));
    int last = 0;
    for (int ms = 1; ms <= 3000; ++ms) {
      const bool repeats = ms >= rate.delay && (ms - rate.delay) % rate.period == 0;
      if (repeats) keys.press(kForward, at(last = ms));
      ASSERT_EQ(keys.at(at(ms)), kForward) << rate.delay << " ms, gap at " << ms;
    }
    EXPECT_TRUE(keys.at(at(last + 250)).is_zero()) << rate.delay;
  }
}

TEST(HeldKeys, AQuickSecondTapHoldsAsLongAsTheFirst) {
  HeldKeys keys;
  keys.press(kForward, at(0));
  keys.press(kForward, at(120));
  EXPECT_EQ(keys.at(at(819)), kForward) << "its first repeat may still come";
  EXPECT_TRUE(keys.at(at(820)).is_zero());
}

TEST(HeldKeys, TheOppositeKeyReplacesIt) {
  HeldKeys keys;
  hold(&keys, kForward, 0, 500, 800);
  keys.press(kBack, at(820));
  EXPECT_EQ(keys.at(at(820)), kBack);
  EXPECT_EQ(keys.at(at(1519)), kBack) << "a first press again";
}

TEST(HeldKeys, AKeyPressedWhileAnotherRepeatsMovesBoth) {
  HeldKeys keys;
  hold(&keys, kForward, 0, 500, 1000);
  hold(&keys, kLeft, 1020, 500, 2500);  // the terminal repeats only this one
  for (const int ms : {1020, 1300, 1800, 2500})
    EXPECT_EQ(keys.at(at(ms)), (Deflection{.forward = 1, .turn = 1})) << ms;
  EXPECT_TRUE(keys.at(at(2760)).is_zero());
}

TEST(HeldKeys, KeysThatAlternateMoveBoth) {
  HeldKeys keys;
  for (int ms = 0; ms < 2000; ms += 60) {
    keys.press(kForward, at(ms));
    keys.press(kLeft, at(ms + 30));
    EXPECT_EQ(keys.at(at(ms + 30)), (Deflection{.forward = 1, .turn = 1})) << ms;
  }
}

TEST(HeldKeys, AKeyReleasedBeforeTheNextOneEndsByItself) {
  HeldKeys keys;
  hold(&keys, kForward, 0, 500, 1000);
  hold(&keys, kLeft, 1180, 500, 2500);
  EXPECT_EQ(keys.at(at(1300)), kLeft);
  EXPECT_EQ(keys.at(at(2500)), kLeft);
}

TEST(HeldKeys, ReleaseAllStopsAtOnce) {
  HeldKeys keys;
  hold(&keys, kForward, 0, 500, 1000);
  keys.release_all();
  EXPECT_TRUE(keys.at(at(1000)).is_zero());
}

TEST(HeldKeys, AHeldRequestActsOnce) {
  HeldKeys keys;
  EXPECT_FALSE(keys.is_repeat(Request::kGripper, at(0)));
  for (int ms = 500; ms < 2000; ms += 33) EXPECT_TRUE(keys.is_repeat(Request::kGripper, at(ms)));
  EXPECT_FALSE(keys.is_repeat(Request::kGripper, at(2700)));
  EXPECT_FALSE(keys.is_repeat(Request::kFaster, at(3000)));
  EXPECT_FALSE(keys.is_repeat(Request::kFaster, at(3033))) << "speeds repeat";
}

}  // namespace
}  // namespace gloam::teleop
