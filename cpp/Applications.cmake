# decalgl_geo, the only user of GeographicLib, and the demo program, which reads and writes files itself.

file(GLOB_RECURSE geo_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/src/geo/*.cpp")
if(geo_sources)
    # Debian keeps the find module in a folder that CMake does not search.
    list(APPEND CMAKE_MODULE_PATH /usr/share/cmake/geographiclib)
    decalgl_require(GeographicLib libgeographiclib-dev)
    if(TARGET GeographicLib::GeographicLib)
        set(geographic_target GeographicLib::GeographicLib)
    else()
        set(geographic_target ${GeographicLib_LIBRARIES})
    endif()

    add_library(decalgl_geo STATIC ${geo_sources})
    add_library(decalgl::geo ALIAS decalgl_geo)
    decalgl_settings(decalgl_geo)
    target_link_libraries(decalgl_geo PUBLIC decalgl_core PRIVATE "$<BUILD_INTERFACE:decalgl_private>"
                                             ${geographic_target})
    set_target_properties(decalgl_geo PROPERTIES EXPORT_NAME geo)
    list(APPEND exported_targets decalgl_geo)
endif()

file(GLOB_RECURSE app_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/src/app/*.cpp")
list(FILTER app_sources EXCLUDE REGEX "/main\\.cpp$")
if(app_sources AND TARGET decalgl_geo)
    decalgl_require(PNG libpng-dev)
    decalgl_require(TIFF libtiff-dev 4.5)
    decalgl_require(ZLIB zlib1g-dev)
    decalgl_require(nlohmann_json nlohmann-json3-dev)
    decalgl_require(CLI11 libcli11-dev)

    # All of the program but main, so that tests can call it.
    add_library(decalgl_demo_parts STATIC ${app_sources})
    decalgl_settings(decalgl_demo_parts)
    target_link_libraries(
        decalgl_demo_parts
        PUBLIC decalgl_geo
        PRIVATE decalgl_private PNG::PNG TIFF::TIFF ZLIB::ZLIB nlohmann_json::nlohmann_json)

    add_executable(decalgl_demo "${CMAKE_CURRENT_LIST_DIR}/src/app/main.cpp")
    decalgl_settings(decalgl_demo)
    target_link_libraries(decalgl_demo PRIVATE decalgl_demo_parts decalgl_private CLI11::CLI11)
    install(TARGETS decalgl_demo COMPONENT development)
endif()
