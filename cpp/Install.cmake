# find_package(decalgl) for other projects: decalgl::core and, where built, decalgl::geo.

include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/decalgl")
install(TARGETS ${exported_targets} EXPORT decalglTargets COMPONENT development)
install(DIRECTORY "${CMAKE_CURRENT_LIST_DIR}/include/decalgl" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        COMPONENT development FILES_MATCHING PATTERN "*.h")
install(EXPORT decalglTargets NAMESPACE decalgl:: DESTINATION "${package_dir}" COMPONENT development)

configure_package_config_file(
    "${PROJECT_SOURCE_DIR}/cmake/decalglConfig.cmake.in" "${CMAKE_CURRENT_BINARY_DIR}/decalglConfig.cmake"
    INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/decalglConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/decalglConfig.cmake"
              "${CMAKE_CURRENT_BINARY_DIR}/decalglConfigVersion.cmake"
        DESTINATION "${package_dir}" COMPONENT development)
