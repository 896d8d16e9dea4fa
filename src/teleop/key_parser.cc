#include "teleop/key_parser.h"

namespace gloam::teleop {
namespace {

constexpr char kEscape = '\x1b';
constexpr size_t kLongestSequence = 32;

struct MoveKey {
  unsigned char letter;
  Deflection move;
};
constexpr MoveKey kMoveKeys[] = {
    {'w', {.forward = 1}}, {'s', {.forward = -1}}, {'a', {.left = 1}},  {'d', {.left = -1}},
    {'r', {.up = 1}},      {'f', {.up = -1}},      {'q', {.turn = 1}},  {'e', {.turn = -1}},
    {'l', {.roll = 1}},    {'j', {.roll = -1}},    {'k', {.pitch = 1}}, {'i', {.pitch = -1}},
};
// Final characters of the sequences of cursor keys.
constexpr MoveKey kArrows[] = {
    {'A', {.forward = 1}}, {'B', {.forward = -1}}, {'C', {.turn = -1}}, {'D', {.turn = 1}}};

struct RequestKey {
  unsigned char letter;
  Request request;
};
constexpr RequestKey kRequestKeys[] = {
    {' ', Request::kStop},   {'g', Request::kGripper}, {'\t', Request::kSwitchGoal},
    {'+', Request::kFaster}, {'-', Request::kSlower},  {'h', Request::kHelp},
    {'?', Request::kHelp},   {'\x03', Request::kEnd},  // Ctrl-C, if the terminal sends no signal
                                                       // for it
};

std::optional<Key> letter_key(unsigned char byte) {
  if (byte >= '1' && byte <= '9') return Key{.speed = byte - '0'};
  if (byte >= 'A' && byte <= 'Z') byte = static_cast<unsigned char>(byte - 'A' + 'a');
  for (const MoveKey& key : kMoveKeys)
    if (key.letter == byte) return Key{.move = key.move};
  for (const RequestKey& key : kRequestKeys)
    if (key.letter == byte) return Key{.request = key.request};
  return {};
}

// CSI: ESC [ parameters final; SS3: ESC O final (ECMA-48, section 5.4).
bool is_complete(const std::string& sequence) {
  if (sequence.size() < 2) return false;
  if (sequence[1] != '[' && sequence[1] != 'O') return true;  // Alt and a key
  const char last = sequence.back();
  return sequence.size() > 2 && last >= '@' && last <= '~';
}

std::optional<Key> arrow_key(const std::string& sequence) {
  if (sequence.size() < 3) return {};
  for (const MoveKey& key : kArrows)
    if (sequence.back() == static_cast<char>(key.letter)) return Key{.move = key.move};
  return {};
}

}  // namespace

std::vector<Key> KeyParser::feed(std::span<const unsigned char> bytes, Time now) {
  std::vector<Key> keys;
  for (const unsigned char byte : bytes) {
    const bool is_escape = byte == static_cast<unsigned char>(kEscape);
    if (is_escape && sequence_.size() == 1) keys.push_back({.request = Request::kEnd});
    if (is_escape) {
      sequence_ = kEscape;
      began_ = now;
    } else if (const auto key = take(byte)) {
      keys.push_back(*key);
    }
  }
  return keys;
}

std::optional<Key> KeyParser::check_escape(Time now) {
  if (sequence_.empty() || now - began_ < kEscapeTime) return {};
  const bool is_alone = sequence_.size() == 1;
  sequence_.clear();
  return is_alone ? std::optional<Key>(Key{.request = Request::kEnd}) : std::nullopt;
}

std::optional<Key> KeyParser::take(unsigned char byte) {
  if (sequence_.empty()) return letter_key(byte);
  sequence_ += static_cast<char>(byte);
  if (!is_complete(sequence_)) {
    if (sequence_.size() >= kLongestSequence) sequence_.clear();
    return {};
  }
  const std::optional<Key> key = arrow_key(sequence_);
  sequence_.clear();
  return key;
}

}  // namespace gloam::teleop
