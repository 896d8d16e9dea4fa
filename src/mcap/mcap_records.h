#pragma once
// Records of MCAP version 0 (https://mcap.dev/spec), as values. A log is
//   magic, Header, data section, DataEnd, summary section, summary offsets, Footer, magic
// and each record is its opcode (1 byte), the length of its content (uint64) and the content.
// All numbers are little-endian; a time is nanoseconds since an epoch of the writer's choice.

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gloam {

inline constexpr std::array<uint8_t, 8> kMcapMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr uint64_t kMcapRecordHead = 9;    ///< opcode and length [bytes]
inline constexpr uint64_t kMcapMessageHead = 22;  ///< content of a message before its data [bytes]
inline constexpr uint64_t kMcapFooterContent = 20;  ///< [bytes]

enum class McapOp : uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
  kFirstPrivate = 0x80,  ///< this one and those above belong to applications
};

using McapStrings = std::map<std::string, std::string>;
using McapCounts = std::vector<std::pair<uint16_t, uint64_t>>;  ///< a number for each channel

struct McapHeader {
  std::string profile;  ///< "ros2": messages are CDR, see the registry of the specification
  std::string library;  ///< that wrote the log
};

struct McapSchema {
  uint16_t id = 0;       ///< not 0
  std::string name;      ///< "sensor_msgs/msg/Image"
  std::string encoding;  ///< "ros2msg"
  std::vector<uint8_t> data;
  bool operator==(const McapSchema&) const = default;
};

struct McapChannel {
  uint16_t id = 0;
  uint16_t schema = 0;  ///< 0 = none
  std::string topic;
  std::string encoding;  ///< of its messages: "cdr"
  McapStrings metadata;  ///< ROS 2: offered_qos_profiles (YAML), topic_type_hash
  bool operator==(const McapChannel&) const = default;
};

struct McapMessage {
  uint16_t channel = 0;
  uint32_t sequence = 0;
  uint64_t log_time = 0;      ///< [ns]
  uint64_t publish_time = 0;  ///< [ns]
  std::span<const uint8_t> data;
};

struct McapAttachment {
  uint64_t log_time = 0, create_time = 0;  ///< [ns]; 0 = not known
  std::string name, media_type;            ///< "map.png", "image/png"
  std::vector<uint8_t> data;
};

struct McapMetadata {
  std::string name;
  McapStrings values;
};

/// Place of a chunk in the log and what it holds.
struct McapChunkIndex {
  uint64_t start_time = 0, end_time = 0;  ///< of the messages inside [ns]
  uint64_t offset = 0, length = 0;        ///< of the whole record [bytes]
  McapCounts message_indexes;             ///< offset of a channel's MessageIndex; may be empty
  uint64_t message_index_length = 0;      ///< of all of them together [bytes]
  std::string compression;                ///< "zstd", "lz4" or ""
  uint64_t compressed_size = 0, uncompressed_size = 0;  ///< [bytes]
};

struct McapAttachmentIndex {
  uint64_t offset = 0, length = 0;  ///< of the whole record [bytes]
  uint64_t log_time = 0, create_time = 0, data_size = 0;
  std::string name, media_type;
};

struct McapMetadataIndex {
  uint64_t offset = 0, length = 0;  ///< of the whole record [bytes]
  std::string name;
};

struct McapStatistics {
  uint64_t messages = 0;
  uint16_t schemas = 0;
  uint32_t channels = 0, attachments = 0, metadata = 0, chunks = 0;
  uint64_t start_time = 0, end_time = 0;  ///< of all messages [ns]; 0 = there are none
  McapCounts channel_messages;
};

struct McapSummaryOffset {
  McapOp op = McapOp::kSchema;
  uint64_t start = 0, length = 0;  ///< of the records of this opcode in the summary [bytes]
};

struct McapFooter {
  uint64_t summary_start = 0;         ///< 0 = there is no summary
  uint64_t summary_offset_start = 0;  ///< 0 = there are no summary offsets
  uint32_t summary_crc = 0;           ///< 0 = not computed
};

/// Front part of a chunk record; its records follow, compressed.
struct McapChunkHead {
  uint64_t start_time = 0, end_time = 0;
  uint64_t uncompressed_size = 0;
  uint32_t uncompressed_crc = 0;  ///< 0 = not computed
  std::string compression;
  std::span<const uint8_t> records;
};

}  // namespace gloam
