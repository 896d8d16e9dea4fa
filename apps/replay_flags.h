#pragma once
// Options of `gloam replay` that can take no effect beside the others.

#include <CLI/CLI.hpp>

#include "gloam/result.h"

namespace gloam::cli {

/// Error: an option was given that changes nothing in this kind of replay, by its name.
Status refuse_void_flags(const CLI::App& replay);

}  // namespace gloam::cli
