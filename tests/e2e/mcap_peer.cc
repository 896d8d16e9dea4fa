// Our reader and writer of logs, for tests with other programs' (mcap_test.py):
//   mcap_peer write LOG LEVEL CHUNK_SIZE   a log of known messages
//   mcap_peer list LOG [TOPIC]             one line per message: topic, times, size, CRC of its
//   data mcap_peer info LOG                     what the log holds, as JSON mcap_peer recover LOG
//   NEW_LOG

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcap/crc32.h"
#include "mcap/mcap_describe.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_recover.h"
#include "mcap/mcap_writer.h"

namespace gloam {
namespace {

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// std_msgs/msg/String as CDR, little-endian.
std::vector<uint8_t> encode_string(const std::string& text) {
  std::vector<uint8_t> out = {0, 1, 0, 0};
  const auto size = static_cast<uint32_t>(text.size() + 1);
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<uint8_t>(size >> (8 * i)));
  out.insert(out.end(), text.begin(), text.end());
  out.push_back(0);
  return out;
}

Status write_known(const std::string& path, int level, uint64_t chunk_size) {
  GLOAM_TRY(std::unique_ptr<LogSink> sink, FileSink::create(path));
  McapWriter writer(std::move(sink), {.chunk_size = chunk_size, .zstd_level = level});
  GLOAM_TRY_STATUS(
      writer.add_schema({1, "std_msgs/msg/String", "ros2msg", bytes_of("string data\n")}));
  for (const uint16_t id : {1, 2, 3}) {
    GLOAM_TRY_STATUS(writer.add_channel({id,
                                         1,
                                         "/chatter_" + std::to_string(id),
                                         "cdr",
                                         {{"offered_qos_profiles", "- history: 1\n  depth: 10\n"},
                                          {"topic_type_hash", "RIHS01_" + std::string(64, 'a')}}}));
  }
  GLOAM_TRY_STATUS(writer.add_attachment({7, 6, "notes.txt", "text/plain", bytes_of("hello")}));
  GLOAM_TRY_STATUS(writer.add_metadata({"run", {{"scene", "demo"}, {"seed", "7"}}}));
  for (uint32_t i = 0; i < 3000; ++i) {
    const std::vector<uint8_t> data = encode_string("message " + std::to_string(i));
    // Late messages: one in ten is 25 ms older than the one before.
    const uint64_t time =
        uint64_t{1000000000} + 1000000 * uint64_t{i} - (i % 10 == 9 ? 25000000 : 0);
    GLOAM_TRY_STATUS(
        writer.add_message({static_cast<uint16_t>(1 + i % 3), i, time, time - 5, data}));
  }
  return writer.finish();
}

Status list_messages(const std::string& path, const McapQuery& query) {
  GLOAM_TRY(const McapReader reader, McapReader::open(path));
  McapMessages messages = reader.messages(query);
  while (true) {
    GLOAM_TRY(const McapMessage* m, messages.next());
    if (m == nullptr) break;
    std::printf("%s %u %llu %llu %zu %08x\n", reader.channels().at(m->channel).topic.c_str(),
                m->sequence, static_cast<unsigned long long>(m->log_time),
                static_cast<unsigned long long>(m->publish_time), m->data.size(),
                crc32_of(m->data));
  }
  if (!reader.damage().empty())
    return Error{ErrorKind::kPartial, reader.damage(), {path, 0, 0}, {}};
  return {};
}

Status print_info(const std::string& path) {
  GLOAM_TRY(const McapReader reader, McapReader::open(path));
  const McapInfo info = describe(reader);
  nlohmann::json topics = nlohmann::json::array();
  for (const McapTopicInfo& t : info.topics)
    topics.push_back(
        {{"topic", t.topic}, {"type", t.type}, {"messages", t.messages}, {"rate", t.rate}});
  nlohmann::json attachments = nlohmann::json::array();
  for (const McapAttachmentIndex& a : info.attachments) {
    GLOAM_TRY(const McapAttachment read, reader.read_attachment(a));
    attachments.push_back({{"name", read.name}, {"crc", crc32_of(read.data)}});
  }
  nlohmann::json metadata = nlohmann::json::object();
  for (const McapMetadataIndex& m : reader.metadata()) {
    GLOAM_TRY(const McapMetadata read, reader.read_metadata(m));
    metadata[read.name] = read.values;
  }
  const nlohmann::json all = {
      {"profile", info.profile},       {"library", info.library}, {"messages", info.messages},
      {"start", info.start_time},      {"end", info.end_time},    {"chunks", info.chunks},
      {"by_summary", info.by_summary}, {"damage", info.damage},   {"topics", topics},
      {"attachments", attachments},    {"metadata", metadata}};
  std::printf("%s\n", all.dump().c_str());
  return {};
}

Status recover(const std::string& from, const std::string& to) {
  GLOAM_TRY(const McapRecovery report, recover_log_file(from, to));
  std::printf("%llu %llu\n", static_cast<unsigned long long>(report.messages),
              static_cast<unsigned long long>(report.messages_lost));
  return {};
}

Status run(const std::vector<std::string>& words) {
  if (words.size() == 4 && words[0] == "write")
    return write_known(words[1], std::atoi(words[2].c_str()),
                       static_cast<uint64_t>(std::atoll(words[3].c_str())));
  if (words.size() == 2 && words[0] == "list") return list_messages(words[1], {});
  if (words.size() == 3 && words[0] == "list") return list_messages(words[1], {{words[2]}, 0, {}});
  if (words.size() == 2 && words[0] == "info") return print_info(words[1]);
  if (words.size() == 3 && words[0] == "recover") return recover(words[1], words[2]);
  return Error{ErrorKind::kUsage, "write, list, info or recover, and their files", {}, {}};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  const gloam::Status status = gloam::run({argv + 1, argv + argc});
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", status.error().to_string().c_str());
  return status.error().exit_code();
}
