#include "record/point_cloud_file.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace gloam {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

enum class Type { kFloat32, kUint32, kUint16, kUint8 };

struct Field {
  const char* name;
  Type type;
  const void* values;
};

size_t size_of(Type type) {
  switch (type) {
    case Type::kFloat32:
    case Type::kUint32:
      return 4;
    case Type::kUint16:
      return 2;
    case Type::kUint8:
      return 1;
  }
  return 0;
}

std::vector<Field> fields_of(const LidarScan& s) {
  std::vector<Field> fields = {{"x", Type::kFloat32, s.x.data()},
                               {"y", Type::kFloat32, s.y.data()},
                               {"z", Type::kFloat32, s.z.data()},
                               {"intensity", Type::kFloat32, s.intensity.data()},
                               {"ring", Type::kUint16, s.ring.data()},
                               {"time", Type::kFloat32, s.time.data()},
                               {"range", Type::kFloat32, s.range.data()},
                               {"column", Type::kUint16, s.column.data()},
                               {"return_number", Type::kUint8, s.return_number.data()}};
  if (s.part.size() == s.size()) {
    fields.push_back({"part", Type::kUint32, s.part.data()});
    fields.push_back({"instance", Type::kUint32, s.instance.data()});
    fields.push_back({"semantic", Type::kUint32, s.semantic.data()});
  }
  return fields;
}

/// The header, then the points one after the other.
std::vector<uint8_t> assemble(const std::string& header, const std::vector<Field>& fields,
                              size_t points) {
  size_t row = 0;
  for (const Field& field : fields) row += size_of(field.type);
  std::vector<uint8_t> bytes(header.size() + row * points);
  std::memcpy(bytes.data(), header.data(), header.size());
  size_t offset = header.size();
  for (const Field& field : fields) {
    const size_t size = size_of(field.type);
    const auto* from = static_cast<const uint8_t*>(field.values);
    for (size_t i = 0; i < points; ++i) {
      std::memcpy(bytes.data() + offset + i * row, from + i * size, size);
    }
    offset += size;
  }
  return bytes;
}

/// `text` of each field, joined.
template <class Text>
std::string joined(const std::vector<Field>& fields, const Text& text) {
  std::string all;
  for (const Field& field : fields) all += text(field);
  return all;
}

}  // namespace

std::vector<uint8_t> encode_pcd(const LidarScan& scan) {
  const std::vector<Field> fields = fields_of(scan);
  const Vec3& p = scan.deskewed ? scan.X_WL_end.p : scan.X_WL_start.p;
  const Quat& q = scan.deskewed ? scan.X_WL_end.q : scan.X_WL_start.q;
  std::string header = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS";
  header += joined(fields, [](const Field& f) { return fmt::format(" {}", f.name); }) + "\nSIZE";
  header += joined(fields, [](const Field& f) { return fmt::format(" {}", size_of(f.type)); });
  header += "\nTYPE" + joined(fields, [](const Field& f) {
              return f.type == Type::kFloat32 ? std::string(" F") : std::string(" U");
            });
  header += "\nCOUNT" + joined(fields, [](const Field&) { return std::string(" 1"); });
  header += fmt::format(
      "\nWIDTH {}\nHEIGHT 1\nVIEWPOINT {} {} {} {} {} {} {}\nPOINTS {}\n"
      "DATA binary\n",
      scan.size(), p.x, p.y, p.z, q.w, q.x, q.y, q.z, scan.size());
  return assemble(header, fields, scan.size());
}

std::vector<uint8_t> encode_ply(const LidarScan& scan) {
  const std::vector<Field> fields = fields_of(scan);
  const auto property = [](const Field& f) {
    const char* type = f.type == Type::kFloat32  ? "float"
                       : f.type == Type::kUint32 ? "uint"
                       : f.type == Type::kUint16 ? "ushort"
                                                 : "uchar";
    return fmt::format("property {} {}\n", type, f.name);
  };
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment start {} s, end {} s\n"
      "element vertex {}\n{}end_header\n",
      scan.start, scan.end, scan.size(), joined(fields, property));
  return assemble(header, fields, scan.size());
}

std::vector<uint8_t> encode_npy(const LidarScan& scan) {
  const std::vector<Field> fields = fields_of(scan);
  const auto described = [](const Field& f) {
    const char* type = f.type == Type::kFloat32  ? "<f4"
                       : f.type == Type::kUint32 ? "<u4"
                       : f.type == Type::kUint16 ? "<u2"
                                                 : "|u1";
    return fmt::format("('{}', '{}'), ", f.name, type);
  };
  // NPY 1.0: the header's length is two bytes; data begins at a multiple of 64.
  std::string dictionary =
      fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}",
                  joined(fields, described), scan.size());
  constexpr size_t kPreamble = 10;
  while ((kPreamble + dictionary.size() + 1) % 64 != 0) dictionary += ' ';
  dictionary += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(dictionary.size() & 0xff);
  header += static_cast<char>(dictionary.size() >> 8);
  return assemble(header + dictionary, fields, scan.size());
}

}  // namespace gloam
