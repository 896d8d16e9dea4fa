#pragma once
// The head of a PLY file (Turk, "The PLY Polygon File Format", 1994). Not for others.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh/model_source.h"

namespace gloam {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;
  std::optional<PlyType> count_type;  ///< a list, and the type of its length
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
  bool has_lists() const;
  /// Bytes of one of it in a binary file; of lists, only their lengths.
  size_t least_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  uint64_t bytes = 0;  ///< size of the head
  uint64_t lines = 0;
};

size_t size_of(PlyType type);
Result<PlyHeader> read_ply_header(const ModelSource& source);

}  // namespace gloam
