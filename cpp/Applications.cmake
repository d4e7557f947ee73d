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
if(app_sources AND TARGET decalgl_geo)
    decalgl_require(PNG libpng-dev)
    decalgl_require(TIFF libtiff-dev)
    decalgl_require(nlohmann_json nlohmann-json3-dev)
    decalgl_require(CLI11 libcli11-dev)

    add_executable(decalgl_demo ${app_sources})
    decalgl_settings(decalgl_demo)
    target_link_libraries(decalgl_demo PRIVATE decalgl_geo decalgl_private PNG::PNG TIFF::TIFF
                                               nlohmann_json::nlohmann_json CLI11::CLI11)
    install(TARGETS decalgl_demo COMPONENT development)
endif()
