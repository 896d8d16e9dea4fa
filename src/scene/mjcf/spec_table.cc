#include "scene/mjcf/spec_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "base/check.h"
#include "places/writer/spec_edit.h"
#include "scene/mjcf/spec_kinds.h"
#include "scene/mjcf/spec_values.h"
#include "scene/mjcf/specimen.h"

namespace gloam {
namespace {

using mjcf::OwnedSpec;

bool is_bits(const SpecField& field) {
  return field.name == "authored" || field.name == "disableflags" || field.name == "enableflags" ||
         field.name == "disableactuator";
}

// The objects of `spec` that an element owns, itself first: "mjsGeom" and its "mjsOrientation".
std::vector<SpecObject> objects_of(const mjSpec* spec, mjsElement* element) {
  std::vector<SpecObject> all = element == nullptr ? spec_objects(spec) : spec_objects_of(element);
  if (element == nullptr) {
    const auto other = std::ranges::find_if(
        all, [](const SpecObject& object) { return !object.label.starts_with("mjSpec"); });
    all.erase(other, all.end());
  }
  return all;
}

// One attribute's documents: the value asked for, if any, and as many others as the parser takes.
struct Readings {
  std::vector<OwnedSpec> specs;
  int taken = 0;          // number of tried values that the parser took
  Status complaint = {};  // about the last that was not taken
  Status refused = {};    // why the value asked for was not taken
};

Readings read_values(const MjcfElement& element, const MjcfAttribute& attribute,
                     const std::string* value) {
  Readings readings;
  mjcf::Specimen specimen = mjcf::make_specimen(element, attribute.name);
  const auto read = [&] {
    Result<OwnedSpec> spec = mjcf::parse_document(specimen.document);
    if (!spec.ok()) return Status(spec.error());
    readings.specs.push_back(std::move(spec).value());
    return Status();
  };
  const auto read_with = [&](const std::string& text) {
    Status status = specimen.element.set(attribute.name, text);
    return status.ok() ? read() : status;
  };
  if (value != nullptr) {
    readings.refused = read_with(*value);
    if (!readings.refused.ok()) return readings;
  }
  if (const auto given = specimen.element.get(attribute.name); given.ok() && given->has_value())
    readings.taken += read().ok() ? 1 : 0;
  if (!attribute.is_required) {
    (void)specimen.element.clear(attribute.name).ok();
    (void)read().ok();
  }
  for (const std::string& text : mjcf::values_to_try(attribute)) {
    Status status = read_with(text);
    if (status.ok()) {
      ++readings.taken;
    } else {
      readings.complaint = std::move(status);
    }
  }
  return readings;
}

}  // namespace

// One object of the specimen as the value asked for makes it, and as other values do.
struct AttributeExample {
  SpecObject wanted;
  std::vector<SpecObject> others;
};

namespace {

std::vector<AttributeExample> examples_of(const MjcfElement& element,
                                          const std::vector<OwnedSpec>& specs) {
  std::vector<AttributeExample> examples;
  for (const OwnedSpec& spec : specs) {
    const std::vector<SpecObject> objects =
        objects_of(spec.get(), specimen_of(spec.get(), element));
    if (&spec == &specs.front()) {
      for (const SpecObject& object : objects) examples.push_back({object, {}});
    } else if (objects.size() == examples.size()) {
      for (size_t i = 0; i < objects.size(); ++i) examples[i].others.push_back(objects[i]);
    }
  }
  return examples;
}

char* bytes_at(const SpecObject& object, const SpecField& field) {
  return static_cast<char*>(const_cast<void*>(object.address)) + field.offset;
}

template <class T>
T* pointer_at(const SpecObject& object, const SpecField& field) {
  return *reinterpret_cast<T**>(bytes_at(object, field));
}

// Copies the values in which `from` differs from all `others`; true if there are any.
bool copy_changed(const SpecObject& from, const std::vector<SpecObject>& others,
                  const SpecField& field, const SpecObject& to) {
  if (field.type == SpecType::kStruct || field.type == SpecType::kHandle) return false;
  if (std::ranges::all_of(others, [&](const SpecObject& o) { return spec_equal(from, o, field); }))
    return false;
  if (field.type < SpecType::kString) {
    const size_t size = spec_size(field.type);
    for (int i = 0; i < field.count; ++i) {
      char* const target = bytes_at(to, field) + size * static_cast<size_t>(i);
      const char* const source = bytes_at(from, field) + size * static_cast<size_t>(i);
      for (const SpecObject& other : others) {
        const char* const differs = bytes_at(other, field) + size * static_cast<size_t>(i);
        if (std::memcmp(source, differs, size) == 0) continue;
        if (is_bits(field)) {
          for (size_t b = 0; b < size; ++b) {
            const char mask = static_cast<char>(source[b] ^ differs[b]);
            target[b] = static_cast<char>((target[b] & ~mask) | (source[b] & mask));
          }
        } else {
          std::memcpy(target, source, size);
        }
      }
    }
    return true;
  }
  if (field.type == SpecType::kString) {
    edit(mjs_setString, pointer_at<mjString>(to, field),
         mjs_getString(pointer_at<mjString>(from, field)));
  } else if (field.type == SpecType::kStrings) {
    const auto* source = pointer_at<mjStringVec>(from, field);
    auto* dest = pointer_at<mjStringVec>(to, field);
    for (int i = 0; mjs_getInStringVec(source, i) != nullptr; ++i) {
      if (mjs_getInStringVec(dest, i) == nullptr) {
        edit(mjs_appendString, dest, mjs_getInStringVec(source, i));
      } else {
        edit(mjs_setInStringVec, dest, i, mjs_getInStringVec(source, i));
      }
    }
  } else if (field.type == SpecType::kInts) {
    const mjIntVec& source = *pointer_at<mjIntVec>(from, field);
    edit(mjs_setInt, pointer_at<mjIntVec>(to, field), source.data(),
         static_cast<int>(source.size()));
  } else if (field.type == SpecType::kFloats) {
    const mjFloatVec& source = *pointer_at<mjFloatVec>(from, field);
    edit(mjs_setFloat, pointer_at<mjFloatVec>(to, field), source.data(),
         static_cast<int>(source.size()));
  } else if (field.type == SpecType::kDoubles) {
    const mjDoubleVec& source = *pointer_at<mjDoubleVec>(from, field);
    edit(mjs_setDouble, pointer_at<mjDoubleVec>(to, field), source.data(),
         static_cast<int>(source.size()));
  } else if (field.type == SpecType::kBytes) {
    const mjByteVec& source = *pointer_at<mjByteVec>(from, field);
    edit(mjs_setBuffer, pointer_at<mjByteVec>(to, field), source.data(),
         static_cast<int>(source.size()));
  } else {
    return false;  // lists of lists: skins' bones
  }
  return true;
}

}  // namespace

AttributeEffect find_effect(const MjcfElement& element, const MjcfAttribute& attribute) {
  const Readings readings = read_values(element, attribute, nullptr);
  std::set<std::string> fields;
  for (size_t i = 1; i < readings.specs.size(); ++i) {
    for (const SpecDifference& difference :
         spec_difference(readings.specs[0].get(), readings.specs[i].get()))
      fields.insert(difference.field);
  }
  fields.erase("mjsCompiler.authored");  // only records that something was given
  return {readings.taken > 0,
          {fields.begin(), fields.end()},
          readings.complaint.ok() ? "" : readings.complaint.error().message};
}

struct AttributeValue::Learned {
  const MjcfElement* element;
  const MjcfAttribute* attribute;
  std::string value;
  std::vector<OwnedSpec> specs;  // owners of the elements in `objects`
  std::vector<AttributeExample> objects;
};

AttributeValue::AttributeValue(std::unique_ptr<Learned> learned) : learned_(std::move(learned)) {}
AttributeValue::~AttributeValue() = default;
AttributeValue::AttributeValue(AttributeValue&&) noexcept = default;

Result<AttributeValue> AttributeValue::read(const MjcfElement& element,
                                            const MjcfAttribute& attribute,
                                            const std::string& value) {
  Readings readings = read_values(element, attribute, &value);
  if (!readings.refused.ok()) return readings.refused.error();
  std::vector<AttributeExample> objects = examples_of(element, readings.specs);
  return AttributeValue(std::make_unique<Learned>(
      Learned{&element, &attribute, value, std::move(readings.specs), std::move(objects)}));
}

Status AttributeValue::set(mjSpec* spec, mjsElement* target) const {
  const Learned& l = *learned_;
  if (l.attribute->name == "name" && target != nullptr) {
    if (edit(mjs_setName, target, l.value.c_str()) == 0) return {};
    return Error{ErrorKind::kInput, fmt::format("the name '{:.60}' is taken", l.value)};
  }
  const std::vector<SpecObject> to = objects_of(spec, target);
  bool any = false;
  for (size_t i = 0; i < std::min(l.objects.size(), to.size()); ++i) {
    const auto& [wanted, others] = l.objects[i];
    for (const SpecField& field : spec_fields_of(wanted.owner))
      any = copy_changed(wanted, others, field, to[i]) || any;
  }
  if (any) return {};
  return Error{ErrorKind::kUnsupported,
               fmt::format("'{}' of <{}> cannot be changed after the model has been loaded",
                           l.attribute->name, l.element->name)};
}

}  // namespace gloam
