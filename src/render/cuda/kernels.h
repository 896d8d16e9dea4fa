#pragma once
// Interface of the host to the card: plain structures that both compilers see, and the launches.

#include "render/kernel/camera/view_clip.h"
#include "render/kernel/light/ambient_path.h"
#include "render/kernel/path/path_state.h"
#include "render/kernel/trace/bvh_tracer.h"

struct CUstream_st;

namespace gloam {

/// Channels in device memory, one entry per pixel; null = not wanted.
struct DeviceFilm {
  Vec3f* radiance = nullptr;
  Vec3f* squares = nullptr;  ///< sums of squared differences from the mean; at the end the variance
  Vec3f* albedo = nullptr;
  Vec3f* normal = nullptr;
  float* depth = nullptr;
  float* distance = nullptr;
  uint32_t* part = nullptr;
  Vec3f* center_normal = nullptr;
  Vec3f* center_albedo = nullptr;
  Vec2f* motion = nullptr;
  Vec3f* scene_flow = nullptr;
  float* clear = nullptr;  ///< with the guides: luminance of the transmittance before the surface
  uint8_t* rgb = nullptr;
  unsigned long long* rays = nullptr;  ///< one number: traced so far
};

/// Arguments of all kernels for one picture of one world. Pointers are device pointers.
struct DevicePicture {
  SceneView scene;
  BvhTracer tracer;
  CameraView32 camera;
  ViewClip clip;
  PathOptions path;
  DeviceFilm film;
  int width = 0, height = 0;
  uint64_t seed = 1;
  uint32_t frame = 0, log2_samples = 0;
  int first_sample = 0, samples = 0;  ///< of this launch
  int done = 0;                       ///< samples of earlier launches, in the film
  int split = 1;                      ///< warps that share a pixel's samples: 1, 2 or 4
  bool last = true;                   ///< launch: the film is finished
  bool has_motion = false;            ///< something moves while the shutter is open
  bool centered = false;  ///< direct stage: its sample answers for the exact channels too
};

/// Pixels that the exact channels are made for: all, those of kUnknownPart, or instead of channels
/// the denoiser's guides, with `samples` rays at edges.
enum class ChannelRays : uint8_t { kAll, kUnknown, kGuides };

/// Value that the direct stage leaves in `part` where the exact channels need rays of their own.
inline constexpr uint32_t kUnknownPart = ~0u;

namespace cuda {

using Stream = CUstream_st*;

// Kernels for plain pictures, and for any; the paths of any others are in wavefront.h. Those of
// paths are compiled with fast arithmetic; those of exact channels round as on the CPU.
void launch_plain_path(const DevicePicture& picture, Stream stream);
void launch_plain_direct(const DevicePicture& picture, Stream stream);
void launch_full_direct(const DevicePicture& picture, Stream stream);
void launch_plain_channels(const DevicePicture& picture, ChannelRays rays, Stream stream);
void launch_full_channels(const DevicePicture& picture, ChannelRays rays, Stream stream);
/// Measures the ambient light of any picture by (1 << kLog2AmbientPaths) paths.
void launch_ambient(const DevicePicture& picture, AmbientPath* paths, AmbientCube* ambient,
                    Stream stream);

}  // namespace cuda
}  // namespace gloam
