#pragma once
// Every field of MuJoCo's mjSpec and of its elements by name, out of the lists of MuJoCo's own
// headers: what a parsed model holds. Elements of MJCF say the same in other words (spec_table.h).

#include <mujoco/mujoco.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gloam {

enum class SpecType : uint8_t {
  kBool,
  kByte,
  kChar,
  kInt,  ///< and every enum
  kSize,
  kUint64,
  kFloat,
  kDouble,
  kString,
  kStrings,
  kInts,
  kFloats,
  kDoubles,
  kBytes,
  kIntLists,
  kFloatLists,
  kStruct,  ///< one of the other structs, by value: its fields are in the list too
  kHandle,  ///< the element itself, or a struct of defaults by pointer: not data
};

struct SpecField {
  std::string_view owner;  ///< "mjsJoint"
  std::string_view name;   ///< "damping"
  std::string_view type_name;
  SpecType type = SpecType::kDouble;
  int count = 1;  ///< length of a fixed array
  size_t offset = 0;
};

/// All of mjspecmacro.h's lists, and of mjxmacro.h's those of options, statistics and visuals.
std::span<const SpecField> spec_fields();
std::span<const SpecField> spec_fields_of(std::string_view owner);

/// One struct of a spec that holds fields: "mjsGeom" at its address.
struct SpecObject {
  std::string_view owner;
  std::string label;  ///< for messages: "mjsGeom[2]", "default 'main' mjsGeom"
  const void* address;
  std::string name;  ///< name of an element, "" where it has none
};

/// Everything in the spec: itself, what it holds by value, its elements and defaults, in its order.
std::vector<SpecObject> spec_objects(const mjSpec* spec);

/// One element and what it holds by value.
std::vector<SpecObject> spec_objects_of(mjsElement* element);

}  // namespace gloam
