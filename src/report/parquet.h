#pragma once
// Flat tables as Apache Parquet: pages of plain values, zstd, one page a column and row group.
// Format: parquet-format 2.11 (Thrift compact protocol, data pages of version 1).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "render/film/byte_sink.h"

namespace gloam {

enum class ParquetType { kDouble, kInt64, kString };

/// Values of a column of one row group. `present` says which rows have one; only those are in the
/// list of its type.
struct ParquetColumn {
  std::string name;
  ParquetType type = ParquetType::kDouble;
  std::vector<uint8_t> present = {};  ///< (rows), 0 or 1
  std::vector<double> doubles = {};
  std::vector<int64_t> integers = {};
  std::vector<std::string> texts = {};

  void add(double value);
  void add(int64_t value);
  void add(std::string value);
  void add_null() { present.push_back(0); }
  void clear();
};

/// Rows that a caller collects before they become a row group.
inline constexpr size_t kParquetGroupRows = 65'536;

class ParquetWriter {
 public:
  static Result<ParquetWriter> start(std::unique_ptr<ByteSink> sink);
  /// Writes a row group; the columns' names and types are those of the first. Errors: the disk, a
  /// column of over 1 GiB.
  Status append(const std::vector<ParquetColumn>& columns);
  /// Writes the footer; `columns` are those of a table without rows.
  Status finish(const std::vector<ParquetColumn>& columns);

 private:
  struct Chunk {
    uint64_t offset = 0, size = 0, raw_size = 0;  // [bytes]
  };
  struct Group {
    std::vector<Chunk> chunks;
    uint64_t rows = 0;
  };
  explicit ParquetWriter(std::unique_ptr<ByteSink> sink) : sink_(std::move(sink)) {}
  Status write(const std::vector<uint8_t>& bytes);
  std::vector<uint8_t> footer(const std::vector<ParquetColumn>& columns) const;

  std::unique_ptr<ByteSink> sink_;
  uint64_t end_ = 0;  // [bytes] written
  std::vector<Group> groups_;
};

}  // namespace gloam
