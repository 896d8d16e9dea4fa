#pragma once
// Messages of a log in the order of their log times, chunk by chunk as they are needed.

#include <cstdint>
#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "mcap/log_source.h"
#include "mcap/mcap_catalog.h"
#include "mcap/mcap_chunk.h"
#include "mcap/mcap_limits.h"
#include "mcap/mcap_records.h"

namespace gloam {

struct McapQuery {
  std::set<std::string> topics;           ///< empty = all
  uint64_t start_time = 0;                ///< log time of the first [ns]
  std::optional<uint64_t> end_time = {};  ///< log time that ends it, not itself taken [ns]
};

/// Holds the chunks that overlap the present time, at most McapLimits::open_bytes of them.
class McapMessages {
 public:
  /// `catalog` outlives it.
  McapMessages(std::shared_ptr<const LogSource> source, const McapCatalog* catalog,
               const McapLimits& limits, const McapQuery& query);

  /// The next message, or nullptr at the end; its data are valid until the next call. Messages of
  /// one time come in the order of the log. Errors: a chunk that is damaged or not as its index
  /// says; too many chunks overlap. After an error there are no further messages.
  Result<const McapMessage*> next();
  /// Goes to the first message at `time` or later, forwards or back.
  void seek(uint64_t time);
  /// Chunks read so far, for tests and measurements.
  uint64_t chunks_read() const { return chunks_read_; }

 private:
  struct Entry {
    uint64_t time, offset;  // log time [ns]; of the record in the chunk [bytes]
  };
  struct OpenPiece {
    size_t piece = 0;
    std::vector<uint8_t> records;
    std::vector<Entry> entries;  // in the order of time
    size_t at = 0;
    uint64_t bytes() const { return records.capacity() + entries.capacity() * sizeof(Entry); }
  };

  bool wants(const McapChunkIndex& index) const;
  Status open(size_t piece);
  Status load(const McapPiece& piece, std::vector<uint8_t>* records);
  Status list_entries(const McapPiece& piece, OpenPiece* open) const;
  void advance(size_t slot);
  /// Gives back what free slots hold, all but one.
  void release_memory(size_t but);
  bool later(size_t a, size_t b) const;

  std::shared_ptr<const LogSource> source_;
  const McapCatalog* catalog_;
  McapLimits limits_;
  McapQuery query_;
  std::optional<std::set<uint16_t>> channels_;  // of query_.topics
  std::vector<size_t> order_;                   // pieces by start time
  size_t next_ = 0;                             // in order_
  std::vector<OpenPiece> slots_;
  std::vector<size_t> heap_, free_;  // slots: with messages left, the earliest first; to use again
  std::optional<size_t> given_;      // slot of the message that the caller looks at
  McapChunkBuffers buffers_;
  McapMessage message_;
  uint64_t open_bytes_ = 0, chunks_read_ = 0;
  bool failed_ = false;
};

}  // namespace gloam
