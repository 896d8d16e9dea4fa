# cmake -D OUTPUT=… -D FOLDER=… -P embed_page.cmake: writes the page's files as byte arrays into one C++ source.
set(files "/|index.html|text/html" "/app.js|app.js|text/javascript" "/style.css|style.css|text/css" "/icon.svg|icon.svg|image/svg+xml")
set(arrays "")
set(rows "")
foreach(entry IN LISTS files)
  string(REPLACE "|" ";" entry "${entry}")
  list(GET entry 0 path)
  list(GET entry 1 file)
  list(GET entry 2 type)
  file(READ ${FOLDER}/${file} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
  string(MAKE_C_IDENTIFIER "k_${file}" name)
  string(APPEND arrays "constexpr char ${name}[] = {${bytes}};\n")
  string(APPEND rows "    {\"${path}\", \"${type}; charset=utf-8\", {${name}, sizeof ${name}}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from studio/web by embed_page.cmake.
#include \"studio/page.h\"

namespace gloam::studio {
namespace {
${arrays}
constexpr PageFile kFiles[] = {
${rows}};
}  // namespace

const PageFile* find_page_file(std::string_view path) {
  for (const PageFile& file : kFiles)
    if (file.path == path) return &file;
  return nullptr;
}

}  // namespace gloam::studio
")
