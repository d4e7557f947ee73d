# Writes the shader files and their manifest into one source file, SHADER_SOURCE.

set(SHADER_DIR "${PROJECT_SOURCE_DIR}/cpp/shaders")
set(SHADER_SOURCE "${PROJECT_BINARY_DIR}/generated/shaders.cpp")
file(GLOB_RECURSE SHADER_FILES CONFIGURE_DEPENDS "${SHADER_DIR}/*.glsl" "${SHADER_DIR}/*.h"
     "${SHADER_DIR}/manifest.json")

add_custom_command(
    OUTPUT "${SHADER_SOURCE}"
    COMMAND "${Python_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/embed_shaders.py" "${SHADER_DIR}" "${SHADER_SOURCE}"
    DEPENDS ${SHADER_FILES} "${CMAKE_CURRENT_LIST_DIR}/embed_shaders.py"
    COMMENT "Embedding the shaders"
    VERBATIM)
