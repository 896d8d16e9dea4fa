// Other people's robots are drawn complete: what the segmentation shows is what MuJoCo's own scene
// would draw and MuJoCo's own rays hit, pixel for pixel.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <set>

#include "robots.h"
#include "runtime/rendering/shared_renderer.h"
#include "scene/test/temp_folder.h"
#include "scenes.h"
#include "sensors/camera/camera_sensor.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

constexpr int kWidth = 96, kHeight = 72;

/// The geoms that MuJoCo's visualiser draws with its default options.
std::set<int> drawn_by_mujoco(const mjModel& m, mjData* d) {
  mjvOption option;
  mjvPerturb perturb;
  mjvCamera camera;
  mjvScene scene;
  mjv_defaultOption(&option);
  mjv_defaultPerturb(&perturb);
  mjv_defaultFreeCamera(&m, &camera);
  mjv_defaultScene(&scene);
  mjv_makeScene(&m, &scene, 20000);
  mjv_updateScene(&m, d, &option, &perturb, &camera, mjCAT_ALL, &scene);
  std::set<int> geoms;
  for (int i = 0; i < scene.ngeom; ++i) {
    if (scene.geoms[i].objtype == mjOBJ_GEOM) geoms.insert(scene.geoms[i].objid);
  }
  mjv_freeScene(&scene);
  return geoms;
}

/// The geom behind each part of the segmentation: rows of the label table are in the model's order
/// and leave out what is fully transparent.
std::vector<int> geoms_of_parts(const mjModel& m, const std::vector<LabelRow>& labels) {
  std::vector<int> geoms = {-1};
  for (int g = 0; g < m.ngeom; ++g) {
    const int material = m.geom_matid[g];
    const float* own = m.geom_rgba + 4 * g;
    // MuJoCo takes the material's colour unless the geom has one that is not the default grey.
    const bool default_color = own[0] == 0.5f && own[1] == 0.5f && own[2] == 0.5f && own[3] == 1;
    const float alpha = material >= 0 && default_color ? m.mat_rgba[4 * material + 3] : own[3];
    if (alpha > 0) geoms.push_back(g);
  }
  EXPECT_EQ(geoms.size(), labels.size() + 1);
  for (size_t part = 1; part < std::min(geoms.size(), labels.size() + 1); ++part) {
    const auto name = [&](int kind, int id) {
      const char* text = mj_id2name(&m, kind, id);
      return std::string(text != nullptr ? text : "");
    };
    const int g = geoms[part];
    EXPECT_EQ(labels[part - 1].part, part);
    const auto expect_name = [](const std::string& label, const std::string& own) {
      if (own.empty())
        EXPECT_TRUE(label.starts_with("body ") || label == "world") << label;
      else
        EXPECT_EQ(label, own);
    };
    expect_name(labels[part - 1].geom, name(mjOBJ_GEOM, g));
    expect_name(labels[part - 1].body, name(mjOBJ_BODY, m.geom_bodyid[g]));
  }
  return geoms;
}

/// A free camera of a paused Simulation, through the public API.
class Viewpoint {
 public:
  explicit Viewpoint(Simulation& simulation) {
    CameraRequest request{.camera = "free", .width = kWidth, .height = kHeight};
    request.outputs = {"segmentation", "depth"};
    auto stream = simulation.open_camera(request, [this](auto frame) {
      const std::lock_guard lock(mutex_);
      frame_ = std::move(frame);
      changed_.notify_all();
    });
    EXPECT_TRUE(stream.ok()) << stream.error().to_string();
    stream_ = std::move(*stream);
  }
  ~Viewpoint() { stream_.reset(); }

  std::shared_ptr<const CameraFrame> look_from(Vec3 eye, Vec3 at) {
    stream_->set_pose(looking(eye, at));
    stream_->refresh();
    std::unique_lock lock(mutex_);
    const bool came = changed_.wait_for(lock, std::chrono::seconds(60), [&] {
      return frame_ != nullptr && std::abs(frame_->X_WC.p.x - eye.x) < 1e-5 &&
             std::abs(frame_->X_WC.p.y - eye.y) < 1e-5 && std::abs(frame_->X_WC.p.z - eye.z) < 1e-5;
    });
    EXPECT_TRUE(came) << "no picture came";
    return frame_;
  }

 private:
  static Pose looking(Vec3 eye, Vec3 at) {
    double back[3] = {eye.x - at.x, eye.y - at.y, eye.z - at.z}, right[3], up[3];
    mju_normalize3(back);
    const double vertical[3] = {0, 0, 1}, sideways[3] = {1, 0, 0};
    mju_cross(right, std::abs(back[2]) < 0.99 ? vertical : sideways, back);
    mju_normalize3(right);
    mju_cross(up, back, right);
    const double R[9] = {right[0], up[0],    back[0], right[1], up[1],
                         back[1],  right[2], up[2],   back[2]};
    double q[4];
    mju_mat2Quat(q, R);
    return {eye, {q[0], q[1], q[2], q[3]}};
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const CameraFrame> frame_;
  std::unique_ptr<CameraStream> stream_;
};

/// Length of the part of a ray before one geom, -1 = it misses.
double distance_to_geom(const mjModel& m, const mjData& d, int g, const double p[3],
                        const double v[3]) {
  if (m.geom_type[g] == mjGEOM_MESH) return mj_rayMesh(&m, &d, g, p, v, nullptr);
  return mju_rayGeom(d.geom_xpos + 3 * g, d.geom_xmat + 9 * g, m.geom_size + 3 * g, p, v,
                     m.geom_type[g], nullptr);
}

struct Tally {
  std::vector<int> hit_by_rays, drawn;  // pixels of each geom over all views
  int compared = 0, equal = 0, coincident = 0;
};

/// Each pixel of our segmentation against MuJoCo's ray through its centre.
void compare(const mjModel& m, const mjData& d, const CameraFrame& frame,
             const std::vector<int>& geoms, Tally* tally) {
  const mjtByte drawn_groups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
  const Intrinsics& k = frame.intrinsics;
  const double p[3] = {frame.X_WC.p.x, frame.X_WC.p.y, frame.X_WC.p.z};
  const double q[4] = {frame.X_WC.q.w, frame.X_WC.q.x, frame.X_WC.q.y, frame.X_WC.q.z};
  for (int y = 0; y < k.height; ++y) {
    for (int x = 0; x < k.width; ++x) {
      const double v_C[3] = {(x + 0.5 - k.cx) / k.fx, -(y + 0.5 - k.cy) / k.fy, -1};
      double v[3];
      mju_rotVecQuat(v, v_C, q);
      int expected = -1;
      const double distance = mj_ray(&m, &d, p, v, drawn_groups, 1, -1, &expected, nullptr);
      const size_t pixel =
          static_cast<size_t>(y) * static_cast<size_t>(k.width) + static_cast<size_t>(x);
      const uint32_t part = frame.part[pixel];
      ASSERT_LT(part, geoms.size());
      const int geom = geoms[part];
      if (expected >= 0) ++tally->hit_by_rays[static_cast<size_t>(expected)];
      if (geom >= 0) ++tally->drawn[static_cast<size_t>(geom)];
      if (expected < 0 && geom < 0) continue;
      ++tally->compared;
      if (expected == geom) {
        ++tally->equal;
      } else if (expected >= 0 && geom >= 0) {
        const double ours = distance_to_geom(m, d, geom, p, v);
        tally->coincident += std::abs(ours - distance) < 1e-4 * distance;
      }
    }
  }
}

/// Pixels of one instance when nothing else is drawn, seen from six sides. `center`, `radius`: of
/// its bounding sphere [m].
int64_t pixels_alone(const RenderDescription& whole, size_t instance, const PoseFrame& poses,
                     const double* center, double radius) {
  RenderDescription alone = whole;
  for (size_t i = 0; i < alone.instances.size(); ++i) {
    if (i != instance) alone.instances[i].shown = false;
  }
  auto renderer = make_cpu_renderer(alone);
  EXPECT_TRUE(renderer.ok());
  (*renderer)->update(poses, poses, poses);
  const PoseFrame* const keys[] = {&poses};
  CameraView view = view_at(alone, static_cast<int>(alone.cameras.size()) - 1, keys, poses);
  view.intrinsics = {64, 64, 64, 64, 32, 32};
  RenderSettings settings;
  settings.spp = 0;
  const Vec3f axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  int64_t pixels = 0;
  for (int i = 0; i < 6; ++i) {
    const Vec3f back = axes[i % 3] * (i < 3 ? 1.0f : -1.0f), right = axes[(i + 1) % 3];
    Affine3f X_WC{right, cross(back, right), back, {}};
    X_WC.p = Vec3f{static_cast<float>(center[0]), static_cast<float>(center[1]),
                   static_cast<float>(center[2])} +
             back * static_cast<float>(3 * radius);
    view.X_WC_open = view.X_WC_previous = X_WC;
    Film film;
    (*renderer)->render(view, settings, &film);
    pixels += std::count(film.part.begin(), film.part.end(), instance + 1);
  }
  return pixels;
}

class DrawnComplete : public ThirdPartyRobot {};

TEST_P(DrawnComplete, EveryGeomInViewIsInTheSegmentation) {
  const StockModel& stock = *stock_;
  const mjModel& m = *stock.model;
  mjData* d = stock.data.get();
  const World world = compile_file(file_);
  auto simulation = Simulation::create(world, {});
  ASSERT_TRUE(simulation.ok()) << simulation.error().to_string();
  const auto labels = (*simulation)->labels();
  ASSERT_TRUE(labels.ok());
  const std::vector<int> geoms = geoms_of_parts(m, *labels);

  Tally tally;
  tally.hit_by_rays.resize(static_cast<size_t>(m.ngeom));
  tally.drawn = tally.hit_by_rays;
  std::set<int> expected;
  // As it stands, and with its joints moved by a while of random inputs.
  for (const int64_t steps : {0, 200}) {
    for (int64_t step = 0; step < steps; ++step) {
      const RandomInputs inputs(m, step);
      inputs.write(m, d);
      mj_step(&m, d);
      ASSERT_TRUE(inputs.post(**simulation, step).ok());
      ASSERT_TRUE((*simulation)->step(1).ok());
    }
    mj_forward(&m, d);
    expected = drawn_by_mujoco(m, d);
    const double* c = d->subtree_com;
    const double radius = 1.3 * m.stat.extent;
    Viewpoint viewpoint(**simulation);
    constexpr int kViews = 14;
    for (int i = 0; i < kViews; ++i) {
      // A Fibonacci sphere: even in all directions, below included.
      const double z = 1 - (2 * i + 1.0) / kViews, phi = i * M_PI * (3 - std::sqrt(5.0));
      const double r = std::sqrt(1 - z * z) * radius;
      const Vec3 eye{c[0] + r * std::cos(phi), c[1] + r * std::sin(phi), c[2] + radius * z};
      const auto frame = viewpoint.look_from(eye, {c[0], c[1], c[2]});
      ASSERT_NE(frame, nullptr);
      ASSERT_NO_FATAL_FAILURE(compare(m, *d, *frame, geoms, &tally));
    }
  }
  EXPECT_GT(tally.compared, 5000);
  // Edges of meshes fall on one side of a pixel's centre or the other by the last bits of a float.
  const int wrong = tally.compared - tally.equal - tally.coincident;
  EXPECT_LE(wrong, tally.compared / 1000);
  RecordProperty("pixels", tally.compared);
  RecordProperty("equal", tally.equal);
  RecordProperty("coincident", tally.coincident);

  std::vector<int> hidden;
  for (int g = 0; g < m.ngeom; ++g) {
    const auto i = static_cast<size_t>(g);
    const char* name = mj_id2name(&m, mjOBJ_GEOM, g);
    const std::string who = "geom " + std::to_string(g) + " '" + (name != nullptr ? name : "") +
                            "' in group " + std::to_string(m.geom_group[g]);
    if (!expected.count(g)) {
      EXPECT_EQ(tally.drawn[i], 0) << who << " is drawn, and MuJoCo hides it";
    } else if (tally.drawn[i] == 0) {
      EXPECT_LE(tally.hit_by_rays[i], 2) << who << " is in view and not drawn";
      hidden.push_back(g);
    }
  }
  RecordProperty("drawn_geoms", static_cast<int>(expected.size()));
  RecordProperty("hidden_geoms", static_cast<int>(hidden.size()));

  // What others hide is there once they are gone.
  auto shared = SharedRenderer::create(world.compiled());
  ASSERT_TRUE(shared.ok());
  auto solver = PoseSolver::create(world.compiled());
  ASSERT_TRUE(solver.ok());
  PoseFrame poses;
  ASSERT_TRUE((*solver)->solve((*simulation)->latest(), poses).ok());
  for (const int g : hidden) {
    const auto part = std::find(geoms.begin(), geoms.end(), g) - geoms.begin();
    ASSERT_GT(part, 0) << "geom " << g << " has no part";
    EXPECT_GT(pixels_alone((*shared)->description, static_cast<size_t>(part) - 1, poses,
                           d->geom_xpos + 3 * g, m.geom_rbound[g]),
              0)
        << "geom " << g << " is not drawn even alone";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Robots, DrawnComplete,
    ::testing::Values(kGo1, kG1, kYam, kPanda,
                      "robosuite/robosuite/models/assets/robots/ur5e/robot.xml",
                      "robosuite/robosuite/models/assets/robots/baxter/robot.xml",
                      "robosuite/robosuite/models/assets/robots/spot/robot.xml"),
    robot_name);

}  // namespace
}  // namespace gloam
