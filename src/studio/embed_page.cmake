# cmake -D OUTPUT=… -D FOLDER=… -P embed_page.cmake: writes a C++ source that contains the page's files. The assembler reads
# them, because compilers take long for arrays of a million bytes.
set(types "html|text/html" "js|text/javascript" "css|text/css" "svg|image/svg+xml")
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*)
set(sections "")
set(symbols "")
set(rows "")
foreach(file IN LISTS files)
  get_filename_component(extension ${file} LAST_EXT)
  string(SUBSTRING "${extension}" 1 -1 extension)
  set(type "")
  foreach(entry IN LISTS types)
    if(entry MATCHES "^${extension}\\|(.*)$")
      set(type ${CMAKE_MATCH_1})
    endif()
  endforeach()
  if(NOT type)
    message(FATAL_ERROR "${FOLDER}/${file}: add its media type to embed_page.cmake")
  endif()
  string(MAKE_C_IDENTIFIER "gloam_page_${file}" name)
  set(path "/${file}")
  if(file STREQUAL "index.html")
    set(path "/")
  endif()
  string(APPEND sections "    \".hidden ${name}\\n.hidden ${name}_end\\n.global ${name}\\n.global ${name}_end\\n\"\n"
    "    \"${name}:\\n.incbin \\\"${FOLDER}/${file}\\\"\\n${name}_end:\\n\"\n")
  string(APPEND symbols "extern const char ${name}[], ${name}_end[];\n")
  string(APPEND rows "    {\"${path}\", \"${type}; charset=utf-8\", {${name}, static_cast<size_t>(${name}_end - ${name})}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from ${FOLDER} by embed_page.cmake.
#include \"studio/page.h\"

asm(\".pushsection .rodata\\n\"
${sections}    \".popsection\\n\");
extern \"C\" {
${symbols}}

namespace gloam::studio {
namespace {
const PageFile kFiles[] = {
${rows}};
}  // namespace

const PageFile* find_page_file(std::string_view path) {
  for (const PageFile& file : kFiles)
    if (file.path == path) return &file;
  return nullptr;
}

}  // namespace gloam::studio
")
