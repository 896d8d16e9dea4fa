#include "scene/mjcf/spec_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>

#include "places/writer/spec_edit.h"
#include "scene/mjcf/node.h"

namespace gloam {
namespace {

const void* at(const SpecObject& object, const SpecField& field) {
  return static_cast<const char*>(object.address) + field.offset;
}

template <class T>
std::string numbers(const void* first, int count) {
  const auto* values = static_cast<const T*>(first);
  std::string text;
  for (int i = 0; i < count; ++i) {
    if (i > 0) text += ' ';
    if constexpr (std::is_floating_point_v<T>) {
      text += mjcf::number_text(values[i]);
    } else {
      text += std::to_string(values[i]);
    }
  }
  return text;
}

template <class T>
std::string list(const std::vector<T>& values) {
  return "[" + numbers<T>(values.data(), static_cast<int>(values.size())) + "]";
}

template <class T>
std::string lists(const std::vector<std::vector<T>>& values) {
  std::string text = "[";
  for (const std::vector<T>& inner : values) text += list(inner);
  return text + "]";
}

// A vector that MuJoCo keeps: begin, end and capacity in every standard library.
template <class T>
const T& vector_at(const void* field) {
  return **static_cast<T* const*>(field);
}

std::string strings(const mjStringVec* values) {
  std::string text = "[";
  for (int i = 0;; ++i) {
    const char* value = mjs_getInStringVec(values, i);
    if (value == nullptr) return text + "]";
    text += fmt::format("'{}'", value);
  }
}

}  // namespace

std::string spec_text(const SpecObject& object, const SpecField& field) {
  const void* value = at(object, field);
  const bool is_pointer = field.type >= SpecType::kString && field.type < SpecType::kStruct;
  // Defaults lack some of their texts.
  if (is_pointer && *static_cast<void* const*>(value) == nullptr) return "";
  switch (field.type) {
    case SpecType::kBool:
      return numbers<mjtBool>(value, field.count);
    case SpecType::kByte:
      return numbers<mjtByte>(value, field.count);
    case SpecType::kChar:
      return {static_cast<const char*>(value),
              strnlen(static_cast<const char*>(value), static_cast<size_t>(field.count))};
    case SpecType::kInt:
      return numbers<int>(value, field.count);
    case SpecType::kSize:
      return numbers<mjtSize>(value, field.count);
    case SpecType::kUint64:
      return numbers<uint64_t>(value, field.count);
    case SpecType::kFloat:
      return numbers<float>(value, field.count);
    case SpecType::kDouble:
      return numbers<double>(value, field.count);
    case SpecType::kString:
      return fmt::format("'{}'", mjs_getString(*static_cast<mjString* const*>(value)));
    case SpecType::kStrings:
      return strings(*static_cast<mjStringVec* const*>(value));
    case SpecType::kInts:
      return list(vector_at<mjIntVec>(value));
    case SpecType::kFloats:
      return list(vector_at<mjFloatVec>(value));
    case SpecType::kDoubles:
      return list(vector_at<mjDoubleVec>(value));
    case SpecType::kBytes: {
      const mjByteVec& bytes = vector_at<mjByteVec>(value);
      return "[" + numbers<uint8_t>(bytes.data(), static_cast<int>(bytes.size())) + "]";
    }
    case SpecType::kIntLists:
      return lists(vector_at<mjIntVecVec>(value));
    case SpecType::kFloatLists:
      return lists(vector_at<mjFloatVecVec>(value));
    case SpecType::kStruct:
    case SpecType::kHandle:
      return "";
  }
  return "";
}

bool spec_equal(const SpecObject& a, const SpecObject& b, const SpecField& field) {
  if (field.type < SpecType::kString)
    return std::memcmp(at(a, field), at(b, field),
                       spec_size(field.type) * static_cast<size_t>(field.count)) == 0;
  if (field.type == SpecType::kStruct || field.type == SpecType::kHandle) return true;
  return spec_text(a, field) == spec_text(b, field);
}

size_t spec_size(SpecType type) {
  switch (type) {
    case SpecType::kBool:
    case SpecType::kByte:
    case SpecType::kChar:
      return 1;
    case SpecType::kInt:
    case SpecType::kFloat:
      return 4;
    default:
      return 8;
  }
}

Status set_spec_numbers(const SpecObject& object, const SpecField& field, std::string_view text) {
  void* const place = const_cast<void*>(at(object, field));
  const auto count = static_cast<size_t>(field.count);
  const auto fill = [&]<class T>(T* first, const auto& values) {
    if (values.size() != count) return false;
    for (size_t i = 0; i < count; ++i) first[i] = static_cast<T>(values[i]);
    return true;
  };
  const std::optional<std::vector<int>> whole = read_numbers<int>(text);
  const std::optional<std::vector<double>> real = read_numbers<double>(text);
  bool done = false;
  if (field.type == SpecType::kBool && whole) {
    done = fill(static_cast<mjtBool*>(place), *whole);
  } else if (field.type == SpecType::kInt && whole) {
    done = fill(static_cast<int*>(place), *whole);
  } else if (field.type == SpecType::kDouble && real) {
    done = fill(static_cast<double*>(place), *real);
  } else if (field.type == SpecType::kInts && whole) {
    edit(mjs_setInt, *static_cast<mjIntVec**>(place), whole->data(),
         static_cast<int>(whole->size()));
    done = true;
  } else if (field.type == SpecType::kBytes && whole &&
             std::ranges::all_of(*whole, [](int value) { return value >= 0 && value <= 255; })) {
    const std::vector<uint8_t> bytes(whole->begin(), whole->end());
    edit(mjs_setBuffer, *static_cast<mjByteVec**>(place), bytes.data(),
         static_cast<int>(bytes.size()));
    done = true;
  } else if (field.type == SpecType::kDoubles && real) {
    edit(mjs_setDouble, *static_cast<mjDoubleVec**>(place), real->data(),
         static_cast<int>(real->size()));
    done = true;
  }
  if (done) return {};
  return Error{ErrorKind::kInput,
               fmt::format("{}.{} cannot be \"{:.60}\"", field.owner, field.name, text)};
}

std::vector<SpecDifference> spec_difference(const mjSpec* a, const mjSpec* b) {
  const std::vector<SpecObject> in_a = spec_objects(a), in_b = spec_objects(b);
  std::map<std::string_view, const SpecObject*> of_b;
  for (const SpecObject& object : in_b) of_b.emplace(object.label, &object);
  std::vector<SpecDifference> found;
  for (const SpecObject& object : in_a) {
    const auto other = of_b.find(object.label);
    if (other == of_b.end()) {
      found.push_back({object.label, std::string(object.owner)});
      continue;
    }
    const auto differs = [&](std::string_view field) {
      found.push_back({object.label, fmt::format("{}.{}", object.owner, field)});
    };
    if (object.name != other->second->name) differs("name");
    for (const SpecField& field : spec_fields_of(object.owner)) {
      if (!spec_equal(object, *other->second, field)) differs(field.name);
    }
    of_b.erase(other);
  }
  for (const auto& [label, object] : of_b)
    found.push_back({object->label, std::string(object->owner)});
  return found;
}

}  // namespace gloam
