#include "world/sensors/visual_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "scene/camera_lens.h"
#include "world/sensors/hidden_bodies.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr double kDefaultFovy = 45;  // [deg], MuJoCo's
constexpr int kMaxSide = 16384;      // [px]

/// Focal lengths and centre from a vertical field of view: degrees, or metres if orthographic.
void set_fovy(double fovy, Intrinsics* k) {
  k->fy = k->orthographic ? k->height / fovy : 0.5 * k->height / std::tan(0.5 * fovy * kDegree);
  k->fx = k->fy;
  k->cx = 0.5 * k->width;
  k->cy = 0.5 * k->height;
}

CameraDescription model_camera(const mjModel& m, int i, std::vector<Error>* unsupported) {
  CameraDescription camera;
  camera.name = camera_name(m, i);
  camera.camera = i;
  Intrinsics& k = camera.intrinsics;
  k.orthographic = m.cam_projection[i] == mjPROJ_ORTHOGRAPHIC;
  const int width = m.cam_resolution[2 * i], height = m.cam_resolution[2 * i + 1];
  if (width > kMaxSide || height > kMaxSide)
    unsupported->push_back({ErrorKind::kUnsupported,
                            fmt::format("camera '{}' requests {} x {} pixels; {} x {} are rendered",
                                        camera.name, width, height, k.width, k.height)});
  else if (width > 1 && height > 1) {  // 1 x 1 is MuJoCo's "not given"
    k.width = width;
    k.height = height;
  }

  const float* sensor = m.cam_sensorsize + 2 * i;    // [m], (width, height)
  const float* intrinsic = m.cam_intrinsic + 4 * i;  // [m], focal x, y, principal x, y
  const bool has_sensor = sensor[0] > 0 && sensor[1] > 0;
  if (has_sensor && intrinsic[0] > 0 && intrinsic[1] > 0 && !k.orthographic) {
    const double px_x = k.width / static_cast<double>(sensor[0]);
    const double px_y = k.height / static_cast<double>(sensor[1]);
    k.fx = intrinsic[0] * px_x;
    k.fy = intrinsic[1] * px_y;
    // A positive principal offset moves the window right and down over the picture plane, so the
    // axis appears left of and above the middle (measured on MuJoCo's renderer).
    k.cx = 0.5 * k.width - intrinsic[2] * px_x;
    k.cy = 0.5 * k.height - intrinsic[3] * px_y;
    return camera;
  }
  double fovy = m.cam_fovy[i];
  if (!(fovy > 0) || (!k.orthographic && fovy >= 180)) {
    unsupported->push_back({ErrorKind::kUnsupported,
                            fmt::format("camera '{}' has no usable field of view", camera.name),
                            {},
                            "set fovy, or sensorsize with focal; 45 is used"});
    fovy = kDefaultFovy;
  }
  set_fovy(fovy, &k);
  return camera;
}

Result<std::shared_ptr<const std::vector<uint8_t>>> hidden_instances(
    const mjModel& m, const CameraOptions& options, const std::vector<InstanceDescription>& drawn) {
  GLOAM_TRY(const std::vector<uint8_t> bodies,
            hidden_bodies(m, options.hide, fmt::format("camera '{}'", options.name), options.loc));
  std::vector<uint8_t> hidden;
  for (const InstanceDescription& in : drawn)
    hidden.push_back(bodies[static_cast<size_t>(in.body)]);
  return std::make_shared<const std::vector<uint8_t>>(std::move(hidden));
}

CameraDescription free_camera(const mjModel& m, const Framing& framing) {
  CameraDescription camera;
  camera.name = "free";
  Intrinsics& k = camera.intrinsics;
  k.orthographic = m.vis.global.orthographic != 0;
  if (m.vis.global.offwidth > 1 && m.vis.global.offheight > 1 &&
      m.vis.global.offwidth <= kMaxSide && m.vis.global.offheight <= kMaxSide) {
    k.width = m.vis.global.offwidth;
    k.height = m.vis.global.offheight;
  }
  const double fovy = m.vis.global.fovy;
  set_fovy(fovy > 0 && (k.orthographic || fovy < 180) ? fovy : kDefaultFovy, &k);

  const double azimuth = m.vis.global.azimuth * kDegree;
  const double elevation = m.vis.global.elevation * kDegree;
  const double distance = 1.5 * framing.extent;  // MuJoCo's mjv_defaultFreeCamera
  const double forward[3] = {std::cos(elevation) * std::cos(azimuth),
                             std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  const double up[3] = {-std::sin(elevation) * std::cos(azimuth),
                        -std::sin(elevation) * std::sin(azimuth), std::cos(elevation)};
  const auto f = [](double x) { return static_cast<float>(x); };
  camera.X_WC.x = {f(std::sin(azimuth)), f(-std::cos(azimuth)), 0};
  camera.X_WC.y = {f(up[0]), f(up[1]), f(up[2])};
  camera.X_WC.z = {f(-forward[0]), f(-forward[1]), f(-forward[2])};
  camera.X_WC.p = {f(framing.center.x - distance * forward[0]),
                   f(framing.center.y - distance * forward[1]),
                   f(framing.center.z - distance * forward[2])};
  return camera;
}

/// True if <visual><global> gives a direction of view.
bool gives_direction(const mjModel& model) {
  constexpr float kMujocoAzimuth = 90, kMujocoElevation = -45;  // defaults without a direction
  const auto& global = model.vis.global;
  return global.azimuth != kMujocoAzimuth || global.elevation != kMujocoElevation;
}

}  // namespace

std::string camera_name(const mjModel& m, int id) {
  if (const char* own = mj_id2name(&m, mjOBJ_CAMERA, id)) return own;
  std::string name = fmt::format("camera_{}", id);
  while (mj_name2id(&m, mjOBJ_CAMERA, name.c_str()) >= 0) name += '_';
  return name;
}

Status set_optics(const Scene& scene, std::vector<CameraDescription>* cameras) {
  for (const CameraOptions& options : scene.cameras) {
    const auto camera =
        std::find_if(cameras->begin(), cameras->end(),
                     [&](const CameraDescription& c) { return c.name == options.name; });
    if (camera == cameras->end()) continue;
    GLOAM_TRY_STATUS(apply_lens(options, &camera->intrinsics));
    camera->exposure_time = options.exposure_time;
    camera->readout_time = options.readout_time;
    if (!options.lens || !options.lens->f_number) continue;
    camera->aperture_radius =
        static_cast<float>(0.5 * *options.lens->focal_length / *options.lens->f_number);
    camera->focus_distance = static_cast<float>(*options.lens->focus_distance);
  }
  return {};
}

Status set_clips(const CompiledWorld& world, RenderDescription* out) {
  const mjModel& m = *world.model;
  for (CameraDescription& camera : out->cameras) {
    if (!world.scene.bare_model.empty()) {
      camera.near = static_cast<float>(static_cast<double>(m.vis.map.znear) * m.stat.extent);
      camera.culls_backs = true;
    }
    for (const CameraOptions& options : world.scene.cameras) {
      if (options.name != camera.name) continue;
      camera.near = static_cast<float>(options.near);
      if (options.hide.empty()) continue;
      GLOAM_TRY(camera.hidden, hidden_instances(m, options, out->instances));
    }
  }
  return {};
}

ViewDirection free_direction(const mjModel& model) {
  constexpr float kAzimuth = 140, kElevation = -22;
  constexpr auto kRadian = static_cast<float>(kDegree);
  if (!gives_direction(model)) return {kAzimuth * kRadian, kElevation * kRadian};
  return {model.vis.global.azimuth * kRadian, model.vis.global.elevation * kRadian};
}

float steepest_elevation(const mjModel& model) {
  constexpr auto kRadian = static_cast<float>(kDegree);
  constexpr float kSteepest = -50;
  return (gives_direction(model) ? model.vis.global.elevation : kSteepest) * kRadian;
}

void describe_cameras(const mjModel& model, const Framing& framing, RenderDescription* out) {
  for (int i = 0; i < static_cast<int>(model.ncam); ++i)
    out->cameras.push_back(model_camera(model, i, &out->unsupported));
  out->cameras.push_back(free_camera(model, framing));
}

}  // namespace gloam
