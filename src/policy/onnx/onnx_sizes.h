#pragma once
// Sizes that an ONNX file declares, added up while it is read.

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam {

/// Checks tensors and graphs of one file. All functions return false once a check has failed; then
/// error() has the reason.
class OnnxSizes {
 public:
  explicit OnnxSizes(std::filesystem::path path) : path_(std::move(path)) {}

  /// A GraphProto with all that it contains; `depth`: graphs around it.
  bool add_graph(std::span<const uint8_t> graph, int depth = 0);
  /// A NodeProto.
  bool add_node(std::span<const uint8_t> node, int depth);

  /// Files of weights, relative to the folder of the network.
  const std::set<std::string>& external() const { return external_; }
  const Error& error() const { return error_; }

 private:
  bool fail(ErrorKind kind, std::string message, std::string hint = {});
  bool refuse(std::string_view tensor, const std::string& reason);
  bool damaged();
  bool add_tensor(std::span<const uint8_t> tensor);
  bool add_sparse(std::span<const uint8_t> tensor);
  bool add_value(std::span<const uint8_t> value_info);
  bool add_attribute(std::span<const uint8_t> attribute, int depth);
  bool check_external(std::string_view tensor, const std::string& location);

  struct Size;
  bool add_size(std::string_view tensor, const Size& size, bool is_data);

  std::filesystem::path path_;
  uint64_t bytes_ = 0;
  int64_t nodes_ = 0, tensors_ = 0;
  std::set<std::string> external_;
  Error error_;
};

/// The error of a file that is not ONNX.
Error damaged_onnx(const std::filesystem::path& path);

}  // namespace gloam
