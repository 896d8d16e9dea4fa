#pragma once
// A line at the bottom of the terminal that changes in place.

#include <string>

namespace gloam::cli {

/// Written to stderr below the cursor, so that other messages appear above it. Nothing if stderr is
/// not a terminal, or TERM is "dumb", or the program runs in the background. Without colours.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Shows the text, cut to the width of the terminal.
  void show(const std::string& text);
  void clear();

 private:
  bool is_possible_ = false;
  bool is_shown_ = false;
};

}  // namespace gloam::cli
