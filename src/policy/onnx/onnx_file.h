#pragma once
// ONNX files (onnx.proto3 of github.com/onnx/onnx), read without creating any tensor: a file may be
// untrusted, and a hundred bytes can declare terabytes.

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gloam/result.h"

namespace gloam {

inline constexpr uint64_t kLargestOnnxFile = uint64_t{512} << 20;     // [B]
inline constexpr uint64_t kLargestOnnxTensors = uint64_t{256} << 20;  // [B], all of a file

/// An input or output of the network.
struct OnnxPort {
  std::string name;
  int64_t element_type = 0;   ///< onnx.TensorProto.DataType; 1 = f32
  std::vector<int64_t> dims;  ///< -1 = open or named
};

struct OnnxFile {
  std::filesystem::path path;
  std::vector<std::pair<std::string, std::string>> metadata;
  std::vector<OnnxPort> inputs;  ///< without those that have a constant value
  std::vector<OnnxPort> outputs;
  std::vector<std::string> results;  ///< names of the results of all operations of the main graph
  std::set<std::string> external;    ///< files of weights, relative to its folder

  /// Value of a key of the metadata; null if it is missing.
  const std::string* find(std::string_view key) const;
};

/// Reads the declarations of a file's bytes. Errors: a file of another kind (pickles are named as
/// such); a damaged or too large file; tensors of more than kLargestOnnxTensors; weights outside of
/// the file's folder; operations that repeat others (Loop, Scan), whose cost no size bounds.
Result<OnnxFile> parse_onnx(std::span<const uint8_t> bytes, const std::filesystem::path& path);

}  // namespace gloam
