#pragma once
// Finds the files of a logged scene on this machine, which need not be the one that wrote the log.

#include <filesystem>

#include "mcap/mcap_reader.h"
#include "runtime/log/run_text.h"

namespace gloam {

/// Remembers in the cache where this run's scene is, for replays on this machine.
void remember_scene_folder(const DescribedRun& run);

/// Folder in which the run's scene can be compiled. Searched are `folder` if it is given, else the
/// scene's place beside the log, the log's own folder, the place that was remembered and the
/// current folder. Files that lie elsewhere below these, or are embedded in the log, are put
/// together in the cache; only files of the logged content count. Where some have changed, the
/// folder that holds most of them is returned, and check_same_bits names the rest.
/// Error: none of the files is to be found.
Result<SceneFolder> find_scene_folder(const RunText& text, const McapReader& log,
                                      const std::filesystem::path& folder);

}  // namespace gloam
