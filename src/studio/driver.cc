#include "studio/driver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gloam/log_player.h"
#include "studio/replies.h"

namespace gloam::studio {
namespace {

using std::chrono::milliseconds;

constexpr size_t kMaxRequests = 256;
constexpr milliseconds kTickPeriod{20};
constexpr milliseconds kReportPause{25};         // between reports after requests, at least
constexpr milliseconds kCameraCloseDelay{3000};  // longer than the reload of a page takes

/// Adds `next` to the message that waits, if both are moves of one kind. False: it must queue up.
bool merge(ControlMessage& waiting, const ControlMessage& next) {
  if (waiting.index() != next.index()) return false;
  return std::visit(
      [&]<class T>(T& first) {
        const T& second = std::get<T>(next);
        if constexpr (std::is_same_v<T, OrbitMessage> || std::is_same_v<T, PanMessage>) {
          first.dx += second.dx;
          first.dy += second.dy;
          return true;
        } else if constexpr (std::is_same_v<T, ZoomMessage>) {
          first.amount += second.amount;
          return true;
        } else if constexpr (std::is_same_v<T, DragMoveMessage> || std::is_same_v<T, SeekMessage> ||
                             std::is_same_v<T, ResetMessage> || std::is_same_v<T, DriveMessage>) {
          first = second;
          return true;
        } else if constexpr (std::is_same_v<T, SetJointMessage>) {
          if (first.joint == second.joint) first = second;
          return first.joint == second.joint;
        } else if constexpr (std::is_same_v<T, SetControlMessage>) {
          if (first.actuator == second.actuator) first = second;
          return first.actuator == second.actuator;
        }
        return false;
      },
      waiting);
}

/// The same point in another picture of the camera: pictures are coarser while something moves.
template <class Message>
Message scaled_to(const CameraFrame& frame, Message message) {
  const double scale =
      message.width > 0 ? frame.intrinsics.width / static_cast<double>(message.width) : 1;
  message.u *= scale;
  message.v *= scale;
  return message;
}

}  // namespace

Driver::Driver(Simulation& simulation, const ViewOptions& options, Publisher& publisher,
               Outputs outputs)
    : simulation_(simulation),
      options_(options),
      publisher_(publisher),
      outputs_(std::move(outputs)),
      camera_(simulation, options, publisher),
      edits_(simulation),
      history_(simulation) {}

Driver::~Driver() { stop(); }

Status Driver::start() {
  GLOAM_TRY_STATUS(camera_.open(options_.camera));
  {
    const std::lock_guard lock(mutex_);
    speed_ = report_.speed = options_.speed;
    last_client_ = Clock::now();
  }
  thread_ = std::thread([this] { run(); });
  return {};
}

bool Driver::post(int64_t client, const ControlMessage& message) {
  {
    const std::lock_guard lock(mutex_);
    if (!requests_.empty() && requests_.back().client == client &&
        merge(requests_.back().message, message))
      return true;
    if (requests_.size() >= kMaxRequests) return false;
    requests_.push_back({client, message});
  }
  wake_.notify_one();
  return true;
}

void Driver::release(int64_t client) {
  const std::lock_guard lock(mutex_);
  requests_.push_back({client, DragEndMessage{}});
}

void Driver::set_clients(int count) {
  {
    const std::lock_guard lock(mutex_);
    someone_came_ |= count > clients_;
    clients_ = count;
    last_client_ = Clock::now();
  }
  wake_.notify_one();
}

void Driver::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  camera_.close();
}

Driver::Report Driver::report() const {
  Report report = [this] {
    const std::lock_guard lock(mutex_);
    return report_;
  }();
  report.camera = camera_.report();
  return report;
}

void Driver::run() {
  if (options_.player == nullptr) history_.keep();  // the beginning, before any request
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    wake_.wait_for(lock, kTickPeriod, [this] { return stopping_ || !requests_.empty(); });
    has_news_ |= !requests_.empty();
    while (!stopping_ && !requests_.empty()) {
      const ControlRequest request = std::move(requests_.front());
      requests_.pop_front();
      lock.unlock();
      carry_out(request);
      lock.lock();
    }
    if (stopping_) break;
    lock.unlock();
    if (has_news_ && Clock::now() - reported_at_ > kReportPause) {
      outputs_.changed();
      reported_at_ = Clock::now();
      has_news_ = false;
    }
    tick();
    lock.lock();
  }
  lock.unlock();
  if (grab_) do_message(grab_->client(), DragEndMessage{});
  camera_.close();
}

void Driver::tick() {
  bool is_wanted = false;
  {
    const std::lock_guard lock(mutex_);
    is_wanted = clients_ > 0 || Clock::now() - last_client_ < kCameraCloseDelay;
    // Pictures that nobody was there to see are not encoded.
    if (std::exchange(someone_came_, false)) camera_.invalidate(false);
  }
  // Somebody else has let it run.
  if (!edits_.empty() && !simulation_.paused()) static_cast<void>(edits_.post());
  const bool is_new = camera_.tick({.is_wanted = is_wanted,
                                    .is_grabbed = grab_.has_value(),
                                    .speed = speed_,
                                    .shown = edits_.empty() ? Snapshot() : edits_.shown()});
  if (grab_ && is_new) follow_grab();
  if (options_.player != nullptr) return;
  history_.keep();
  const std::lock_guard lock(mutex_);
  report_.history_start = history_.start();
}

void Driver::carry_out(const ControlRequest& request) {
  std::visit(
      [&](const auto& message) {
        // Messages about control itself and about the model's data end elsewhere.
        if constexpr (requires { do_message(request.client, message); })
          do_message(request.client, message);
      },
      request.message);
}

void Driver::do_message(int64_t, const PauseMessage&) {
  simulation_.pause();
  camera_.invalidate(false);
}

void Driver::do_message(int64_t client, const ResumeMessage&) {
  tell_failure(client, edits_.post());
  simulation_.resume();
}

void Driver::do_message(int64_t client, const StepMessage& message) {
  tell_failure(client, edits_.post());
  for (int i = 0; i < message.count; ++i) {
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return;
    }
    if (const Status status = simulation_.step(1); !status.ok())
      return tell_failure(client, status);
  }
  camera_.invalidate(true);
}

void Driver::do_message(int64_t client, const BackMessage& message) {
  const SimulationStats now = simulation_.stats();
  if (options_.player != nullptr)
    return seek_log(client, now.time - message.count / simulation_.step_rate().value());
  return_to(client, now.step - message.count);
}

void Driver::do_message(int64_t, const SpeedMessage& message) {
  simulation_.set_pace(options_.pace, message.value);
  speed_ = message.value;
  const std::lock_guard lock(mutex_);
  report_.speed = message.value;
}

void Driver::do_message(int64_t client, const SeekMessage& message) {
  if (options_.player != nullptr) return seek_log(client, message.time);
  const double step_rate = simulation_.step_rate().value();
  return_to(client, std::llround(std::max(message.time, history_.start()) * step_rate));
}

void Driver::seek_log(int64_t client, double time) {
  tell_failure(client, options_.player->seek(std::clamp(time, 0.0, options_.player->end())));
  camera_.invalidate(true);
}

void Driver::return_to(int64_t client, int64_t step) {
  if (step >= simulation_.stats().step) return;
  if (step < 0) return reply(client, notice_message("This is the beginning of the simulation."));
  if (history_.repeats_run())
    reply(client, notice_message("Repeating the simulation from its beginning, because effects and "
                                 "some controllers cannot be copied …"));
  edits_.forget();
  simulation_.pause();
  simulation_.set_pace(Pace::kFast, 1);
  tell_failure(client, history_.return_to(step));
  simulation_.set_pace(options_.pace, speed_);
  camera_.invalidate(true);
  const std::lock_guard lock(mutex_);
  ++report_.returns;
}

void Driver::do_message(int64_t client, const ResetMessage&) {
  if (options_.player != nullptr) return seek_log(client, 0);
  edits_.forget();
  tell_failure(client, simulation_.post({.what = ResetSim{}}));
  camera_.invalidate(true);
  const std::lock_guard lock(mutex_);
  ++report_.returns;
}

void Driver::edit(int64_t client, std::vector<Command> commands) {
  if (options_.player != nullptr)
    return reply(client, notice_message("A log is played; its state cannot be changed."));
  tell_failure(client, edits_.apply(std::move(commands)));
  camera_.invalidate(true);
}

void Driver::do_message(int64_t client, const SetJointMessage& message) {
  edit(client, {{.what = SetJointState{{message.joint, 0}, message.qpos, {}}}});
}

void Driver::do_message(int64_t client, const SetControlMessage& message) {
  edit(client, {{.what = SetControl{{message.actuator, 0}, message.value}}});
}

void Driver::do_message(int64_t client, const SetEqualityMessage& message) {
  edit(client, {{.what = SetEquality{{message.equality, 0}, message.active}}});
}

void Driver::do_message(int64_t client, const ClearControlsMessage&) {
  set_state(client, [](const Instant& instant) -> Result<StateKey> {
    StateKey key;
    key.ctrl.resize(key_of(instant).ctrl.size());
    return key;
  });
}

void Driver::do_message(int64_t client, const LoadKeyframeMessage& message) {
  set_state(client, [&](const Instant& instant) { return keyframe_of(instant, message.keyframe); });
}

void Driver::do_message(int64_t client, const PasteStateMessage& message) {
  set_state(client, [&](const Instant&) { return parse_key(message.text); });
}

void Driver::set_state(int64_t client,
                       const std::function<Result<StateKey>(const Instant&)>& make_key) {
  Instant instant;
  if (const Status status = instant.solve(edits_.shown()); !status.ok())
    return tell_failure(client, status);
  const Result<StateKey> key = make_key(instant);
  if (!key.ok()) return tell_failure(client, key.error());
  Result<std::vector<Command>> commands = set_key(*key, instant);
  if (!commands.ok()) return tell_failure(client, commands.error());
  edit(client, std::move(*commands));
}

void Driver::do_message(int64_t client, const DriveMessage& message) {
  const SetVelocityGoal goal{
      {message.robot, 0}, message.vx, message.vy, message.yaw_rate, message.vz};
  tell_failure(client, simulation_.post({.what = goal}));
}

void Driver::do_message(int64_t client, const CameraMessage& message) {
  if (camera_.is_open_at(message.name)) return;
  if (std::ranges::find(camera_.names(), message.name) == camera_.names().end())
    return reply(client, notice_message("There is no camera '" + message.name + "'."));
  tell_failure(client, camera_.open(message.name));
}

void Driver::do_message(int64_t, const OrbitMessage& message) {
  if (OrbitCamera* camera = camera_.free_camera()) {
    camera->orbit(message.dx, message.dy);
    camera_.moved();
  }
}

void Driver::do_message(int64_t, const PanMessage& message) {
  const auto frame = publisher_.newest();
  OrbitCamera* camera = camera_.free_camera();
  if (!camera || !frame) return;
  camera_.track({});
  const Intrinsics& k = frame->intrinsics;
  camera->pan(message.dx, message.dy, k.height / k.fy * (k.orthographic ? 1 : camera->distance()));
  camera_.moved();
}

void Driver::do_message(int64_t, const ZoomMessage& message) {
  if (OrbitCamera* camera = camera_.free_camera()) {
    camera->zoom(message.amount);
    camera_.moved();
  }
}

void Driver::do_message(int64_t client, const LookAtMessage& message) {
  const auto frame = publisher_.newest();
  OrbitCamera* camera = camera_.free_camera();
  if (!camera || !frame) return;
  const Pixel at = scaled_to(*frame, message);
  const auto hit = simulation_.pick(*frame, at.u, at.v);
  if (!hit.ok()) return reply(client, notice_message("There is nothing to look at here."));
  camera_.track({});
  camera->set_pivot(hit->point_W);
  camera_.moved();
}

void Driver::do_message(int64_t client, const TrackMessage& message) {
  const Body body{message.body, 0};
  if (message.body >= 0 && !simulation_.body_pose(body).ok())
    return reply(client, notice_message("There is no such body to track."));
  camera_.track(body);
}

void Driver::do_message(int64_t client, const PickMessage& message) {
  const auto frame = publisher_.newest();
  if (!frame) return;
  const Pixel at = scaled_to(*frame, message);
  const auto hit = simulation_.pick(*frame, at.u, at.v);
  reply(client, hit.ok() ? picked_message(hit->body, hit->name, hit->point_W, false)
                         : picked_nothing_message());
}

void Driver::do_message(int64_t client, const DragStartMessage& message) {
  if (grab_) do_message(grab_->client(), DragEndMessage{});
  if (options_.player != nullptr)
    return reply(client, notice_message("A log is played; its bodies cannot be moved."));
  const auto frame = publisher_.newest();
  if (!frame) return;
  Result<Grab> grab = Grab::take(client, simulation_, *frame, scaled_to(*frame, message));
  if (!grab.ok()) return reply(client, notice_message(grab.error().message));
  grab_ = std::move(*grab);
  const PickResult& hit = grab_->hit();
  reply(client, picked_message(hit.body, hit.name, hit.point_W, true));
  follow_grab();
}

void Driver::do_message(int64_t client, const DragMoveMessage& message) {
  const auto frame = publisher_.newest();
  if (!grab_ || grab_->client() != client || !frame) return;
  const Pixel at = scaled_to(*frame, message);
  grab_->move_to(*frame, at.u, at.v);
  follow_grab();
}

void Driver::do_message(int64_t client, const DragEndMessage&) {
  if (!grab_ || grab_->client() != client) return;
  tell_failure(client, simulation_.post(grab_->let_go()));
  grab_.reset();
}

/// The mouse or the camera has moved: the target stays under the mouse.
void Driver::follow_grab() {
  const auto frame = publisher_.newest();
  if (!frame) return;
  const std::vector<Command> commands = grab_->follow(*frame, simulation_.paused());
  if (!commands.empty()) edit(grab_->client(), commands);
  const auto X_WB = simulation_.body_pose(grab_->body());
  if (X_WB.ok())
    reply(grab_->client(), pulled_message(X_WB->p + rotate(X_WB->q, grab_->hit().point_B)));
}

void Driver::tell_failure(int64_t client, const Status& status) {
  if (!status.ok()) reply(client, notice_message(status.error().to_string()));
}

}  // namespace gloam::studio
