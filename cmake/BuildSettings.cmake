# Compiler settings that every target shares.

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_C_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

if(DECALGL_LTO)
    set(CMAKE_INTERPROCEDURAL_OPTIMIZATION ON)
endif()

if(DECALGL_SANITIZE)
    add_compile_options(-fsanitize=${DECALGL_SANITIZE} -fno-omit-frame-pointer)
    add_link_options(-fsanitize=${DECALGL_SANITIZE})
    if(DECALGL_SANITIZE MATCHES "undefined")
        add_compile_options(-fno-sanitize-recover=undefined)
    endif()
endif()

find_package(Threads REQUIRED)

# A package that configuring cannot do without, with the Debian package that brings it.
macro(decalgl_require package debian_package)
    find_package(${package} QUIET ${ARGN})
    if(NOT ${package}_FOUND)
        message(FATAL_ERROR "decalgl needs ${package}, which was not found. "
                            "Install it: apt-get install ${debian_package}")
    endif()
endmacro()

# Warnings, and contraction off: a fused multiply-add on one machine and not on another would make
# preprocessing depend on the machine. Nobody reads errno or floating-point exceptions, and loops that keep them are not
# vectorised.
function(decalgl_settings target)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -ffp-contract=off -fno-math-errno
                           -fno-trapping-math
                           $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>)
    if(DECALGL_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
endfunction()
