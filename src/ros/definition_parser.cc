#include "ros/definition_parser.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

namespace gloam {
namespace {

// Limits for untrusted definitions, far above those of ROS's own messages.
constexpr size_t kMostText = size_t{1} << 20, kMostMessages = 512, kMostFields = 1024;
constexpr size_t kLongestName = 255;

constexpr std::string_view kSpaces = " \t\r";

std::string_view without_spaces(std::string_view text) {
  const size_t first = text.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpaces) + 1 - first);
}

/// Letters, digits and _, a letter first; with `others` also those characters.
bool is_name(std::string_view text, std::string_view others = "") {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (text.empty() || text.size() > kLongestName || !is_letter(text[0])) return false;
  for (const char c : text) {
    if (!is_letter(c) && !(c >= '0' && c <= '9') && c != '_' &&
        others.find(c) == std::string_view::npos) {
      return false;
    }
  }
  return true;
}

/// "std_msgs/msg/Header" of "std_msgs/Header", and of "Header" in package std_msgs; "" if it is no
/// name of a message.
std::string full_name(std::string_view name, std::string_view package) {
  if (!is_name(name, "/")) return {};
  const size_t first = name.find('/'), last = name.rfind('/');
  if (first == std::string_view::npos) {
    std::string full = fmt::format("{}/msg/{}", package, name);
    return full.size() > kLongestName ? "" : full;
  }
  if (last + 1 == name.size()) return {};
  if (first == last) return fmt::format("{}/msg/{}", name.substr(0, first), name.substr(last + 1));
  return std::string(name);
}

std::optional<FieldKind> primitive_kind(std::string_view name) {
  for (int kind = 0; kind <= static_cast<int>(FieldKind::kString); ++kind) {
    const std::string_view other = field_kind_name(static_cast<FieldKind>(kind));
    if (!other.empty() && other == name) return static_cast<FieldKind>(kind);
  }
  return std::nullopt;
}

class DefinitionParser {
 public:
  explicit DefinitionParser(std::string_view name) : file_(name) {
    start_message(std::string(name));
  }

  Status read_line(std::string_view line);
  Result<TypeDescription> finish() {
    if (expects_name_) return error("the name of a message is missing after a line of '='");
    return std::move(type_);
  }

 private:
  void start_message(std::string name) {
    package_ = name.substr(0, name.find('/'));
    type_.messages.push_back({.name = std::move(name)});
  }
  Status read_header(std::string_view line);
  Status read_member(std::string_view line);
  Status add_field(FieldType type, std::string_view name, std::string_view value);
  Result<FieldType> read_type(std::string_view text) const;
  Result<size_t> read_size(std::string_view digits) const;
  Error error(std::string message, std::string hint = "") const {
    return {.message = std::move(message), .loc = {file_, line_}, .hint = std::move(hint)};
  }

  TypeDescription type_;
  std::string file_, package_;
  int line_ = 0;
  bool expects_name_ = false;  ///< after a line of =
};

Status DefinitionParser::read_line(std::string_view line) {
  ++line_;
  line = without_spaces(line);
  if (expects_name_) return read_header(line);
  if (line.size() >= 3 && line.find_first_not_of('=') == std::string_view::npos) {
    expects_name_ = true;
    return {};
  }
  if (line.empty() || line[0] == '#') return {};
  return read_member(line);
}

Status DefinitionParser::read_header(std::string_view line) {
  constexpr std::string_view kMessage = "MSG: ";
  if (!line.starts_with(kMessage)) {
    return error(fmt::format("expected 'MSG: package/Name' instead of '{}'", line.substr(0, 40)),
                 line.starts_with("IDL:") ? "IDL definitions are not supported" : "");
  }
  const std::string_view short_name = without_spaces(line.substr(kMessage.size()));
  const std::string name = full_name(short_name, "");
  if (name.empty() || short_name.find('/') == std::string_view::npos) {
    return error(fmt::format("'{}' is not a message name", short_name.substr(0, 40)));
  }
  if (type_.find(name) != nullptr) return error(fmt::format("{} is defined twice", name));
  if (type_.messages.size() == kMostMessages) {
    return error(fmt::format("more than {} messages", kMostMessages));
  }
  start_message(name);
  expects_name_ = false;
  return {};
}

/// TYPE NAME, TYPE NAME DEFAULT or TYPE NAME=VALUE.
Status DefinitionParser::read_member(std::string_view line) {
  const size_t type_end = std::min(line.find_first_of(kSpaces), line.size());
  const std::string_view rest = without_spaces(line.substr(type_end));
  const size_t name_end = std::min(rest.find_first_of(" \t\r=#"), rest.size());
  const std::string_view name = rest.substr(0, name_end);
  if (!is_name(name)) {
    return error(
        fmt::format("'{}' is not a field: expected a type and a name", line.substr(0, 60)));
  }
  GLOAM_TRY(FieldType type, read_type(line.substr(0, type_end)));
  std::string_view value = without_spaces(rest.substr(name_end));
  if (!value.starts_with('=')) return add_field(std::move(type), name, value);
  value.remove_prefix(1);
  if (type.kind == FieldKind::kMessage || type.array != ArrayKind::kNone) {
    return error(fmt::format("constant '{}' does not have a primitive type", name));
  }
  if (type.kind != FieldKind::kString) value = value.substr(0, value.find('#'));
  auto& constants = type_.messages.back().constants;
  if (constants.size() == kMostFields) {
    return error(fmt::format("more than {} constants", kMostFields));
  }
  constants.push_back({std::string(line.substr(0, type_end)), std::string(name),
                       std::string(without_spaces(value))});
  return {};
}

/// `value`: its default, with a remark perhaps.
Status DefinitionParser::add_field(FieldType type, std::string_view name, std::string_view value) {
  std::vector<FieldDescription>& fields = type_.messages.back().fields;
  for (const FieldDescription& field : fields) {
    if (field.name == name) return error(fmt::format("field '{}' is defined twice", name));
  }
  if (fields.size() == kMostFields) return error(fmt::format("more than {} fields", kMostFields));
  const bool is_text = type.kind == FieldKind::kString;
  const size_t end = is_text && !value.starts_with('#') ? std::string_view::npos : value.find('#');
  fields.push_back({std::string(name), std::move(type),
                    std::string(without_spaces(value.substr(0, end))), line_});
  return {};
}

Result<size_t> DefinitionParser::read_size(std::string_view digits) const {
  uint32_t size = 0;
  const char* end = digits.data() + digits.size();
  const auto read = std::from_chars(digits.data(), end, size);
  if (read.ec != std::errc() || read.ptr != end || size == 0) {
    return error(
        fmt::format("'{}' is not an array size: expected 1 to 4294967295", digits.substr(0, 20)));
  }
  return size_t{size};
}

Result<FieldType> DefinitionParser::read_type(std::string_view text) const {
  FieldType type;
  const size_t bracket = text.find('[');
  std::string_view element = text.substr(0, bracket);
  if (bracket != std::string_view::npos) {
    std::string_view size = text.substr(bracket + 1);
    if (!size.ends_with(']'))
      return error(fmt::format("']' is missing in '{}'", text.substr(0, 60)));
    size.remove_suffix(1);
    type.array = size.empty()             ? ArrayKind::kUnbounded
                 : size.starts_with("<=") ? ArrayKind::kBounded
                                          : ArrayKind::kFixed;
    if (type.array == ArrayKind::kBounded) size.remove_prefix(2);
    if (type.array != ArrayKind::kUnbounded) {
      GLOAM_TRY(type.array_size, read_size(size));
    }
  }
  constexpr std::string_view kBoundedText = "string<=";
  if (element.starts_with(kBoundedText)) {
    GLOAM_TRY(type.string_bound, read_size(element.substr(kBoundedText.size())));
    element = element.substr(0, kBoundedText.size() - 2);
  }
  if (const auto kind = primitive_kind(element)) {
    type.kind = *kind;
    return type;
  }
  if (element.starts_with("wstring") || element == "wchar" || element == "float128") {
    return Error{.kind = ErrorKind::kUnsupported,
                 .message = fmt::format("type {} is not supported", element.substr(0, 20)),
                 .loc = {file_, line_}};
  }
  if (element == "time" || element == "duration") {
    return error(fmt::format("type {} is a ROS 1 type", element),
                 "convert the log to ROS 2, for example with rosbags-convert");
  }
  type.message = full_name(element, package_);
  if (type.message.empty()) return error(fmt::format("'{}' is not a type", text.substr(0, 60)));
  return type;
}

}  // namespace

Result<TypeDescription> parse_ros2msg(std::string_view text, std::string_view name) {
  if (text.size() > kMostText) {
    return Error{.message = fmt::format("the definition has more than {} bytes", kMostText),
                 .loc = {std::string(name.substr(0, kLongestName))}};
  }
  if (!is_name(name, "/") || name.find('/') == std::string_view::npos) {
    return Error{.message = fmt::format("'{}' is not a message name", name.substr(0, 60)),
                 .hint = "use a name such as sensor_msgs/msg/Imu"};
  }
  DefinitionParser parser(full_name(name, ""));
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    GLOAM_TRY_STATUS(parser.read_line(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.finish();
}

}  // namespace gloam
