#pragma once
// Fields that each attribute of MJCF sets in a parsed model, and the same set in a model that is
// parsed already. No list of them exists: MuJoCo's parser reads a document with and without the
// attribute, and the fields that differ are those that it sets. So `kp` of a position servo or
// `euler` of a body mean here what they mean in a file.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/mjcf/schema.h"
#include "scene/mjcf/spec_fields.h"

namespace gloam {

/// Effect of an attribute on the parsed model.
struct AttributeEffect {
  bool is_read = false;  ///< it takes one of the values that were tried
  /// Fields that it sets, as "mjsJoint.damping", "mjOption.timestep", "mjsOrientation.euler";
  /// "mjsGeom.name" for an element's name, "mjsWrap" for one more of them. Empty: it tells the
  /// parser something and leaves nothing behind (<include file>, <replicate count> …).
  std::vector<std::string> fields;
  std::string complaint;  ///< message of the parser for the last value that it did not take
};
AttributeEffect find_effect(const MjcfElement& element, const MjcfAttribute& attribute);

/// One value of an attribute, to be set in elements of parsed models as their files would.
class AttributeValue {
 public:
  /// Errors: not what the attribute takes, MuJoCo's parser refuses it.
  static Result<AttributeValue> read(const MjcfElement& element, const MjcfAttribute& attribute,
                                     const std::string& value);
  ~AttributeValue();
  AttributeValue(AttributeValue&&) noexcept;

  /// `target` is null for what a model has once: options, sizes, visuals. Errors: nothing of it
  /// can be set once a model is parsed; a name that is taken.
  Status set(mjSpec* spec, mjsElement* target) const;

 private:
  struct Learned;
  explicit AttributeValue(std::unique_ptr<Learned> learned);
  std::unique_ptr<Learned> learned_;
};

}  // namespace gloam
