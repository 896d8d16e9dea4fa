#pragma once
// Names of metrics: their units, and whether less or more is better.

#include <string>

namespace gloam {

struct MetricName {
  std::string subject;  ///< "ada" of "ada.vx_mps"; "" = the run's
  std::string text;     ///< "vx"
  std::string unit;     ///< "m/s"; "" = none
};
MetricName split_metric_name(const std::string& name);

/// Whether less or more of it is better; unknown for most numbers.
enum class Better { kUnknown, kLess, kMore };
Better better_of(const std::string& name);

}  // namespace gloam
