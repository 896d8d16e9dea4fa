#include "policy/onnx/onnx_sizes.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "policy/onnx/onnx_file.h"
#include "policy/onnx/protobuf.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr int64_t kMostNodes = 100'000, kMostTensors = 100'000;
constexpr int kMostDepth = 16;            // graphs within graphs
constexpr uint64_t kLargestElement = 16;  // [B]

/// Bytes of an element by onnx.TensorProto.DataType; unknown types count as the largest.
uint64_t element_bytes(int64_t type) {
  constexpr uint64_t kBytes[] = {16, 4, 1, 1, 2, 2, 4, 8, 16, 1, 2, 8, 4, 8, 8, 16, 2};
  return type >= 0 && type < std::ssize(kBytes) ? kBytes[type] : kLargestElement;
}

/// The first 80 bytes of a name, as text.
std::string short_name(std::string_view name) { return as_utf8(name.substr(0, 80)); }

}  // namespace

/// Bytes of a tensor as the product of its sizes; it stops growing above the limit.
struct OnnxSizes::Size {
  uint64_t bytes = 1;  // without the size of an element
  int64_t type = 0;
  bool is_negative = false;
  std::string text = {};  // "[4, 1099511627776]"

  void add(int64_t dim) {
    if (text.size() < 100) text += fmt::format("{}{}", text.empty() ? "" : ", ", dim);
    is_negative = is_negative || dim < 0;
    const auto size = static_cast<uint64_t>(dim < 0 ? 1 : dim);
    if (size != 0 && bytes > (uint64_t{1} << 60) / size)
      bytes = uint64_t{1} << 60;
    else
      bytes *= size;
  }
  /// One integer, or a packed list.
  bool add(const WireReader& field) {
    if (field.is_integer()) return add(field.integer()), true;
    std::span<const uint8_t> list = field.bytes();
    for (uint64_t value = 0; !list.empty();) {
      if (!take_varint(&list, &value)) return false;
      add(static_cast<int64_t>(value));
    }
    return true;
  }
};

Error damaged_onnx(const fs::path& path) {
  return {ErrorKind::kInput, "the file is damaged or not an ONNX file", {path.string(), 0, 0}};
}

bool OnnxSizes::fail(ErrorKind kind, std::string message, std::string hint) {
  error_ = {kind, std::move(message), {path_.string(), 0, 0}, std::move(hint)};
  return false;
}

bool OnnxSizes::refuse(std::string_view tensor, const std::string& reason) {
  return fail(ErrorKind::kInput, fmt::format("tensor '{}' {}", short_name(tensor), reason),
              fmt::format("all tensors of a policy together may have at most {} MiB",
                          kLargestOnnxTensors >> 20));
}

bool OnnxSizes::damaged() {
  error_ = damaged_onnx(path_);
  return false;
}

bool OnnxSizes::add_size(std::string_view tensor, const Size& size, bool is_data) {
  if (size.is_negative) return refuse(tensor, fmt::format("has a negative size: [{}]", size.text));
  const uint64_t bytes =
      std::min(size.bytes, uint64_t{1} << 60) * std::min(element_bytes(size.type), uint64_t{16});
  if (bytes > kLargestOnnxTensors)
    return refuse(tensor, fmt::format("of size [{}] would take {} MiB", size.text, bytes >> 20));
  if (is_data) bytes_ += bytes;
  if (bytes_ > kLargestOnnxTensors)
    return refuse(tensor, fmt::format("and the tensors before it would take {} MiB", bytes_ >> 20));
  return true;
}

// TensorProto: dims = 1, data_type = 2, name = 8, external_data = 13.
bool OnnxSizes::add_tensor(std::span<const uint8_t> tensor) {
  if (++tensors_ > kMostTensors)
    return fail(ErrorKind::kInput,
                fmt::format("the network has more than {} tensors", kMostTensors));
  Size size;
  std::string_view name;
  std::string location;
  bool is_external = false;
  WireReader field(tensor);
  while (field.next()) {
    if (field.number() == 1 && !size.add(field)) return damaged();
    if (field.number() == 2) size.type = field.integer();
    if (field.number() == 8) name = field.text();
    if (field.number() != 13) continue;
    is_external = true;
    std::string_view key, value;
    WireReader entry(field.bytes());
    while (entry.next()) (entry.number() == 1 ? key : value) = entry.text();
    if (key == "location") location = value;
  }
  if (field.damaged()) return damaged();
  if (!add_size(name, size, true)) return false;
  return !is_external || check_external(name, location);
}

// Weights may be in the network's folder or below it.
bool OnnxSizes::check_external(std::string_view tensor, const std::string& location) {
  std::error_code code;
  const fs::path relative = location.find('\0') == std::string::npos ? fs::path(location) : "";
  const fs::path folder = fs::weakly_canonical(path_.parent_path(), code);
  const fs::path file = fs::weakly_canonical(path_.parent_path() / relative, code);
  bool is_inside =
      !relative.empty() && !relative.is_absolute() && fs::is_regular_file(file, code) && !code &&
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
  for (const fs::path& part : relative) is_inside = is_inside && part != "..";
  if (!is_inside)
    return refuse(tensor, fmt::format("is in the file '{}', which is missing or outside the "
                                      "network's folder",
                                      short_name(location)));
  external_.insert(location);
  const uint64_t bytes = fs::file_size(file, code);
  return bytes <= kLargestOnnxFile ||
         refuse(tensor, fmt::format("is in a file of {} MiB", bytes >> 20));
}

// SparseTensorProto: values = 1, indices = 2, dims = 3. It counts as the dense tensor.
bool OnnxSizes::add_sparse(std::span<const uint8_t> tensor) {
  Size size;
  WireReader field(tensor);
  while (field.next()) {
    if (field.number() == 3 && !size.add(field)) return damaged();
    const bool is_tensor = field.number() == 1 || field.number() == 2;
    if (is_tensor && !add_tensor(field.bytes())) return false;
  }
  return field.damaged() ? damaged() : add_size("", size, true);
}

// ValueInfoProto: name = 1, type = 2; TypeProto: tensor_type = 1; Tensor: elem_type = 1, shape = 2;
// TensorShapeProto: dim = 1; Dimension: dim_value = 1.
bool OnnxSizes::add_value(std::span<const uint8_t> value_info) {
  std::string_view name;
  Size size;
  size.type = 1;
  WireReader field(value_info);
  while (field.next()) {
    if (field.number() == 1) name = field.text();
    if (field.number() != 2) continue;
    WireReader type(field.bytes());
    while (type.next()) {
      if (type.number() != 1) continue;
      WireReader tensor(type.bytes());
      while (tensor.next()) {
        if (tensor.number() == 1) size.type = tensor.integer();
        if (tensor.number() != 2) continue;
        WireReader shape(tensor.bytes());
        while (shape.next()) {
          WireReader dim(shape.bytes());
          while (dim.next())
            if (dim.number() == 1 && dim.is_integer() && dim.integer() >= 0)
              size.add(dim.integer());
        }
      }
    }
  }
  return field.damaged() ? damaged() : add_size(name, size, false);
}

// AttributeProto: t = 5, g = 6, tensors = 10, graphs = 11, sparse_tensor = 22, sparse_tensors = 23.
bool OnnxSizes::add_attribute(std::span<const uint8_t> attribute, int depth) {
  WireReader field(attribute);
  while (field.next()) {
    if (field.is_integer()) continue;
    const uint64_t n = field.number();
    if ((n == 5 || n == 10) && !add_tensor(field.bytes())) return false;
    if ((n == 6 || n == 11) && !add_graph(field.bytes(), depth + 1)) return false;
    if ((n == 22 || n == 23) && !add_sparse(field.bytes())) return false;
  }
  return !field.damaged() || damaged();
}

// NodeProto: op_type = 4, attribute = 5.
bool OnnxSizes::add_node(std::span<const uint8_t> node, int depth) {
  if (++nodes_ > kMostNodes)
    return fail(ErrorKind::kInput,
                fmt::format("the network has more than {} operations", kMostNodes));
  WireReader field(node);
  while (field.next()) {
    const std::string_view op = field.text();
    if (field.number() == 4 && (op == "Loop" || op == "Scan" || op == "SequenceMap"))
      return fail(
          ErrorKind::kUnsupported,
          fmt::format("the network has a {}: its memory and run time would depend on values", op),
          "export the policy for one observation, without loops");
    if (field.number() == 5 && !add_attribute(field.bytes(), depth)) return false;
  }
  return !field.damaged() || damaged();
}

// GraphProto: node = 1, initializer = 5, input = 11, output = 12, value_info = 13,
// sparse_initializer = 15.
bool OnnxSizes::add_graph(std::span<const uint8_t> graph, int depth) {
  if (depth > kMostDepth)
    return fail(ErrorKind::kInput,
                fmt::format("the network nests graphs more than {} deep", kMostDepth));
  WireReader field(graph);
  while (field.next()) {
    if (field.is_integer()) continue;
    const uint64_t n = field.number();
    if (n == 1 && !add_node(field.bytes(), depth)) return false;
    if (n == 5 && !add_tensor(field.bytes())) return false;
    if (n >= 11 && n <= 13 && !add_value(field.bytes())) return false;
    if (n == 15 && !add_sparse(field.bytes())) return false;
  }
  return !field.damaged() || damaged();
}

}  // namespace gloam
