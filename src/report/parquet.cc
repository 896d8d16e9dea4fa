#include "report/parquet.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "base/check.h"
#include "base/text.h"
#include "gloam/program.h"
#include "mcap/compression.h"

namespace gloam {
namespace {

static_assert(std::endian::native == std::endian::little, "plain values are little-endian");

constexpr int kZstdLevel = 3;
constexpr size_t kMostPageBytes = size_t{1} << 30;
// Numbers of parquet.thrift.
constexpr int64_t kTypeInt64 = 2, kTypeDouble = 5, kTypeByteArray = 6, kOptional = 1, kUtf8 = 0;
constexpr int64_t kPlain = 0, kRle = 3, kZstd = 6, kDataPage = 0;

int64_t physical_type(ParquetType type) {
  return type == ParquetType::kDouble  ? kTypeDouble
         : type == ParquetType::kInt64 ? kTypeInt64
                                       : kTypeByteArray;
}

/// Thrift's compact protocol: fields by the difference of their numbers, zigzag varints.
class ThriftWriter {
 public:
  enum Type : uint8_t { kI32 = 5, kI64 = 6, kBinary = 8, kList = 9, kStruct = 12 };

  void begin() { last_.push_back(0); }
  void end() {
    bytes.push_back(0);
    last_.pop_back();
  }
  void integer(int field, Type type, int64_t value) {
    head(field, type);
    signed_varint(value);
  }
  void text(int field, const std::string& value) {
    head(field, kBinary);
    bare_text(value);
  }
  void structure(int field) {
    head(field, kStruct);
    begin();
  }
  void list(int field, Type of, size_t count) {
    head(field, kList);
    if (count < 15) {
      bytes.push_back(static_cast<uint8_t>(count << 4 | of));
    } else {
      bytes.push_back(static_cast<uint8_t>(0xf0 | of));
      varint(count);
    }
  }
  void bare_text(const std::string& value) {
    varint(value.size());
    bytes.insert(bytes.end(), value.begin(), value.end());
  }
  void signed_varint(int64_t value) {
    varint(static_cast<uint64_t>(value) << 1 ^ static_cast<uint64_t>(value >> 63));
  }
  void varint(uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<uint8_t>(value | 0x80));
    bytes.push_back(static_cast<uint8_t>(value));
  }

  std::vector<uint8_t> bytes;

 private:
  void head(int field, Type type) {
    const int step = field - last_.back();
    GLOAM_CHECK(step >= 1 && step <= 15, "field numbers must rise by 1 to 15");
    bytes.push_back(static_cast<uint8_t>(step << 4 | type));
    last_.back() = field;
  }
  std::vector<int> last_;
};

template <class T>
void add_raw(const T& value, std::vector<uint8_t>* out) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
  out->insert(out->end(), bytes, bytes + sizeof value);
}

// Definition levels: runs of equal bits, behind their length.
void add_levels(const std::vector<uint8_t>& present, std::vector<uint8_t>* out) {
  ThriftWriter runs;  // its varints are those of the levels
  for (size_t i = 0; i < present.size();) {
    size_t end = i;
    while (end < present.size() && present[end] == present[i]) ++end;
    runs.varint((end - i) << 1);
    runs.bytes.push_back(present[i]);
    i = end;
  }
  add_raw(static_cast<uint32_t>(runs.bytes.size()), out);
  out->insert(out->end(), runs.bytes.begin(), runs.bytes.end());
}

std::vector<uint8_t> page_of(const ParquetColumn& column) {
  std::vector<uint8_t> page;
  add_levels(column.present, &page);
  for (const double value : column.doubles) add_raw(value, &page);
  for (const int64_t value : column.integers) add_raw(value, &page);
  for (const std::string& value : column.texts) {
    add_raw(static_cast<uint32_t>(value.size()), &page);
    page.insert(page.end(), value.begin(), value.end());
  }
  return page;
}

std::vector<uint8_t> page_header(size_t raw_size, size_t size, size_t rows) {
  ThriftWriter w;
  w.begin();
  w.integer(1, ThriftWriter::kI32, kDataPage);
  w.integer(2, ThriftWriter::kI32, static_cast<int64_t>(raw_size));
  w.integer(3, ThriftWriter::kI32, static_cast<int64_t>(size));
  w.structure(5);
  w.integer(1, ThriftWriter::kI32, static_cast<int64_t>(rows));
  w.integer(2, ThriftWriter::kI32, kPlain);
  w.integer(3, ThriftWriter::kI32, kRle);
  w.integer(4, ThriftWriter::kI32, kRle);
  w.end();
  w.end();
  return std::move(w.bytes);
}

void write_schema(const std::vector<ParquetColumn>& columns, ThriftWriter* w) {
  w->list(2, ThriftWriter::kStruct, columns.size() + 1);
  w->begin();
  w->text(4, "schema");
  w->integer(5, ThriftWriter::kI32, static_cast<int64_t>(columns.size()));
  w->end();
  for (const ParquetColumn& column : columns) {
    w->begin();
    w->integer(1, ThriftWriter::kI32, physical_type(column.type));
    w->integer(3, ThriftWriter::kI32, kOptional);
    w->text(4, as_utf8(column.name));
    if (column.type == ParquetType::kString) {
      w->integer(6, ThriftWriter::kI32, kUtf8);
      w->structure(10);  // LogicalType: string
      w->structure(1);
      w->end();
      w->end();
    }
    w->end();
  }
}

}  // namespace

void ParquetColumn::add(double value) {
  present.push_back(1);
  doubles.push_back(value);
}
void ParquetColumn::add(int64_t value) {
  present.push_back(1);
  integers.push_back(value);
}
void ParquetColumn::add(std::string value) {
  present.push_back(1);
  texts.push_back(as_utf8(value));
}
void ParquetColumn::clear() {
  present.clear();
  doubles.clear();
  integers.clear();
  texts.clear();
}

Result<ParquetWriter> ParquetWriter::start(std::unique_ptr<ByteSink> sink) {
  ParquetWriter writer(std::move(sink));
  GLOAM_TRY_STATUS(writer.write({'P', 'A', 'R', '1'}));
  return writer;
}

Status ParquetWriter::write(const std::vector<uint8_t>& bytes) {
  GLOAM_TRY_STATUS(sink_->append(bytes));
  end_ += bytes.size();
  return {};
}

Status ParquetWriter::append(const std::vector<ParquetColumn>& columns) {
  if (columns.empty() || columns[0].present.empty()) return {};
  Group group;
  group.rows = columns[0].present.size();
  ZstdCompressor zstd(kZstdLevel);
  for (const ParquetColumn& column : columns) {
    GLOAM_CHECK(column.present.size() == group.rows,
                "all columns must have the same number of rows");
    const std::vector<uint8_t> page = page_of(column);
    std::vector<uint8_t> packed;
    const size_t most = page.size() + page.size() / 128 + 1024;  // what zstd may need at worst
    if (page.size() > kMostPageBytes || !zstd.append(page, most, &packed))
      return Error{ErrorKind::kUnsupported, fmt::format("column '{}' has over 1 GiB in {} rows",
                                                        as_utf8(column.name), group.rows)};
    const std::vector<uint8_t> header = page_header(page.size(), packed.size(), group.rows);
    group.chunks.push_back({end_, header.size() + packed.size(), header.size() + page.size()});
    GLOAM_TRY_STATUS(write(header));
    GLOAM_TRY_STATUS(write(packed));
  }
  groups_.push_back(std::move(group));
  return {};
}

std::vector<uint8_t> ParquetWriter::footer(const std::vector<ParquetColumn>& columns) const {
  uint64_t rows = 0;
  for (const Group& group : groups_) rows += group.rows;
  ThriftWriter w;
  w.begin();
  w.integer(1, ThriftWriter::kI32, 1);  // version
  write_schema(columns, &w);
  w.integer(3, ThriftWriter::kI64, static_cast<int64_t>(rows));
  w.list(4, ThriftWriter::kStruct, groups_.size());
  for (const Group& group : groups_) {
    uint64_t raw_size = 0;
    w.begin();
    w.list(1, ThriftWriter::kStruct, group.chunks.size());
    for (size_t i = 0; i < group.chunks.size(); ++i) {
      const Chunk& chunk = group.chunks[i];
      raw_size += chunk.raw_size;
      w.begin();
      w.integer(2, ThriftWriter::kI64, static_cast<int64_t>(chunk.offset));
      w.structure(3);
      w.integer(1, ThriftWriter::kI32, physical_type(columns[i].type));
      w.list(2, ThriftWriter::kI32, 2);
      w.signed_varint(kPlain);
      w.signed_varint(kRle);
      w.list(3, ThriftWriter::kBinary, 1);
      w.bare_text(as_utf8(columns[i].name));
      w.integer(4, ThriftWriter::kI32, kZstd);
      w.integer(5, ThriftWriter::kI64, static_cast<int64_t>(group.rows));
      w.integer(6, ThriftWriter::kI64, static_cast<int64_t>(chunk.raw_size));
      w.integer(7, ThriftWriter::kI64, static_cast<int64_t>(chunk.size));
      w.integer(9, ThriftWriter::kI64, static_cast<int64_t>(chunk.offset));
      w.end();
      w.end();
    }
    w.integer(2, ThriftWriter::kI64, static_cast<int64_t>(raw_size));
    w.integer(3, ThriftWriter::kI64, static_cast<int64_t>(group.rows));
    w.end();
  }
  w.text(6, std::string("gloam version ") + version());
  w.end();
  return std::move(w.bytes);
}

Status ParquetWriter::finish(const std::vector<ParquetColumn>& columns) {
  std::vector<uint8_t> bytes = footer(columns);
  add_raw(static_cast<uint32_t>(bytes.size()), &bytes);
  for (const char c : {'P', 'A', 'R', '1'}) bytes.push_back(static_cast<uint8_t>(c));
  GLOAM_TRY_STATUS(write(bytes));
  return sink_->close();
}

}  // namespace gloam
