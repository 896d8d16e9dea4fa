#pragma once
// Tables of results folders (metrics.csv, poses.csv), which may come from strangers.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

struct MetricTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  ///< (columns x rows); NaN = empty, or no number

  size_t rows() const { return values.empty() ? 0 : values[0].size(); }
  /// Values of a column; nullptr = there is none of that name.
  const std::vector<double>* find(std::string_view column) const;
};

/// CSV (RFC 4180) with a header. A last row that is cut, as of a run that was killed, is left out.
/// Errors, by line: another number of fields than the header has, a quote without an end, two
/// columns of one name, more than 4096 columns or 50 million cells.
Result<MetricTable> parse_metric_table(std::string_view text, const std::string& name);
Result<MetricTable> read_metric_table(const std::filesystem::path& file);

}  // namespace gloam
