#pragma once
// Values of the fields of a spec: as text, compared, set.

#include "gloam/result.h"
#include "scene/mjcf/spec_fields.h"

namespace gloam {

/// A field as text: numbers with all their digits, texts in quotes, lists in brackets. Handles are
/// "".
std::string spec_text(const SpecObject& object, const SpecField& field);

/// Do they hold the same, bit by bit? Handles always do.
bool spec_equal(const SpecObject& a, const SpecObject& b, const SpecField& field);

size_t spec_size(SpecType type);  ///< size of one number [bytes]

/// Sets numbers from text, as spec_text writes them without the brackets. Errors: not the field's
/// kind or number of values; a field that is not numbers.
Status set_spec_numbers(const SpecObject& object, const SpecField& field, std::string_view text);

/// One place where two specs differ.
struct SpecDifference {
  std::string object;  ///< "mjsGeom[2]"
  std::string field;   ///< "mjsGeom.size", or of a part of it "mjsOrientation.euler"; an element's
                       ///< name is "mjsGeom.name"; of an object that one of them lacks "mjsGeom"
};
std::vector<SpecDifference> spec_difference(const mjSpec* a, const mjSpec* b);

}  // namespace gloam
