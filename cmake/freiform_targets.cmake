# freiform_common(TARGET): the flags that everything of the project is compiled with.
# freiform_library(NAME FOLDER...): the component NAME from src/FOLDER/*.cpp, as target freiform_NAME = freiform::NAME.

if(FREIFORM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(FREIFORM_CCACHE_PROGRAM ccache)
    mark_as_advanced(FREIFORM_CCACHE_PROGRAM)
    if(FREIFORM_CCACHE_PROGRAM)
        # What ccache has to be told before it dares to cache files that use a precompiled header, that another clone has
        # the same files in another folder, and to compare headers byte by byte (CCACHE_DEPEND). Without their comments, as
        # it compares them otherwise, it hands out a precompiled header of the text before, and g++ takes the header with
        # the new text for another file ("redefinition of").
        set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
            CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
            CCACHE_DEPEND=1 CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} ${FREIFORM_CCACHE_PROGRAM})
    endif()
endif()

function(freiform_common target)
    target_compile_features(${target} PUBLIC cxx_std_23)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
    if(NOT CMAKE_SYSTEM_PROCESSOR STREQUAL wasm32)
        set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
    # No contraction: a sum of products gives the same bits on every machine.
    target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno)
    if(FREIFORM_WARNINGS)
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Werror)
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        # False alarms of g++ 12 about std::string and std::vector that it has inlined (its bugs 105329, 105651).
        target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
    endif()
    if(FREIFORM_CHECKED)
        target_compile_definitions(${target} PRIVATE FF_CHECKED=1)
    endif()
    if(FREIFORM_PCH AND FREIFORM_CCACHE)
        # ccache looks at what the header contains, not at when it was written.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
            $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)
    endif()
endfunction()

# freiform_quick(TARGET): computes little, so that with FREIFORM_QUICK it is not optimised. After freiform_common.
function(freiform_quick target)
    if(FREIFORM_QUICK)
        target_compile_options(${target} PRIVATE -O0)
    endif()
endfunction()

# freiform_unity(TARGET SIZE FILE...): files of one folder are compiled SIZE at a time as one, so that what they share
# is parsed and instantiated once; half the time of a cold build. After freiform_isa and freiform_cold: a file with
# options of its own stays by itself. The names of a folder's files must differ, also those that only one file sees.
function(freiform_unity target size)
    if(NOT FREIFORM_UNITY)
        return()
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    # g++ takes a file that is included for a header, where types that only one file sees would be wrong.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    set(last "")
    foreach(file IN LISTS ARGN)
        get_filename_component(folder ${file} DIRECTORY)
        if(NOT folder STREQUAL last)
            set(last ${folder})
            set(count 0)
        endif()
        get_filename_component(name ${folder} NAME)
        math(EXPR group "${count} / ${size}")
        math(EXPR count "${count} + 1")
        set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${name}_${group})
    endforeach()
endfunction()

set_property(GLOBAL PROPERTY FREIFORM_COMPONENTS "")

function(freiform_library name)
    set(sources "")
    foreach(folder IN LISTS ARGN)
        file(GLOB found CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/src/${folder}/*.cpp")
        if(CMAKE_SYSTEM_PROCESSOR STREQUAL wasm32)  # readers that src/io/read.cpp does without there
            list(FILTER found EXCLUDE REGEX "/io/(rhino_|bezierview)")
        endif()
        list(APPEND sources ${found})
    endforeach()
    set(all ${sources})  # those that are compiled as one are of one group, whichever part they are in
    # Modules: but for what evaluates, bounds and tessellates, and there again for what is done seldom, all is compiled
    # without putting functions into their callers, as files and commands are (bindings/wasm/CMakeLists.txt).
    if(CMAKE_SYSTEM_PROCESSOR STREQUAL wasm32)
        string(CONCAT hot "/src/(basis|core|io|kernel|mesh|poly)/|/src/spline/(block|derivative|geometry|patch|prepared)|"
            "/src/model/(apex|edge_|face_|matched|piecewise|tessellat|triangle_)")
        string(CONCAT rare "/(arc_index|change|curvature_tree_columns|curvature_tree_torn|decimal|edge_continuity|edge_gap|"
            "edge_length|edge_mesh|edge_parts|exact|face_boundary|face_box|face_loops|face_overlaps|"
            "face_parts|face_region|face_rim|filler_separate|grid|insertion_order|integer|level_lines|"
            "matched_grids|normal_cone|orient3d|polynomial_basis|predicates_integer|refine|roots|roots_exact|"
            "segment_box|simple_polygons|spelling|subdivide|tessellate|tessellate_boundaries|"
            "tessellate_calls|tessellate_collect|tessellate_lenses|text|topology|triangle_budget|triangle_mesh|view|visibility)[.]cpp$")
        set(small ${sources})
        list(FILTER small EXCLUDE REGEX "${hot}")
        set(few ${sources})
        list(FILTER few INCLUDE REGEX "${hot}")
        list(FILTER few INCLUDE REGEX "${rare}")
        list(APPEND small ${few})
    endif()
    if(small)
        list(REMOVE_ITEM sources ${small})
        add_library(freiform_${name}_small OBJECT ${small})
        freiform_common(freiform_${name}_small)
        freiform_unity(freiform_${name}_small 6 ${all})
        target_compile_definitions(freiform_${name}_small PRIVATE FREIFORM_SERIAL=1)
        target_compile_options(freiform_${name}_small PRIVATE "SHELL:-mllvm -inline-threshold=-20")
        target_include_directories(freiform_${name}_small PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
    endif()
    add_library(freiform_${name} ${sources})
    add_library(freiform::${name} ALIAS freiform_${name})
    freiform_common(freiform_${name})
    if(small)
        target_sources(freiform_${name} PRIVATE $<TARGET_OBJECTS:freiform_${name}_small>)
    endif()
    freiform_isa(${sources})
    freiform_cold(${sources})
    freiform_unity(freiform_${name} 6 ${all})
    target_include_directories(freiform_${name}
        PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
        PRIVATE ${PROJECT_SOURCE_DIR}/src)
    set_target_properties(freiform_${name} PROPERTIES EXPORT_NAME ${name}
        ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
    if(BUILD_SHARED_LIBS)
        set_target_properties(freiform_${name} PROPERTIES VERSION ${PROJECT_VERSION}
            SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    endif()
    if(FREIFORM_PCH)
        target_precompile_headers(freiform_${name} PRIVATE <algorithm> <array> <cmath> <expected> <functional> <memory>
            <optional> <span> <string> <variant> <vector>)
    endif()
    set_property(GLOBAL APPEND PROPERTY FREIFORM_COMPONENTS ${name})
endfunction()

# src/kernel/*_avx2.cpp and *_avx512.cpp are compiled for the instructions that their name says; the precompiled
# header is for other flags. In kernels that evaluate, products and sums are contracted where the processor can. Nothing that takes
# a vector is called from another file, so how vectors are passed (psabi) does not matter.
function(freiform_isa)
    foreach(file IN LISTS ARGN)
        set(flags "")
        if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
            if(file MATCHES "_avx2\\.cpp$")
                set(flags -mavx2 -mfma)
            elseif(file MATCHES "_avx512\\.cpp$")
                set(flags -mavx512f -mavx512dq -mavx512vl -mfma)
            endif()
        endif()
        if(file MATCHES "/src/kernel/(evaluate|blocks)_")
            list(APPEND flags -Wno-psabi)
        endif()
        if(file MATCHES "/src/kernel/evaluate_")
            list(APPEND flags -ffp-contract=fast)
        endif()
        # Modules are compiled for size (-Oz); what evaluates a little less so. With -O3 scattered points take 3 to 14 % less
        # time, grids and meshes as much, and the module is 25 kB larger after gzip.
        if(CMAKE_SYSTEM_PROCESSOR STREQUAL wasm32 AND file MATCHES "/src/(kernel|spline/prepared[a-z_]*\\.cpp)")
            list(APPEND flags -Os)
        endif()
        if(flags)
            set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS "${flags}" SKIP_PRECOMPILE_HEADERS ON)
        endif()
    endforeach()
endfunction()

# Files in which no program spends its time: construction, questions that are asked once, documents, drawings. They
# are a large part of the library's text, and g++ takes 40 % less time for them with -O1 and inlining than with -O3.
# What evaluates, flattens, tessellates, solves or reads large files is not among them.
set(FREIFORM_COLD
    fit/approximate fit/local
    intersect/exact_pair
    io/bpt io/document io/document_fields io/document_model io/document_model_write io/document_patch
    io/drawing io/drawing_compose io/drawing_elements io/drawing_flatten io/drawing_joints io/drawing_panels io/drawing_svg io/exchange io/figure
    io/figure_axes io/figure_labels io/paper io/quake3_map io/read io/scene io/step_composite
    make/conic make/conic_equation make/graph make/joint make/named_curve make/named_surface make/over_one_denominator
    model/assemble
    query/continuity query/features query/implicit query/knot_lines query/meetings query/reparametrise
    query/reparametrised query/self_intersection query/surface_curvature
    spline/a_frame spline/coefficients spline/transform spline/weights
    trim/loop_links trim/loops)
function(freiform_cold)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU OR NOT (CMAKE_CONFIGURATION_TYPES OR CMAKE_BUILD_TYPE STREQUAL Release))
        return()
    endif()
    foreach(name IN LISTS FREIFORM_COLD)
        if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/src/${name}.cpp)
            message(FATAL_ERROR "FREIFORM_COLD names src/${name}.cpp, which is not there")
        endif()
    endforeach()
    foreach(file IN LISTS ARGN)
        file(RELATIVE_PATH name ${CMAKE_CURRENT_SOURCE_DIR}/src ${file})
        string(REGEX REPLACE "\\.cpp$" "" name ${name})
        if(name IN_LIST FREIFORM_COLD)
            set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS
                "$<$<CONFIG:Release>:-O1;-finline-functions;-finline-small-functions>")
        endif()
    endforeach()
endfunction()
