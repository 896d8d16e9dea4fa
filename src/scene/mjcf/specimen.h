#pragma once
// For each element of MJCF a document in which MuJoCo reads it, and values that its attributes
// take: what the parser makes of an attribute is found out by letting it read one (spec_table.h).

#include <memory>
#include <string>
#include <vector>

#include "gloam/mjcf.h"
#include "scene/mjcf/schema.h"

struct mjSpec_;

namespace gloam::mjcf {

inline constexpr const char* kSpecimenName = "specimen";

struct Specimen {
  Document document;
  Element element;  ///< called kSpecimenName if it takes a name
  Element named;    ///< itself, or what above it has the name: an <inertial>'s body
};

/// A small world with one element of this path, and above it what it needs; beside it what lets
/// `attribute` stand.
Specimen make_specimen(const MjcfElement& element, std::string_view attribute = {});

/// Different values that the attribute takes, though not each in every context.
std::vector<std::string> values_to_try(const MjcfAttribute& attribute);

struct SpecDeleter {
  void operator()(mjSpec_* spec) const;
};
using OwnedSpec = std::unique_ptr<mjSpec_, SpecDeleter>;

/// Spec that MuJoCo's parser makes of a document. Errors: the parser's message.
Result<OwnedSpec> parse_document(const Document& document);

}  // namespace gloam::mjcf
