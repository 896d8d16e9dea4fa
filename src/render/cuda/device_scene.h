#pragma once
// A scene in the card's memory: what never changes goes there once, the rest in one copy for each
// picture.

#include <map>
#include <vector>

#include "render/cuda/cuda_stages.h"
#include "render/cuda/device_memory.h"
#include "render/cuda/kernels.h"

namespace gloam::cuda {

class DeviceScene {
 public:
  /// The host's tables of meshes have been made anew: forgets what it knows of them.
  void forget() { kept_.clear(); }
  /// Sets picture->scene, camera, clip and tracer, with pointers of the card's. The copy has been
  /// made when the stream has come so far; until then the job's tables must stay as they are.
  void upload(const CudaJob& job, Stream stream, DevicePicture* picture);

 private:
  struct Kept {
    DeviceBuffer buffer;
    size_t bytes = 0;
  };
  /// Buffer that is copied for each picture: first measured, then filled.
  struct Parcel {
    char *host = nullptr, *device = nullptr;
    size_t used = 0;

    const void* put(const void* data, size_t bytes);
    template <class T>
    DeviceSpan<const T> put(DeviceSpan<const T> span);
    template <class T>
    DeviceSpan<const T> put(const std::vector<T>& v);
  };

  template <class T>
  DeviceSpan<const T> keep(DeviceSpan<const T> span);
  const void* keep(const void* data, size_t bytes);
  MeshView keep_mesh(const MeshView& mesh, bool deforms, Parcel* parcel);
  void fill(const CudaJob& job, Parcel* parcel, DevicePicture* picture);
  void upload_trees(const BvhScene& bvh, Stream stream);

  std::map<const void*, Kept> kept_;  ///< by the host's address
  DeviceBuffer parcel_, nodes_, triangles_;
  PinnedBuffer staging_;
  uint64_t bvh_version_ = 0;
};

}  // namespace gloam::cuda
