#pragma once
// The only way to print: control characters in text from files, such as names, are shown and never
// executed by the terminal (gloam/text.h).

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "gloam/text.h"

namespace gloam::cli {

template <class T>
decltype(auto) shown(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return printable(std::string_view(value));
  } else {
    return (value);
  }
}

template <class... Args>
void print_to(std::FILE* file, fmt::format_string<const Args&...> format, const Args&... args) {
  const auto put = [&](const auto&... safe) {
    return fmt::vformat(format, fmt::make_format_args(safe...));
  };
  const std::string text = printable(put(shown(args)...), "\n");  // texts within ranges, too
  std::fwrite(text.data(), 1, text.size(), file);
}

/// Data, on stdout.
template <class... Args>
void say(fmt::format_string<const Args&...> format, const Args&... args) {
  print_to(stdout, format, args...);
}

/// Text for people, on stderr.
template <class... Args>
void tell(fmt::format_string<const Args&...> format, const Args&... args) {
  print_to(stderr, format, args...);
}

}  // namespace gloam::cli
