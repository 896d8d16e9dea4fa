// Delay of controls by a whole number of steps, of buses and drives.

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

class ControlDelay final : public ActuatorModel {
 public:
  struct Line {
    size_t row;
    size_t first, count;  // of numbers_
    size_t next = 0;      // the oldest
  };

  ControlDelay(std::vector<Line> lines, size_t numbers)
      : lines_(std::move(lines)), numbers_(numbers) {}

  std::string_view kind() const override { return "delay"; }
  void reset(std::span<Drive> drives) override {
    for (Line& line : lines_) {
      line.next = 0;
      std::fill_n(numbers_.begin() + static_cast<ptrdiff_t>(line.first), line.count,
                  drives[line.row].command);
    }
  }
  // If the length of a line has changed, its newest controls remain.
  void take_over(const ActuatorModel& before, std::span<const int> old_row) override {
    const auto& old = static_cast<const ControlDelay&>(before);
    for (Line& line : lines_) {
      for (const Line& from : old.lines_) {
        if (static_cast<int>(from.row) != old_row[line.row]) continue;
        for (size_t age = 1; age <= line.count; ++age)
          at(line, line.count - age) = old.aged(from, std::min(age, from.count));
      }
    }
  }
  bool apply(ActuatorStep& step) override {
    for (Line& line : lines_) {
      double& command = step.drives[line.row].command;
      std::swap(command, numbers_[line.first + line.next]);
      line.next = (line.next + 1) % line.count;
    }
    return true;
  }
  uint64_t hash(uint64_t before) const override { return hash_span<double>(numbers_, before); }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<ControlDelay>(*this);
  }

 private:
  double& at(const Line& line, size_t i) {
    return numbers_[line.first + (line.next + i) % line.count];
  }
  // The control `age` steps ago, 1 … count.
  double aged(const Line& line, size_t age) const {
    return numbers_[line.first + (line.next + line.count - age) % line.count];
  }

  std::vector<Line> lines_;
  std::vector<double> numbers_;  // rings of controls
};

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_control_delay(const ActuatorParts& parts) {
  std::vector<ControlDelay::Line> lines;
  size_t numbers = 0;
  for (size_t row = 0; row < parts.drives.size(); ++row) {
    const ActuatorOptions& o = parts.drives[row].options;
    if (o.delay == 0) continue;
    GLOAM_TRY(const int64_t steps,
              whole_steps(o.delay, parts.timestep,
                          fmt::format("'delay' of actuator '{}' of robot '{}'",
                                      parts.drives[row].name, parts.robot.name),
                          o.loc));
    lines.push_back({row, numbers, static_cast<size_t>(steps)});
    numbers += static_cast<size_t>(steps);
  }
  if (lines.empty()) return std::unique_ptr<ActuatorModel>();
  return std::unique_ptr<ActuatorModel>(std::make_unique<ControlDelay>(std::move(lines), numbers));
}

}  // namespace gloam
