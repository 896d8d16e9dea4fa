#include "render/cuda/cuda_history.h"

#include <algorithm>

namespace gloam::cuda {
namespace {

/// Samples of a pixel in a picture.
constexpr int kUsualSamples = 1;
/// Samples of a first picture, which has no history, in those of usual ones.
constexpr int kFirstPictures = 16;
/// Pictures whose samples belong to one well-spread sequence.
constexpr int kLog2Sequence = 6;

bool is_at(const Affine3f& a, const Affine3f& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.p == b.p;
}

}  // namespace

InteractiveSamples CudaHistory::begin(const CameraView32& camera, int width, int height) {
  if (width != width_ || height != height_ || !is_at(camera.pose.X_WC_previous, X_WC_)) {
    pictures_ = 0;
    width_ = width;
    height_ = height;
  }
  const bool is_first = pictures_ == 0;
  weight_ = is_first ? kFirstPictures : 1;
  InteractiveSamples out;
  out.count = is_first ? kFirstPictures * kUsualSamples : kUsualSamples;
  const uint32_t in_sequence = pictures_ % (1u << kLog2Sequence);
  // A first picture has a sequence of its own: so do each of the following groups.
  out.frame = is_first ? 0 : 1 + pictures_ / (1u << kLog2Sequence);
  out.first = is_first ? 0 : static_cast<int>(in_sequence) * kUsualSamples;
  while ((1 << out.log2_samples) < (kUsualSamples << kLog2Sequence)) ++out.log2_samples;
  return out;
}

TemporalPlanes CudaHistory::place(DeviceBuffer* buffer) const {
  const size_t n = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  TemporalPlanes out;
  const auto each = [&](DeviceLayout* layout) {
    layout->put(&out.light, n);
    layout->put(&out.recent, n);
    layout->put(&out.noisy, n);
    layout->put(&out.square, n);
    layout->put(&out.age, n);
    layout->put(&out.distance, n);
    layout->put(&out.part, n);
    layout->put(&out.normal, n);
  };
  DeviceLayout measured;
  each(&measured);
  DeviceLayout layout(buffer->reserve(measured.bytes()));
  each(&layout);
  return out;
}

void CudaHistory::add(const CameraView32& camera, const Vec3f* noisy, DeviceFilm* film,
                      Stream stream) {
  const size_t n = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  TemporalPicture p;
  p.width = width_;
  p.height = height_;
  p.camera = camera;
  p.radiance = film->radiance;
  p.noisy = noisy;
  p.albedo = film->center_albedo;
  p.part = film->part;
  p.clear = film->clear;
  p.motion = film->motion;
  p.scene_flow = film->scene_flow;
  p.before = place(&planes_[pictures_ % 2]);
  p.now = place(&planes_[(pictures_ + 1) % 2]);
  p.has_before = pictures_ > 0;
  p.weight = weight_;
  p.color = color_.reserve_of<Vec3f>(n);
  p.shown = shown_.reserve_of<Vec3f>(n);
  p.blocks = blocks_.reserve_of<BlockLight>(static_cast<size_t>(p.block_columns()) *
                                            static_cast<size_t>(p.block_rows()));
  const auto copy = [&](auto* to, const auto* from) {
    check(cudaMemcpyAsync(to, from, n * sizeof *to, cudaMemcpyDeviceToDevice, stream),
          "cannot copy in GPU memory");
  };
  copy(p.now.distance, film->distance);
  copy(p.now.normal, film->center_normal);
  launch_temporal(p, stream);
  check(cudaGetLastError(), "cannot launch a CUDA kernel");
  film->radiance = p.shown;
  X_WC_ = camera.pose.X_WC_open;
  ++pictures_;
}

}  // namespace gloam::cuda
