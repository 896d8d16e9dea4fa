// Paths per second, and the share of a bare Embree loop that traces the very same rays. All figures
// are of CPU time over all threads, medians of alternating runs: they stand on a busy machine.
//   path_rate [--picture FILE.ppm] [--spp N] [--depth N] [--direct] [--plain] [--meshes]
//             [--size WxH] [--runs N] [--export FOLDER] [--json]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include "base/parallel.h"
#include "bench/command_line.h"
#include "bench/room_scene.h"
#include "render/cpu/tracer/embree_build.h"
#include "render/test/probe.h"

using namespace gloam;

namespace {

struct Arguments {
  std::string picture, export_folder;
  RenderSettings settings;
  RoomOptions room;
  int width = 640, height = 480, runs = 5;
  bool json = false;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  CommandLine line(argc, argv);
  if (line.flag("--direct")) a.settings.tier = RenderTier::kDirect;
  if (line.flag("--interactive")) a.settings.tier = RenderTier::kInteractive;
  a.room.plain = line.flag("--plain");
  a.room.meshes = line.flag("--meshes");
  a.json = line.flag("--json");
  line.value("--picture", &a.picture);
  line.value("--export", &a.export_folder);
  line.value("--spp", &a.settings.spp, 0);
  line.value("--runs", &a.runs);
  line.value("--depth", &a.settings.max_depth);
  line.size(&a.width, &a.height);
  return a;
}

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// A quick look: exposure to the logarithmic mean, soft shoulder, sRGB.
void write_ppm(const std::string& path, const Film& film) {
  double mean = 0;  // of the red channel, to compare with peers
  for (const Vec3f& c : film.radiance) mean += std::log(1e-3 + luminance(c));
  const double scale = 0.22 / std::exp(mean / static_cast<double>(film.radiance.size()));
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return;
  std::fprintf(file, "P6 %d %d 255\n", film.width, film.height);
  for (const Vec3f& c : film.radiance) {
    for (int k = 0; k < 3; ++k) {
      double v = c[k] * scale;
      v = v * (1 + v / 16) / (1 + v);
      v = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
      std::fputc(static_cast<int>(std::lround(std::min(1.0, std::max(0.0, v)) * 255)), file);
    }
  }
  std::fclose(file);
}

struct RecordedRay {
  Ray ray;
  bool any;
};

/// Writes down what it traces.
struct RecordingTracer {
  const CpuTracer* tracer;
  std::vector<RecordedRay>* rays;
  bool trace(const Ray& ray, bool any, RayHit* hit) const {
    rays->push_back({ray, any});
    return tracer->trace(ray, any, hit);
  }
  bool closest(const Ray& ray, bool active, bool, RayHit* hit) const {
    return active && trace(ray, false, hit);
  }
  bool occluded(const Ray& ray, bool active) const {
    RayHit hit;
    return active && trace(ray, true, &hit);
  }
};

/// The rays of one sample per pixel of the path tier, in its own order, one list per row; for the
/// interactive tier, the primary and one shadow ray.
std::vector<std::vector<RecordedRay>> record_rays(const Probe& probe, const CameraView& view,
                                                  const RenderSettings& settings) {
  CameraView32 camera;
  camera.fx = camera.fy = static_cast<float>(view.intrinsics.fx);
  camera.cx = static_cast<float>(view.intrinsics.cx);
  camera.cy = static_cast<float>(view.intrinsics.cy);
  camera.pose = {view.X_WC_open, view.X_WC_open, {}};
  std::vector<std::vector<RecordedRay>> rows(static_cast<size_t>(view.intrinsics.height));
  parallel_for("record", view.intrinsics.height, [&](int64_t y) {
    const RecordingTracer tracer{&probe.tracer, &rows[static_cast<size_t>(y)]};
    for (int x = 0; x < view.intrinsics.width; ++x) {
      Sampler sampler =
          Sampler::make(1, 0, static_cast<uint32_t>(x), static_cast<uint32_t>(y), 0, 0);
      const Vec2f offset = sample_pixel_filter(sampler.next_2d());
      RayCone cone;
      const Ray ray = camera_ray(camera, static_cast<float>(x) + 0.5f + offset.x,
                                 static_cast<float>(y) + 0.5f + offset.y, 0, &cone);
      if (settings.tier != RenderTier::kPath) {
        DirectState state;
        direct_start(&state, ray, cone, sampler);
        const int most = settings.tier == RenderTier::kInteractive ? 2 : 1 << 20;
        bool going = true;
        for (int i = 0; going && i < most; ++i) {
          RayHit hit;
          const bool found = tracer.trace(state.ray, state.any, &hit);
          going = direct_advance(probe.view, &state, found, hit, [](const auto&...) {});
        }
      } else {
        trace_path(probe.view, tracer, ray, cone.width, cone.spread, {settings.max_depth, 100},
                   sampler);
      }
    }
  });
  return rows;
}

/// Triangles of an instance in world coordinates.
TriangleMesh world_mesh(const SceneBuilder& b, const InstanceDescription& in) {
  TriangleMesh mesh;
  if (in.shape == ShapeType::kMesh) {
    mesh = b.description.meshes[static_cast<size_t>(in.mesh)];
  } else if (in.shape == ShapeType::kBox) {
    mesh = make_box(in.size);
  } else {  // curved shapes: a fine ball squeezed to the bounds is work enough alike
    mesh = make_ball(24);
    const Vec3f h = in.shape == ShapeType::kSphere ? Vec3f{in.size.x, in.size.x, in.size.x}
                                                   : Vec3f{in.size.x, in.size.x, in.size.y};
    for (Vec3f& v : mesh.positions) v = v * h;
  }
  const double* p = &b.frame.body_p[3 * static_cast<size_t>(in.body)];
  const double* R = &b.frame.body_R[9 * static_cast<size_t>(in.body)];
  Affine3f X_WB;
  X_WB.x = {static_cast<float>(R[0]), static_cast<float>(R[3]), static_cast<float>(R[6])};
  X_WB.y = {static_cast<float>(R[1]), static_cast<float>(R[4]), static_cast<float>(R[7])};
  X_WB.z = {static_cast<float>(R[2]), static_cast<float>(R[5]), static_cast<float>(R[8])};
  X_WB.p = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  const Affine3f X = X_WB * in.X_BG;
  for (Vec3f& v : mesh.positions) v = transform_point(X, v);
  for (Vec3f& n : mesh.normals) n = transform_vector(X, n);
  return mesh;
}

/// Embree and nothing else: all triangles in one scene, with its default settings.
class BareEmbree {
 public:
  explicit BareEmbree(const SceneBuilder& b)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_.get())) {
    for (const InstanceDescription& in : b.description.instances) {
      const TriangleMesh mesh = world_mesh(b, in);
      const RtcOwner<RTCGeometry> geometry(
          rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
      const auto fill = [&](RTCBufferType type, RTCFormat format, const void* data, size_t count) {
        void* out = rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, 12, count);
        std::memcpy(out, data, 12 * count);
      };
      fill(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions.data(), mesh.positions.size());
      fill(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.indices.data(), mesh.triangle_count());
      rtcCommitGeometry(geometry.get());
      rtcAttachGeometry(scene_.get(), geometry.get());
    }
    rtcCommitScene(scene_.get());
  }

  void trace(const std::vector<std::vector<RecordedRay>>& rows) const {
    parallel_for("bare", static_cast<int64_t>(rows.size()), [&](int64_t row) {
      for (const RecordedRay& r : rows[static_cast<size_t>(row)]) {
        EmbreeQuery embree;
        RTCRayHit query;
        query.ray = {r.ray.o.x, r.ray.o.y, r.ray.o.z,  0,   r.ray.d.x, r.ray.d.y,
                     r.ray.d.z, 0,         r.ray.tmax, ~0u, 0,         0};
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (r.any) {
          embree.occluded(scene_.get(), &query.ray);
        } else {
          embree.intersect(scene_.get(), &query);
        }
      }
    });
  }

 private:
  RtcOwner<RTCDevice> device_;
  RtcOwner<RTCScene> scene_;
};

/// Meshes as PLY in world coordinates and a text list of them, for bench/peers/mitsuba_room.py.
void export_scene(const std::string& folder, const SceneBuilder& b, const CameraView& view) {
  std::FILE* list = std::fopen((folder + "/scene.txt").c_str(), "w");
  if (list == nullptr) return;
  const Affine3f& C = view.X_WC_open;
  std::fprintf(list, "camera %d %d %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n",
               view.intrinsics.width, view.intrinsics.height, view.intrinsics.fy, C.p.x, C.p.y,
               C.p.z, -C.z.x, -C.z.y, -C.z.z, C.y.z);
  for (size_t i = 0; i < b.description.instances.size(); ++i) {
    const InstanceDescription& in = b.description.instances[i];
    const MaterialDescription& m = b.description.materials[static_cast<size_t>(in.material)];
    const TriangleMesh mesh = world_mesh(b, in);
    const std::string name = "shape" + std::to_string(i) + ".ply";
    std::FILE* ply = std::fopen((folder + "/" + name).c_str(), "wb");
    if (ply == nullptr) break;
    const bool smooth = !mesh.normals.empty();
    std::fprintf(ply, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n",
                 mesh.positions.size());
    std::fprintf(ply, "property float x\nproperty float y\nproperty float z\n");
    if (smooth) std::fprintf(ply, "property float nx\nproperty float ny\nproperty float nz\n");
    std::fprintf(ply, "element face %zu\nproperty list uchar int vertex_indices\nend_header\n",
                 mesh.triangle_count());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      std::fwrite(&mesh.positions[v], sizeof(Vec3f), 1, ply);
      if (smooth) std::fwrite(&mesh.normals[v], sizeof(Vec3f), 1, ply);
    }
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
      const uint8_t three = 3;
      std::fwrite(&three, 1, 1, ply);
      std::fwrite(&mesh.indices[t], sizeof(uint32_t), 3, ply);
    }
    std::fclose(ply);
    std::fprintf(list, "shape %s %d %.9g %.9g %.9g %.9g %.9g %.9g\n", name.c_str(), smooth ? 1 : 0,
                 m.base_color.x, m.base_color.y, m.base_color.z, m.emission.x, m.emission.y,
                 m.emission.z);
  }
  std::fclose(list);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a = parse(argc, argv);
  const SceneBuilder builder = make_room(a.room);
  const CameraView view = room_camera(a.width, a.height);
  if (!a.export_folder.empty()) export_scene(a.export_folder, builder, view);
  const double start = wall_seconds();
  auto renderer = builder.make();
  const double build = wall_seconds() - start;
  const Probe probe(builder);
  const BareEmbree bare(builder);

  const auto history = renderer->make_history();
  a.settings.history = history.get();
  PoseFrame now = builder.frame, before = now;
  Film film;
  a.settings.exact_channels = !a.picture.empty();
  const auto rays = record_rays(probe, view, a.settings);
  size_t recorded = 0;
  for (const auto& row : rays) recorded += row.size();
  std::vector<double> render_cpu, render_wall, bare_cpu;
  RenderStats stats;
  for (int i = 0; i < a.runs; ++i) {
    double cpu = cpu_seconds(), wall = wall_seconds();
    if (a.settings.tier == RenderTier::kInteractive) {  // the robot walks
      std::swap(before, now);
      now = builder.frame;
      for (size_t body = 1; 3 * body < now.body_p.size(); ++body) now.body_p[3 * body] += 0.02 * i;
      renderer->update(now, now, before);
      a.settings.frame = static_cast<uint32_t>(i);
    }
    stats = renderer->render(view, a.settings, &film);
    render_cpu.push_back(cpu_seconds() - cpu);
    render_wall.push_back(wall_seconds() - wall);
    cpu = cpu_seconds();
    bare.trace(rays);
    bare_cpu.push_back(cpu_seconds() - cpu);
  }
  const double paths = static_cast<double>(stats.paths), threads = thread_count();
  const double per_path = static_cast<double>(recorded) / (a.width * a.height);
  const double cpu_per_path = median(render_cpu) / paths;
  const double bare_per_path = median(bare_cpu) / (a.width * a.height);
  const double rate = threads / cpu_per_path * 1e-6, bare_rate = threads / bare_per_path * 1e-6;
  double mean = 0;  // of the red channel, to compare with peers
  for (const Vec3f& c : film.radiance) mean += c.x;
  mean /= static_cast<double>(film.radiance.size());
  if (a.json) {
    std::printf(
        "{\"name\": \"path_rate\", \"rays_per_path\": %.4f, \"mpaths_per_s\": %.4f, "
        "\"bare_mpaths_per_s\": %.4f, \"wall_ms\": %.2f, \"cpu_ms\": %.2f, \"cpu_over_bare\": "
        "%.4f, "
        "\"mean\": %.4f}\n",
        per_path, rate, bare_rate, median(render_wall) * 1e3, median(render_cpu) * 1e3,
        median(render_cpu) / median(bare_cpu), mean);
  } else {
    std::printf("build %.0f ms; %d threads; wall %.1f ms; CPU %.1f ms per picture\n", build * 1e3,
                thread_count(), median(render_wall) * 1e3, median(render_cpu) * 1e3);
    std::printf(
        "%.2f rays/path; %.3f Mpaths/s at %.0f full threads; bare Embree %.3f Mpaths/s "
        "(%.1f Mrays/s); share %.1f %%\n",
        per_path, rate, threads, bare_rate, per_path * bare_rate, 100 * rate / bare_rate);
    std::printf("CPU time / bare loop %.3f; %.2f rays/path traced\n",
                median(render_cpu) / median(bare_cpu), static_cast<double>(stats.rays) / paths);
    std::printf("mean %.4f\n", mean);
  }
  if (!a.picture.empty()) write_ppm(a.picture, film);
}
