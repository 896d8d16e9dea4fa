#include "gloam/result.h"

#include <fmt/format.h>

#include "gloam/text.h"

namespace gloam {

std::string Error::to_string() const {
  std::string text;
  if (!loc.file.empty()) {
    text = printable(loc.file);
    if (loc.line > 0) text += fmt::format(":{}", loc.line);
    if (loc.line > 0 && loc.column > 0) text += fmt::format(":{}", loc.column);
    text += ": ";
  }
  text += printable(message);
  if (!hint.empty()) text += fmt::format(" ({})", printable(hint));
  return text;
}

int Error::exit_code() const {
  switch (kind) {
    case ErrorKind::kUsage:
      return 2;
    case ErrorKind::kPartial:
    case ErrorKind::kDiverged:
      return 3;
    case ErrorKind::kInterrupted:
      return 130;
    case ErrorKind::kInput:
    case ErrorKind::kIo:
    case ErrorKind::kUnsupported:
      return 1;
  }
  return 1;
}

}  // namespace gloam
