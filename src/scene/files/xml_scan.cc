#include "scene/files/xml_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "scene/files/foreign_model.h"
#include "scene/files/xml_text.h"

namespace gloam {
namespace {

constexpr int64_t kMostElements = 4'000'000;

// Sizes that only a mistake or an attack would ask for. The product of all numbers of the attribute
// counts.
struct SizeLimit {
  std::string_view element, attribute;
  double largest;
};
constexpr SizeLimit kSizeLimits[] = {
    {"replicate", "count", 1e5},   {"flexcomp", "count", 1e6},    {"flexcomp", "cellcount", 1e6},
    {"texture", "width", 16384},   {"texture", "height", 98304},  {"texture", "nchannel", 4},
    {"hfield", "nrow", 16384},     {"hfield", "ncol", 16384},     {"numeric", "size", 1e7},
    {"size", "nuserdata", 1e8},    {"size", "nkey", 1e6},         {"size", "njmax", 1e7},
    {"size", "nconmax", 1e7},      {"size", "nstack", 1e9},       {"mesh", "octree_maxdepth", 12},
    {"user", "dim", 1e6},          {"texture", "gridsize", 144},  {"size", "nuser_geom", 1e4},
    {"size", "nuser_body", 1e4},   {"size", "nuser_jnt", 1e4},    {"size", "nuser_site", 1e4},
    {"size", "nuser_cam", 1e4},    {"size", "nuser_tendon", 1e4}, {"size", "nuser_actuator", 1e4},
    {"size", "nuser_sensor", 1e4},
};
constexpr double kLargestArena = 64.0 * (uint64_t{1} << 30);  // [bytes]

bool names_a_file(std::string_view element, std::string_view attribute) {
  if (element == "compiler")
    return attribute == "meshdir" || attribute == "texturedir" || attribute == "assetdir";
  if (attribute.starts_with("file")) return element != "key" && element != "text";
  return false;
}

double product_of_numbers(const char* text) {
  double product = 1;
  bool any = false;
  while (*text != 0) {
    char* end = nullptr;
    const double x = std::strtod(text, &end);
    if (end == text) {
      ++text;
      continue;
    }
    product *= std::abs(x) > 1 ? std::abs(x) : 1;
    any = true;
    text = end;
  }
  return any ? product : 0;
}

double memory_bytes(const char* text) {
  char* end = nullptr;
  const double x = std::strtod(text, &end);
  static constexpr std::string_view kUnits = "KMGTPE";
  const size_t unit =
      kUnits.find(static_cast<char>(std::toupper(static_cast<unsigned char>(*end))));
  return unit == std::string_view::npos || *end == 0
             ? x
             : x * std::pow(1024.0, static_cast<double>(unit) + 1);
}

// Calls visit(node) on every element in document order without recursion; stops when it
// returns false.
template <class Visit>
void walk(const pugi::xml_document& document, Visit&& visit) {
  pugi::xml_node node = document.document_element();
  int depth = 1;
  while (node) {
    if (node.type() == pugi::node_element && !visit(node)) return;
    if (node.first_child()) {
      node = node.first_child();
      ++depth;
      continue;
    }
    while (node && !node.next_sibling()) {
      node = node.parent();
      --depth;
      if (depth < 1) return;
    }
    node = node.next_sibling();
  }
}

Status check_sizes(const pugi::xml_node& node, const std::function<SourceLoc()>& loc) {
  const std::string_view element = node.name();
  for (const SizeLimit& limit : kSizeLimits) {
    if (element != limit.element) continue;
    const pugi::xml_attribute attribute = node.attribute(limit.attribute.data());
    if (!attribute) continue;
    const double size = product_of_numbers(attribute.value());
    if (size <= limit.largest) continue;
    return Error{ErrorKind::kInput,
                 fmt::format("{} {}=\"{:.40}\" exceeds the limit of {}", element, limit.attribute,
                             attribute.value(), limit.largest),
                 loc()};
  }
  if (element == "size" && node.attribute("memory") &&
      memory_bytes(node.attribute("memory").value()) > kLargestArena) {
    return Error{ErrorKind::kInput,
                 fmt::format("size memory=\"{:.40}\" exceeds the limit of 64G",
                             node.attribute("memory").value()),
                 loc()};
  }
  return {};
}

// Checks for faults at which MuJoCo 4.0.1 ends the whole process, instead of reporting an error. (A
// C++ exception in it cannot be caught outside: it comes with a runtime library of its own.)
Status check_fatal(const pugi::xml_node& node, const std::function<SourceLoc()>& loc) {
  const std::string_view element = node.name(), above = node.parent().name();
  const auto is_blank = [&](const char* attribute) {
    return std::string_view(node.attribute(attribute).value()).find_first_not_of(" \t\r\n") ==
           std::string_view::npos;
  };
  const char* what = nullptr;
  if (element == "model" && above == "asset" && !node.attribute("file")) {
    what = "<model> is missing 'file'";
  } else if (element == "connect" && node.attribute("anchor") && is_blank("anchor")) {
    what = "<connect> has an empty 'anchor': it takes 3 numbers";
  } else if (element == "plugin" && above == "flexcomp" && node.attribute("plugin") &&
             is_blank("plugin")) {
    what = "<plugin> of a <flexcomp> has an empty 'plugin'";
  } else if (element == "contact" && node.attribute("activelayers") &&
             node.attribute("activelayers").as_int(0) < 1) {
    what = "'activelayers' of <contact> is less than 1";
  }
  return what == nullptr ? Status() : Error{ErrorKind::kInput, what, loc()};
}

// A xacro file is a program that writes a URDF; read as one it would be an empty robot.
Status check_expanded(const pugi::xml_node& node, const std::function<SourceLoc()>& loc) {
  bool is_macro = std::string_view(node.name()).starts_with("xacro:");
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    const std::string_view value = attribute.value();
    is_macro = is_macro || value.find("${") != std::string_view::npos ||
               value.find("$(") != std::string_view::npos;
  }
  if (!is_macro) return {};
  return Error{ErrorKind::kInput, fmt::format("<{:.60}>: xacro is not expanded", node.name()),
               loc(), "run xacro first: xacro FILE.urdf.xacro > FILE.urdf"};
}

// The elements that `node` becomes. MuJoCo attaches copies one by one and goes through all elements
// of the copies so far at each: measured for 10⁴ to 5·10⁴ lights with 3.12 on a server's core.
double weigh(const pugi::xml_node& node, const XmlLines& lines, Replicate* slowest) {
  constexpr double kSeconds = 3e-8;  // time of each copy and element
  double inside = 0;
  for (const pugi::xml_node& child : node.children())
    if (child.type() == pugi::node_element) inside += weigh(child, lines, slowest);
  if (std::string_view(node.name()) != "replicate") return 1 + inside;
  const double copies = std::max(0.0, node.attribute("count").as_double());
  const double seconds = kSeconds * copies * copies * inside;
  if (seconds > slowest->seconds) *slowest = {seconds, copies, lines.at(node.offset_debug())};
  return copies * inside;
}

}  // namespace

Result<XmlScan> scan_model_xml(std::string_view text, const std::string& file) {
  pugi::xml_document document;
  GLOAM_TRY_STATUS(parse_xml(text, file, pugi::parse_default, &document));
  const XmlLines lines(text);
  const auto loc_at = [&](ptrdiff_t offset) { return SourceLoc{file, lines.at(offset), 0}; };
  XmlScan scan;
  scan.root = document.document_element().name();
  Status status;
  int64_t elements = 0;
  walk(document, [&](const pugi::xml_node& node) {
    const auto loc = [&] { return loc_at(node.offset_debug()); };
    if (++elements > kMostElements) {
      status =
          Error{ErrorKind::kInput, fmt::format("has more than {} elements", kMostElements), loc()};
    } else {
      status = check_sizes(node, loc);
      if (status.ok()) status = check_fatal(node, loc);
      if (status.ok() && scan.root == "robot") status = check_expanded(node, loc);
    }
    if (!status.ok()) return false;
    const std::string_view element = node.name();
    if (element == "extension" || element == "plugin") scan.has_plugins = true;
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      if (!names_a_file(element, attribute.name())) continue;
      scan.references.push_back({std::string(element), attribute.name(), attribute.value(),
                                 lines.at(node.offset_debug())});
    }
    return true;
  });
  GLOAM_TRY_STATUS(std::move(status));
  if (scan.root == "robot") GLOAM_TRY_STATUS(check_is_urdf(document.document_element(), file));
  weigh(document.document_element(), lines, &scan.slowest);
  return scan;
}

bool has_element_at(std::string_view text, std::string_view name, int line) {
  pugi::xml_document document;
  if (!parse_xml(text, "", pugi::parse_default, &document).ok()) return false;
  const XmlLines lines(text);
  bool found = false;
  walk(document, [&](const pugi::xml_node& node) {
    found = (name.empty() || name == node.name()) && lines.at(node.offset_debug()) == line;
    return !found;
  });
  return found;
}

int line_of_element(std::string_view text, std::string_view name) {
  pugi::xml_document document;
  if (!parse_xml(text, "", pugi::parse_default, &document).ok()) return 0;
  const XmlLines lines(text);
  int line = 0;
  walk(document, [&](const pugi::xml_node& node) {
    if (name != node.name()) return true;
    line = lines.at(node.offset_debug());
    return false;
  });
  return line;
}

int line_of_element_with(std::string_view text, std::string_view name,
                         const std::vector<std::string>& words) {
  pugi::xml_document document;
  if (!parse_xml(text, "", pugi::parse_default, &document).ok()) return 0;
  const XmlLines lines(text);
  int line = 0;
  walk(document, [&](const pugi::xml_node& node) {
    if (!name.empty() && name != node.name()) return true;
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      for (const std::string& word : words) {
        if (word != attribute.name() && word != attribute.value()) continue;
        line = lines.at(node.offset_debug());
        return false;
      }
    }
    return true;
  });
  return line;
}

}  // namespace gloam
