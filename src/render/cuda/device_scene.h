#pragma once
// A scene in the card's memory: what never changes goes there once, the rest in one copy for each
// picture.

#include <map>
#include <vector>

#include "render/cuda/cuda_stages.h"
#include "render/cuda/device_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/parcel.h"

namespace gloam::cuda {

class DeviceScene {
 public:
  /// Forgets all tables on the device, because the host has rebuilt its tables of meshes.
  void forget() { kept_.clear(); }
  /// Sets picture->scene, camera, clip and tracer, with pointers of the card's. The copy has been
  /// made when the stream has come so far;
  /// `staging` is free again then, the job's tables at once.
  void upload(const CudaJob& job, Stream stream, PinnedBuffer* staging, DevicePicture* picture);

 private:
  struct Kept {
    DeviceBuffer buffer;
    size_t bytes = 0;
  };
  template <class T>
  DeviceSpan<const T> keep(DeviceSpan<const T> span);
  const void* keep(const void* data, size_t bytes);
  MeshView keep_mesh(const MeshView& mesh, bool deforms, Parcel* parcel);
  void fill(const CudaJob& job, Parcel* parcel, DevicePicture* picture);
  template <class T>
  void upload_tree(const std::vector<T>& from, size_t fresh, Parcel* parcel, DeviceBuffer* to);
  void fill_all(const CudaJob& job, Parcel* parcel, DevicePicture* picture);

  std::map<const void*, Kept> kept_;  ///< by the host's address
  /// Part of a parcel that replaces the beginning of a tree's array.
  struct TreePart {
    const void* from = nullptr;
    DeviceBuffer* to = nullptr;
    size_t bytes = 0;
  };
  ParcelPlace place_;
  DeviceBuffer nodes_, triangles_;
  std::vector<TreePart> parts_;
  uint64_t bvh_version_ = 0;
};

}  // namespace gloam::cuda
