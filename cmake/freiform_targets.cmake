# freiform_library(NAME FOLDER...): the component NAME from src/FOLDER/*.cpp, as target freiform_NAME = freiform::NAME.
function(freiform_common target)
    target_compile_features(${target} PUBLIC cxx_std_23)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
    # No contraction: a sum of products gives the same bits on every machine.
    target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno)
    if(FREIFORM_WARNINGS)
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Werror)
    endif()
    if(FREIFORM_CHECKED)
        target_compile_definitions(${target} PRIVATE FF_CHECKED=1)
    endif()
endfunction()

set_property(GLOBAL PROPERTY FREIFORM_COMPONENTS "")

function(freiform_library name)
    set(sources "")
    foreach(folder IN LISTS ARGN)
        file(GLOB found CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/src/${folder}/*.cpp")
        list(APPEND sources ${found})
    endforeach()
    add_library(freiform_${name} ${sources})
    add_library(freiform::${name} ALIAS freiform_${name})
    freiform_common(freiform_${name})
    target_include_directories(freiform_${name}
        PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
        PRIVATE ${PROJECT_SOURCE_DIR}/src)
    set_target_properties(freiform_${name} PROPERTIES EXPORT_NAME ${name}
        ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
    if(BUILD_SHARED_LIBS)
        set_target_properties(freiform_${name} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
    endif()
    if(FREIFORM_PCH)
        target_precompile_headers(freiform_${name} PRIVATE <algorithm> <array> <cmath> <expected> <functional> <memory>
            <optional> <span> <string> <variant> <vector>)
    endif()
    install(TARGETS freiform_${name} EXPORT freiform_${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(EXPORT freiform_${name} NAMESPACE freiform:: FILE freiform-${name}.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/freiform)
    set_property(GLOBAL APPEND PROPERTY FREIFORM_COMPONENTS ${name})
endfunction()
