#pragma once
// Overlays: one scene file's tables laid over another's.

#include <toml++/toml.h>

namespace gloam {

/// Lays `over` over `base`: values replace values, tables join, list tables change those of the
/// same `name` and are added otherwise. What comes from `over` keeps its file and line.
void overlay_table(toml::table&& over, toml::table* base);

}  // namespace gloam
