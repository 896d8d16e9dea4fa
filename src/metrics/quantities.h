#pragma once
// Quantities that expressions name: which there are, and their numbers at an instant.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "metrics/builtin/robot_metric.h"
#include "metrics/expression.h"
#include "metrics/metric_instant.h"

namespace gloam {

/// Data of an instant that quantities read.
struct QuantityReader {
  int id = 0;              ///< of MuJoCo's element; row of its sensor, column of a built-in metric
  int probe = -1;          ///< row of CompiledWorld::probes; -1 = it is none
  int width = 1;           ///< 1 or 3
  size_t first = 0;        ///< of its numbers
  std::vector<char> a, b;  ///< of contacts: geoms on both sides, by id
  void (*read)(const MetricInstant& instant, const QuantityReader& self, double* out) = nullptr;
};

/// A built-in metric that expressions can name as robot.NAME.
struct BuiltinColumn {
  std::string name;
  int robot = 0;   ///< row of CompiledWorld::robots
  int column = 0;  ///< of MetricInstant::row
};

class Quantities final : public QuantityNames {
 public:
  /// `robot`: row of CompiledWorld::robots that "robot" stands for; -1 = none.
  Quantities(const CompiledWorld& world, const std::vector<BuiltinColumn>& builtin, int robot)
      : world_(world), builtin_(builtin), robot_(robot) {}

  Result<QuantitySlot> find(std::span<const NameStep> name) override;
  std::vector<std::string> words() const override;
  std::vector<QuantityReader> take_readers() { return std::move(readers_); }
  /// Numbers that all readers fill.
  size_t size() const { return size_; }

 private:
  Result<QuantitySlot> find_scene_number(std::span<const NameStep> name);
  Result<QuantitySlot> find_robot(std::span<const NameStep> name);
  Result<QuantitySlot> find_robot_number(int robot, std::span<const NameStep> rest);
  Result<QuantitySlot> find_element(std::span<const NameStep> name, const std::string& prefix);
  Result<QuantitySlot> find_sensor(std::span<const NameStep> name, int id);
  Result<QuantitySlot> find_probe(std::span<const NameStep> name, int probe);
  Result<int> sensor_width(const NameStep& step, int count) const;
  Result<QuantitySlot> find_contacts(std::span<const NameStep> name, const std::string& prefix);
  Result<std::vector<char>> geoms_like(const std::string& pattern, const NameStep& step) const;
  /// Places the reader, and takes one number of it where `.x`, `.y` or `.z` follows.
  Result<QuantitySlot> place(QuantityReader reader, std::span<const NameStep> rest);

  const CompiledWorld& world_;
  const std::vector<BuiltinColumn>& builtin_;
  int robot_;
  std::vector<QuantityReader> readers_;
  size_t size_ = 0;
};

}  // namespace gloam
