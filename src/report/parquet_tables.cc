// Tables as Parquet: topics of logs, and tables of results folders.

#include <algorithm>
#include <cmath>

#include "gloam/report.h"
#include "report/metric_table.h"
#include "report/parquet.h"
#include "runtime/log/message_columns.h"
#include "runtime/log/topic_reader.h"

namespace gloam {
namespace {

void add_cell(const DynamicMessage& message, const MessageColumn& from, ParquetColumn* to) {
  if (from.kind == MessageColumn::Kind::kText) {
    if (auto text = message.text(from.path); text.ok()) return to->add(std::move(*text));
  } else if (from.kind == MessageColumn::Kind::kInteger) {
    if (const auto number = message.integer(from.path); number.ok()) return to->add(*number);
  } else if (const auto number = message.number(from.path); number.ok()) {
    return to->add(*number);
  }
  to->add_null();
}

ParquetType type_of(MessageColumn::Kind kind) {
  return kind == MessageColumn::Kind::kText      ? ParquetType::kString
         : kind == MessageColumn::Kind::kInteger ? ParquetType::kInt64
                                                 : ParquetType::kDouble;
}

}  // namespace

Result<int64_t> write_topic_parquet(const std::filesystem::path& log, const std::string& topic,
                                    const std::filesystem::path& to) {
  GLOAM_TRY(const McapReader reader, McapReader::open(log));
  GLOAM_TRY(const TopicReader logged, TopicReader::find(reader, topic));
  GLOAM_TRY(auto sink, create_file_sink(to));
  GLOAM_TRY(ParquetWriter writer, ParquetWriter::start(std::move(sink)));
  std::vector<MessageColumn> listed;
  std::vector<ParquetColumn> columns;
  int64_t rows = 0;
  const auto flush = [&]() -> Status {
    GLOAM_TRY_STATUS(writer.append(columns));
    for (ParquetColumn& column : columns) column.clear();
    return {};
  };
  GLOAM_TRY_STATUS(logged.for_each(reader, [&](const DynamicMessage& message) -> Status {
    if (rows == 0) {
      GLOAM_TRY(listed, list_columns(logged.schema, message));
      for (const MessageColumn& column : listed)
        columns.push_back({.name = column.path, .type = type_of(column.kind)});
    }
    ++rows;
    for (size_t i = 0; i < listed.size(); ++i) add_cell(message, listed[i], &columns[i]);
    return rows % static_cast<int64_t>(kParquetGroupRows) == 0 ? flush() : Status();
  }));
  GLOAM_TRY_STATUS(flush());
  GLOAM_TRY_STATUS(writer.finish(columns));
  return rows;
}

Result<int64_t> write_table_parquet(const std::filesystem::path& csv,
                                    const std::filesystem::path& to) {
  GLOAM_TRY(const MetricTable table, read_metric_table(csv));
  GLOAM_TRY(auto sink, create_file_sink(to));
  GLOAM_TRY(ParquetWriter writer, ParquetWriter::start(std::move(sink)));
  std::vector<ParquetColumn> columns;
  for (const std::string& name : table.columns) columns.push_back({.name = name});
  for (size_t row = 0; row < table.rows();) {
    const size_t end = std::min(table.rows(), row + kParquetGroupRows);
    for (size_t i = 0; i < columns.size(); ++i) {
      columns[i].clear();
      for (size_t k = row; k < end; ++k) {
        if (std::isnan(table.values[i][k]))
          columns[i].add_null();
        else
          columns[i].add(table.values[i][k]);
      }
    }
    GLOAM_TRY_STATUS(writer.append(columns));
    row = end;
  }
  GLOAM_TRY_STATUS(writer.finish(columns));
  return static_cast<int64_t>(table.rows());
}

}  // namespace gloam
