#pragma once
// RenderTurns: shares one renderer fairly between sensors, as an operating system shares a
// processor. The sensor that has used the renderer least gets the next turn; a sensor in the middle
// of a long picture passes its turn on, between two tiles, to one that has used less. A sensor that
// needs less than an equal share therefore keeps its rate, however long the others take.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <vector>

namespace gloam {

/// One sensor's account of a RenderTurns, which alone reads and writes `used`.
struct RenderUse {
  double used = 0;    ///< time of the renderer that counts towards the next turn [s]
  double waited = 0;  ///< wall time spent waiting for turns since the beginning [s]
};

/// Any thread; a turn belongs to the thread that took it.
class RenderTurns {
 public:
  /// Waits for a turn. `use` must live until the turn is given back.
  void take(RenderUse& use);
  void give();
  /// Whether another sensor should have the turn now. Also for threads that work for its holder;
  /// costs one atomic load where nobody waits.
  bool is_wanted() const;
  /// Lets those go first that should, then goes on. True if another sensor had a turn in between:
  /// the renderer then has to be updated again.
  bool pass();
  /// Reports the time [s] of that update by the holder of the turn. Turns become so long that
  /// updates take a fifth of the time at most.
  void count_update(double seconds);

  // A turn without an account, for std::lock_guard: of short work that is no sensor's.
  void lock() { take(others_); }
  void unlock() { give(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    RenderUse* use;
    std::condition_variable granted;
    bool has_turn = false;
  };

  void grant(RenderUse& use);
  void grant_next();
  void settle();
  void wait_for_turn(std::unique_lock<std::mutex>& lock, RenderUse& use);
  void find_least();

  static constexpr double kNobody = std::numeric_limits<double>::infinity();
  // A sensor that comes back after a pause is ahead of the others by a slice, and no more however
  // long it paused; a holder keeps its turn for as long against sensors that have used as much as
  // it has.
  static constexpr double kShortestSlice = 0.02;  // [s]
  std::mutex mutex_;                              // guards all but the atomic numbers
  std::vector<Waiting*> waiting_;                 // in the order in which they came
  RenderUse* holder_ = nullptr;                   // null: the renderer is free
  Clock::time_point since_;  // of the holder's turn, up to which its time is settled
  double floor_ = 0;         // the most that a holder had used when its turn began [s]
  RenderUse others_;
  std::atomic<double> least_waiting_{kNobody};  // least `used` among those that wait [s]
  std::atomic<double> slice_{kShortestSlice};   // [s]
};

/// A turn of a sensor, given back at the end of its scope.
class RenderTurn {
 public:
  RenderTurn(RenderTurns& turns, RenderUse& use) : turns_(turns) { turns.take(use); }
  ~RenderTurn() { turns_.give(); }
  RenderTurn(const RenderTurn&) = delete;
  RenderTurn& operator=(const RenderTurn&) = delete;

 private:
  RenderTurns& turns_;
};

}  // namespace gloam
