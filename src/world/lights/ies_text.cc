#include "world/lights/ies_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace gloam {
namespace {

constexpr int kMostAngles = 1 << 14;
constexpr int64_t kMostValues = 1 << 20;

/// A word of the file for a message: short, and printable.
std::string quoted(std::string_view word) {
  std::string out = "'";
  for (const char c : word.substr(0, 24)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (word.size() > 24 ? "…'" : "'");
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Error error(std::string message, std::string hint = {}, int line = 0) const {
    return {ErrorKind::kInput,
            std::move(message),
            {name_, line > 0 ? line : line_, 0},
            std::move(hint)};
  }

  bool next_line(std::string_view* line) {
    if (at_ >= text_.size()) return false;
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    *line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    next_ = line_ + 1;
    return true;
  }

  /// The next number, whatever line it is in; blanks and commas part numbers.
  Result<double> number(const char* what) {
    const auto parts = [](char c) {
      return std::isspace(static_cast<unsigned char>(c)) || c == ',';
    };
    while (at_ < text_.size() && parts(text_[at_])) next_ += text_[at_++] == '\n';
    line_ = next_;
    if (at_ >= text_.size()) return error(fmt::format("the file ends before {}", what));
    size_t end = at_;
    while (end < text_.size() && !parts(text_[end])) ++end;
    std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    std::string_view digits = word;
    if (digits.front() == '+') digits.remove_prefix(1);
    double value = 0;
    const auto [stop, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (code != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value)) {
      return error(fmt::format("{} instead of {}", quoted(word), what));
    }
    return value;
  }

  Result<int> whole(const char* what, int low, int high) {
    GLOAM_TRY(const double value, number(what));
    if (!(value >= low && value <= high) || value != std::floor(value)) {
      return error(
          fmt::format("{} is {}; whole numbers from {} to {} are allowed", what, value, low, high));
    }
    return static_cast<int>(value);
  }

  Result<double> factor(const char* what) {
    GLOAM_TRY(const double value, number(what));
    if (!(value >= 0 && value <= 1e9)) {
      return error(fmt::format("{} is {}; 0 to 1e9 is allowed", what, value));
    }
    return value;
  }

  Result<std::vector<double>> angles(const char* what, int count, int* line) {
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) {
      GLOAM_TRY(const double angle, number(what));
      if (i == 0) *line = line_;
      if (!(std::abs(angle) <= 360))
        return error(fmt::format("{} of {} degrees is out of range", what, angle));
      if (i > 0 && !(angle > angles.back())) {
        return error(fmt::format("{} {} is not greater than {}", what, angle, angles.back()));
      }
      angles.push_back(angle);
    }
    return angles;
  }

  int line() const { return line_; }

 private:
  std::string_view text_;
  const std::string& name_;
  size_t at_ = 0;
  int line_ = 0, next_ = 1;  ///< lines of the last token and of the next
};

std::string_view trimmed(std::string_view line) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!line.empty() && blank(line.front())) line.remove_prefix(1);
  while (!line.empty() && blank(line.back())) line.remove_suffix(1);
  return line;
}

/// Up to and with the TILT line and its table. `later`: LM-63-2002 and after, whose second factor
/// is a field for future use.
Status skip_header(Reader& in, bool* later) {
  std::string_view line;
  while (in.next_line(&line)) {
    line = trimmed(line);
    if (in.line() == 1 && line.starts_with("IES")) {
      *later = line.find("2002") != line.npos || line.find("2019") != line.npos;
    }
    if (!line.starts_with("TILT=")) continue;
    const std::string_view tilt = trimmed(line.substr(5));
    if (tilt == "NONE") return {};
    if (tilt != "INCLUDE") {
      return in.error(fmt::format("TILT refers to another file, {}", quoted(tilt)),
                      "include its table in this file with TILT=INCLUDE, or write TILT=NONE");
    }
    GLOAM_TRY_STATUS(in.whole("the lamp's geometry", 1, 3));
    GLOAM_TRY(const int pairs, in.whole("the number of tilt angles", 1, kMostAngles));
    for (int i = 0; i < 2 * pairs; ++i) GLOAM_TRY_STATUS(in.number("a value of the tilt table"));
    return {};
  }
  return in.error("has no TILT= line", "is it a photometric file (IES LM-63)?");
}

}  // namespace

Result<IesMeasurement> read_ies_text(std::string_view text, const std::string& name) {
  Reader in(text, name);
  bool later = false;
  GLOAM_TRY_STATUS(skip_header(in, &later));
  GLOAM_TRY_STATUS(in.whole("the number of lamps", 0, 1 << 20));
  GLOAM_TRY_STATUS(in.number("the lumens of a lamp"));
  GLOAM_TRY(double factor, in.factor("the multiplier"));
  GLOAM_TRY(const int verticals, in.whole("the number of vertical angles", 1, kMostAngles));
  GLOAM_TRY(const int horizontals, in.whole("the number of horizontal angles", 1, kMostAngles));
  if (static_cast<int64_t>(verticals) * horizontals > kMostValues) {
    return in.error(
        fmt::format("{} x {} intensities; the limit is {}", verticals, horizontals, kMostValues));
  }
  IesMeasurement out;
  GLOAM_TRY(const int type, in.whole("the photometric type", 1, 3));
  out.type = static_cast<Goniometer>(type);
  GLOAM_TRY_STATUS(in.whole("the unit of lengths", 1, 2));
  for (const char* what : {"the width", "the length", "the height"}) {
    GLOAM_TRY_STATUS(in.number(what));
  }
  GLOAM_TRY(const double ballast, in.factor("the ballast factor"));
  GLOAM_TRY(const double lamp, in.factor("the ballast-lamp factor"));
  GLOAM_TRY_STATUS(in.number("the input watts"));
  factor *= ballast * (later ? 1 : lamp);
  GLOAM_TRY(out.vertical, in.angles("a vertical angle", verticals, &out.vertical_line));
  GLOAM_TRY(out.horizontal, in.angles("a horizontal angle", horizontals, &out.horizontal_line));
  for (int64_t i = 0; i < static_cast<int64_t>(verticals) * horizontals; ++i) {
    GLOAM_TRY(const double value, in.number("an intensity"));
    if (!(value >= 0 && value * factor <= 1e12)) {
      return in.error(
          fmt::format("an intensity of {} cd, times {}, is out of range", value, factor));
    }
    out.candela.push_back(value * factor);
  }
  return out;
}

}  // namespace gloam
