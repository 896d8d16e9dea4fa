#pragma once
// The path stage for scenes that are not plain, as a wavefront. A kernel for whole paths outgrows
// the instruction cache there, and its lanes part at every material. Here a million paths advance
// by one segment at a time through short kernels, sorted by material between them.

#include "render/cuda/device_memory.h"
#include "render/cuda/kernels.h"

namespace gloam::cuda {

class Wavefront {
 public:
  /// Traces the samples of this launch and puts their means into the picture's film. Returns when
  /// the card has at most the end of it left to do.
  void render(const DevicePicture& picture, Stream stream);

 private:
  DeviceBuffer pool_;
  PinnedBuffer counts_;
};

}  // namespace gloam::cuda
