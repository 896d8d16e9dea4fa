// Terms measured by rays against the model's colliding geoms, without those of the robot itself.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text.h"
#include "policy/policy_spec.h"
#include "policy/terms/body_pose.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

constexpr size_t kMostRays = 10'000;

/// Geoms that rays of a robot pass through: its own, and those that are only drawn.
class RayFilter {
 public:
  void bind(const TermBinding& binding) {
    const mjModel& m = *binding.model;
    passes_.assign(static_cast<size_t>(m.ngeom), 0);
    for (int g = 0; g < m.ngeom; ++g)
      passes_[static_cast<size_t>(g)] = is_part_of(m, m.geom_bodyid[g], binding.robot->root_body) ||
                                        (m.geom_contype[g] == 0 && m.geom_conaffinity[g] == 0);
  }

  /// Distance to the first other geom along a unit vector [m]; -1 = none within `range`.
  double cast(const mjModel& m, const mjData& d, const mjtNum from[3], const mjtNum direction[3],
              double range) const {
    constexpr int kMostPasses = 64;
    constexpr double kStep = 1e-6;  // [m] past a surface of a geom that the ray passes through
    double travelled = 0;
    for (int i = 0; i < kMostPasses && travelled < range; ++i) {
      mjtNum start[3];
      int geom[1] = {-1};
      mju_addScl3(start, from, direction, travelled);
      const mjtNum hit = mj_ray(&m, &d, start, direction, nullptr, 1, -1, geom, nullptr);
      if (hit < 0 || geom[0] < 0) return -1;
      travelled += hit;
      if (!passes_[static_cast<size_t>(geom[0])]) return travelled <= range ? travelled : -1;
      travelled += kStep;
    }
    return -1;
  }

 private:
  std::vector<uint8_t> passes_;  // (ngeom)
};

/// Heights of the ground on a grid around the base that turns with its heading: base height less
/// the ground's less `offset` [m], as Isaac Lab and legged_gym define them.
class HeightScan final : public Term {
 public:
  struct Grid {
    double length, width;          ///< along x and y [m]
    double resolution;             ///< [m]
    double offset = 0.5;           ///< [m]
    double start = 1, range = 10;  ///< rays begin above the base and end below their beginning [m]
    bool x_fastest = true;
    size_t columns() const { return 1 + static_cast<size_t>(std::lround(length / resolution)); }
    size_t rows() const { return 1 + static_cast<size_t>(std::lround(width / resolution)); }
  };
  explicit HeightScan(const Grid& grid) : grid_(grid) {}
  size_t size() const override { return grid_.columns() * grid_.rows(); }
  bool needs_base() const override { return true; }
  Status bind(const TermBinding& binding) override {
    filter_.bind(binding);
    return {};
  }
  void write(const TermInputs& in, std::span<double> out) override {
    const auto& R = in.robot->R_WB;
    const double heading = std::atan2(R[3], R[0]), c = std::cos(heading), s = std::sin(heading);
    const size_t outer = grid_.x_fastest ? grid_.rows() : grid_.columns();
    const size_t inner = grid_.x_fastest ? grid_.columns() : grid_.rows();
    constexpr mjtNum kDown[3] = {0, 0, -1};
    for (size_t k = 0; k < outer * inner; ++k) {
      const auto column = static_cast<double>(grid_.x_fastest ? k % inner : k / inner);
      const auto row = static_cast<double>(grid_.x_fastest ? k / inner : k % inner);
      const double x = column * grid_.resolution - grid_.length / 2;
      const double y = row * grid_.resolution - grid_.width / 2;
      const mjtNum from[3] = {in.robot->p_WB[0] + c * x - s * y, in.robot->p_WB[1] + s * x + c * y,
                              in.robot->p_WB[2] + grid_.start};
      const double hit = filter_.cast(*in.model, *in.data, from, kDown, grid_.range);
      out[k] = (hit < 0 ? grid_.range : hit) - grid_.start - grid_.offset;
    }
  }
  std::unique_ptr<Term> clone() const override { return std::make_unique<HeightScan>(*this); }

 private:
  Grid grid_;
  RayFilter filter_;
};

/// Distances along the optical axis of a camera of the model [m], by rows from the top left pixel.
class DepthImage final : public Term {
 public:
  struct Image {
    std::string camera;
    size_t width, height;
    double near, far;  ///< [m]; pixels without a surface have `far`
    bool normalized;   ///< (depth - near) / (far - near) - 0.5, as visual policies are trained
  };
  explicit DepthImage(Image image) : image_(std::move(image)) {}
  size_t size() const override { return image_.width * image_.height; }
  Status bind(const TermBinding& binding) override {
    filter_.bind(binding);
    const std::string full = full_name(*binding.robot, image_.camera);
    camera_ = mj_name2id(binding.model, mjOBJ_CAMERA, full.c_str());
    if (camera_ >= 0) return {};
    return Error{ErrorKind::kInput,
                 fmt::format("robot '{}' has no camera '{:.80}', which the policy requires",
                             binding.robot->name, full),
                 {},
                 suggest_name(full, names_of(*binding.model, *binding.robot, mjOBJ_CAMERA))};
  }
  void write(const TermInputs& in, std::span<double> out) override {
    const mjtNum* position = in.data->cam_xpos + 3 * camera_;
    const mjtNum* R_WC = in.data->cam_xmat + 9 * camera_;  // looks along -z, y is up
    const double fovy = in.model->cam_fovy[camera_] * std::numbers::pi / 180;
    const double focal = 0.5 * static_cast<double>(image_.height) / std::tan(0.5 * fovy);  // [px]
    for (size_t k = 0; k < out.size(); ++k) {
      const double u = static_cast<double>(k % image_.width) + 0.5;
      const double v = static_cast<double>(k / image_.width) + 0.5;
      const mjtNum ray_C[3] = {(u - 0.5 * static_cast<double>(image_.width)) / focal,
                               (0.5 * static_cast<double>(image_.height) - v) / focal, -1};
      const double length = mju_norm3(ray_C);
      mjtNum direction[3];
      mju_mulMatVec3(direction, R_WC, ray_C);
      mju_scl3(direction, direction, 1 / length);
      const double hit =
          filter_.cast(*in.model, *in.data, position, direction, image_.far * length);
      const double depth = std::clamp(hit < 0 ? image_.far : hit / length, image_.near, image_.far);
      out[k] = image_.normalized ? (depth - image_.near) / (image_.far - image_.near) - 0.5 : depth;
    }
  }
  std::unique_ptr<Term> clone() const override { return std::make_unique<DepthImage>(*this); }

 private:
  Image image_;
  RayFilter filter_;
  int camera_ = -1;
};

std::unique_ptr<Term> make_height_scan(const TermRequest& request) {
  Settings& s = *request.settings;
  const toml::table& table = *request.table;
  HeightScan::Grid grid{1.6, 1.0, 0.1};
  if (const toml::node* size = table.get("size")) {
    const std::vector<double> numbers = s.numbers(*size, "size");
    if (numbers.size() != 2 || !(numbers[0] >= 0 && numbers[1] >= 0))
      s.fail(size, "size must be [length, width] of the grid in metres");
    else
      grid.length = numbers[0], grid.width = numbers[1];
  }
  grid.resolution = s.number(table, "resolution", 0.1, {.min = 1e-3, .max = 10});
  grid.offset = s.number(table, "offset", grid.offset, {.min = -100, .max = 100});
  grid.start = s.number(table, "start_height", grid.start, {.min = -1, .max = 100});
  grid.range = s.number(table, "range", grid.range, {.min = 0, .max = 1000, .open = true});
  constexpr std::string_view kOrders[] = {"x_fastest", "y_fastest"};
  grid.x_fastest = s.choice(table, "order", kOrders) == 0;
  if (s.ok() && !(grid.length / grid.resolution < kMostRays &&
                  grid.width / grid.resolution < kMostRays && HeightScan(grid).size() <= kMostRays))
    s.fail(&table, fmt::format("height_scan has more than {} rays", kMostRays));
  return s.ok() ? std::make_unique<HeightScan>(grid) : nullptr;
}

std::unique_ptr<Term> make_depth_image(const TermRequest& request) {
  Settings& s = *request.settings;
  const toml::table& table = *request.table;
  DepthImage::Image image;
  image.camera = s.text(table, "camera");
  if (image.camera.empty()) s.fail(&table, "depth_image needs the camera of the model");
  image.width = static_cast<size_t>(s.whole(table, "width", 87, 1, 1000));
  image.height = static_cast<size_t>(s.whole(table, "height", 58, 1, 1000));
  image.near = s.number(table, "near", 0, {.min = 0, .max = 1000});
  image.far = s.number(table, "far", 2, {.min = 0, .max = 1000, .open = true});
  image.normalized = s.flag(table, "normalized", false);
  if (s.ok() && image.near >= image.far) s.fail(&table, "depth_image: near is not below far");
  if (image.width * image.height > kMostRays)
    s.fail(&table, fmt::format("depth_image has more than {} pixels", kMostRays));
  return std::make_unique<DepthImage>(std::move(image));
}

constexpr TermKind kRayTerms[] = {
    {.name = "height_scan",
     .aliases = "height_measurements",
     .unit = "m",
     .doc = "base height less the ground's less an offset, on a grid that turns with the heading",
     .make = make_height_scan,
     .keys = "size resolution offset start_height range order"},
    {.name = "depth_image",
     .aliases = "depth",
     .unit = "m",
     .doc = "depths seen by a camera of the model, by rows",
     .make = make_depth_image,
     .keys = "camera width height near far normalized"},
};

}  // namespace

std::span<const TermKind> ray_terms() { return kRayTerms; }

}  // namespace gloam
