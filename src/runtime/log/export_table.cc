// Topics of logs as tables.

#include <fmt/format.h>

#include <algorithm>

#include "gloam/log_export.h"
#include "record/csv.h"
#include "render/film/byte_sink.h"
#include "runtime/log/message_columns.h"
#include "runtime/log/topic_reader.h"

namespace gloam {
namespace {

constexpr size_t kMostColumns = 4096;
constexpr size_t kMostBytes = 64;  // an array of bytes that is longer is a picture or points

MessageColumn::Kind kind_of(FieldKind kind) {
  if (kind == FieldKind::kString) return MessageColumn::Kind::kText;
  return kind == FieldKind::kFloat32 || kind == FieldKind::kFloat64 ? MessageColumn::Kind::kReal
                                                                    : MessageColumn::Kind::kInteger;
}

/// The columns of a message: its numbers and texts in order, arrays element by element.
class ColumnLister {
 public:
  ColumnLister(const MessageSchema& schema, const DynamicMessage& message)
      : schema_(schema), message_(message) {}

  Result<std::vector<MessageColumn>> list() {
    GLOAM_TRY_STATUS(add_part(0, ""));
    return std::move(columns_);
  }

 private:
  size_t part_of(const MessageSchema::Field& field) const { return field.part; }

  Status add_part(size_t part, const std::string& above) {
    for (const MessageSchema::Field& field : schema_.fields(part))
      GLOAM_TRY_STATUS(add_field(field, above + field.name));
    return {};
  }

  Status add_field(const MessageSchema::Field& field, const std::string& path) {
    if (field.type.array == ArrayKind::kNone) return add_element(field, path);
    GLOAM_TRY(const size_t count, message_.count(path));
    const bool is_bytes = field.type.kind == FieldKind::kUint8 ||
                          field.type.kind == FieldKind::kByte ||
                          field.type.kind == FieldKind::kChar;
    if (is_bytes && count > kMostBytes) return {};
    for (size_t i = 0; i < count; ++i)
      GLOAM_TRY_STATUS(add_element(field, fmt::format("{}[{}]", path, i)));
    return {};
  }

  Status add_element(const MessageSchema::Field& field, const std::string& path) {
    if (field.type.kind == FieldKind::kMessage) return add_part(part_of(field), path + ".");
    if (columns_.size() == kMostColumns)
      return Error{ErrorKind::kUnsupported,
                   fmt::format("a table can have at most {} columns", kMostColumns)};
    columns_.push_back({path, kind_of(field.type.kind)});
    return {};
  }

  const MessageSchema& schema_;
  const DynamicMessage& message_;
  std::vector<MessageColumn> columns_;
};

std::string cell(const DynamicMessage& message, const MessageColumn& column) {
  if (column.kind == MessageColumn::Kind::kText) {
    const auto text = message.text(column.path);
    return text.ok() ? csv_field(*text) : "";
  }
  const auto number = message.number(column.path);
  return number.ok() ? fmt::format("{}", *number) : "";
}

}  // namespace

Result<std::vector<MessageColumn>> list_columns(const MessageSchema& schema,
                                                const DynamicMessage& message) {
  return ColumnLister(schema, message).list();
}

Result<int64_t> write_topic_table(const std::filesystem::path& log, const std::string& topic,
                                  const std::filesystem::path& to) {
  GLOAM_TRY(const McapReader reader, McapReader::open(log));
  GLOAM_TRY(const TopicReader logged, TopicReader::find(reader, topic));
  GLOAM_TRY(auto sink, create_file_sink(to));
  std::vector<MessageColumn> columns;
  int64_t rows = 0;
  std::string text;
  const auto take = [&](const DynamicMessage& message) -> Status {
    if (rows++ == 0) {
      GLOAM_TRY(columns, list_columns(logged.schema, message));
      for (const MessageColumn& column : columns)
        text += (&column == columns.data() ? "" : ",") + csv_field(column.path);
      text += "\n";
    }
    for (const MessageColumn& column : columns)
      text += (&column == columns.data() ? "" : ",") + cell(message, column);
    text += "\n";
    const Status written =
        sink->append({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    text.clear();
    return written;
  };
  GLOAM_TRY_STATUS(logged.for_each(reader, take));
  GLOAM_TRY_STATUS(sink->close());
  return rows;
}

}  // namespace gloam
