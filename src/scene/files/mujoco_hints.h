#pragma once
// Remedies for refusals of MuJoCo's parser and compiler.

#include <string>
#include <string_view>

namespace gloam {

/// A sentence for an error that MuJoCo reported as `message`, of the element `element` ("" = not
/// known);
/// "" where Gloam knows nothing that MuJoCo does not say.
std::string mujoco_hint(std::string_view message, std::string_view element);

}  // namespace gloam
