#pragma once
// ONNX files of tests, made by hand in the wire format: field numbers of onnx.proto3.

#include <cstdint>
#include <string>
#include <vector>

#include "policy/onnx/protobuf.h"

namespace gloam {

/// A field of type VARINT.
inline std::string wire_number(uint64_t field, uint64_t value) {
  std::string out;
  for (uint64_t v : {field << 3, value}) {
    for (; v >= 0x80; v >>= 7) out.push_back(static_cast<char>(v | 0x80));
    out.push_back(static_cast<char>(v));
  }
  return out;
}

/// TensorProto of f32. Without `values` it declares its size and contains nothing.
inline std::string onnx_tensor(const std::string& name, const std::vector<int64_t>& dims,
                               const std::vector<float>& values = {}) {
  std::string out;
  for (const int64_t dim : dims) out += wire_number(1, static_cast<uint64_t>(dim));
  out += wire_number(2, 1) + wire_field(8, name);
  if (!values.empty())
    out += wire_field(9, {reinterpret_cast<const char*>(values.data()), values.size() * 4});
  return out;
}

/// ValueInfoProto of f32; -1 = a dimension named "batch".
inline std::string onnx_port(const std::string& name, const std::vector<int64_t>& dims) {
  std::string shape;
  for (const int64_t dim : dims)
    shape += wire_field(
        1, dim < 0 ? wire_field(2, "batch") : wire_number(1, static_cast<uint64_t>(dim)));
  return wire_field(1, name) +
         wire_field(2, wire_field(1, wire_number(1, 1) + wire_field(2, shape)));
}

inline std::string onnx_node(const std::string& op, const std::vector<std::string>& inputs,
                             const std::string& output, const std::string& attribute = "") {
  std::string out;
  for (const std::string& input : inputs) out += wire_field(1, input);
  out += wire_field(2, output) + wire_field(4, op);
  return attribute.empty() ? out : out + wire_field(5, attribute);
}

struct OnnxGraph {
  std::vector<std::string> nodes, tensors, inputs, outputs;
};

/// ModelProto with opset 17.
inline std::string onnx_model(const OnnxGraph& graph, const std::string& more = "") {
  std::string g;
  for (const std::string& node : graph.nodes) g += wire_field(1, node);
  g += wire_field(2, "g");
  for (const std::string& tensor : graph.tensors) g += wire_field(5, tensor);
  for (const std::string& input : graph.inputs) g += wire_field(11, input);
  for (const std::string& output : graph.outputs) g += wire_field(12, output);
  return wire_number(1, 8) + wire_field(7, g) +
         wire_field(8, wire_field(1, "") + wire_number(2, 17)) + more;
}

/// actions (1, 2) = obs (batch, 4) * w.
inline OnnxGraph onnx_linear() {
  return {{onnx_node("MatMul", {"obs", "w"}, "actions")},
          {onnx_tensor("w", {4, 2}, {1, 0, 0, 1, 1, 0, 0, -1})},
          {onnx_port("obs", {-1, 4})},
          {onnx_port("actions", {-1, 2})}};
}

}  // namespace gloam
