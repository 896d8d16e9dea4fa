#pragma once
// Replaces `model` of robots by the settings of their robot.toml: the one place where the two meet,
// for scene files and for Scenes made in code.

#include <toml++/toml.h>

#include <string>

#include "gloam/scene.h"
#include "scene/files/file_finder.h"
#include "scene/robots/robot_entry.h"

namespace gloam {

/// In every [[robot]] of a scene file that has a `model`: adds the keys of its robot.toml that the
/// file does not give, below tables, too; a controller of another type inherits only the rate. Adds
/// the listed sensors to the scene's sections. `file` names the scene in errors. Errors: no such
/// model or sensor, `model` beside `file`, `sensors` without `model`; those of parse_robot_entry.
Status expand_robot_models(const FileFinder& finder, const FileAccess& access,
                           const std::string& file, toml::table* scene);

/// The same for one `robot` of the `scene` and the entry that it names.
Status merge_robot_entry(RobotEntry entry, const std::string& file, toml::table* robot,
                         toml::table* scene);

/// Before `over` is laid over a scene: removes from its robots the file and settings of the models
/// that `over` replaces.
void forget_other_models(const toml::table& over, toml::table* scene);

/// expand_robot_models for a Scene: options that have their default values count as not given. A
/// Scene without `model`s is returned unchanged.
Result<Scene> with_robot_models(const Scene& scene);

}  // namespace gloam
