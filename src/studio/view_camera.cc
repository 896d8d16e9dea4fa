#include "studio/view_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gloam::studio {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRetryPeriod{1000};
constexpr milliseconds kStillDelay{400};  // without a movement, before a picture counts as still
constexpr int kStillPictures = 64;        // that a still picture is the mean of
constexpr int kMeasuredPictures = 3;
constexpr int kPreviewSamples = 4;                    // per pixel, of the first picture
constexpr int kSmallWidth = 160, kSmallHeight = 120;  // [px] of a picture that is made at once

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

ViewCamera::ViewCamera(Simulation& simulation, const ViewOptions& options, Publisher& publisher)
    : simulation_(simulation), options_(options), publisher_(publisher), names_{kFreeCamera} {
  for (auto& name : simulation.camera_names())
    if (name != kFreeCamera) names_.push_back(std::move(name));
}

ViewCamera::Report ViewCamera::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

bool ViewCamera::tick(const Situation& situation) {
  now_ = situation;
  keep_open(situation.is_wanted);
  follow_tracked();
  const bool is_new = follow_pictures();
  adapt_resolution();
  refresh_when_due();
  return is_new;
}

void ViewCamera::invalidate(bool moves) {
  picture_is_old_ = true;
  if (moves) last_moved_ = Clock::now();
}

Status ViewCamera::open(std::string name) {
  // The free camera begins where its user was looking from: the model may have walls.
  if (const auto frame = publisher_.newest(); frame && camera_ != kFreeCamera)
    free_start_ = frame->X_WC;
  if (stream_) close();
  if (name != camera_) full_width_ = full_height_ = 0;
  const std::string before = std::exchange(camera_, std::move(name));
  const Status status = open_stream(full_width_ > 0 ? scale_.scale() : 1);
  if (!status.ok()) camera_ = before;
  return status;
}

Status ViewCamera::open_stream(double scale) {
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

bool ViewCamera::is_still() const {
  return simulation_.paused() && !now_.is_grabbed && Clock::now() - last_moved_ > kStillDelay;
}

/// Coarser pictures while something moves, if the renderer is slow; all pixels when nothing does.
void ViewCamera::adapt_resolution() {
  if (!stream_) return;
  if (simulation_.paused()) {  // the time until it resumes is none that pictures took
    measured_ = 0;
    measured_from_ = Clock::now();
    dropped_before_ = stream_->dropped();
  }
  const auto frame = publisher_.newest();
  if (!frame || frame->camera != camera_ || publisher_.sequence() == opened_at_) return;
  if (is_preview_) return reopen(full_width_ > 0 ? scale_.scale() : 1);
  if (full_width_ == 0) {
    full_width_ = frame->intrinsics.width;
    full_height_ = frame->intrinsics.height;
  }
  const double wanted = is_still() ? 1 : scale_.scale();
  if (std::abs(wanted - opened_scale_) > 1e-9) reopen(wanted);
}

/// A failure is in the report, and keep_open() tries again.
void ViewCamera::reopen(double scale) {
  if (camera_ == kFreeCamera && !orbit_) free_start_ = stream_->pose();
  stream_.reset();
  refreshed_at_.reset();
  static_cast<void>(open_stream(scale));
}

/// Tells scale_ how long pictures take: between them while the simulation runs, and from the
/// request for one to its arrival while it is paused and the camera moves.
void ViewCamera::measure_pictures(uint64_t pictures) {
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

void ViewCamera::close() {
  stream_.reset();
  publisher_.forget();
  refreshed_at_.reset();
}

void ViewCamera::keep_open(bool is_wanted) {
  if (stream_) {
    const std::lock_guard lock(mutex_);
    report_.dropped = stream_->dropped();
  }
  if (!is_wanted && stream_) close();
  // A failure is in the report, where every client sees it.
  if (is_wanted && !stream_ && Clock::now() - last_attempt_ > kRetryPeriod)
    static_cast<void>(open(camera_));
}

/// The camera moves with the body, so it keeps its direction and distance.
void ViewCamera::follow_tracked() {
  if (tracked_.id < 0 || camera_ != kFreeCamera || !stream_) return;
  const Result<Pose> X_WB = simulation_.body_pose(tracked_);
  if (!X_WB.ok()) {  // it is gone
    tracked_ = {};
    return;
  }
  OrbitCamera* camera = free_camera();
  if (camera == nullptr || norm(X_WB->p - camera->pivot()) < 1e-6) return;
  camera->set_pivot(X_WB->p);
  stream_->set_pose(camera->pose());
  invalidate(false);
}

bool ViewCamera::follow_pictures() {
  const uint64_t sequence = publisher_.sequence();
  if (sequence == seen_sequence_) return false;
  measure_pictures(sequence - seen_sequence_);
  seen_sequence_ = sequence;
  last_frame_ = Clock::now();
  return true;
}

void ViewCamera::refresh_when_due() {
  if (!stream_) return;
  const auto now = Clock::now();
  const uint64_t sequence = seen_sequence_;
  // One refresh at a time: a slow renderer must not be given a queue of them.
  if (refreshed_at_ == sequence && now - last_refresh_ < kRetryPeriod) return;
  refreshed_at_.reset();
  const bool paused = simulation_.paused();
  const bool slow_motion = now_.speed < 1 && !paused;
  const bool late = now - last_frame_ > std::chrono::duration<double>(1.5 / options_.rate);
  if (picture_is_old_) added_ = 0;
  // Each refresh of an instant adds samples to its picture.
  const bool more = is_still() && added_ < kStillPictures;
  if (!(picture_is_old_ || slow_motion || more) || !(paused || late)) return;
  if (!picture_is_old_) ++added_;
  picture_is_old_ = false;
  refreshed_at_ = sequence;
  last_refresh_ = now;
  if (now_.shown) {
    stream_->show(now_.shown);
  } else {
    stream_->refresh();
  }
}

OrbitCamera* ViewCamera::free_camera() {
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

void ViewCamera::moved() {
  if (stream_ == nullptr || !orbit_) return;
  stream_->set_pose(orbit_->pose());
  invalidate(true);
}

}  // namespace gloam::studio
