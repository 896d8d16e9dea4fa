#pragma once
// A log read from front to end, record by record, damaged or not.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "mcap/log_source.h"
#include "mcap/mcap_chunk.h"
#include "mcap/mcap_limits.h"
#include "mcap/mcap_records.h"

namespace gloam {

/// Record of the data section.
struct McapRecordPlace {
  McapOp op = McapOp::kHeader;
  uint64_t offset = 0;  ///< of its opcode [bytes]
  uint64_t length = 0;  ///< with opcode and length [bytes]
};

/// Calls of scan_log() for each record, in the order of the log. An Error ends the scan with it.
class McapVisitor {
 public:
  virtual ~McapVisitor() = default;
  /// Chunk that is whole: its CRC is right and `records` consist of whole records.
  virtual Status visit_chunk(const McapRecordPlace& place, const McapChunkHead& head,
                             std::span<const uint8_t> records) = 0;
  /// Schema, channel, message, message index, metadata or private record.
  virtual Status visit_record(const McapRecordPlace& place, std::span<const uint8_t> content) = 0;
  /// Attachment: its content may be large and is not read.
  virtual Status visit_attachment(const McapRecordPlace& place) = 0;
  /// Bytes that are no part of a whole record, or a chunk that is not whole.
  virtual void visit_damage(const McapRecordPlace& place, const std::string& cause) = 0;
};

struct McapScanResult {
  McapHeader header;
  bool whole = false;  ///< it ends with a DataEnd whose CRC, if it has one, is right, or a Footer
  uint64_t end = 0;    ///< where the data section ends, or where nothing could be read any more
};

/// `restarts`: offsets of chunks, ascending, known from a summary: behind damage the scan goes on
/// at the next. Errors: no MCAP log, the disk, the visitor's.
Result<McapScanResult> scan_log(const LogSource& source, const McapLimits& limits,
                                std::span<const uint64_t> restarts, McapVisitor* visitor);

/// Magic and header at the start; `end`: where the data section begins. Errors: no MCAP log.
Result<McapHeader> read_header(const LogSource& source, uint64_t* end);

}  // namespace gloam
