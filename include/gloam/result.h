#pragma once
// Errors caused by the user's data are values. Result<T> holds a T or an Error; neither may be
// ignored. Bugs are not values: see GLOAM_CHECK in src/base/check.h.

#include <string>
#include <utility>
#include <variant>

namespace gloam {

/// A location in a text file of the user. `line` and `column` count from 1; 0 = unknown.
struct SourceLoc {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Kind of a failure; it decides the exit code of the program.
enum class ErrorKind {
  kInput,     ///< a file or value from the user is wrong: exit 1
  kIo,        ///< reading or writing failed (permission, disk full, port in use): exit 1
  kUsage,     ///< the command line or the call is wrong: exit 2
  kPartial,   ///< the run stopped early, the recording so far is complete and readable: exit 3
  kDiverged,  ///< physics produced a value that is not finite; the last valid state is kept: exit 3
  kUnsupported,  ///< valid input that this build does not support: exit 1
  kInterrupted,  ///< stopped by the user: exit 130
};

/// One failure: the problem, its location and a remedy.
struct [[nodiscard]] Error {
  ErrorKind kind = ErrorKind::kInput;
  std::string message;    ///< one sentence without a final full stop
  SourceLoc loc = {};     ///< location in the user's files; empty if there is none
  std::string hint = {};  ///< remedy; may be empty

  /// "file:line:column: message (hint)", one line.
  std::string to_string() const;
  /// 1, 2, 3 or 130, as ErrorKind documents.
  int exit_code() const;
};

/// A value or an Error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}      // NOLINT: implicit on purpose, `return value;`
  Result(Error error) : value_(std::move(error)) {}  // NOLINT: implicit on purpose, `return error;`

  bool ok() const { return value_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return std::get<0>(value_); }
  const T& value() const& { return std::get<0>(value_); }
  T&& value() && { return std::get<0>(std::move(value_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const& { return std::get<1>(value_); }
  Error&& error() && { return std::get<1>(std::move(value_)); }

 private:
  std::variant<T, Error> value_;
};

/// Success without a value, or an Error.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_(std::move(error)), ok_(false) {}  // NOLINT: implicit on purpose

  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }
  const Error& error() const& { return error_; }
  Error&& error() && { return std::move(error_); }

 private:
  Error error_;
  bool ok_ = true;
};

}  // namespace gloam

#define GLOAM_CONCAT_INNER(a, b) a##b
#define GLOAM_CONCAT(a, b) GLOAM_CONCAT_INNER(a, b)

/// `GLOAM_TRY(auto x, f());` declares x from the value of f(), or returns its Error from this
/// function.
#define GLOAM_TRY(declaration, expression)                        \
  auto GLOAM_CONCAT(gloam_try_, __LINE__) = (expression);         \
  if (!GLOAM_CONCAT(gloam_try_, __LINE__).ok())                   \
    return std::move(GLOAM_CONCAT(gloam_try_, __LINE__)).error(); \
  declaration = std::move(GLOAM_CONCAT(gloam_try_, __LINE__)).value()

/// Returns the Error of a Status (or Result) from this function, if there is one.
#define GLOAM_TRY_STATUS(expression)                                \
  if (auto gloam_try_status = (expression); !gloam_try_status.ok()) \
  return std::move(gloam_try_status).error()
