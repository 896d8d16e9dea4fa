#pragma once
// Dependency: one file that models were made of.

#include <cstdint>
#include <filesystem>

namespace gloam {

/// One file that the models were made of, or one that was looked for in vain (`exists` false).
struct Dependency {
  std::filesystem::path path;
  bool exists = true;
  uint64_t hash = 0;  ///< hash of the content
};

}  // namespace gloam
