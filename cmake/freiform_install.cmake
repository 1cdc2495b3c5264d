# What `cmake --install` adds to the libraries: headers, package configuration, pkg-config files.
install(DIRECTORY include/freiform DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
get_property(FREIFORM_COMPONENTS GLOBAL PROPERTY FREIFORM_COMPONENTS)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/freiform)
configure_package_config_file(cmake/freiform-config.cmake.in freiform-config.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(freiform-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/freiform-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/freiform-config-version.cmake
    DESTINATION ${config_folder})
