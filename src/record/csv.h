#pragma once
// Tables of numbers as CSV (RFC 4180, LF line ends), one row per write, so that written rows are
// complete.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "render/film/byte_sink.h"

namespace gloam {

/// One field of text, quoted if it must be. One that a spreadsheet would run as a formula (it
/// begins with =, +, -, @, a tab or a carriage return and is no number) gets an apostrophe in
/// front.
std::string csv_field(const std::string& text);

class CsvWriter {
 public:
  /// Writes the header. Units belong into the names: "time_s", "vx_mps".
  static Result<CsvWriter> start(std::unique_ptr<ByteSink> sink,
                                 const std::vector<std::string>& columns);
  /// Shortest digits that read back to the same double; not-a-number is an empty field.
  Status add(std::span<const double> row);
  Status finish() { return sink_->close(); }

 private:
  CsvWriter(std::unique_ptr<ByteSink> sink, size_t columns)
      : sink_(std::move(sink)), columns_(columns) {}
  Status append(const std::string& line);

  std::unique_ptr<ByteSink> sink_;
  size_t columns_;
};

}  // namespace gloam
