#include "record/csv.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "base/check.h"

namespace gloam {

namespace {

bool is_number(const std::string& text) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (*begin == '+') ++begin;  // std::from_chars knows no plus sign
  double value = 0;
  const auto [after, error] = std::from_chars(begin, end, value);
  return error == std::errc() && after == end;
}

}  // namespace

std::string csv_field(const std::string& given) {
  // Spreadsheets run cells that begin like this as formulas, and a text may come from anybody.
  const bool is_formula =
      !given.empty() && std::string_view("=+-@\t\r").find(given[0]) != std::string_view::npos;
  const std::string text = is_formula && !is_number(given) ? "'" + given : given;
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

Result<CsvWriter> CsvWriter::start(std::unique_ptr<ByteSink> sink,
                                   const std::vector<std::string>& columns) {
  CsvWriter writer(std::move(sink), columns.size());
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + csv_field(column);
  GLOAM_TRY_STATUS(writer.append(line + "\n"));
  return writer;
}

Status CsvWriter::add(std::span<const double> row) {
  GLOAM_CHECK(row.size() == columns_, "a row has one value per column");
  std::string line;
  for (size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line += ',';
    if (!std::isnan(row[i])) fmt::format_to(std::back_inserter(line), "{}", row[i]);
  }
  return append(line + "\n");
}

Status CsvWriter::append(const std::string& line) {
  return sink_->append({reinterpret_cast<const uint8_t*>(line.data()), line.size()});
}

}  // namespace gloam
