#pragma once
// Formats of others that users take for logs or scenes, recognised by their first bytes.

#include <filesystem>
#include <optional>
#include <string>

#include "gloam/result.h"

namespace gloam {

/// A format that Gloam does not read.
struct ForeignFormat {
  std::string what;  ///< "is a ROS 1 bag", after the file's name
  std::string hint;  ///< how it becomes a file that Gloam reads
};

/// The format of a file or folder of others; an empty file counts as one. Nothing of an unknown
/// format, of a text, or if it cannot be read.
std::optional<ForeignFormat> foreign_format(const std::filesystem::path& path);

/// Error: the file is of a format of others.
Status refuse_foreign_format(const std::filesystem::path& path, const SourceLoc& loc = {});

}  // namespace gloam
