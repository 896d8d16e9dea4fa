#include "mcap/mcap_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "mcap/mcap_decode.h"

namespace gloam {

McapMessages::McapMessages(std::shared_ptr<const LogSource> source, const McapCatalog* catalog,
                           const McapLimits& limits, const McapQuery& query)
    : source_(std::move(source)), catalog_(catalog), limits_(limits), query_(query) {
  if (!query_.topics.empty()) {
    channels_.emplace();
    for (const auto& [id, channel] : catalog_->channels)
      if (query_.topics.contains(channel.topic)) channels_->insert(id);
  }
  order_.resize(catalog_->pieces.size());
  std::iota(order_.begin(), order_.end(), size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](size_t a, size_t b) {
    return catalog_->pieces[a].index.start_time < catalog_->pieces[b].index.start_time;
  });
}

void McapMessages::seek(uint64_t time) {
  query_.start_time = time;
  next_ = 0;
  slots_.clear();
  heap_.clear();
  free_.clear();
  given_.reset();
  open_bytes_ = 0;
  failed_ = false;
}

bool McapMessages::wants(const McapChunkIndex& index) const {
  if (index.end_time < query_.start_time) return false;
  if (query_.end_time && index.start_time >= *query_.end_time) return false;
  if (!channels_ || index.message_indexes.empty()) return true;
  return std::any_of(index.message_indexes.begin(), index.message_indexes.end(),
                     [&](const auto& entry) { return channels_->contains(entry.first); });
}

bool McapMessages::later(size_t a, size_t b) const {
  const OpenPiece &x = slots_[a], &y = slots_[b];
  const uint64_t time_x = x.entries[x.at].time, time_y = y.entries[y.at].time;
  return time_x != time_y ? time_x > time_y : x.piece > y.piece;
}

Result<const McapMessage*> McapMessages::next() {
  if (failed_) return nullptr;
  if (given_) advance(*std::exchange(given_, std::nullopt));
  // A chunk that begins no later than the earliest message known may hold an earlier one.
  for (; next_ < order_.size(); ++next_) {
    const McapChunkIndex& index = catalog_->pieces[order_[next_]].index;
    if (!wants(index)) continue;
    if (!heap_.empty()) {
      const OpenPiece& first = slots_[heap_.front()];
      if (index.start_time > first.entries[first.at].time) break;
    }
    if (Status opened = open(order_[next_]); !opened) {
      failed_ = true;
      return std::move(opened).error();
    }
  }
  if (heap_.empty()) return nullptr;
  std::pop_heap(heap_.begin(), heap_.end(), [&](size_t a, size_t b) { return later(a, b); });
  given_ = heap_.back();
  heap_.pop_back();
  const OpenPiece& from = slots_[*given_];
  McapRecordCursor cursor(
      std::span<const uint8_t>(from.records).subspan(from.entries[from.at].offset));
  cursor.next();
  (void)decode(cursor.content(), &message_);  // list_entries has decoded it before
  return &message_;
}

void McapMessages::advance(size_t slot) {
  OpenPiece& piece = slots_[slot];
  if (++piece.at < piece.entries.size()) {
    heap_.push_back(slot);
    std::push_heap(heap_.begin(), heap_.end(), [&](size_t a, size_t b) { return later(a, b); });
    return;
  }
  free_.push_back(slot);
}

Status McapMessages::open(size_t piece) {
  if (free_.empty()) {
    free_.push_back(slots_.size());
    slots_.emplace_back();
  }
  const size_t slot = free_.back();
  OpenPiece& open = slots_[slot];
  const McapPiece& from = catalog_->pieces[piece];
  open_bytes_ -= open.bytes();
  open.piece = piece;
  open.at = 0;
  GLOAM_TRY_STATUS(load(from, &open.records));
  ++chunks_read_;
  GLOAM_TRY_STATUS(list_entries(from, &open));
  open_bytes_ += open.bytes();
  if (open_bytes_ > limits_.open_bytes) release_memory(slot);
  if (open_bytes_ > limits_.open_bytes) {
    return mcap_error(
        *source_, from.index.offset,
        fmt::format("chunks of more than {} bytes overlap in time", limits_.open_bytes),
        "read fewer topics or a shorter time range");
  }
  if (open.entries.empty()) return {};  // the slot stays free
  free_.pop_back();
  heap_.push_back(slot);
  std::push_heap(heap_.begin(), heap_.end(), [&](size_t a, size_t b) { return later(a, b); });
  return {};
}

void McapMessages::release_memory(size_t but) {
  for (const size_t slot : free_) {
    if (slot == but) continue;
    open_bytes_ -= slots_[slot].bytes();
    slots_[slot] = OpenPiece();
    open_bytes_ += slots_[slot].bytes();
  }
}

Status McapMessages::load(const McapPiece& piece, std::vector<uint8_t>* records) {
  if (!piece.loose) {
    std::swap(*records, buffers_.records);
    const Result<McapChunkHead> head =
        load_chunk(*source_, piece.index.offset, piece.index.length, limits_, &buffers_);
    std::swap(*records, buffers_.records);
    return head.ok() ? Status() : Status(head.error());
  }
  records->resize(piece.index.length);  // in the log and within limits, as the scan has found
  return source_->read(piece.index.offset, *records);
}

Status McapMessages::list_entries(const McapPiece& piece, OpenPiece* open) const {
  const McapChunkIndex& index = piece.index;
  open->entries.clear();
  McapRecordCursor cursor(open->records);
  while (cursor.next()) {
    if (cursor.op() != McapOp::kMessage) continue;
    McapMessage message;
    if (!decode(cursor.content(), &message))
      return mcap_error(*source_, index.offset, "a chunk contains a message that is too short");
    if (!catalog_->channels.contains(message.channel)) {
      return mcap_error(
          *source_, index.offset,
          fmt::format("a message has channel {}, which no record declares", message.channel));
    }
    const uint64_t time = message.log_time;
    if (time < index.start_time || time > index.end_time) {
      return mcap_error(*source_, index.offset,
                        fmt::format("a chunk from {} to {} ns contains a message at {} ns",
                                    index.start_time, index.end_time, time),
                        "'gloam recover' writes a correct index");
    }
    if (time < query_.start_time || (query_.end_time && time >= *query_.end_time)) continue;
    if (channels_ && !channels_->contains(message.channel)) continue;
    open->entries.push_back({time, cursor.offset()});
  }
  if (!cursor.whole())
    return mcap_error(*source_, index.offset, "a chunk contains incomplete records",
                      "'gloam recover' keeps all undamaged data");
  std::stable_sort(open->entries.begin(), open->entries.end(),
                   [](const Entry& a, const Entry& b) { return a.time < b.time; });
  return {};
}

}  // namespace gloam
