#pragma once
// Limits on a stranger's model file. All of them are checked before memory is allocated.

#include <cstdint>

namespace gloam {

struct ModelLimits {
  uint64_t file_bytes = uint64_t{4} << 30;     ///< size of one file
  uint64_t decoded_bytes = uint64_t{8} << 30;  ///< size of all that a model file unpacks to
  uint64_t vertices = uint64_t{1} << 28;       ///< vertices of one mesh
  uint64_t triangles = uint64_t{1} << 28;      ///< triangles of one mesh
  uint64_t instances = uint64_t{1} << 20;
  uint64_t meshes = uint64_t{1} << 20;
  uint64_t materials = uint64_t{1} << 16;
  uint64_t external_files = 4096;
};

/// JSON of glTF: how many values there may be. A value takes up to about 100 bytes in memory.
inline constexpr uint64_t kMaxJsonValues = uint64_t{8} << 20;
/// Data without a buffer (glTF: an accessor that is all zeros but for a sparse part).
inline constexpr uint64_t kMaxZeroElements = uint64_t{1} << 20;
/// Concave polygons with more corners are refused: cutting them up takes quadratic time.
inline constexpr uint32_t kMaxConcaveCorners = 1024;
/// Lines of text files [bytes].
inline constexpr uint64_t kMaxLine = uint64_t{1} << 20;
/// Names and notes that are kept.
inline constexpr uint64_t kMaxName = 1024;
inline constexpr uint64_t kMaxNotes = 64;

}  // namespace gloam
