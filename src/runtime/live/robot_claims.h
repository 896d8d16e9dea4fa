#pragma once
// Claims on the robots of one simulation.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "gloam/control_lease.h"
#include "world/world.h"

namespace gloam {

class RobotClaims {
 public:
  using Post = std::function<Status(std::span<const Command>, const std::string& holder)>;

  /// Errors: no such robot, claimed already. `post` takes the lease's Commands.
  Result<std::unique_ptr<ControlLease>> claim(const std::shared_ptr<const CompiledWorld>& world,
                                              Robot robot, Post post);
  /// Error: one of the Commands drives a robot that somebody else has claimed than the holder of
  /// robot `holder`; empty = who has none.
  Status check(const CompiledWorld& world, std::span<const Command> commands,
               const std::string& holder = {}) const;

 private:
  class Lease;
  struct Table {
    std::mutex mutex;
    std::map<std::string, Lease*> by_robot;
  };
  std::shared_ptr<Table> table_ = std::make_shared<Table>();
};

}  // namespace gloam
