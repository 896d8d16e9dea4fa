// Accessors: typed, strided, normalised and sparse arrays ("glTF 2.0 Specification", 3.6.2).

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "geometry/gltf/document.h"

namespace gloam {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

enum ComponentType : uint32_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

size_t component_size(uint64_t type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

size_t component_count(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "MAT4") return 16;
  return type == "VEC4" ? 4 : 0;  // smaller matrices do not occur in what is read
}

template <class T>
T load(const uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

float load_float(const uint8_t* from, uint64_t type, bool normalized) {
  switch (type) {
    case kByte: {
      const float x = load<int8_t>(from);
      return normalized ? std::max(x / 127.0f, -1.0f) : x;
    }
    case kUnsignedByte: {
      const float x = load<uint8_t>(from);
      return normalized ? x / 255.0f : x;
    }
    case kShort: {
      const float x = load<int16_t>(from);
      return normalized ? std::max(x / 32767.0f, -1.0f) : x;
    }
    case kUnsignedShort: {
      const float x = load<uint16_t>(from);
      return normalized ? x / 65535.0f : x;
    }
    case kUnsignedInt: {
      const double x = load<uint32_t>(from);
      return static_cast<float>(normalized ? x / 4294967295.0 : x);
    }
    default:
      return load<float>(from);
  }
}

uint32_t load_index(const uint8_t* from, uint64_t type) {
  if (type == kUnsignedByte) return load<uint8_t>(from);
  return type == kUnsignedShort ? load<uint16_t>(from) : load<uint32_t>(from);
}

bool is_index_type(uint64_t type) {
  return type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt;
}

// Elements in a file's bytes: element i starts at bytes[i * stride].
struct Elements {
  std::span<const uint8_t> bytes;
  size_t stride = 0;
};

// The part of a buffer view that holds `count` elements of `size` bytes; checked.
Elements find_elements(GltfDocument* document, const JsonNode& place, uint64_t count, size_t size) {
  const JsonNode views = document->root()["bufferViews"];
  const int view = place["bufferView"].required_index(views.size(), "buffer view");
  const uint64_t offset = place["byteOffset"].integer(0, UINT64_MAX);
  if (!document->errors().ok()) return {};
  const std::span<const uint8_t> bytes = document->view(view);
  const uint64_t stride =
      views.at(static_cast<size_t>(view))["byteStride"].integer(size, uint64_t{1} << 16);
  if (!document->errors().ok()) return {};
  if (stride < size) {
    views.at(static_cast<size_t>(view))["byteStride"].fail(
        fmt::format("is {}, but an element has {} bytes", stride, size));
    return {};
  }
  const bool fits = offset <= bytes.size() && size <= bytes.size() - offset &&
                    (count - 1) <= (bytes.size() - offset - size) / stride;
  if (count > 0 && !fits) {
    place.fail(fmt::format("{} elements with a stride of {} bytes from byte {} do not fit into "
                           "buffer view {} of {} bytes",
                           count, stride, offset, view, bytes.size()),
               "the file may be truncated; export the model again");
    return {};
  }
  return {bytes.subspan(std::min<uint64_t>(offset, bytes.size())), stride};
}

struct AccessorHead {
  uint64_t type = 0, count = 0;
  size_t components = 0;
  bool normalized = false, has_view = false;
  size_t size() const { return component_size(type) * components; }
};

// Reads and checks all but the data. `out_size` = bytes that each element takes when read.
bool read_head(GltfDocument* document, const JsonNode& node, size_t out_size, AccessorHead* head) {
  head->type = node["componentType"].integer(0, 1 << 16);
  head->components = component_count(node["type"].text());
  head->normalized = node["normalized"].flag(false);
  head->count = node["count"].integer(0, uint64_t{1} << 53);
  head->has_view = node["bufferView"].exists();
  if (component_size(head->type) == 0)
    node["componentType"].fail(fmt::format("{} is not a component type", head->type));
  if (head->components == 0) node["type"].fail("must be one of SCALAR, VEC2, VEC3, VEC4, MAT4");
  const uint64_t limit =
      head->has_view ? 3 * document->source().options->limits.vertices : kMaxZeroElements;
  if (head->count > limit)
    node["count"].fail(fmt::format("is {}; the limit is {}", head->count, limit));
  if (document->errors().ok() && !document->budget().take(head->count, out_size))
    node["count"].fail("makes the model exceed the size limit when decoded",
                       "split the model into several files");
  return document->errors().ok();
}

// Calls put(element, bytes) for each element that a sparse accessor replaces.
template <class F>
void read_sparse(GltfDocument* document, const JsonNode& node, const AccessorHead& head,
                 const F& put) {
  const JsonNode sparse = node["sparse"];
  if (!sparse.exists()) return;
  const uint64_t count = sparse["count"].integer(0, head.count);
  const JsonNode indices = sparse["indices"];
  const uint64_t type = indices["componentType"].integer(0, 1 << 16);
  if (!is_index_type(type)) indices["componentType"].fail("is not an index type");
  if (!document->errors().ok() || count == 0) return;
  const Elements at = find_elements(document, indices, count, component_size(type));
  const Elements values = find_elements(document, sparse["values"], count, head.size());
  for (uint64_t i = 0; i < count && document->errors().ok(); ++i) {
    const uint32_t element = load_index(at.bytes.data() + i * at.stride, type);
    if (element >= head.count) {
      indices.fail(
          fmt::format("index {} is {}, but there are {} elements", i, element, head.count));
      return;
    }
    put(element, values.bytes.data() + i * values.stride);
  }
}

}  // namespace

bool GltfDocument::read_floats(int accessor, size_t components, std::vector<float>* out) {
  const JsonNode node = root()["accessors"].at(static_cast<size_t>(accessor));
  AccessorHead head;
  if (!read_head(this, node, components * sizeof(float), &head)) return false;
  if (head.components != components) {
    node["type"].fail(fmt::format("has {} components, expected {}", head.components, components));
    return false;
  }
  Elements elements;
  if (head.has_view && head.count > 0) {
    elements = find_elements(this, node, head.count, head.size());
    if (!errors_.ok()) return false;
  }
  out->assign(head.count * components, 0.0f);
  const size_t step = component_size(head.type);
  const auto read_element = [&](uint64_t i, const uint8_t* from) {
    for (size_t c = 0; c < components; ++c)
      (*out)[i * components + c] = load_float(from + c * step, head.type, head.normalized);
  };
  if (!elements.bytes.empty()) {
    parallel_for_range("read accessor", static_cast<int64_t>(head.count), 1 << 14,
                       [&](int64_t begin, int64_t end) {
                         for (auto i = static_cast<uint64_t>(begin); i < static_cast<uint64_t>(end);
                              ++i)
                           read_element(i, elements.bytes.data() + i * elements.stride);
                       });
  }
  read_sparse(this, node, head, read_element);
  return errors_.ok();
}

bool GltfDocument::read_indices(int accessor, std::vector<uint32_t>* out) {
  const JsonNode node = root()["accessors"].at(static_cast<size_t>(accessor));
  AccessorHead head;
  if (!read_head(this, node, sizeof(uint32_t), &head)) return false;
  if (head.components != 1 || !is_index_type(head.type)) {
    node.fail("indices must be unsigned integers");
    return false;
  }
  Elements elements;
  if (head.has_view && head.count > 0) {
    elements = find_elements(this, node, head.count, head.size());
    if (!errors_.ok()) return false;
  }
  out->assign(head.count, 0);
  if (!elements.bytes.empty()) {
    parallel_for_range(
        "read indices", static_cast<int64_t>(head.count), 1 << 15, [&](int64_t begin, int64_t end) {
          for (auto i = static_cast<uint64_t>(begin); i < static_cast<uint64_t>(end); ++i)
            (*out)[i] = load_index(elements.bytes.data() + i * elements.stride, head.type);
        });
  }
  read_sparse(this, node, head,
              [&](uint64_t i, const uint8_t* from) { (*out)[i] = load_index(from, head.type); });
  return errors_.ok();
}

}  // namespace gloam
