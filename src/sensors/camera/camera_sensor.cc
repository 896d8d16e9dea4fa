#include "sensors/camera/camera_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/log.h"
#include "base/text.h"
#include "geometry/mesh/single.h"
#include "render/film/tone_map.h"
#include "render/kernel/camera/channels.h"
#include "render/scene/pose.h"
#include "sensors/camera/object_boxes.h"
#include "sensors/camera/sample_noise.h"
#include "sensors/timing.h"
#include "sim/loop/step_schedule.h"
#include "world/sensors/camera_rate.h"

namespace gloam {
namespace {

template <class T>
std::vector<float> flatten(const std::vector<T>& values) {
  static_assert(sizeof(T) % sizeof(float) == 0);
  const auto* first = reinterpret_cast<const float*>(values.data());
  return {first, first + values.size() * sizeof(T) / sizeof(float)};
}

// The picture keeps the camera's vertical field of view; a principal point off the centre stays at
// its share.
Intrinsics resized(const Intrinsics& from, int width, int height) {
  Intrinsics to = from;
  if (width <= 0 || height <= 0) return to;
  const double scale = static_cast<double>(height) / from.height;
  to.width = width;
  to.height = height;
  // Panoramas keep what they hold from left to right, too.
  const double across =
      from.lens == LensModel::kEquirectangular ? static_cast<double>(width) / from.width : scale;
  to.fx = from.fx * across;
  to.fy = from.fy * scale;
  to.cx = width * 0.5 + (from.cx - from.width * 0.5) * across;
  to.cy = height * 0.5 + (from.cy - from.height * 0.5) * scale;
  return to;
}

// Checks the numbers of a request.
Status check_numbers(const CameraRequest& request) {
  const auto refuse = [&](const std::string& what) {
    return Error{ErrorKind::kUsage, fmt::format("camera '{}': {}", request.camera, what)};
  };
  if (request.rate.num < 0 || request.rate.den <= 0) return refuse("the rate must be positive");
  constexpr int kMaxSide = 16384;  // [px]
  const int width = request.width, height = request.height;
  const bool own = width == 0 && height == 0;
  if (!own && (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)) {
    return refuse(fmt::format("an image of {} x {} pixels is not in 1 … {} in both dimensions",
                              width, height, kMaxSide));
  }
  const RenderOptions& render = request.render;
  const int least = render.error ? kLeastAdaptiveSpp : 1;
  if (render.samples() < least || render.samples() > 65536) {
    return refuse(
        fmt::format("spp = {} is not in {} … 65536{}", render.samples(), least,
                    render.error ? ", the maximum number of samples per pixel with 'error'" : ""));
  }
  if (render.error && !(*render.error >= 1e-4 && *render.error <= 1))
    return refuse(fmt::format("error = {} is not in 0.0001 … 1", *render.error));
  if (render.error && render.tier_or_default(false) != RenderTier::kPath)
    return refuse("'error' requires the path tier");
  if (const int depth = request.render.max_depth.value_or(1); depth < 1 || depth > 64)
    return refuse(fmt::format("max_depth = {} is not in 1 … 64", depth));
  return {};
}

Result<int> find_camera(const RenderDescription& description, const std::string& name) {
  std::vector<std::string> names;
  for (size_t i = 0; i < description.cameras.size(); ++i) {
    if (description.cameras[i].name == name) return static_cast<int>(i);
    names.push_back(description.cameras[i].name);
  }
  return Error{ErrorKind::kInput,
               fmt::format("there is no camera '{}'", name),
               {},
               suggest_name(name, names)};
}

}  // namespace

int path_depth(const RenderOptions& render, bool has_media) {
  // On a GPU the interactive tier traces whole paths: it keeps the light of many bounces, as its
  // cache does on the CPU. Longer paths have 1 to 2 % of the light of white rooms.
  constexpr int kDefaultDepth = 5, kInteractiveDepth = 8, kDepthInMedia = 24;
  if (render.max_depth) return *render.max_depth;
  if (has_media) return kDepthInMedia;
  return render.tier_or_default(false) == RenderTier::kInteractive ? kInteractiveDepth
                                                                   : kDefaultDepth;
}

Pose to_pose(const Affine3f& X) { return {{X.p.x, X.p.y, X.p.z}, quaternion_of(X)}; }

Pose in_world(const Affine3f& X, const Vec3& origin) {
  Pose out = to_pose(X);
  out.p = in_world(out.p, origin);
  return out;
}

Pose from_origin(const Pose& X_W, const Vec3& origin) {
  return {from_origin(X_W.p, origin), X_W.q};
}

Affine3f to_affine(const Pose& X) {
  const auto& [w, x, y, z] = X.q;
  const auto f = [](double a, double b, double c) {
    return Vec3f{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
  };
  return {f(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
          f(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
          f(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
          f(X.p.x, X.p.y, X.p.z)};
}

CameraSensor::CameraSensor(const RenderDescription& description, int camera,
                           const CameraChannels& channels)
    : description_(description), camera_(camera), channels_(channels) {}

Result<std::unique_ptr<CameraSensor>> CameraSensor::create(const RenderDescription& description,
                                                           const CameraRequest& request,
                                                           uint64_t seed) {
  GLOAM_TRY(const int camera, find_camera(description, request.camera));
  GLOAM_TRY(const CameraChannels channels, CameraChannels::parse(request.outputs));
  GLOAM_TRY_STATUS(check_numbers(request));
  const CameraDescription& described = description.cameras[static_cast<size_t>(camera)];
  std::unique_ptr<CameraSensor> sensor(new CameraSensor(description, camera, channels));
  sensor->intrinsics_ = resized(described.intrinsics, request.width, request.height);
  if (const std::string fault =
          described.intrinsics.orthographic ? "" : lens_fault(sensor->intrinsics_);
      !fault.empty()) {
    return Error{ErrorKind::kInput,
                 fmt::format("camera '{}' at {} x {} pixels: {}", request.camera,
                             sensor->intrinsics_.width, sensor->intrinsics_.height, fault)};
  }
  sensor->rate_ = request.rate.num > 0 ? request.rate : kDefaultCameraRate;
  const double ev100 = request.render.ev100.value_or(static_cast<double>(description.ev100));
  GLOAM_TRY(sensor->models_,
            CameraModels::create(description, camera, sensor->intrinsics_, channels, ev100,
                                 sensor_seed(seed, request.camera)));
  sensor->free_pose_ = sensor->previous_free_pose_ =
      request.X_WC ? to_affine(from_origin(*request.X_WC, description.origin)) : described.X_WC;

  const WeatherDescription& weather = description.weather;
  if (weather.lens_drops > 0 && described.camera >= 0) {
    sensor->drops_.emplace(sensor->intrinsics_, weather.lens_drops, weather.drops_fall_on_lenses,
                           described.aperture_radius, sensor_seed(seed, request.camera));
  }
  RenderSettings& settings = sensor->settings_;
  settings.tier = request.render.tier_or_default(false);
  settings.spp = channels.light() ? request.render.samples() : 0;
  if (request.render.error && channels.light()) {
    // Darker than this fraction of the display's top, an error shows less and less (docs/light.md).
    constexpr float kFloor = 0.05f;
    settings.error = static_cast<float>(*request.render.error);
    settings.error_floor = kFloor * max_luminance(static_cast<float>(sensor->models_->ev100()));
  }
  settings.max_depth = path_depth(request.render, !description.volumes.empty());
  settings.roulette_depth = 2;  // unbiased, and spares the rays of dim paths
  settings.seed = hash_bytes(request.camera.data(), request.camera.size(), seed);
  if (settings.tier == RenderTier::kInteractive && !channels.light())
    settings.tier = RenderTier::kDirect;
  if (request.render.denoise && channels.light() && settings.tier != RenderTier::kInteractive) {
    sensor->denoises_ = true;
    sensor->device_ = request.render.device;
    settings.guide_samples = 4;
    settings.variance = settings.tier == RenderTier::kPath && settings.error <= 0 &&
                        !description.volumes.empty();  // for warn_of_noise()
  }
  const bool details = channels.needs(ChannelSource::kDetails);
  const bool geometry = details || channels.needs(ChannelSource::kSurface);
  settings.cover = channels.needs(ChannelSource::kCover);
  const bool particles = channels.light() && !weather.particles.empty();
  sensor->needs_exact_ = geometry || particles;
  sensor->needs_details_ = details;
  settings.exact_channels = sensor->needs_exact_ || sensor->denoises_;
  settings.exact_details = details || sensor->denoises_;
  return sensor;
}

void CameraSensor::set_progress(std::function<bool(double done)> progress) {
  settings_.progress = std::move(progress);
  denoiser_.reset();  // the next one asks this callback
}

PictureMemory CameraSensor::memory() const {
  const auto pixels =
      static_cast<uint64_t>(intrinsics_.width) * static_cast<uint64_t>(intrinsics_.height);
  // Planes of render/film/film.h and render/cpu/interactive/frame.h; two of the latter and the
  // filter's.
  uint64_t pixel = channels_.light() ? 36 : 0;
  if (settings_.exact_channels) pixel += settings_.exact_details ? sizeof(ExactChannels) : 12;
  if (settings_.error > 0) pixel += 4;
  if (settings_.variance) pixel += sizeof(Vec3f);
  if (settings_.tier == RenderTier::kInteractive) pixel += 400;
  PictureMemory out;
  if (denoises_) {
    // Measured with Open Image Denoise 2.5, which goes over larger pictures in tiles.
    constexpr uint64_t kDenoiser = 600, kTile = uint64_t{2160} * 2160;
    pixel += sizeof(Vec3f);
    out.working = kDenoiser * std::min(pixels, kTile);
  }
  out.working += pixel * pixels + models_->memory();
  out.frame = pixels * channels_.pixel_bytes();
  return out;
}

void CameraSensor::set_free_pose(const Pose& X_WC) {
  const std::lock_guard lock(pose_mutex_);
  free_pose_ = to_affine(from_origin(X_WC, description_.origin));
}

Pose CameraSensor::free_pose() const {
  const std::lock_guard lock(pose_mutex_);
  return in_world(free_pose_, description_.origin);
}

std::shared_ptr<const CameraFrame> CameraSensor::capture(Renderer& renderer, RenderTurns& turns,
                                                         std::span<const PoseFrame* const> keys,
                                                         const PoseFrame& previous,
                                                         int64_t frame_index) {
  const PoseFrame& now = *keys.front();
  CameraView view = view_at(description_, camera_, keys, previous);
  view.intrinsics = intrinsics_;
  view.shutter = shutter(keys);
  view.aperture = {camera().aperture_radius, camera().focus_distance};
  if (camera().camera < 0) {
    const std::lock_guard lock(pose_mutex_);
    view.X_WC_open = free_pose_;
    view.X_WC_keys.clear();
    view.X_WC_previous = previous_free_pose_;
    previous_free_pose_ = free_pose_;
  }
  settings_.frame = draws(view, frame_index);
  begin_samples(view);
  std::vector<Vec3f>* const light = render(renderer, turns, view, keys, previous);
  if (!stats_.finished) return nullptr;
  auto frame = std::make_shared<CameraFrame>();
  convert(now, frame_index, view, light, frame.get());
  if (settings_.progress && !settings_.progress(1)) return nullptr;  // its denoising was ended
  return frame;
}

std::vector<Vec3f>* CameraSensor::render(Renderer& renderer, RenderTurns& turns,
                                         const CameraView& view,
                                         std::span<const PoseFrame* const> keys,
                                         const PoseFrame& previous) {
  std::future<RenderStats> picture;
  {
    const RenderTurn turn(turns, use_);
    settings_.turns = &turns;
    renderer.update(keys, previous);
    if (settings_.tier == RenderTier::kInteractive && history_ == nullptr) {
      history_ = renderer.make_history();
      settings_.history = history_.get();
    }
    plan_finish(renderer);
    picture = renderer.begin(view, settings_, &film_);
  }
  stats_ = picture.get();
  if (!stats_.finished) return nullptr;
  warn_of_noise(renderer);
  accumulate();
  if (!channels_.light() || description_.weather.particles.empty()) return nullptr;
  std::vector<Vec3f>* const light = denoise();
  const RenderTurn turn(turns, use_);
  renderer.update(keys, previous);
  renderer.draw_particles(view, film_, light);
  return light;
}

void CameraSensor::plan_finish(Renderer& renderer) {
  settings_.finish = {};
  settings_.exact_channels = needs_exact_ || denoises_;
  settings_.exact_details = needs_details_ || denoises_;
  if (!channels_.light() || pictures_ > 1) return;  // their mean is denoised
  const bool shows = models_->shows_light() && !channels_.has("radiance") && !drops_ &&
                     description_.weather.particles.empty();
  settings_.finish = {.denoise = denoises_ || settings_.tier == RenderTier::kInteractive,
                      .to_display = shows,
                      .tone = {.ev100 = static_cast<float>(models_->ev100())}};
  if (!renderer.finishes(settings_)) {
    settings_.finish = {};
  } else if (settings_.finish.denoise) {  // its guides are the renderer's own matter
    settings_.exact_channels = needs_exact_;
    settings_.exact_details = needs_details_;
  }
}

uint32_t CameraSensor::draws(const CameraView& view, int64_t frame_index) const {
  if (sensing().events) return 0;
  if (!denoises_ || settings_.tier == RenderTier::kInteractive)
    return static_cast<uint32_t>(frame_index);
  const uint64_t index = draws_by_index_ ? static_cast<uint64_t>(frame_index) : 0;
  return static_cast<uint32_t>(hash_bytes(&view.X_WC_open, sizeof(view.X_WC_open), index));
}

void CameraSensor::begin_samples(const CameraView& view) {
  const bool may = channels_.light() && settings_.tier != RenderTier::kInteractive &&
                   settings_.error <= 0 && sensing().events == std::nullopt;
  constexpr int kMaxAccumulatedSamples = 1 << 20;  // samples, far from the end of an int
  const bool goes_on = may && same_instant_ && pictures_ > 0 &&
                       is_same(view.X_WC_open, accumulated_from_) &&
                       settings_.first_sample < kMaxAccumulatedSamples;
  settings_.first_sample = goes_on ? settings_.first_sample + settings_.spp : 0;
  pictures_ = goes_on ? pictures_ + 1 : 1;
  accumulated_from_ = view.X_WC_open;
}

void CameraSensor::warn_of_noise(Renderer& renderer) {
  if (!settings_.variance || pictures_ > 1) return;
  const int needed = samples_needed(film_, settings_.spp);
  if (needed <= settings_.spp || !renderer.first_to_warn()) return;
  log_warning(
      "camera '{}': {} samples per pixel are too few for the light in this smoke or dust: its "
      "images flicker; use about {} (spp) or the interactive tier",
      camera().name, settings_.spp, needed);
}

void CameraSensor::accumulate() {
  if (pictures_ < 2) return;
  std::vector<Vec3f>* const planes[] = {&film_.radiance, &film_.albedo, &film_.normal};
  const float share = 1.0f / static_cast<float>(pictures_ - 1);
  for (size_t k = 0; k < std::size(planes); ++k) {
    std::vector<Vec3f>& plane = *planes[k];
    std::vector<Vec3f>& sum = sums_[k];
    if (pictures_ == 2) {
      sum = plane;
      continue;
    }
    for (size_t i = 0; i < plane.size(); ++i) {
      sum[i] += plane[i];
      plane[i] = sum[i] * share;
    }
  }
}

std::vector<Vec3f>* CameraSensor::denoise() {
  // Blurred light has blurred albedo and normal, too: means over the same samples. Depth is sharp
  // and no guide.
  const bool blurred = camera().aperture_radius > 0 || camera().exposure_time > 0;
  if (!denoises_ || settings_.finish.denoise) return &film_.radiance;
  if (denoiser_ == nullptr) {
    const bool on_card = renders_on_card(device_);
    denoiser_ = make_denoiser({.device = on_card ? DenoiseDevice::kCuda : DenoiseDevice::kCpu});
    if (const auto& progress = settings_.progress)
      denoiser_->set_may_continue([progress] { return progress(1); });
  }
  std::vector<float> sharp;
  if (blurred) sharp.swap(film_.depth);
  const bool clean = denoiser_->denoise(film_, &clean_).ok();
  if (blurred) sharp.swap(film_.depth);
  return clean ? &clean_ : &film_.radiance;
}

Rational CameraSensor::window() const {
  return exact_rational(camera().exposure_time + camera().readout_time);
}

Shutter CameraSensor::shutter(std::span<const PoseFrame* const> keys) const {
  const double length = keys.back()->time - keys.front()->time;
  if (!(length > 0)) return {.open = 0, .length = 0, .row = 0};
  return {.open = 0,
          .length = static_cast<float>(camera().exposure_time / length),
          .row = static_cast<float>(camera().readout_time / length / intrinsics_.height)};
}

void CameraSensor::convert(const PoseFrame& now, int64_t frame_index, const CameraView& view,
                           std::vector<Vec3f>* light, CameraFrame* frame) {
  frame->camera = camera().name;
  frame->index = frame_index;
  frame->step = now.step;
  frame->time = now.time;
  frame->delivery = models_->delivery_of(frame_index, now.time);
  frame->intrinsics = intrinsics_;
  frame->X_WC = in_world(view.X_WC_open, description_.origin);
  frame->exposure_time = camera().exposure_time;
  frame->readout_time = camera().readout_time;

  if (channels_.light()) {
    if (settings_.finish.to_display) {
      frame->ev100 = models_->ev100();
      frame->rgb = std::move(film_.rgb);
    } else {
      if (light == nullptr) light = denoise();
      if (drops_) drops_->draw(now.time, light);
      models_->develop(*light, now.run, frame);
      if (channels_.has("radiance")) frame->radiance = flatten(*light);
    }
    if (channels_.has("samples")) {
      frame->samples = film_.sample_count;
      frame->samples.resize(film_.pixel_count(), static_cast<uint32_t>(settings_.spp));
    }
  }
  if (channels_.has("depth")) frame->depth = film_.depth;
  if (channels_.has("boxes")) frame->objects = view_objects(description_, now, film_.cover);
  if (channels_.has("distance")) frame->distance = film_.distance;
  if (channels_.has("scene_flow")) frame->scene_flow = flatten(film_.scene_flow);
  if (channels_.has("normal")) frame->normal = flatten(film_.center_normal);
  if (channels_.has("albedo")) frame->albedo = flatten(film_.center_albedo);
  if (channels_.has("motion")) frame->motion = flatten(film_.motion);
  models_->measure(now, film_, view, frame);
  if (channels_.has("segmentation")) {
    frame->part = film_.part;
    frame->part_count = static_cast<uint32_t>(description_.instances.size());
    frame->instance.resize(film_.part.size());
    frame->semantic.resize(film_.part.size());
    for (size_t i = 0; i < film_.part.size(); ++i) {
      if (film_.part[i] == 0) continue;
      const LabelRow& label = description_.instances[film_.part[i] - 1].label;
      frame->instance[i] = label.instance;
      frame->semantic[i] = label.semantic;
    }
  }
}

}  // namespace gloam
