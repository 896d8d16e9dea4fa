#pragma once
// Command lines of the measurement programs: "--name value", "--name" and words.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Each call takes what it finds out of the line, so that words() are what is left.
class CommandLine {
 public:
  CommandLine(int argc, char** argv) : words_(argv + 1, argv + argc) {}

  bool flag(std::string_view name) {
    const auto found = std::find(words_.begin(), words_.end(), name);
    if (found == words_.end()) return false;
    words_.erase(found);
    return true;
  }
  /// False, and nothing is written, where the option is not there.
  bool value(std::string_view name, std::string* out) {
    const auto found = std::find(words_.begin(), words_.end(), name);
    if (found == words_.end() || found + 1 == words_.end()) return false;
    *out = found[1];
    words_.erase(found, found + 2);
    return true;
  }
  void value(std::string_view name, int* out, int least = 1) {
    std::string text;
    if (value(name, &text)) *out = std::max(least, std::atoi(text.c_str()));
  }
  /// "--size WxH" [px].
  void size(int* width, int* height) {
    std::string text;
    if (value("--size", &text)) std::sscanf(text.c_str(), "%dx%d", width, height);
  }
  const std::vector<std::string>& words() const { return words_; }

 private:
  std::vector<std::string> words_;
};

/// Of a program that ended with `status`, after telling what went wrong.
inline int exit_code(const Status& status) {
  if (status.ok()) return 0;
  std::fprintf(stderr, "gloam: error: %s\n", status.error().to_string().c_str());
  return status.error().exit_code();
}

}  // namespace gloam
