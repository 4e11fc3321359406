# What every target of Weft shares: language, warnings, packages, and how a room is declared.
set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(WEFT_SANITIZE "" CACHE STRING "In every target: 'address' (AddressSanitizer and UndefinedBehaviorSanitizer) or 'thread' (ThreadSanitizer)")
set_property(CACHE WEFT_SANITIZE PROPERTY STRINGS "" address thread)

add_library(weft_options INTERFACE)
target_include_directories(weft_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_definitions(weft_options INTERFACE _GNU_SOURCE WEFT_VERSION="${PROJECT_VERSION}")
target_compile_options(weft_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wvla -Werror
    $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes -Wmissing-prototypes> -fno-math-errno)
target_link_libraries(weft_options INTERFACE m)
if(WEFT_SANITIZE STREQUAL "address")
    target_compile_options(weft_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(weft_options INTERFACE -fsanitize=address,undefined)
elseif(WEFT_SANITIZE STREQUAL "thread")
    target_compile_options(weft_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
    target_link_options(weft_options INTERFACE -fsanitize=thread)
elseif(WEFT_SANITIZE)
    message(FATAL_ERROR "WEFT_SANITIZE is 'address' or 'thread', not '${WEFT_SANITIZE}'")
endif()

find_package(PkgConfig REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS C)
find_package(Threads REQUIRED)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(GLFW REQUIRED IMPORTED_TARGET glfw3)
pkg_check_modules(LAPACKE REQUIRED IMPORTED_TARGET lapacke)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
find_package(embree 3 REQUIRED)
find_package(Ceres REQUIRED)
pkg_check_modules(NLOPT REQUIRED IMPORTED_TARGET nlopt)
find_package(OpenCV REQUIRED COMPONENTS core imgproc calib3d video aruco)

# weft_room(NAME SOURCES file... LINKS target...): the static library of one room. A room sees only the
# libraries it links, so nothing can point backwards along the corridor.
function(weft_room name)
    cmake_parse_arguments(room "" "" "SOURCES;LINKS" ${ARGN})
    add_library(weft_${name} STATIC ${room_SOURCES})
    target_link_libraries(weft_${name} PUBLIC weft_options ${room_LINKS})
endfunction()

# weft_kernels(TARGET file...): sources that use btf/lanes.h, compiled once for each instruction set and added to the target. The
# instruction set is part of the names of their functions, so that none of another set is ever called by accident.
set(WEFT_INSTRUCTION_SETS baseline)
set(WEFT_FLAGS_baseline "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND WEFT_INSTRUCTION_SETS avx2 avx512)
    set(WEFT_FLAGS_avx2 -mavx2 -mfma -mf16c)
    set(WEFT_FLAGS_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx2 -mfma -mf16c -mprefer-vector-width=512)
endif()
function(weft_kernels target)
    foreach(set ${WEFT_INSTRUCTION_SETS})
        set(kernels ${target}_${set})
        add_library(${kernels} OBJECT ${ARGN})
        target_link_libraries(${kernels} PRIVATE weft_options)
        target_compile_definitions(${kernels} PRIVATE WEFT_INSTRUCTION_SET=${set})
        # Multiply-adds in one rounding; vectors wider than a register never cross a call, so that their ABI does not matter.
        target_compile_options(${kernels} PRIVATE -O3 -ffp-contract=fast -fno-trapping-math -Wno-psabi ${WEFT_FLAGS_${set}})
        target_sources(${target} PRIVATE $<TARGET_OBJECTS:${kernels}>)
    endforeach()
endfunction()

# weft_test(NAME SOURCES file... LINKS target... [LABELS label...]): a cmocka program run by ctest.
function(weft_test name)
    cmake_parse_arguments(test "" "" "SOURCES;LINKS;LABELS" ${ARGN})
    add_executable(test_${name} ${test_SOURCES})
    target_link_libraries(test_${name} PRIVATE weft_options ${test_LINKS} cmocka)
    target_compile_definitions(test_${name} PRIVATE
        WEFT_TEST_DATA="${CMAKE_SOURCE_DIR}/tests/data" WEFT_ASSETS="${CMAKE_SOURCE_DIR}/assets"
        WEFT_SHARED="${CMAKE_SOURCE_DIR}/../shared")
    add_test(NAME ${name} COMMAND test_${name} WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
    set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS "${test_LABELS}")
endfunction()

# weft_threads_test(NAME...): tests, of weft_test, of what starts threads of its own. They also run under ThreadSanitizer
# (preset tsan), whose build needs no more than the target threads_tests.
add_custom_target(threads_tests)
function(weft_threads_test)
    foreach(name ${ARGN})
        set_property(TEST ${name} APPEND PROPERTY LABELS threads)
        add_dependencies(threads_tests test_${name})
    endforeach()
endfunction()
