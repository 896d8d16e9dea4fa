#include "geometry/mesh/ply_header.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/mesh/text_lines.h"

namespace gloam {
namespace {

constexpr size_t kMostPlyElements = 64, kMostProperties = 256, kMostLines = 4096;

std::optional<PlyType> type_of(std::string_view name) {
  struct Name {
    std::string_view old, sized;
    PlyType type;
  };
  constexpr Name kNames[] = {
      {"char", "int8", PlyType::kInt8},      {"uchar", "uint8", PlyType::kUint8},
      {"short", "int16", PlyType::kInt16},   {"ushort", "uint16", PlyType::kUint16},
      {"int", "int32", PlyType::kInt32},     {"uint", "uint32", PlyType::kUint32},
      {"float", "float32", PlyType::kFloat}, {"double", "float64", PlyType::kDouble}};
  for (const Name& n : kNames)
    if (name == n.old || name == n.sized) return n.type;
  return {};
}

// "" or the fault of a line of the header.
std::string read_line(std::string_view line, bool* has_format, PlyHeader* out) {
  const std::string_view word = take_word(&line);
  if (word == "format") {
    const std::string_view name = take_word(&line);
    *has_format = true;
    if (name == "ascii")
      out->format = PlyFormat::kAscii;
    else if (name == "binary_little_endian")
      out->format = PlyFormat::kLittleEndian;
    else if (name == "binary_big_endian")
      out->format = PlyFormat::kBigEndian;
    else
      return fmt::format("the format '{}' is unknown", name.substr(0, 40));
  } else if (word == "element") {
    PlyElement element;
    element.name = take_word(&line).substr(0, kMaxName);
    if (!parse_integer(take_word(&line), &element.count)) return "the element has no count";
    if (out->elements.size() == kMostPlyElements) return "there are too many elements";
    out->elements.push_back(std::move(element));
  } else if (word == "property") {
    if (out->elements.empty()) return "property before the first element";
    std::vector<PlyProperty>& properties = out->elements.back().properties;
    if (properties.size() == kMostProperties) return "there are too many properties";
    PlyProperty property;
    std::string_view type = take_word(&line);
    if (type == "list") {
      property.count_type = type_of(take_word(&line));
      if (!property.count_type || *property.count_type >= PlyType::kFloat)
        return "the type of the list's length is not an integer type";
      type = take_word(&line);
    }
    const std::optional<PlyType> known = type_of(type);
    if (!known) return fmt::format("the type '{}' is unknown", type.substr(0, 40));
    property.type = *known;
    property.name = take_word(&line).substr(0, kMaxName);
    properties.push_back(std::move(property));
  } else if (!word.empty() && word != "ply" && word != "comment" && word != "obj_info") {
    return fmt::format("unexpected '{}' in the header", word.substr(0, 40));
  }
  return {};
}

}  // namespace

size_t size_of(PlyType type) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.count_type.has_value(); });
}

size_t PlyElement::least_bytes() const {
  size_t out = 0;
  for (const PlyProperty& p : properties) out += size_of(p.count_type.value_or(p.type));
  return out;
}

Result<PlyHeader> read_ply_header(const ModelSource& source) {
  PlyHeader out;
  std::string_view text = as_text(source.bytes);
  bool has_format = false;
  const auto bad = [&](std::string message) {
    return Error{ErrorKind::kInput,
                 "not a readable PLY file: " + message,
                 {source.name, static_cast<int>(out.lines), 0},
                 "export it again"};
  };
  while (!text.empty() && out.lines < kMostLines) {
    const std::string_view line = take_line(&text);
    ++out.lines;
    if (trim(line) == "end_header") {
      if (!has_format) return bad("its header does not specify a format");
      out.bytes = source.bytes.size() - text.size();
      return out;
    }
    if (std::string why = read_line(line, &has_format, &out); !why.empty())
      return bad(std::move(why));
  }
  return bad("its header is not terminated");
}

}  // namespace gloam
