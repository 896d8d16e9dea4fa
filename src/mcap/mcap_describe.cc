#include "mcap/mcap_describe.h"

#include <algorithm>

namespace gloam {
namespace {

std::vector<McapTopicInfo> list_topics(const McapReader& reader, double duration) {
  std::map<uint16_t, uint64_t> counts;
  for (const auto& [id, messages] : reader.statistics().channel_messages) counts[id] = messages;
  std::vector<McapTopicInfo> topics;
  for (const auto& [id, channel] : reader.channels()) {
    McapTopicInfo info{channel.topic, {}, channel.encoding, counts[id], 0};
    const auto schema = reader.schemas().find(channel.schema);
    if (schema != reader.schemas().end()) info.type = schema->second.name;
    if (info.messages > 1 && duration > 0)
      info.rate = static_cast<double>(info.messages - 1) / duration;
    topics.push_back(std::move(info));
  }
  std::stable_sort(
      topics.begin(), topics.end(),
      [](const McapTopicInfo& a, const McapTopicInfo& b) { return a.topic < b.topic; });
  return topics;
}

}  // namespace

McapInfo describe(const McapReader& reader) {
  McapInfo info;
  const McapStatistics& counts = reader.statistics();
  info.profile = reader.header().profile;
  info.library = reader.header().library;
  info.bytes = reader.size();
  info.messages = counts.messages;
  info.start_time = counts.start_time;
  info.end_time = counts.end_time;
  if (counts.end_time > counts.start_time)
    info.duration = 1e-9 * static_cast<double>(counts.end_time - counts.start_time);
  info.topics = list_topics(reader, info.duration);
  double compressed = 0, uncompressed = 0;
  for (const McapPiece& piece : reader.pieces()) {
    if (piece.loose) continue;
    ++info.chunks;
    ++info.chunks_by_compression[piece.index.compression];
    compressed += static_cast<double>(piece.index.compressed_size);
    uncompressed += static_cast<double>(piece.index.uncompressed_size);
  }
  if (compressed > 0) info.compression_ratio = uncompressed / compressed;
  info.attachments = reader.attachments();
  for (const McapMetadataIndex& metadata : reader.metadata())
    info.metadata.push_back(metadata.name);
  info.by_summary = reader.by_summary();
  info.damage = reader.damage();
  return info;
}

}  // namespace gloam
