#include <utility>

#include "sim/effects/gas/cuda/cuda_momentum.h"
#include "sim/effects/gas/cuda/launch.cuh"
#include "sim/effects/gas/kernel/carry.h"
#include "sim/effects/gas/kernel/forces.h"

namespace gloam::gas {
namespace {

Faces<float> faces_in(DeviceArray<float> (&f)[3]) { return {f[0].get(), f[1].get(), f[2].get()}; }

/// Sets a cell, and the ghosts beside it.
__device__ void put(const Shape& s, float* f, int i, int j, int k, float value) {
  const int c = s.at(i, j, k);
  f[c] = value;
  if (i == 0) f[c - 1] = value;
  if (i == s.nx - 1) f[c + 1] = value;
  if (j == 0) f[c - s.sy] = value;
  if (j == s.ny - 1) f[c + s.sy] = value;
  if (k == 0) f[c - s.sz] = value;
  if (k == s.nz - 1) f[c + s.sz] = value;
}

__device__ void put(const Shape& s, const Faces<float>& f, int i, int j, int k, Vec3f value) {
  put(s, f.x, i, j, k, value.x);
  put(s, f.y, i, j, k, value.y);
  put(s, f.z, i, j, k, value.z);
}

void find_centres(const Shape& s, const Faces<const float>& u, float scale, float limit,
                  const Faces<float>& to, cudaStream_t stream) {
  const float half = 0.5f * scale;
  for_cells(s, stream, [s, u, half, limit, to] __device__(int i, int j, int k) {
    put(s, to, i, j, k, carrier_velocity(s, u, s.at(i, j, k), half, limit));
  });
}

struct Walls {
  Faces<const float> open;
  const uint8_t* clearance;
  const uint8_t* solid;
};

void find_paths(const Shape& s, const Walls& walls, const Faces<const float>& centre,
                const Faces<float>& moved, float* trusted, cudaStream_t stream) {
  for_cells(s, stream, [s, walls, centre, moved, trusted] __device__(int i, int j, int k) {
    const Carrier v{s, centre};
    const int c = s.at(i, j, k);
    Vec3f d = displacement(v, i, j, k);
    bool trust = true;
    if (comes_near_walls(d, {centre.x[c], centre.y[c], centre.z[c]}, walls.clearance[c])) {
      d = {};
      trust = !walls.solid[c] && displacement_near_walls(v, walls.open, i, j, k, &d);
    }
    put(s, moved, i, j, k, d);
    put(s, trusted, i, j, k, trust ? 1.0f : 0.0f);
  });
}

void find_smoothness(const Shape& s, const Faces<const float>& v, float* smooth,
                     cudaStream_t stream) {
  for_cells(s, stream, [s, v, smooth] __device__(int i, int j, int k) {
    put(s, smooth, i, j, k, smoothness_at(s, v, s.at(i, j, k)));
  });
}

void carry_component(const CarryView& v, float drift, cudaStream_t stream) {
  const Shape faces = v.shape.faces(v.axis);
  for_cells(faces, stream, [v] __device__(int i, int j, int k) { carry_face(v, i, j, k); });
  for_cells(faces, stream, [v] __device__(int i, int j, int k) { correct_face(v, i, j, k); });
  for (int side = 0; side < 2; ++side) {
    const float inward = side == 0 ? v.wind : -v.wind;
    if (!(inward > 0.0f)) continue;
    const float share = min(inward * drift, 1.0f);
    Shape plane = faces;
    (v.axis == 0 ? plane.nx : (v.axis == 1 ? plane.ny : plane.nz)) = 1;
    const int far = side == 0 ? 0 : v.shape.n(v.axis) * v.stride;
    for_cells(plane, stream, [v, far, share] __device__(int i, int j, int k) {
      const int c = v.shape.at(i, j, k) + far;
      v.corrected[c] = let_in(v, c, share);
    });
  }
}

void lift_faces(const LiftView& v, float* u, cudaStream_t stream) {
  for_cells(v.shape.faces(2), stream, [v, u] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    u[c] += lift(v, c);
  });
}

void find_curl(const Shape& s, const Faces<const float>& v, float* length, cudaStream_t stream) {
  for_cells(s, stream, [s, v, length] __device__(int i, int j, int k) {
    const Vec3f w = curl(s, v, s.at(i, j, k));
    put(s, length, i, j, k, sqrtf(dot(w, w)));
  });
}

void find_confinement(const Shape& s, const Faces<const float>& v, const float* length,
                      const float* smooth, const Faces<float>& to, cudaStream_t stream) {
  for_cells(s, stream, [s, v, length, smooth, to] __device__(int i, int j, int k) {
    const int c = s.at(i, j, k);
    put(s, to, i, j, k, confinement(s, v, length, c) * (1.0f - smooth[c]));
  });
}

void spin_up(const Shape& s, const Faces<const float>& open, const Faces<const float>& f,
             const Faces<float>& u, float scale, cudaStream_t stream) {
  for_faces(s, stream, [s, open, f, u, scale] __device__(int axis, int c) {
    const float* of = f[axis];
    u[axis][c] += open[axis][c] * scale * (of[c] + of[c - s.stride(axis)]);
  });
}

}  // namespace

CudaMomentum::CudaMomentum(const Openings& openings, cudaStream_t stream)
    : shape_(openings.shape), stream_(stream) {
  for (int n = 0; n < 6; ++n) side_open_[n] = openings.side_open[n] ? 1.0f : 0.0f;
  const size_t size = size_t(shape_.size());
  for (int a = 0; a < 3; ++a) centre_[a].reserve(size), moved_[a].reserve(size);
  for (auto* f : {&smooth_, &trusted_, &carried_, &least_, &most_, &corrected_}) f->reserve(size);
}

void CudaMomentum::take_walls(const Openings& openings) {
  clearance_.assign(openings.clearance, stream_);
  solid_.assign(openings.solid, stream_);
}

void CudaMomentum::trace(const Faces<const float>& open, const Faces<const float>& velocity,
                         float voxel, float dt) {
  const Faces<float> centre = faces_in(centre_);
  find_centres(shape_, velocity, dt / voxel, float(kReach), centre, stream_);
  find_paths(shape_, {open, clearance_.get(), solid_.get()}, centre.read(), faces_in(moved_),
             trusted_.get(), stream_);
  find_smoothness(shape_, centre.read(), smooth_.get(), stream_);
}

void CudaMomentum::carry(const Faces<const float>& open, DeviceArray<float> (&velocity)[3],
                         float voxel, float dt, Vec3f wind) {
  for (int a = 0; a < 3; ++a) {
    CarryView v{shape_,
                a,
                shape_.stride(a),
                wind[a],
                {},
                faces_in(moved_).read(),
                faces_in(centre_).read(),
                trusted_.get(),
                open[a],
                velocity[a].get(),
                carried_.get(),
                least_.get(),
                most_.get(),
                corrected_.get()};
    for (int n = 0; n < 6; ++n) v.side[n] = side_open_[n];
    carry_component(v, dt / (voxel * kInflow), stream_);
    velocity[a].swap(corrected_);
  }
}

void CudaMomentum::lift(const Faces<const float>& open, const Faces<float>& velocity,
                        const float* heat, const float* smoke, float ambient_density, float dt,
                        uint32_t count) {
  lift_faces({shape_, open.z, smooth_.get(), heat, smoke, ambient_density, dt, count}, velocity.z,
             stream_);
}

void CudaMomentum::confine(const Faces<const float>& open, const Faces<float>& velocity,
                           float strength, float dt) {
  const Faces<float> centre = faces_in(centre_), force = faces_in(moved_);
  float* const length = trusted_.get();
  find_centres(shape_, velocity.read(), 1.0f, 1e6f, centre, stream_);
  find_curl(shape_, centre.read(), length, stream_);
  find_confinement(shape_, centre.read(), length, smooth_.get(), force, stream_);
  // curl() holds two voxels of length and so does its gradient: one voxel of each is left.
  spin_up(shape_, open, force.read(), velocity, 0.25f * strength * dt, stream_);
}

}  // namespace gloam::gas
