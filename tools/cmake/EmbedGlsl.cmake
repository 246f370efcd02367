# Shaders as text in a generated source file.
#
#   rangepose_embed_glsl(out folder file...)   sets `out` to the generated file; files are named relative to folder
#
# The file is written at build time by this script itself (cmake -P), so an edited shader rebuilds one file.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(RANGEPOSE_EMBED_GLSL_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

  function(rangepose_embed_glsl out folder)
    set(generated ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.cpp)
    list(TRANSFORM ARGN PREPEND ${folder}/ OUTPUT_VARIABLE paths)
    list(JOIN ARGN "," names)
    add_custom_command(
      OUTPUT ${generated}
      COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder} -DNAMES=${names} -DOUTPUT=${generated}
              -P ${RANGEPOSE_EMBED_GLSL_SCRIPT}
      DEPENDS ${paths} ${RANGEPOSE_EMBED_GLSL_SCRIPT}
      COMMENT "Embedding shaders" VERBATIM)
    set(${out} ${generated} PARENT_SCOPE)
  endfunction()
  return()
endif()

string(REPLACE "," ";" NAMES "${NAMES}")
set(text "// Generated from glsl/ by EmbedGlsl.cmake.\n#include \"gles/shader_library.h\"\n\n")
string(APPEND text "namespace rangepose::gles::detail {\n\n")
string(APPEND text "const std::vector<EmbeddedShader>& embeddedShaders() {\n")
string(APPEND text "  static const std::vector<EmbeddedShader> kShaders = {\n")
foreach(name IN LISTS NAMES)
  file(READ "${FOLDER}/${name}" body)
  string(APPEND text "      {\"${name}\", R\"rp_glsl(${body})rp_glsl\"},\n")
endforeach()
string(APPEND text "  };\n  return kShaders;\n}\n\n}  // namespace rangepose::gles::detail\n")
file(WRITE "${OUTPUT}" "${text}")
