#pragma once
// Writer of MCAP logs. A chunk goes out whole, in one write with its indexes, so what a full disk
// or the end of the process leaves behind is a log without its end: mcap_recover.h makes it whole.
// Schemas and channels are written in front of the chunk that first needs them, not inside: a
// damaged chunk loses its own messages alone.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gloam/result.h"
#include "mcap/compression.h"
#include "mcap/log_sink.h"
#include "mcap/mcap_chunk_writer.h"
#include "mcap/mcap_records.h"

namespace gloam {

/// Largest content of one message or attachment that is written [bytes]; readers hold it in memory.
inline constexpr uint64_t kMcapLargestMessage = uint64_t{255} << 20;
inline constexpr uint64_t kMcapLargestAttachment = uint64_t{1} << 30;

struct McapWriterOptions {
  std::string profile = "ros2";
  std::string library;                ///< empty = "gloam VERSION"
  uint64_t chunk_size = 1024 * 1024;  ///< a chunk is closed when it has so many bytes
  int zstd_level = 1;                 ///< 0 = chunks are not compressed
  bool durable = false;               ///< sync after each chunk: outlives a loss of power
};

/// Not thread-safe. After an error every call returns it, and nothing more is written.
class McapWriter {
 public:
  /// Nothing is written yet: an error of the sink comes from the first call that needs it.
  explicit McapWriter(std::unique_ptr<LogSink> sink, McapWriterOptions options = {});
  ~McapWriter();

  /// Ids are the caller's. The same record again is allowed; errors: another of the same id, a
  /// channel of an unknown schema.
  Status add_schema(const McapSchema& schema);
  Status add_channel(const McapChannel& channel);
  /// Errors, after which the writer goes on: unknown channel, data of more than
  /// kMcapLargestMessage.
  Status add_message(const McapMessage& message);
  Status add_attachment(const McapAttachment& attachment);
  Status add_metadata(const McapMetadata& metadata);
  /// Record of an application's own; `op` is kFirstPrivate or above.
  Status add_private(McapOp op, std::span<const uint8_t> content);

  /// Closes the chunk and hands all to the operating system: the end of the process cannot take it.
  Status flush();
  /// flush(), then the summary, then sync and close. Without it the log is one to recover.
  Status finish();

  /// Failure that stopped the writer, if one did.
  const Status& status() const { return status_; }
  /// Bytes at the start of the log that are whole records and written (durable: and synced).
  uint64_t safe_bytes() const { return safe_; }
  const McapStatistics& statistics() const { return statistics_; }

 private:
  struct Channel {
    uint64_t messages = 0;
    std::vector<std::pair<uint64_t, uint64_t>> index;  // of the open chunk: log time, offset
  };

  Status close_chunk();
  void append_message_indexes(McapChunkIndex* index);
  Status hand_over();
  void add_to_crc();
  Status fail(Error error);
  void append_summary();
  uint64_t end() const { return handed_ + out_.size(); }

  std::unique_ptr<LogSink> sink_;
  McapWriterOptions options_;
  ZstdCompressor compressor_;
  std::vector<uint8_t> out_;                  // complete records that wait for the sink
  std::vector<uint8_t> records_;              // of the open chunk
  uint64_t chunk_start_ = 0, chunk_end_ = 0;  // log times in it [ns]
  std::vector<uint16_t> chunk_channels_;      // that have messages in it
  std::unordered_map<uint16_t, Channel> channels_;
  std::map<uint16_t, McapSchema> schemas_;
  std::map<uint16_t, McapChannel> definitions_;
  std::vector<McapChunkIndex> chunks_;
  std::vector<McapAttachmentIndex> attachments_;
  std::vector<McapMetadataIndex> metadata_;
  McapStatistics statistics_;
  uint64_t handed_ = 0, safe_ = 0;           // [bytes]
  uint32_t crc_ = 0;                         // of all that was handed over
  std::optional<McapStoredRecords> stored_;  // of a chunk in out_ whose CRC is known already
  Status status_;
  bool finished_ = false;
};

}  // namespace gloam
