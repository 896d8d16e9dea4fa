#pragma once
// A first look at a model's XML, before MuJoCo sees it: bounds what hostile files could make its
// recursive parser or its compiler do, and remembers where every file is named.

#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// One attribute that names a file, or the folder of files (<compiler meshdir="…">).
struct FileReference {
  std::string element;    ///< "mesh", "include" …
  std::string attribute;  ///< "file", "fileup", "filename" …
  std::string value;      ///< as written
  int line = 0;           ///< line of the element
};

/// A <replicate>, of which MuJoCo's time grows with the square of its copies.
struct Replicate {
  double seconds = 0;  ///< time that MuJoCo takes for it, roughly
  double copies = 0;
  int line = 0;
};

struct XmlScan {
  std::string root;                       ///< name of the top element: "mujoco", "robot" …
  std::vector<FileReference> references;  ///< in document order
  bool has_plugins = false;               ///< an <extension> or <plugin> element
  Replicate slowest;
};

/// `file` names the text in errors. Errors: not well-formed, nested deeper than 200, absurd sizes
/// (a billion replicas, a texture of a million pixels' width …).
Result<XmlScan> scan_model_xml(std::string_view text, const std::string& file);

/// Is there an element `name` (any, if empty) that starts in line `line`?
bool has_element_at(std::string_view text, std::string_view name, int line);

/// Line of the first element `name`; 0 = none.
int line_of_element(std::string_view text, std::string_view name);

/// Line of the first element `name` (any, if empty) with an attribute whose name or value is one of
/// `words`; 0 = none.
int line_of_element_with(std::string_view text, std::string_view name,
                         const std::vector<std::string>& words);

}  // namespace gloam
