#include "mcap/mcap_writer.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "mcap/crc32.h"
#include "mcap/mcap_chunk_writer.h"
#include "mcap/mcap_encode.h"
#include "mcap/mcap_limits.h"

namespace gloam {
namespace {

Error refused(std::string message) { return {ErrorKind::kUsage, std::move(message), {}, {}}; }

}  // namespace

McapWriter::McapWriter(std::unique_ptr<LogSink> sink, McapWriterOptions options)
    : sink_(std::move(sink)), options_(std::move(options)), compressor_(options_.zstd_level) {
  GLOAM_CHECK(sink_ != nullptr, "a log needs a sink");
  options_.chunk_size = std::min(options_.chunk_size, McapLimits().chunk_bytes / 2);
  if (options_.library.empty()) options_.library = "gloam " GLOAM_VERSION;
  append_magic(&out_);
  append_record(&out_, McapHeader{options_.profile, options_.library});
}

McapWriter::~McapWriter() = default;

Status McapWriter::add_schema(const McapSchema& schema) {
  GLOAM_TRY_STATUS(status_);
  if (schema.id == 0) return refused("the id of a schema must not be 0");
  const auto [known, is_new] = schemas_.emplace(schema.id, schema);
  if (!is_new) {
    if (known->second == schema) return {};
    return refused(fmt::format("schema {} already exists as '{}'", schema.id, known->second.name));
  }
  append_record(&out_, schema);
  return out_.size() < options_.chunk_size ? Status() : hand_over();
}

Status McapWriter::add_channel(const McapChannel& channel) {
  GLOAM_TRY_STATUS(status_);
  if (channel.schema != 0 && !schemas_.contains(channel.schema))
    return refused(fmt::format("'{}' has the unknown schema {}", channel.topic, channel.schema));
  const auto [known, is_new] = definitions_.emplace(channel.id, channel);
  if (!is_new) {
    if (known->second == channel) return {};
    return refused(
        fmt::format("channel {} already exists as '{}'", channel.id, known->second.topic));
  }
  channels_[channel.id];
  append_record(&out_, channel);
  return out_.size() < options_.chunk_size ? Status() : hand_over();
}

Status McapWriter::add_message(const McapMessage& message) {
  GLOAM_TRY_STATUS(status_);
  GLOAM_CHECK(!finished_, "a message was added after the end of the log");
  const auto found = channels_.find(message.channel);
  if (found == channels_.end())
    return refused(fmt::format("a message has the unknown channel {}", message.channel));
  if (message.data.size() > kMcapLargestMessage) {
    return refused(fmt::format("a message has {} bytes; the limit is {}", message.data.size(),
                               kMcapLargestMessage));
  }
  const uint64_t size = kMcapRecordHead + kMcapMessageHead + message.data.size();
  if (!records_.empty() && records_.size() + size > options_.chunk_size)
    GLOAM_TRY_STATUS(close_chunk());
  Channel& channel = found->second;
  if (channel.index.empty()) chunk_channels_.push_back(message.channel);
  channel.index.emplace_back(message.log_time, records_.size());
  chunk_start_ = records_.empty() ? message.log_time : std::min(chunk_start_, message.log_time);
  chunk_end_ = records_.empty() ? message.log_time : std::max(chunk_end_, message.log_time);
  append_record(&records_, message);

  ++channel.messages;
  const bool first = statistics_.messages++ == 0;
  statistics_.start_time =
      first ? message.log_time : std::min(statistics_.start_time, message.log_time);
  statistics_.end_time = std::max(statistics_.end_time, message.log_time);
  return records_.size() < options_.chunk_size ? Status() : close_chunk();
}

Status McapWriter::add_attachment(const McapAttachment& attachment) {
  GLOAM_TRY_STATUS(status_);
  if (attachment.data.size() > kMcapLargestAttachment) {
    return refused(fmt::format("attachment '{}' has {} bytes; the limit is {}", attachment.name,
                               attachment.data.size(), kMcapLargestAttachment));
  }
  const uint64_t begin = end();
  append_record(&out_, attachment);
  attachments_.push_back({begin, end() - begin, attachment.log_time, attachment.create_time,
                          attachment.data.size(), attachment.name, attachment.media_type});
  ++statistics_.attachments;
  return out_.size() < options_.chunk_size ? Status() : hand_over();
}

Status McapWriter::add_metadata(const McapMetadata& metadata) {
  GLOAM_TRY_STATUS(status_);
  const uint64_t begin = end();
  append_record(&out_, metadata);
  metadata_.push_back({begin, end() - begin, metadata.name});
  ++statistics_.metadata;
  return {};
}

Status McapWriter::add_private(McapOp op, std::span<const uint8_t> content) {
  GLOAM_TRY_STATUS(status_);
  if (op < McapOp::kFirstPrivate) return refused("opcodes below 0x80 belong to the format");
  McapRecordScope(&out_, op).put_bytes(content);
  return {};
}

Status McapWriter::flush() {
  GLOAM_TRY_STATUS(status_);
  if (!records_.empty()) return close_chunk();
  return hand_over();
}

Status McapWriter::finish() {
  GLOAM_CHECK(!finished_, "a log can be finished only once");
  finished_ = true;
  GLOAM_TRY_STATUS(flush());
  append_data_end(&out_, crc_);
  append_summary();
  GLOAM_TRY_STATUS(hand_over());
  if (Status synced = sink_->sync(); !synced) return fail(std::move(synced).error());
  if (Status closed = sink_->close(); !closed) return fail(std::move(closed).error());
  return {};
}

Status McapWriter::close_chunk() {
  McapChunkIndex index;
  index.offset = end();
  index.start_time = chunk_start_;
  index.end_time = chunk_end_;
  stored_ = append_chunk(records_, options_.zstd_level > 0 ? &compressor_ : nullptr, &out_, &index);
  append_message_indexes(&index);
  index.message_index_length = end() - index.offset - index.length;
  chunks_.push_back(std::move(index));
  records_.clear();
  ++statistics_.chunks;
  return hand_over();
}

void McapWriter::append_message_indexes(McapChunkIndex* index) {
  std::sort(chunk_channels_.begin(), chunk_channels_.end());
  for (const uint16_t id : chunk_channels_) {
    Channel& channel = channels_[id];
    index->message_indexes.emplace_back(id, end());
    append_message_index(&out_, id, channel.index);
    channel.index.clear();
  }
  chunk_channels_.clear();
}

Status McapWriter::hand_over() {
  if (out_.empty()) return {};
  if (Status written = sink_->write(out_); !written) return fail(std::move(written).error());
  add_to_crc();
  handed_ += out_.size();
  if (options_.durable) {
    if (Status synced = sink_->sync(); !synced) return fail(std::move(synced).error());
  }
  safe_ = handed_;
  out_.clear();
  return {};
}

void McapWriter::add_to_crc() {
  const std::span<const uint8_t> out(out_);
  if (stored_) {
    crc_ = crc32_of(out.first(stored_->begin), crc_);
    crc_ = crc32_join(crc_, stored_->crc, stored_->size);
    crc_ = crc32_of(out.subspan(stored_->begin + stored_->size), crc_);
    stored_.reset();
  } else {
    crc_ = crc32_of(out, crc_);
  }
}

Status McapWriter::fail(Error error) {
  error.message += fmt::format("; the first {} bytes of the log are safe", safe_);
  if (error.hint.empty()) error.hint = "'gloam recover' turns them into a complete log";
  status_ = std::move(error);
  (void)sink_->close().ok();
  return status_;
}

void McapWriter::append_summary() {
  const size_t begin = out_.size();
  McapFooter footer;
  footer.summary_start = end();
  std::vector<McapSummaryOffset> offsets;
  const auto group = [&](McapOp op, const auto& append_all) {
    const uint64_t start = end();
    append_all();
    if (end() > start) offsets.push_back({op, start, end() - start});
  };
  const auto append_each = [&](const auto& records) {
    for (const auto& record : records) append_record(&out_, record);
  };
  group(McapOp::kSchema, [&] {
    for (const auto& [id, schema] : schemas_) append_record(&out_, schema);
  });
  group(McapOp::kChannel, [&] {
    for (const auto& [id, channel] : definitions_) append_record(&out_, channel);
  });
  statistics_.schemas = static_cast<uint16_t>(schemas_.size());
  statistics_.channels = static_cast<uint32_t>(definitions_.size());
  for (const auto& [id, channel] : definitions_) {
    if (const uint64_t messages = channels_[id].messages; messages > 0)
      statistics_.channel_messages.emplace_back(id, messages);
  }
  group(McapOp::kStatistics, [&] { append_record(&out_, statistics_); });
  group(McapOp::kChunkIndex, [&] { append_each(chunks_); });
  group(McapOp::kAttachmentIndex, [&] { append_each(attachments_); });
  group(McapOp::kMetadataIndex, [&] { append_each(metadata_); });
  footer.summary_offset_start = end();
  append_each(offsets);
  append_footer(&out_, footer, begin);
  append_magic(&out_);
}

}  // namespace gloam
