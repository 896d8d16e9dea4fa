#pragma once
// Grids of numbers in files: NumPy's .npy, version 1 to 3 (NumPy Enhancement Proposal 1).

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Values of a box's voxels, x fastest: (nz x ny x nx).
struct VolumeFile {
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> values;  ///< finite, >= 0
};

/// An array of little-endian float32 or float64 in C order with the shape (nz, ny, nx). `name` is
/// for messages. Errors: another type or shape, damaged, more than `max_voxels`, values below zero
/// or not finite. Memory is asked for after the size of the file bears the shape out.
Result<VolumeFile> decode_npy(std::span<const uint8_t> bytes, const std::string& name,
                              uint64_t max_voxels);

/// The same from a file. Its head is checked before the rest is read.
Result<VolumeFile> read_npy(const std::filesystem::path& path, uint64_t max_voxels);

}  // namespace gloam
