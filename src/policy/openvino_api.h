#pragma once
// OpenVINO through its C interface, declared here from its public documentation
// (https://docs.openvino.ai, C API, versions 2024 to 2026): no headers are needed to build. The
// library is opened when the first network is loaded, so that the program starts without it.

#include <cstddef>
#include <cstdint>

#include "gloam/result.h"

namespace gloam {

struct OvDimension {
  int64_t min = 0, max = 0;
};
struct OvPartialShape {
  OvDimension rank;
  OvDimension* dims = nullptr;
};

/// Statuses are 0 when a call succeeded. Objects are opaque.
struct OpenvinoApi {
  int (*core_create)(void** core) = nullptr;
  int (*core_read_model)(const void* core, const char* path, const char* weights,
                         void** model) = nullptr;
  int (*core_read_model_bytes)(const void* core, const char* bytes, size_t size,
                               const void* weights, void** model) = nullptr;
  int (*core_compile_model)(const void* core, const void* model, const char* device,
                            size_t property_words, void** compiled, ...) = nullptr;
  const char* (*last_error)() = nullptr;
  void (*model_free)(void* model) = nullptr;
  int (*model_outputs_size)(const void* model, size_t* count) = nullptr;
  int (*model_output)(const void* model, size_t index, void** port) = nullptr;
  int (*model_reshape_input)(const void* model, const char* name, OvPartialShape shape) = nullptr;
  int (*port_any_name)(const void* port, char** name) = nullptr;
  int (*port_partial_shape)(const void* port, OvPartialShape* shape) = nullptr;
  void (*port_free)(void* port) = nullptr;
  int (*shape_create)(int64_t rank, const int64_t* dims, OvPartialShape* shape) = nullptr;
  void (*shape_free)(OvPartialShape* shape) = nullptr;
  void (*text_free)(const char* text) = nullptr;
  int (*create_request)(const void* compiled, void** request) = nullptr;
  void (*compiled_free)(void* compiled) = nullptr;
  int (*request_tensor)(const void* request, const char* name, void** tensor) = nullptr;
  int (*request_infer)(void* request) = nullptr;
  void (*request_free)(void* request) = nullptr;
  int (*tensor_data)(const void* tensor, void** data) = nullptr;
  int (*tensor_size)(const void* tensor, size_t* count) = nullptr;
  int (*tensor_byte_size)(const void* tensor, size_t* bytes) = nullptr;
  void (*tensor_free)(void* tensor) = nullptr;

  void* core = nullptr;  ///< the one that all networks share
};

/// The library, opened once; any thread. Error: it is not installed, or a function is missing.
Result<const OpenvinoApi*> openvino();

}  // namespace gloam
