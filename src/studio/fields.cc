#include "studio/fields.h"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

namespace gloam::studio {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

constexpr size_t kMaxValues = size_t{16} << 20;  // 64 MiB of f32

std::vector<double> contacts_of(const Instant& instant) {
  std::vector<double> values;
  for (const ContactState& c : instant.contacts()) {
    const Vec3 &p = c.position, &n = c.normal, &f = c.force;
    for (const Geom geom : c.geoms) values.push_back(geom.id);
    values.insert(values.end(),
                  {p.x, p.y, p.z, n.x, n.y, n.z, f.x, f.y, f.z, c.distance, c.friction});
  }
  return values;
}

Result<std::vector<double>> actuated_by(const Instant& instant, const World& world) {
  GLOAM_TRY(const std::vector<std::string> actuators, world.names("actuator"));
  std::vector<double> forces;
  for (size_t i = 0; i < actuators.size(); ++i) {
    GLOAM_TRY(const double force, instant.force({static_cast<int>(i), world.serial()}));
    forces.push_back(force);
  }
  return forces;
}

Result<std::vector<double>> values_of(const std::string& field, const Snapshot& snapshot,
                                      const Instant& instant) {
  if (field == "contact") return contacts_of(instant);
  if (field == "actuated") return actuated_by(instant, snapshot.world());
  return instant.value(field);
}

void append(std::vector<uint8_t>* bytes, const void* data, size_t size) {
  const auto* first = static_cast<const uint8_t*>(data);
  bytes->insert(bytes->end(), first, first + size);
}

}  // namespace

FieldsMessage encode_fields(const std::vector<std::string>& fields, int id,
                            const Snapshot& snapshot, const Instant& instant) {
  FieldsMessage message;
  std::vector<float> values;
  json list = json::array();
  for (const std::string& field : fields) {
    const Result<std::vector<double>> of_field = values_of(field, snapshot, instant);
    if (!of_field.ok()) {
      message.problems.push_back(of_field.error().to_string());
    } else if (values.size() + of_field->size() > kMaxValues) {
      message.problems.push_back("Field '" + field + "' is too large for one message.");
    } else {
      list.push_back({{"name", field}, {"count", of_field->size()}});
      for (const double value : *of_field) values.push_back(static_cast<float>(value));
    }
  }
  const json head = {{"id", id},
                     {"step", snapshot.step()},
                     {"time", snapshot.time()},
                     {"serial", snapshot.world().serial()},
                     {"fields", list}};
  std::string text = head.dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<uint32_t>(text.size());
  append(&message.bytes, "GLF1", 4);
  append(&message.bytes, &length, sizeof length);
  append(&message.bytes, text.data(), text.size());
  append(&message.bytes, values.data(), values.size() * sizeof(float));
  return message;
}

}  // namespace gloam::studio
