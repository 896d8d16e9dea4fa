#pragma once
// Writes .npy files for tests.

#include <cstring>
#include <string>
#include <vector>

namespace gloam {

/// `head` is the dictionary; version 1 has a two-byte length, later ones a four-byte one.
inline std::string npy_file(const std::string& head, const std::string& values, int version = 1) {
  std::string text = head + "\n";
  std::string out = "\x93NUMPY";
  out += static_cast<char>(version);
  out += '\0';
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
    out += static_cast<char>(text.size() >> (8 * i) & 255);
  return out + text + values;
}

template <class T>
std::string npy_values(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string npy_head(const std::string& shape, const std::string& type = "<f4",
                            const std::string& order = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }";
}

}  // namespace gloam
