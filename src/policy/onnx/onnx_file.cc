#include "policy/onnx/onnx_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/text.h"
#include "policy/onnx/onnx_sizes.h"
#include "policy/onnx/protobuf.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr size_t kMostMetadata = 1000, kMostPorts = 1000, kMostDims = 16, kMostResults = 200'000;

/// The format of a file that is known and is not ONNX, by its first bytes; "" = none of these.
std::string_view foreign_format(std::span<const uint8_t> bytes) {
  const auto begins = [&](std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char c, uint8_t b) { return static_cast<uint8_t>(c) == b; });
  };
  if (begins("PK\x03\x04"))
    return "a zip archive, as torch.save and torch.jit write it, with pickles";
  // Protocols 2 to 5. No ONNX file begins with 0x80: it would be a field of type VARINT, number 16.
  if (begins("\x80") && bytes.size() > 1 && bytes[1] >= 2 && bytes[1] <= 5)
    return "a Python pickle";
  if (begins("\x89HDF")) return "an HDF5 file";
  if (begins("\x93NUMPY")) return "a NumPy array";
  return {};
}

Error too_many(const fs::path& path, std::string_view what, size_t limit) {
  return {ErrorKind::kInput,
          fmt::format("the network has more than {} {}", limit, what),
          {path.string(), 0, 0}};
}

/// ValueInfoProto; onnx_sizes.cc lists its fields.
OnnxPort read_port(std::span<const uint8_t> value_info) {
  OnnxPort port;
  WireReader field(value_info);
  while (field.next()) {
    if (field.number() == 1) port.name = as_utf8(field.text());
    if (field.number() != 2) continue;
    WireReader type(field.bytes());
    while (type.next()) {
      WireReader tensor(type.bytes());
      while (type.number() == 1 && tensor.next()) {
        if (tensor.number() == 1) port.element_type = tensor.integer();
        WireReader shape(tensor.number() == 2 ? tensor.bytes() : std::span<const uint8_t>());
        while (shape.next() && port.dims.size() <= kMostDims) {
          int64_t& size = port.dims.emplace_back(-1);
          WireReader dim(shape.bytes());
          while (dim.next())
            if (dim.number() == 1 && dim.is_integer()) size = std::max<int64_t>(dim.integer(), -1);
        }
      }
    }
  }
  return port;
}

/// Text of the field `number` of a message, "" if it is missing.
std::string_view text_of(std::span<const uint8_t> message, uint64_t number) {
  std::string_view text;
  WireReader field(message);
  while (field.next())
    if (field.number() == number) text = field.text();
  return text;
}

/// GraphProto: node = 1 (NodeProto: output = 2), initializer = 5, input = 11, output = 12.
Status read_graph(std::span<const uint8_t> graph, OnnxFile* file) {
  std::set<std::string_view> constants;
  std::vector<OnnxPort> inputs;
  WireReader field(graph);
  while (field.next()) {
    if (field.number() == 5) constants.insert(text_of(field.bytes(), 8));
    if (field.number() == 11) inputs.push_back(read_port(field.bytes()));
    if (field.number() == 12) file->outputs.push_back(read_port(field.bytes()));
    if (std::max(inputs.size(), file->outputs.size()) > kMostPorts)
      return too_many(file->path, "inputs or outputs", kMostPorts);
    if (field.number() != 1) continue;
    WireReader node(field.bytes());
    while (node.next())
      if (node.number() == 2 && !node.bytes().empty()) file->results.emplace_back(node.text());
    if (file->results.size() > kMostResults) return too_many(file->path, "results", kMostResults);
  }
  for (OnnxPort& input : inputs) {
    if (input.dims.size() > kMostDims) return too_many(file->path, "dimensions", kMostDims);
    if (!constants.contains(input.name)) file->inputs.push_back(std::move(input));
  }
  return {};
}

}  // namespace

const std::string* OnnxFile::find(std::string_view key) const {
  for (const auto& [name, value] : metadata)
    if (name == key) return &value;
  return nullptr;
}

// ModelProto: graph = 7, metadata_props = 14 (key = 1, value = 2), functions = 25 (node = 7).
Result<OnnxFile> parse_onnx(std::span<const uint8_t> bytes, const fs::path& path) {
  if (const std::string_view format = foreign_format(bytes); !format.empty())
    return Error{ErrorKind::kInput,
                 fmt::format("the file is {}, not a network in the ONNX format", format),
                 {path.string(), 0, 0},
                 "a pickle can run any code and is never read: export the policy with "
                 "torch.onnx.export or the exporter of its framework"};
  OnnxFile file;
  file.path = path;
  OnnxSizes sizes(path);
  bool has_graph = false;
  WireReader field(bytes);
  while (field.next()) {
    if (field.is_integer()) continue;
    if (field.number() == 7) {
      has_graph = true;
      if (!sizes.add_graph(field.bytes())) return sizes.error();
      GLOAM_TRY_STATUS(read_graph(field.bytes(), &file));
    } else if (field.number() == 14) {
      if (file.metadata.size() == kMostMetadata) return too_many(path, "metadata", kMostMetadata);
      file.metadata.emplace_back(as_utf8(text_of(field.bytes(), 1)),
                                 as_utf8(text_of(field.bytes(), 2)));
    } else if (field.number() == 25) {
      WireReader function(field.bytes());
      while (function.next())
        if (function.number() == 7 && !sizes.add_node(function.bytes(), 0)) return sizes.error();
    }
  }
  if (field.damaged() || !has_graph) return damaged_onnx(path);
  file.external = sizes.external();
  return file;
}

}  // namespace gloam
