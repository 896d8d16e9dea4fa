#include "gloam/drive/teleop.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

#include "teleop/gamepad.h"
#include "teleop/held_keys.h"
#include "teleop/help.h"
#include "teleop/key_parser.h"
#include "teleop/robot_driver.h"
#include "teleop/terminal.h"

namespace gloam {
namespace teleop {
namespace {

constexpr std::chrono::milliseconds kTick{100};        // longest time between two looks at devices
constexpr std::chrono::milliseconds kStickPeriod{20};  // of the goal of a frame

class TeleopLoop final : public Teleop {
 public:
  TeleopLoop(std::unique_ptr<RobotDriver> driver, std::unique_ptr<Terminal> terminal,
             std::unique_ptr<Gamepad> gamepad)
      : driver_(std::move(driver)),
        terminal_(std::move(terminal)),
        gamepad_(std::move(gamepad)),
        wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    publish_status();
    thread_ = std::thread([this] { run(); });
  }

  ~TeleopLoop() override {
    is_stopping_ = true;
    static_cast<void>(::eventfd_write(wake_, 1));
    thread_.join();
    ::close(wake_);
  }

  std::vector<std::string> help() const override {
    const std::lock_guard lock(mutex_);
    return help_;
  }
  bool take_help_request() override { return help_asked_.exchange(false); }
  std::string status() const override {
    const std::lock_guard lock(mutex_);
    return status_;
  }
  std::vector<std::string> take_notices() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(notices_, {});
  }
  bool end_asked() const override { return end_asked_; }

 private:
  void run() {
    while (!is_stopping_) {
      wait();
      const Time now = Clock::now();
      read_keyboard(now);
      read_gamepad(now);
      report(steer(now));
      driver_->release_idle(now);
      publish_status();
    }
    keys_.release_all();
    if (!driver_->moves_frame()) static_cast<void>(driver_->steer({}, Clock::now()).ok());
  }

  // Until a device has something to read, or the next movement ends.
  void wait() {
    const bool has_keys = terminal_ != nullptr && terminal_->is_ready();
    pollfd inputs[] = {{wake_, POLLIN, 0},
                       {has_keys ? terminal_->descriptor() : -1, POLLIN, 0},
                       {gamepad_->descriptor(), POLLIN, 0}};
    const Time now = Clock::now();
    auto longest = std::chrono::duration_cast<Clock::duration>(kTick);
    if (const auto end = keys_.next_end(now)) longest = std::min(longest, *end - now);
    if (driver_->moves_frame() && !gamepad_->deflection().is_zero())
      longest = std::min<Clock::duration>(longest, kStickPeriod);
    const auto whole = std::chrono::ceil<std::chrono::milliseconds>(longest);
    ::poll(inputs, std::size(inputs), static_cast<int>(whole.count()));
    has_gamepad_input_ = inputs[2].revents != 0;
  }

  void read_keyboard(Time now) {
    if (terminal_ == nullptr) return;
    if (!terminal_->is_ready()) return lose_keyboard();
    for (const Key& key : parser_.feed(terminal_->read(), now))
      if (!keys_.is_repeat(key.request, now)) take(key, now);
    if (const auto key = parser_.check_escape(now)) take(*key, now);
    if (terminal_->is_lost()) lose_keyboard();
  }

  // In the background, or the terminal is closed.
  void lose_keyboard() {
    keys_.release_all();
    if (!terminal_->is_lost() || std::exchange(was_lost_, true)) return;
    notify("the terminal is closed, the robot stops");
  }

  void read_gamepad(Time now) {
    gamepad_->reopen(now);
    if (has_gamepad_input_) gamepad_->read();
    if (const auto notice = gamepad_->take_notice()) notify(*notice);
    for (const Request request : gamepad_->take_requests()) take({.request = request}, now);
  }

  void take(const Key& key, Time now) {
    if (key.speed != 0) driver_->set_speed(key.speed);
    if (key.request != Request::kNone) report(carry_out(key.request, now));
    if (key.move.is_zero()) return;
    if (driver_->moves_frame())
      report(driver_->jog(key.move, now));
    else
      keys_.press(key.move, now);
  }

  Status carry_out(Request request, Time now) {
    switch (request) {
      case Request::kStop:
        keys_.release_all();
        return driver_->stop(now);
      case Request::kGripper:
        return driver_->toggle_gripper(now);
      case Request::kGripperOpen:
      case Request::kGripperClose:
        return driver_->set_gripper(request == Request::kGripperOpen, now);
      case Request::kSwitchGoal:
        keys_.release_all();
        if (driver_->switch_goal(now)) help_asked_ = true;
        return {};
      case Request::kFaster:
      case Request::kSlower:
        driver_->set_speed(driver_->speed() + (request == Request::kFaster ? 1 : -1));
        return {};
      case Request::kHelp:
        help_asked_ = true;
        return {};
      case Request::kEnd:
        end_asked_ = true;
        return {};
      case Request::kNone:
        break;
    }
    return {};
  }

  // The device that deflects an axis further has it.
  Status steer(Time now) {
    Deflection move = gamepad_->deflection();
    const Deflection keys = keys_.at(now);
    for (const auto axis : kAxes)
      if (std::abs(keys.*axis) > std::abs(move.*axis)) move.*axis = keys.*axis;
    return driver_->steer(move, now);
  }

  void notify(std::string notice) {
    const std::lock_guard lock(mutex_);
    notices_.push_back(std::move(notice));
  }

  // A failure that repeats is reported once.
  void report(const Status& status) {
    std::string failure = status.ok() ? "" : status.error().to_string();
    if (!status.ok() && failure != failure_) notify(failure);
    if (!status.ok()) failed_at_ = Clock::now();
    if (!status.ok() || Clock::now() - failed_at_ > kForgetFailure) failure_ = std::move(failure);
  }

  void publish_status() {
    std::string status =
        fmt::format("{}: {}  speed {}", driver_->robot(), driver_->goal_text(), driver_->speed());
    if (gamepad_->is_alive()) status += "  gamepad";
    auto help = help_lines(driver_->robot(), driver_->goals(), driver_->moves_frame());
    const std::lock_guard lock(mutex_);
    status_ = std::move(status);
    help_ = std::move(help);
  }

  static constexpr std::chrono::seconds kForgetFailure{1};

  // The loop's thread only, once it runs.
  const std::unique_ptr<RobotDriver> driver_;
  const std::unique_ptr<Terminal> terminal_;  // null: a gamepad only
  const std::unique_ptr<Gamepad> gamepad_;
  KeyParser parser_;
  HeldKeys keys_;
  bool has_gamepad_input_ = false, was_lost_ = false;
  std::string failure_;
  Time failed_at_;

  mutable std::mutex mutex_;
  std::string status_;
  std::vector<std::string> help_, notices_;
  std::atomic<bool> help_asked_ = false, end_asked_ = false, is_stopping_ = false;
  const int wake_;
  std::thread thread_;
};

}  // namespace
}  // namespace teleop

Status check_teleop(const TeleopOptions& options) {
  return options.gamepad.empty() ? teleop::check_terminal(options.keyboard) : Status();
}

Result<std::unique_ptr<Teleop>> Teleop::start(Simulation& simulation,
                                              const TeleopOptions& options) {
  GLOAM_TRY_STATUS(check_teleop(options));
  GLOAM_TRY(auto driver, teleop::RobotDriver::create(simulation, options.robot));
  auto gamepad = std::make_unique<teleop::Gamepad>(options.gamepad);
  if (const Status status = gamepad->open(); !status.ok() && !options.gamepad.empty())
    return status.error();
  std::unique_ptr<teleop::Terminal> terminal;
  if (teleop::check_terminal(options.keyboard).ok()) {
    GLOAM_TRY(terminal, teleop::Terminal::open(options.keyboard));
  }
  return std::unique_ptr<Teleop>(std::make_unique<teleop::TeleopLoop>(
      std::move(driver), std::move(terminal), std::move(gamepad)));
}

}  // namespace gloam
