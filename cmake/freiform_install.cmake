# What `cmake --install` adds to the programs: libraries, headers, package configuration, pkg-config files.
get_property(FREIFORM_COMPONENTS GLOBAL PROPERTY FREIFORM_COMPONENTS)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/freiform)
if(BUILD_SHARED_LIBS)
    set(FREIFORM_STATIC OFF)
else()
    set(FREIFORM_STATIC ON)
endif()

install(DIRECTORY include/freiform DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
foreach(component IN LISTS FREIFORM_COMPONENTS)
    install(TARGETS freiform_${component} EXPORT freiform_${component}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(EXPORT freiform_${component} NAMESPACE freiform:: FILE freiform-${component}.cmake
        DESTINATION ${config_folder})
endforeach()

configure_package_config_file(cmake/freiform-config.cmake.in freiform-config.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(freiform-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/freiform-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/freiform-config-version.cmake
    DESTINATION ${config_folder})

# pkg-config finds its folder from where the file lies, so an installed tree can be moved.
function(freiform_pkgconfig component description requires private_libs)
    file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    set(COMPONENT ${component})
    set(DESCRIPTION ${description})
    set(REQUIRES ${requires})
    set(PRIVATE_LIBS ${private_libs})
    set(DEFINITIONS "")
    if(NOT FREIFORM_THREADS)
        set(DEFINITIONS " -DFREIFORM_SERIAL=1")  # as freiform_core has it
    endif()
    set(PREFIX "\${pcfiledir}/${up}")
    configure_file(cmake/freiform.pc.in freiform-${component}.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/freiform-${component}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

set(private "-lstdc++ -lm")
set(tbb "")
if(FREIFORM_THREADS)
    set(tbb tbb)
endif()
freiform_pkgconfig(core "curves and surfaces whose answers carry a bound that holds" "${tbb}" "${private}")
if(io IN_LIST FREIFORM_COMPONENTS)
    freiform_pkgconfig(io "freiform's readers and writers" "freiform-core = ${PROJECT_VERSION}" "-lpugixml ${private}")
endif()
