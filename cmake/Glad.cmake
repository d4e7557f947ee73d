# Generates the table of OpenGL functions, and EGL's types, from the specifications inside glad2.
# Sets GLAD_INCLUDE_DIR and GLAD_SOURCE; only gl.c is compiled, since EGL is opened at run time.

set(GLAD_DIR "${PROJECT_BINARY_DIR}/generated/glad")
set(GLAD_INCLUDE_DIR "${GLAD_DIR}/include")
set(GLAD_SOURCE "${GLAD_DIR}/src/gl.c")
set(GLAD_EXTENSIONS
    EGL_EXT_device_base
    EGL_EXT_device_enumeration
    EGL_EXT_device_query
    EGL_EXT_platform_base
    EGL_EXT_platform_device
    EGL_KHR_create_context
    EGL_KHR_no_config_context
    EGL_KHR_surfaceless_context
    EGL_MESA_platform_surfaceless
    GL_ARB_texture_filter_anisotropic
    GL_EXT_texture_filter_anisotropic)
list(JOIN GLAD_EXTENSIONS "," glad_extension_list)

add_custom_command(
    OUTPUT "${GLAD_SOURCE}" "${GLAD_INCLUDE_DIR}/glad/gl.h" "${GLAD_INCLUDE_DIR}/glad/egl.h"
    COMMAND "${Python_EXECUTABLE}" -m glad --quiet --reproducible --api "gl:core=4.6,egl=1.5"
            --extensions "${glad_extension_list}" --out-path "${GLAD_DIR}" c
    DEPENDS "${CMAKE_CURRENT_LIST_FILE}"
    COMMENT "Generating the table of OpenGL functions"
    VERBATIM)
add_custom_target(decalgl_glad DEPENDS "${GLAD_SOURCE}")
set_source_files_properties("${GLAD_SOURCE}" PROPERTIES COMPILE_OPTIONS -w)
