#pragma once
// Connections that nobody vouches for yet. They have a small quota of their own and little time, so
// that however many come, whoever has the token gets in: the oldest makes room for the newest, and
// a client that knows what it wants needs a few milliseconds.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

namespace gloam::web {

class HalfOpen {
 public:
  static constexpr size_t kMaxConnections = 16;
  static constexpr std::chrono::milliseconds kHeaderTimeout{2000};  ///< for a whole request header

  /// `close` ends the connection when another needs its place. Returns its number, from 1.
  int64_t enter(std::function<void()> close) {
    open_.emplace(++last_, std::move(close));
    if (open_.size() > kMaxConnections) {
      const auto oldest = open_.extract(open_.begin());
      oldest.mapped()();
    }
    return last_;
  }
  /// It was let in, or it is gone.
  void leave(int64_t number) { open_.erase(number); }
  size_t count() const { return open_.size(); }

 private:
  std::map<int64_t, std::function<void()>> open_;  // by age
  int64_t last_ = 0;
};

}  // namespace gloam::web
