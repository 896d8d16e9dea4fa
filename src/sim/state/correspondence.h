#pragma once
// Which elements of one World are those of another: the same full name. What has no name is the
// same where it is the same unnamed one of what it belongs to: the second geom without a name of
// body 'trunk'.

#include <optional>
#include <vector>

#include "gloam/command.h"
#include "world/world.h"

namespace gloam {

struct Correspondence {
  Correspondence(const CompiledWorld& before, const CompiledWorld& after);

  const CompiledWorld& before;  ///< must outlive this
  const CompiledWorld& after;
  // By id in `after`: the id in `before`, -1 = new.
  std::vector<int> body, joint, geom, light, material, height_field, flex, tendon, actuator, sensor,
      equality, plugin, robot;

  /// Of every value of a live field in `after`: its place in `before`, -1 = new.
  std::vector<int> live_values(LiveFieldId field) const;
  /// The same of the degrees of freedom, and of the samples of height fields.
  std::vector<int> dof_places() const;
  std::vector<int> height_places() const;
  /// A Command for `before` as one for `after`; nothing where what it names is gone.
  std::optional<Command> translate(const Command& command) const;
};

}  // namespace gloam
