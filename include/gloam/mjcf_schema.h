#pragma once
// Coverage of MuJoCo's grammar by gloam/mjcf.h, and the JSON Schema of models. Part of
// gloam/mjcf.h.

#include <functional>
#include <string>
#include <vector>

namespace gloam::mjcf {

/// What this MuJoCo has, and by what it is given here: `gloam info --schema`.
struct SchemaCoverage {
  struct Attribute {
    std::string name;           ///< "mujoco/body/joint/damping"
    bool is_mirrored = false;   ///< the parser takes a value of it
    bool is_spec_only = false;  ///< MJCF lacks it: of mjSpec, for models in TOML
    std::string complaint;      ///< of the parser, where it takes none
    /// That it sets: names of Fields, "mjsGeom.name" for the name of an element, "mjsGeom" where
    /// there are more or fewer of them. Empty: it tells the parser something.
    std::vector<std::string> fields;
  };
  struct Field {
    std::string name;                     ///< "mjsJoint.damping"
    std::vector<std::string> attributes;  ///< that set it
    std::string follows_from;             ///< where none does and none can
    bool is_mirrored() const { return !attributes.empty() || !follows_from.empty(); }
  };
  int elements = 0;
  std::vector<Attribute> attributes;  ///< of the grammar, then those that are spec-only
  std::vector<Field> fields;          ///< of mjSpec and all that is in it
};

/// Asks MuJoCo's parser about every attribute, which takes seconds. `progress` is told the share
/// that is done, from any thread, and returns false to stop.
SchemaCoverage find_schema_coverage(const std::function<bool(double)>& progress = {});

/// JSON Schema (draft 7) of models in TOML, for editors: docs/models.md.
std::string model_schema();

}  // namespace gloam::mjcf
