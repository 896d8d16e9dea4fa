#pragma once
// Builds RenderDescriptions and the PoseFrames that go with them by hand, for tests and benches.

#include <memory>
#include <string>

#include "base/check.h"
#include "render/renderer.h"

namespace gloam {

/// C at `eye` looks at `target`; +Y up as near to world Z as can be.
inline Affine3f look_at(Vec3f eye, Vec3f target) {
  const Vec3f z = normalize(eye - target);
  const Vec3f up = std::fabs(z.z) > 0.999f ? Vec3f{0, 1, 0} : Vec3f{0, 0, 1};
  const Vec3f x = normalize(cross(up, z));
  return {x, cross(z, x), z, eye};
}

/// Rotation by `angle` [rad] about a unit axis, then a shift.
inline Affine3f rigid(Vec3f axis, float angle, Vec3f p) {
  const float s = std::sin(angle), c = std::cos(angle);
  const auto turn = [&](Vec3f v) {
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
  };
  return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1}), p};
}

inline Affine3f translation(Vec3f p) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, p}; }

/// Of the path tier, with variances.
inline RenderSettings settings_of(int spp, int depth = 5) {
  RenderSettings s;
  s.spp = spp;
  s.max_depth = depth;
  s.variance = true;
  return s;
}

class SceneBuilder {
 public:
  SceneBuilder() { add_body({}); }

  int add_body(const Affine3f& X_WB) {
    frame.body_p.resize(frame.body_p.size() + 3);
    frame.body_R.resize(frame.body_R.size() + 9);
    const int body = static_cast<int>(frame.body_p.size() / 3) - 1;
    set_body(&frame, body, X_WB);
    return body;
  }
  static void set_body(PoseFrame* frame, int body, const Affine3f& X_WB) {
    double* p = &frame->body_p[3 * static_cast<size_t>(body)];
    double* R = &frame->body_R[9 * static_cast<size_t>(body)];
    for (int i = 0; i < 3; ++i) {
      p[i] = X_WB.p[i];
      R[3 * i] = X_WB.x[i];
      R[3 * i + 1] = X_WB.y[i];
      R[3 * i + 2] = X_WB.z[i];
    }
  }

  int add_material(const MaterialDescription& material) {
    description.materials.push_back(material);
    return static_cast<int>(description.materials.size()) - 1;
  }
  /// Lambertian.
  int add_diffuse(Vec3f color) {
    MaterialDescription m;
    m.base_color = color;
    m.specular_weight = 0;
    return add_material(m);
  }
  int add_emitter(Vec3f luminance) {
    MaterialDescription m;
    m.base_color = {0, 0, 0};
    m.specular_weight = 0;
    m.emission = luminance;
    return add_material(m);
  }
  int add_texture(Image8 image) {
    description.textures.push_back({"texture", {std::move(image)}});
    return static_cast<int>(description.textures.size()) - 1;
  }
  int add_mesh(TriangleMesh mesh) {
    description.meshes.push_back(std::move(mesh));
    return static_cast<int>(description.meshes.size()) - 1;
  }
  /// On body 0 it is static.
  int add(ShapeType shape, Vec3f size, const Affine3f& X_BG, int material, int body = 0,
          int mesh = -1) {
    InstanceDescription in;
    in.shape = shape;
    in.size = size;
    in.X_BG = X_BG;
    in.material = material;
    in.body = body;
    in.is_static = body == 0;
    in.mesh = mesh;
    description.instances.push_back(in);
    return static_cast<int>(description.instances.size()) - 1;
  }
  int add_light(LightDescription light, Vec3f p, Vec3f direction = {0, 0, -1}) {
    light.light = static_cast<int>(frame.light_p.size() / 3);
    for (int i = 0; i < 3; ++i) {
      frame.light_p.push_back(p[i]);
      frame.light_dir.push_back(direction[i]);
    }
    description.lights.push_back(light);
    return light.light;
  }

  static CameraView camera(const Affine3f& X_WC, int width, int height, double fovy_degrees = 45) {
    CameraView view;
    view.intrinsics.width = width;
    view.intrinsics.height = height;
    view.intrinsics.fy = view.intrinsics.fx = 0.5 * height / std::tan(fovy_degrees * kPi / 360);
    view.intrinsics.cx = 0.5 * width;
    view.intrinsics.cy = 0.5 * height;
    view.X_WC_open = view.X_WC_previous = X_WC;
    return view;
  }

  /// A renderer of the description as it stands, updated to `frame`.
  std::unique_ptr<Renderer> make() const {
    auto renderer = make_cpu_renderer(description);
    GLOAM_CHECK(renderer.ok(), "the test's scene is refused");
    (*renderer)->update(frame, frame, frame);
    return std::move(*renderer);
  }
  Film render(const CameraView& view, const RenderSettings& settings) const {
    Film film;
    make()->render(view, settings, &film);
    return film;
  }

  RenderDescription description;
  PoseFrame frame;
};

/// The twelve triangles of a box, without normals.
inline TriangleMesh make_box(Vec3f half) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.positions.push_back({(k & 1) != 0 ? half.x : -half.x, (k & 2) != 0 ? half.y : -half.y,
                              (k & 4) != 0 ? half.z : -half.z});
  }
  mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

/// A sphere of `rings` x 2 `rings` quads, smooth normals and uvs; radius 1 + bumps.
inline TriangleMesh make_ball(int rings, float bump = 0, int bumps = 5) {
  TriangleMesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const float theta = kPi * static_cast<float>(i) / static_cast<float>(rings);
      const float phi = 2 * kPi * static_cast<float>(j % columns) / static_cast<float>(columns);
      const Vec3f n{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    std::cos(theta)};
      const float k = static_cast<float>(bumps);
      const float r = 1 + bump * std::sin(k * n.x) * std::cos(k * n.y) * std::sin(k * n.z + 1);
      mesh.positions.push_back(n * r);
      mesh.normals.push_back(n);
      mesh.uvs.push_back({static_cast<float>(j) / static_cast<float>(columns),
                          1 - static_cast<float>(i) / static_cast<float>(rings)});
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < columns; ++j) {
      const auto at = [columns](int a, int b) {
        return static_cast<uint32_t>(a * (columns + 1) + b);
      };
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i < rings - 1) {
        mesh.indices.insert(mesh.indices.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  if (bump != 0) {  // normals of the bumpy surface
    std::vector<Vec3f> sum(mesh.positions.size());
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
      const Vec3f a = mesh.positions[mesh.indices[t]];
      const Vec3f n =
          cross(mesh.positions[mesh.indices[t + 1]] - a, mesh.positions[mesh.indices[t + 2]] - a);
      for (int k = 0; k < 3; ++k) sum[mesh.indices[t + k]] += n;
    }
    for (int i = 0; i <= rings; ++i) {  // the seam's two columns are one
      const size_t a = static_cast<size_t>(i) * (columns + 1), b = a + columns;
      sum[a] = sum[b] = sum[a] + sum[b];
    }
    for (size_t i = 0; i < sum.size(); ++i) {
      if (length(sum[i]) > 0) mesh.normals[i] = normalize(sum[i]);
    }
  }
  return mesh;
}

/// Checkerboard of `squares` x `squares` over `size` x `size` texels, RGB.
inline Image8 make_checker(int size, int squares, uint8_t a, uint8_t b) {
  Image8 image{size, size, 3, ColorSpace::kSrgb, {}};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const uint8_t v = ((x * squares / size + y * squares / size) & 1) != 0 ? b : a;
      image.texels.insert(image.texels.end(), {v, v, v});
    }
  }
  return image;
}

}  // namespace gloam
