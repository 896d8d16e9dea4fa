#include "studio/driver.h"

#include "gloam/log_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gloam::studio {
namespace {

using std::chrono::milliseconds;

constexpr size_t kMaxRequests = 256;
constexpr milliseconds kTickPeriod{20};
constexpr milliseconds kCameraCloseDelay{3000};  // longer than the reload of a page takes
constexpr milliseconds kRetryPeriod{1000};
constexpr milliseconds kStillDelay{400};  // without a movement, before a picture counts as still
constexpr int kStillPictures = 64;        // that a still picture is the mean of
constexpr int kMeasuredPictures = 3;
constexpr int kPreviewSamples = 4;                    // per pixel, of the first picture
constexpr int kSmallWidth = 160, kSmallHeight = 120;  // [px] of a picture that is made at once
constexpr const char* kFreeCamera = "free";

/// Adds `next` to the message that waits, if both are moves of one kind. False: it must queue up.
bool merge(ControlMessage& waiting, const ControlMessage& next) {
  if (waiting.index() != next.index()) return false;
  if (auto* orbit = std::get_if<OrbitMessage>(&waiting)) {
    orbit->dx += std::get<OrbitMessage>(next).dx;
    orbit->dy += std::get<OrbitMessage>(next).dy;
    return true;
  }
  if (auto* pan = std::get_if<PanMessage>(&waiting)) {
    pan->dx += std::get<PanMessage>(next).dx;
    pan->dy += std::get<PanMessage>(next).dy;
    return true;
  }
  if (auto* zoom = std::get_if<ZoomMessage>(&waiting)) {
    zoom->amount += std::get<ZoomMessage>(next).amount;
    return true;
  }
  if (std::holds_alternative<DragMoveMessage>(waiting) ||
      std::holds_alternative<SeekMessage>(waiting) ||
      std::holds_alternative<ResetMessage>(waiting)) {
    waiting = next;
    return true;
  }
  return false;
}

/// Size of a request's pictures [px]; where it is the camera's own that of the scene's camera; 0 =
/// not known.
std::pair<int, int> size_of(const CameraRequest& request, const World& world) {
  if (request.width > 0 && request.height > 0) return {request.width, request.height};
  if (world.compiled() == nullptr) return {0, 0};
  for (const CameraOptions& camera : world.scene().cameras)
    if (camera.name == request.camera) return {camera.width, camera.height};
  return {0, 0};
}

/// Replaces a request for a slow picture by a preview: path traced, since the interactive tier
/// fills its cache of light before its first picture, and a quarter as wide unless it is small.
/// Returns false where the request is fast already, or so large that it must be tried as it is, so
/// that a lack of memory does not show later.
bool make_preview(const World& world, CameraRequest* request) {
  constexpr int kFraction = 4;
  constexpr int64_t kMostPixels = int64_t{16} << 20;
  const auto [width, height] = size_of(*request, world);
  const int64_t pixels = int64_t{width} * height;
  const bool is_small = pixels > 0 && pixels <= kSmallWidth * kSmallHeight;
  const bool fills_cache = request->render.tier == RenderTier::kInteractive;
  if ((is_small && !fills_cache) || pixels > kMostPixels) return false;
  if (!is_small) {
    request->width = pixels > 0 ? std::max(width / kFraction, 1) : kSmallWidth;
    request->height = pixels > 0 ? std::max(height / kFraction, 1) : kSmallHeight;
  }
  if (fills_cache) request->render.tier = RenderTier::kPath;
  request->render.error.reset();
  request->render.spp = std::min(request->render.samples(), kPreviewSamples);
  return true;
}

/// Pivot of a camera that sees nothing at its centre: the floor, or a step ahead [m].
double distance_to_floor(const Pose& X_WC) {
  const double fall = -rotate(X_WC.q, {0, 0, -1}).z;
  const double distance = fall > 0.01 ? X_WC.p.z / fall : 0;
  return distance > 0.2 && distance < 50 ? distance : 3;
}

}  // namespace

Driver::Driver(Simulation& simulation, const ViewOptions& options, Publisher& publisher,
               Reply reply)
    : simulation_(simulation),
      options_(options),
      publisher_(publisher),
      reply_(std::move(reply)),
      cameras_{kFreeCamera} {
  for (auto& name : simulation.camera_names())
    if (name != kFreeCamera) cameras_.push_back(std::move(name));
}

Driver::~Driver() { stop(); }

Status Driver::start() {
  GLOAM_TRY_STATUS(open_camera(options_.camera));
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
  stream_.reset();
}

Driver::CameraReport Driver::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void Driver::run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    wake_.wait_for(lock, kTickPeriod, [this] { return stopping_ || !requests_.empty(); });
    while (!stopping_ && !requests_.empty()) {
      const ControlRequest request = std::move(requests_.front());
      requests_.pop_front();
      lock.unlock();
      carry_out(request);
      lock.lock();
    }
    if (stopping_) break;
    lock.unlock();
    keep_camera();
    follow_pictures();
    adapt_resolution();
    refresh_when_due();
    lock.lock();
  }
  lock.unlock();
  if (drag_) do_message(drag_->client, DragEndMessage{});
  close_camera();
}

void Driver::carry_out(const ControlRequest& request) {
  std::visit(
      [&](const auto& message) {
        // Messages about control itself and about seen pictures end in the server.
        if constexpr (requires { do_message(request.client, message); })
          do_message(request.client, message);
      },
      request.message);
}

void Driver::do_message(int64_t, const PauseMessage&) {
  simulation_.pause();
  picture_is_old_ = true;
}

void Driver::do_message(int64_t, const ResumeMessage&) { simulation_.resume(); }

void Driver::do_message(int64_t client, const StepMessage& message) {
  for (int i = 0; i < message.count; ++i) {
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return;
    }
    if (const Status status = simulation_.step(1); !status.ok())
      return tell_failure(client, status);
  }
  picture_is_old_ = true;
  last_moved_ = Clock::now();
}

void Driver::do_message(int64_t, const SpeedMessage& message) {
  simulation_.set_pace(options_.pace, message.value);
  speed_ = message.value;
  const std::lock_guard lock(mutex_);
  report_.speed = message.value;
}

void Driver::do_message(int64_t client, const SeekMessage& message) {
  if (options_.player == nullptr)
    return reply_(client, notice_message("Seeking is only possible in the replay of a log."));
  const double time = std::min(message.time, options_.player->end());
  tell_failure(client, options_.player->seek(time));
  picture_is_old_ = true;
  last_moved_ = Clock::now();
}

void Driver::do_message(int64_t client, const ResetMessage&) {
  if (options_.player != nullptr) return do_message(client, SeekMessage{0});
  tell_failure(client, simulation_.post({.what = ResetSim{}}));
  picture_is_old_ = true;
}

void Driver::do_message(int64_t client, const CameraMessage& message) {
  if (message.name == camera_ && stream_) return;
  if (std::find(cameras_.begin(), cameras_.end(), message.name) == cameras_.end())
    return reply_(client, notice_message("There is no camera '" + message.name + "'."));
  // The free camera begins where its user was looking from: the model may have walls.
  if (const auto frame = publisher_.newest(); frame && camera_ != kFreeCamera)
    free_start_ = frame->X_WC;
  close_camera();
  tell_failure(client, open_camera(message.name));
}

void Driver::do_message(int64_t, const OrbitMessage& message) {
  if (OrbitCamera* camera = free_camera()) {
    camera->orbit(message.dx, message.dy);
    move_free_camera();
  }
}

void Driver::do_message(int64_t, const PanMessage& message) {
  const auto frame = publisher_.newest();
  OrbitCamera* camera = free_camera();
  if (!camera || !frame) return;
  const Intrinsics& k = frame->intrinsics;
  camera->pan(message.dx, message.dy, k.height / k.fy * (k.orthographic ? 1 : camera->distance()));
  move_free_camera();
}

void Driver::do_message(int64_t, const ZoomMessage& message) {
  if (OrbitCamera* camera = free_camera()) {
    camera->zoom(message.amount);
    move_free_camera();
  }
}

void Driver::do_message(int64_t client, const PickMessage& message) {
  const auto frame = publisher_.newest();
  if (!frame) return;
  const auto hit = simulation_.pick(*frame, message.u, message.v);
  reply_(client,
         hit.ok() ? picked_message(hit->name, hit->point_W, false) : picked_nothing_message());
}

void Driver::do_message(int64_t client, const DragStartMessage& message) {
  if (drag_) do_message(drag_->client, DragEndMessage{});
  const auto frame = publisher_.newest();
  if (!frame) return;
  const auto hit = simulation_.pick(*frame, message.u, message.v);
  if (!hit.ok()) return reply_(client, notice_message("There is nothing to pull here."));
  if (hit->body.id <= 0)
    return reply_(client, notice_message("This is part of the world and cannot move."));
  drag_ = Drag{.client = client,
               .body = hit->body,
               .point_B = hit->point_B,
               .depth = depth_of(frame->X_WC, frame->intrinsics, hit->point_W),
               .u = message.u,
               .v = message.v,
               .target_W = hit->point_W};
  pull(true);
  reply_(client, picked_message(hit->name, hit->point_W, true));
}

void Driver::do_message(int64_t client, const DragMoveMessage& message) {
  if (!drag_ || drag_->client != client) return;
  drag_->u = message.u;
  drag_->v = message.v;
  follow_drag();
}

void Driver::do_message(int64_t client, const DragEndMessage&) {
  if (!drag_ || drag_->client != client) return;
  pull(false);
  drag_.reset();
}

void Driver::pull(bool active) {
  tell_failure(
      drag_->client,
      simulation_.post({.what = DragBody{drag_->body, drag_->point_B, drag_->target_W, active}}));
}

/// The mouse or the camera has moved: the target stays under the mouse.
void Driver::follow_drag() {
  const auto frame = publisher_.newest();
  if (!frame) return;
  const auto target = point_at(frame->X_WC, frame->intrinsics, drag_->u, drag_->v, drag_->depth);
  if (!target || norm(*target - drag_->target_W) < 1e-9) return;
  drag_->target_W = *target;
  pull(true);
}

Status Driver::open_camera(std::string name) {
  if (name != camera_) full_width_ = full_height_ = 0;
  const std::string before = std::exchange(camera_, std::move(name));
  const Status status = open_stream(full_width_ > 0 ? scale_.scale() : 1);
  if (!status.ok()) camera_ = before;
  return status;
}

Status Driver::open_stream(double scale) {
  const std::string& name = camera_;
  const auto scaled = [scale](int full) {
    return std::max(static_cast<int>(std::lround(full * scale)), 1);
  };
  const bool coarse = scale < 1 && full_width_ > 0;
  CameraRequest request{.camera = name,
                        .rate = {std::llround(options_.rate * 1000), 1000},
                        .width = coarse ? scaled(full_width_) : options_.width,
                        .height = coarse ? scaled(full_height_) : options_.height,
                        .render = options_.render,
                        .is_view = true};
  opened_scale_ = coarse ? scale : 1;
  is_preview_ = publisher_.newest() == nullptr && make_preview(simulation_.world(), &request);
  opened_at_ = publisher_.sequence();
  // From the first picture on where its user left it.
  if (name == kFreeCamera) request.X_WC = orbit_ ? orbit_->pose() : free_start_;
  last_attempt_ = Clock::now();
  auto opened = simulation_.open_camera(
      request, [this](std::shared_ptr<const CameraFrame> frame) { publisher_.offer(frame); });
  {
    const std::lock_guard lock(mutex_);
    report_.error = opened.ok() ? "" : opened.error().to_string();
    if (opened.ok()) report_.camera = name;
  }
  if (!opened.ok()) return std::move(opened).error();
  stream_ = std::move(opened).value();
  picture_is_old_ = true;
  last_frame_ = measured_from_ = Clock::now();
  measured_ = 0;
  dropped_before_ = 0;
  added_ = 0;
  return {};
}

bool Driver::is_still() const {
  return simulation_.paused() && !drag_ && Clock::now() - last_moved_ > kStillDelay;
}

/// Coarser pictures while something moves, if the renderer is slow; all pixels when nothing does.
void Driver::adapt_resolution() {
  if (!stream_) return;
  if (simulation_.paused()) {  // the time until it resumes is none that pictures took
    measured_ = 0;
    measured_from_ = Clock::now();
    dropped_before_ = stream_->dropped();
  }
  const auto frame = publisher_.newest();
  if (!frame || frame->camera != camera_ || publisher_.sequence() == opened_at_) return;
  if (is_preview_) {
    if (drag_) do_message(drag_->client, DragEndMessage{});
    reopen(full_width_ > 0 ? scale_.scale() : 1);
    return;
  }
  if (full_width_ == 0) {
    full_width_ = frame->intrinsics.width;
    full_height_ = frame->intrinsics.height;
  }
  const double wanted = is_still() ? 1 : scale_.scale();
  if (std::abs(wanted - opened_scale_) < 1e-9) return;
  const double ratio = wanted / opened_scale_;
  if (reopen(wanted) && drag_) {
    drag_->u *= ratio;
    drag_->v *= ratio;
  }
}

/// A failure is in the report, and keep_camera() tries again.
bool Driver::reopen(double scale) {
  if (camera_ == kFreeCamera && !orbit_) free_start_ = stream_->pose();
  stream_.reset();
  refreshed_at_.reset();
  return open_stream(scale).ok();
}

/// Tells scale_ how long pictures take: between them while the simulation runs, and from the
/// request for one to its arrival while it is paused and the camera moves.
void Driver::measure_pictures(uint64_t pictures) {
  const auto now = Clock::now();
  if (simulation_.paused()) {
    if (is_still() || !refreshed_at_ || full_width_ == 0) return;
    const double seconds = std::chrono::duration<double>(now - last_refresh_).count();
    return scale_.add(seconds, seconds <= PictureScale::kTargetInterval);
  }
  if (is_preview_) return;
  measured_ += static_cast<int>(pictures);
  if (measured_ < kMeasuredPictures) return;
  const double seconds = std::chrono::duration<double>(now - measured_from_).count() / measured_;
  const int64_t dropped = stream_ ? stream_->dropped() : 0;
  scale_.add(seconds, dropped == dropped_before_);
  measured_ = 0;
  measured_from_ = now;
  dropped_before_ = dropped;
}

void Driver::close_camera() {
  stream_.reset();
  publisher_.forget();
  refreshed_at_.reset();
}

void Driver::keep_camera() {
  const auto now = Clock::now();
  bool wanted = false;
  {
    const std::lock_guard lock(mutex_);
    wanted = clients_ > 0 || now - last_client_ < kCameraCloseDelay;
    if (stream_) report_.dropped = stream_->dropped();
    // Pictures that nobody was there to see are not encoded.
    picture_is_old_ |= std::exchange(someone_came_, false);
  }
  if (!wanted && stream_) close_camera();
  // A failure is in the report, where every client sees it.
  if (wanted && !stream_ && now - last_attempt_ > kRetryPeriod) (void)open_camera(camera_).ok();
}

void Driver::follow_pictures() {
  const uint64_t sequence = publisher_.sequence();
  if (sequence == seen_sequence_) return;
  measure_pictures(sequence - seen_sequence_);
  seen_sequence_ = sequence;
  last_frame_ = Clock::now();
  if (!drag_) return;
  follow_drag();
  const auto X_WB = simulation_.body_pose(drag_->body);
  if (X_WB.ok()) reply_(drag_->client, pulled_message(X_WB->p + rotate(X_WB->q, drag_->point_B)));
}

void Driver::refresh_when_due() {
  if (!stream_) return;
  const auto now = Clock::now();
  const uint64_t sequence = seen_sequence_;
  // One refresh at a time: a slow renderer must not be given a queue of them.
  if (refreshed_at_ == sequence && now - last_refresh_ < kRetryPeriod) return;
  refreshed_at_.reset();
  const bool paused = simulation_.paused();
  const bool slow_motion = speed_ < 1 && !paused;
  const bool late = now - last_frame_ > std::chrono::duration<double>(1.5 / options_.rate);
  if (picture_is_old_) added_ = 0;
  // Each refresh of an instant adds samples to its picture.
  const bool more = is_still() && added_ < kStillPictures;
  if (!(picture_is_old_ || slow_motion || more) || !(paused || late)) return;
  if (!picture_is_old_) ++added_;
  picture_is_old_ = false;
  refreshed_at_ = sequence;
  last_refresh_ = now;
  stream_->refresh();
}

OrbitCamera* Driver::free_camera() {
  if (camera_ != kFreeCamera || !stream_) return nullptr;
  if (!orbit_) {
    const Pose X_WC = stream_->pose();
    double distance = distance_to_floor(X_WC);
    if (const auto frame = publisher_.newest()) {
      const auto hit =
          simulation_.pick(*frame, frame->intrinsics.width / 2.0, frame->intrinsics.height / 2.0);
      if (hit.ok()) distance = depth_of(X_WC, hit->point_W);
    }
    orbit_.emplace(X_WC, distance);
  }
  return &*orbit_;
}

void Driver::move_free_camera() {
  stream_->set_pose(orbit_->pose());
  picture_is_old_ = true;
  last_moved_ = Clock::now();
}

void Driver::tell_failure(int64_t client, const Status& status) {
  if (!status.ok()) reply_(client, notice_message(status.error().to_string()));
}

}  // namespace gloam::studio
