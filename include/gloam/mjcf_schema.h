#pragma once
// Coverage of MuJoCo's grammar by gloam/mjcf.h, and the JSON Schema of models. Part of
// gloam/mjcf.h.

#include <functional>
#include <string>
#include <vector>

namespace gloam::mjcf {

/// Coverage of this MuJoCo's attributes and fields by Gloam: `gloam info --schema`.
struct SchemaCoverage {
  struct Attribute {
    std::string name;           ///< "mujoco/body/joint/damping"
    bool is_mirrored = false;   ///< the parser accepts a value for it
    bool is_spec_only = false;  ///< only in mjSpec, not in MJCF; for models in TOML
    std::string complaint;      ///< message of the parser, if it accepts no value
    /// Fields that it sets; "mjsGeom.name" for the name of an element, "mjsGeom" if their number
    /// varies. Empty: an instruction to the parser.
    std::vector<std::string> fields;
  };
  struct Field {
    std::string name;                     ///< "mjsJoint.damping"
    std::vector<std::string> attributes;  ///< attributes that set it
    std::string follows_from;             ///< reason why no attribute sets it
    bool is_mirrored() const { return !attributes.empty() || !follows_from.empty(); }
  };
  int elements = 0;
  std::vector<Attribute> attributes;  ///< attributes of the grammar, then spec-only ones
  std::vector<Field> fields;          ///< fields of mjSpec and of all structs in it
};

/// Tests every attribute with MuJoCo's parser, which takes seconds. `progress` receives the
/// completed fraction, on any thread, and returns false to cancel.
SchemaCoverage find_schema_coverage(const std::function<bool(double)>& progress = {});

/// JSON Schema (draft 7) of models in TOML, for editors: docs/models.md.
std::string model_schema();

}  // namespace gloam::mjcf
