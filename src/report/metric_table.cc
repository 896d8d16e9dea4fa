#include "report/metric_table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "base/files.h"
#include "base/text.h"

namespace gloam {
namespace {

constexpr size_t kMostColumns = 4096, kMostCells = 50'000'000;
constexpr uint64_t kMostTableBytes = uint64_t{1} << 30;

/// Rows of a CSV, one at a time.
class CsvRows {
 public:
  CsvRows(std::string_view text, const std::string& name) : text_(text), name_(name) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  }
  bool at_end() const { return text_.empty(); }
  int line() const { return line_; }
  /// Did the row that was read last end with the end of its line?
  bool was_whole() const { return was_whole_; }

  Status next(std::vector<std::string>* fields) {
    fields->clear();
    line_ = next_line_;
    was_whole_ = false;
    for (;;) {
      std::string field;
      GLOAM_TRY_STATUS(take_field(&field));
      fields->push_back(std::move(field));
      if (fields->size() > kMostColumns)
        return Error{ErrorKind::kInput, "more than 4096 columns", {name_, line_, 0}};
      if (text_.empty()) return {};
      const char end = text_.front();
      text_.remove_prefix(1);
      if (end == ',') continue;
      if (end == '\r' && text_.starts_with("\n")) text_.remove_prefix(1);
      ++next_line_;
      was_whole_ = true;
      return {};
    }
  }

 private:
  Status take_field(std::string* field) {
    if (!text_.starts_with("\"")) {
      const size_t end = std::min(text_.find_first_of(",\r\n"), text_.size());
      field->assign(text_.substr(0, end));
      text_.remove_prefix(end);
      return {};
    }
    text_.remove_prefix(1);
    for (;;) {
      const size_t end = text_.find('"');
      if (end == std::string_view::npos)
        return Error{ErrorKind::kInput, "a quoted field is not closed", {name_, line_, 0}};
      for (const char c : text_.substr(0, end)) next_line_ += c == '\n' ? 1 : 0;
      field->append(text_.substr(0, end));
      text_.remove_prefix(end + 1);
      if (!text_.starts_with("\"")) break;
      field->push_back('"');
      text_.remove_prefix(1);
    }
    if (!text_.empty() && text_.find_first_of(",\r\n") != 0)
      return Error{ErrorKind::kInput, "text after the end of a quoted field", {name_, line_, 0}};
    return {};
  }

  std::string_view text_;
  const std::string& name_;
  int line_ = 0, next_line_ = 1;
  bool was_whole_ = false;
};

double cell_number(std::string_view text) {
  double value = 0;
  const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number =
      error == std::errc() && after == text.data() + text.size() && std::isfinite(value);
  return is_number ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

const std::vector<double>* MetricTable::find(std::string_view column) const {
  for (size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == column) return &values[i];
  return nullptr;
}

Result<MetricTable> parse_metric_table(std::string_view text, const std::string& name) {
  CsvRows rows(text, name);
  MetricTable table;
  if (rows.at_end()) return Error{ErrorKind::kInput, "is empty", {name, 0, 0}};
  GLOAM_TRY_STATUS(rows.next(&table.columns));
  std::set<std::string> names;
  for (const std::string& column : table.columns)
    if (!names.insert(column).second)
      return Error{ErrorKind::kInput,
                   fmt::format("two columns are named '{}'", as_utf8(column)),
                   {name, 1, 0}};
  table.values.resize(table.columns.size());
  std::vector<std::string> fields;
  while (!rows.at_end()) {
    const Status row = rows.next(&fields);
    const bool is_cut = rows.at_end() && !rows.was_whole();
    if (is_cut && (!row.ok() || fields.size() != table.columns.size())) break;
    if (!row.ok()) return row.error();
    if (fields.size() == 1 && fields[0].empty()) continue;
    if (fields.size() != table.columns.size())
      return Error{
          ErrorKind::kInput,
          fmt::format("a row has {} fields for {} columns", fields.size(), table.columns.size()),
          {name, rows.line(), 0}};
    if ((table.rows() + 1) * fields.size() > kMostCells)
      return Error{ErrorKind::kUnsupported, "more than 50 million cells", {name, 0, 0}};
    for (size_t i = 0; i < fields.size(); ++i) table.values[i].push_back(cell_number(fields[i]));
  }
  return table;
}

Result<MetricTable> read_metric_table(const std::filesystem::path& file) {
  GLOAM_TRY(const std::string text, read_text_file(file, kMostTableBytes));
  return parse_metric_table(text, file.string());
}

}  // namespace gloam
