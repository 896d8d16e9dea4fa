#pragma once
// TopicTables: the table of topics of the World that runs, made once for each World.

#include <memory>
#include <mutex>

#include "topics/topic_table.h"

namespace gloam {

/// Any thread.
class TopicTables {
 public:
  Result<std::shared_ptr<const TopicTable>> of(const std::shared_ptr<const CompiledWorld>& world) {
    const std::lock_guard lock(mutex_);
    if (world_ != world) {
      GLOAM_TRY(TopicTable table, make_topic_table(world));
      table_ = std::make_shared<const TopicTable>(std::move(table));
      world_ = world;
    }
    return table_;
  }

  /// Forgets the table of another World; its readers keep it.
  void keep_only(const std::shared_ptr<const CompiledWorld>& world) {
    const std::lock_guard lock(mutex_);
    if (world_ == world) return;
    world_.reset();
    table_.reset();
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const CompiledWorld> world_;
  std::shared_ptr<const TopicTable> table_;
};

}  // namespace gloam
