#pragma once
// Policies that the program itself has read (LoadedPolicy::load). Controllers may use them wherever
// their files are, whereas paths from scenes and from clients of bridges must not leave the scene's
// root (docs/security.md).

#include <filesystem>
#include <memory>

#include "policy/policy.h"

namespace gloam {

/// Reads a policy for the program. Any thread; absolute paths, or empty ones. Errors: those of
/// Policy::load().
Result<std::shared_ptr<const Policy>> open_policy(const std::filesystem::path& network,
                                                  const std::filesystem::path& settings);

/// The policy of these files, read again if no one uses it any longer. Null: the program has not
/// opened them.
Result<std::shared_ptr<const Policy>> find_opened_policy(const std::filesystem::path& network,
                                                         const std::filesystem::path& settings);

}  // namespace gloam
