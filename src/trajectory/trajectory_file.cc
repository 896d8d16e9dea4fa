// Trajectories out of files of others.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/files.h"
#include "base/formats/foreign_format.h"
#include "base/text.h"
#include "trajectory/rigid_pose.h"

namespace gloam {
namespace {

constexpr uint64_t kMostFileBytes = uint64_t{1} << 30;
constexpr double kMostMeters = 1e12;           // sums of squares of more leave the doubles' digits
constexpr double kQuaternionTolerance = 0.01;  // of its length: files have four digits and up
constexpr double kRotationTolerance = 0.001;   // of R Rᵀ, within which a matrix is kept as it is
constexpr double kRoundedRotation = 0.05;      // of R Rᵀ: rounded to two decimals, and drifted
constexpr long double kMostSeconds = 4e9L;     // differences of nanoseconds fit into 64 bits

enum class LineFormat { kUnknown, kTum, kKitti, kEuroc };

// A number at the start of `text`, which is removed together with the separator after it.
template <class Number>
bool take_number(std::string_view* text, Number* value) {
  while (!text->empty() && (text->front() == ' ' || text->front() == '\t')) text->remove_prefix(1);
  if (text->size() > 1 && text->front() == '+' && (*text)[1] != '-') text->remove_prefix(1);
  const auto [after, error] = std::from_chars(text->data(), text->data() + text->size(), *value);
  if (error != std::errc() || !std::isfinite(*value)) return false;
  text->remove_prefix(static_cast<size_t>(after - text->data()));
  const size_t spaces = text->find_first_not_of(" \t");
  text->remove_prefix(spaces == std::string_view::npos ? text->size() : spaces);
  const bool was_space = spaces != 0;
  if (!text->empty() && text->front() == ',')
    text->remove_prefix(1);
  else if (!text->empty() && !was_space)
    return false;  // "1.2x"
  return true;
}

size_t field_count(std::string_view line, char divider) {
  size_t count = 0;
  if (divider == ',') {
    count = 1;
    for (const char c : line) count += c == ',' ? 1 : 0;
    return count;
  }
  bool inside = false;
  for (const char c : line) {
    const bool is_field = c != ' ' && c != '\t';
    count += is_field && !inside ? 1 : 0;
    inside = is_field;
  }
  return count;
}

class TrajectoryParser {
 public:
  explicit TrajectoryParser(const std::string& name) { out_.name = name; }

  Result<Trajectory> parse(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty()) {
      ++number_;
      const size_t end = text.find('\n');
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t'))
        line.remove_suffix(1);
      const size_t begin = line.find_first_not_of(" \t");
      if (begin == std::string_view::npos || line[begin] == '#') continue;
      GLOAM_TRY_STATUS(take(line.substr(begin)));
    }
    if (out_.positions.empty())
      return Error{ErrorKind::kInput, "contains no poses", {out_.name, 0, 0}, kHint};
    note_rough_matrices();
    return std::move(out_);
  }

 private:
  static constexpr const char* kHint =
      "a line is 't x y z qx qy qz qw' (TUM), 12 numbers (KITTI) or 'ns,x,y,z,qw,qx,qy,qz' (EuRoC)";

  Error at_line(std::string message, std::string hint = "") const {
    return {ErrorKind::kInput, std::move(message), {out_.name, number_, 0}, std::move(hint)};
  }

  Status take(std::string_view line) {
    const char divider = line.find(',') != std::string_view::npos ? ',' : ' ';
    const size_t fields = field_count(line, divider);
    LineFormat format = LineFormat::kUnknown;
    if (divider == ',' && fields >= 8) format = LineFormat::kEuroc;
    if (divider == ' ' && fields == 8) format = LineFormat::kTum;
    if (divider == ' ' && fields == 12) format = LineFormat::kKitti;
    if (format == LineFormat::kUnknown || (format_ != LineFormat::kUnknown && format != format_))
      return at_line(
          fmt::format("{} fields separated by '{}' are {}", fields, divider,
                      format == LineFormat::kUnknown ? "not a pose"
                                                     : "not the format of the previous lines"),
          kHint);
    format_ = format;
    if (format != LineFormat::kKitti) GLOAM_TRY_STATUS(take_stamp(&line));
    double numbers[12];
    const size_t count = format == LineFormat::kKitti ? 12 : 7;
    for (size_t i = 0; i < count; ++i)
      if (!take_number(&line, &numbers[i]))
        return at_line(fmt::format("'{}' is not a finite number",
                                   as_utf8(line.substr(0, std::min<size_t>(line.size(), 24)))));
    if (format == LineFormat::kKitti) return add_matrix(numbers);
    const double* q = numbers + 3;
    return format == LineFormat::kTum
               ? add_pose({numbers[0], numbers[1], numbers[2]}, {q[3], q[0], q[1], q[2]})
               : add_pose({numbers[0], numbers[1], numbers[2]}, {q[0], q[1], q[2], q[3]});
  }

  Status take_stamp(std::string_view* line) {
    long double time = 0;
    if (!take_number(line, &time)) return at_line("the time is not a finite number");
    const long double seconds = format_ == LineFormat::kEuroc ? time * 1e-9L : time;
    if (std::fabs(seconds) > kMostSeconds)
      return at_line("the time is more than 4e9 s: is it in seconds (EuRoC: nanoseconds)?");
    const int64_t stamp = std::llround(format_ == LineFormat::kEuroc ? time : time * 1e9L);
    if (!out_.stamps.empty() && stamp < out_.stamps.back())
      return at_line(fmt::format("time goes back by {} s",
                                 static_cast<double>(out_.stamps.back() - stamp) * 1e-9),
                     "sort the lines by time");
    out_.stamps.push_back(stamp);
    return {};
  }

  Status add_matrix(const double* m) {
    const RotationRows R = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    const double distance = distance_from_rotation(R);
    if (!(distance <= kRoundedRotation))
      return at_line("the 3x3 part is not a rotation matrix",
                     "R Rᵀ must be the identity to within 0.05, and R must not be a reflection");
    const bool is_rough = distance > kRotationTolerance;
    if (is_rough) {
      ++rough_;
      roughest_ = std::max(roughest_, distance);
    }
    return add({m[3], m[7], m[11]}, is_rough ? rotation_of(nearest_quaternion(R)) : R);
  }

  void note_rough_matrices() {
    if (rough_ == 0) return;
    out_.notes.push_back(
        fmt::format("{}: the matrices of {} of {} poses are rotations only to within {:.2g}: the "
                    "nearest rotation is used; write more decimals",
                    out_.name, rough_, out_.size(), roughest_));
  }

  Status add_pose(const Vec3& p, const Quat& q) {
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(std::fabs(length - 1) <= kQuaternionTolerance))
      return at_line(fmt::format("the quaternion's length is {:.3g}, not 1", length),
                     "TUM ends with qw, EuRoC begins with it");
    return add(p, rotation_of(q));
  }

  Status add(const Vec3& p, const RotationRows& R) {
    if (std::fabs(p.x) > kMostMeters || std::fabs(p.y) > kMostMeters ||
        std::fabs(p.z) > kMostMeters)
      return at_line("a coordinate of the position exceeds 1e12 m");
    out_.positions.push_back(p);
    out_.rotations.push_back(R);
    return {};
  }

  Trajectory out_;
  LineFormat format_ = LineFormat::kUnknown;
  int number_ = 0;
  size_t rough_ = 0;  // matrices that were replaced
  double roughest_ = 0;
};

}  // namespace

double Trajectory::path_length() const {
  double length = 0;
  for (size_t i = 1; i < positions.size(); ++i) length += norm(positions[i] - positions[i - 1]);
  return length;
}

Result<Trajectory> parse_trajectory(std::string_view text, const std::string& name) {
  return TrajectoryParser(name).parse(text);
}

Result<Trajectory> read_trajectory_file(const std::filesystem::path& file) {
  GLOAM_TRY_STATUS(refuse_foreign_format(file));
  GLOAM_TRY(const std::string text, read_text_file(file, kMostFileBytes));
  return parse_trajectory(text, file.string());
}

Result<Trajectory> make_trajectory(std::span<const StampedPose> poses, const std::string& name) {
  Trajectory out;
  out.name = name;
  const auto wrong = [&](size_t i, const char* what) {
    return Error{ErrorKind::kInput, fmt::format("pose {} {}", i + 1, what), {name, 0, 0}};
  };
  for (size_t i = 0; i < poses.size(); ++i) {
    const auto& [stamp, X] = poses[i];
    const Quat& q = X.q;
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(std::fabs(X.p.x) <= kMostMeters && std::fabs(X.p.y) <= kMostMeters &&
          std::fabs(X.p.z) <= kMostMeters))
      return wrong(i, "does not have a finite position");
    if (!(std::fabs(length - 1) <= kQuaternionTolerance))
      return wrong(i, "does not have a unit quaternion");
    if (!out.stamps.empty() && stamp < out.stamps.back())
      return wrong(i, "is earlier than the previous pose");
    out.stamps.push_back(stamp);
    out.positions.push_back(X.p);
    out.rotations.push_back(rotation_of(q));
  }
  if (poses.empty()) return Error{ErrorKind::kInput, "contains no poses", {name, 0, 0}};
  return out;
}

}  // namespace gloam
