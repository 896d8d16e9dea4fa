#pragma once
// Light of a scene's first image on disk, so that the next start with the same scene, instant and
// camera has it at once. The image is the same, bit for bit.

#include <cstdint>
#include <functional>
#include <vector>

#include "base/archive.h"
#include "render/kernel/camera/camera.h"

namespace gloam {

/// Hash of all that the light in the cells of a first image depends on: the scene's content, the
/// camera, the image's size [px] and the seed. 0: this compiler cannot make one.
uint64_t light_key(const SceneView& scene, const CameraView32& camera, int width, int height,
                   uint64_t seed);

/// Cells from which an entry is worth its file.
inline constexpr size_t kLightWorthKeeping = 500;

/// Reads the entry of `key` by calling `read`. False: there is none, or it is not whole.
bool load_light(uint64_t key, const std::function<void(ArchiveReader&)>& read);
/// Keeps what `write` gives; written later, by another thread.
void keep_light(uint64_t key, const std::function<void(ArchiveWriter&)>& write);

}  // namespace gloam
