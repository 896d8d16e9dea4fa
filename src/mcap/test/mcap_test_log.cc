#include "mcap/test/mcap_test_log.h"

#include <algorithm>
#include <utility>

#include "base/rng.h"

namespace gloam {

LogBytes test_payload(uint32_t number, size_t size) {
  LogBytes bytes(size);
  const RandomStream noise{number, 5};
  for (size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<uint8_t>(i % 2 == 0 ? noise.draw(i, 0).v[0] : 7u);
  return bytes;
}

McapSchema test_schema(uint16_t id) {
  const std::string text = "uint8[] data\n";
  return {id, "test_msgs/msg/Blob", "ros2msg", {text.begin(), text.end()}};
}

McapChannel test_channel(uint16_t id, uint16_t schema) {
  return {id,
          schema,
          "/topic_" + std::to_string(id),
          "cdr",
          {{"offered_qos_profiles", "- history: 1\n"}, {"topic_type_hash", "RIHS01_00"}}};
}

McapMessage view(const TestMessage& m) {
  return {m.channel, m.sequence, m.log_time, m.log_time + 1, m.data};
}

TestMessage numbered(uint32_t number, size_t size) {
  return {static_cast<uint16_t>(1 + number % 2), number, 1000000 * uint64_t{number},
          test_payload(number, size)};
}

Status declare_two(McapWriter* writer) {
  GLOAM_TRY_STATUS(writer->add_schema(test_schema()));
  GLOAM_TRY_STATUS(writer->add_channel(test_channel(1)));
  return writer->add_channel(test_channel(2));
}

LogBytes write_log(const std::vector<TestMessage>& messages, const McapWriterOptions& options) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes), options);
  Status status = declare_two(&writer);
  for (const TestMessage& m : messages)
    if (status.ok()) status = writer.add_message(view(m));
  if (status.ok()) status = writer.finish();
  return status.ok() ? *bytes : LogBytes();
}

std::vector<TestMessage> numbered_messages(uint32_t count, size_t size) {
  std::vector<TestMessage> out;
  for (uint32_t i = 0; i < count; ++i) out.push_back(numbered(i, size));
  return out;
}

std::vector<TestMessage> read_all(McapMessages messages, std::string* error) {
  std::vector<TestMessage> out;
  while (true) {
    Result<const McapMessage*> next = messages.next();
    if (!next) *error += next.error().to_string();
    if (!next || *next == nullptr) return out;
    const McapMessage& m = **next;
    out.push_back({m.channel, m.sequence, m.log_time, {m.data.begin(), m.data.end()}});
  }
}

std::vector<TestMessage> read_log(const LogBytes& bytes, std::string* error,
                                  const McapQuery& query) {
  Result<McapReader> reader = McapReader::open(make_memory_source(bytes, "test.mcap"));
  if (!reader) {
    *error += reader.error().to_string();
    return {};
  }
  return read_all(reader->messages(query), error);
}

bool is_prefix(const std::vector<TestMessage>& found, const std::vector<TestMessage>& expected) {
  return found.size() <= expected.size() &&
         std::equal(found.begin(), found.end(), expected.begin(),
                    [](const TestMessage& a, const TestMessage& b) {
                      return a.channel == b.channel && a.sequence == b.sequence &&
                             a.log_time == b.log_time && a.data == b.data;
                    });
}

Recovered recover_bytes(const LogBytes& damaged) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes));
  Recovered out;
  out.report = recover_log(*make_memory_source(damaged, "test.mcap"), {}, &writer);
  out.bytes = *bytes;
  return out;
}

}  // namespace gloam
