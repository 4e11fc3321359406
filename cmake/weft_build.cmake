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
target_compile_definitions(weft_options INTERFACE _GNU_SOURCE WEFT_VERSION="${PROJECT_VERSION}")
target_compile_options(weft_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wvla -Werror
    $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes -Wmissing-prototypes> -fno-math-errno)
target_link_libraries(weft_options INTERFACE m)
# Where it is there, gold links the two hundred programs of the tests in half the time.
include(CheckLinkerFlag)
check_linker_flag(C -fuse-ld=gold WEFT_HAS_GOLD)
if(WEFT_HAS_GOLD AND NOT WEFT_SANITIZE)
    target_link_options(weft_options INTERFACE -fuse-ld=gold)
endif()
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
pkg_check_modules(PNG REQUIRED IMPORTED_TARGET libpng)
pkg_check_modules(LCMS REQUIRED IMPORTED_TARGET lcms2)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(GLFW REQUIRED IMPORTED_TARGET glfw3)
pkg_check_modules(LAPACKE REQUIRED IMPORTED_TARGET lapacke)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(CONFUSE REQUIRED IMPORTED_TARGET libconfuse)
pkg_check_modules(GPHOTO2 REQUIRED IMPORTED_TARGET libgphoto2)
pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo cairo-ft cairo-pdf cairo-svg)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(EXIF REQUIRED IMPORTED_TARGET libexif)
find_package(embree 3 REQUIRED)
find_package(Ceres REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc calib3d video videoio aruco mcc)

# ---- Rooms ----
#
# A room is a folder and a static library. It says which of its headers it SHOWS and which other rooms it builds on, and the compiler
# finds those headers and no others: the include path of a room holds links to its own headers and to the shown ones of the rooms
# it LINKS or USES, and never the source tree. An include that points backwards or into another room's own headers does not compile
# (tests/house tries both).
set(WEFT_INCLUDE ${CMAKE_BINARY_DIR}/include)
file(REMOVE_RECURSE ${WEFT_INCLUDE})

# Private headers of all rooms, for tests and benches.
add_library(weft_inside INTERFACE)
target_include_directories(weft_inside INTERFACE ${WEFT_INCLUDE}/inside)

# weft_target_of(RESULT NAME...): compress/fit is weft_compress_fit; what is no folder of the source tree is a package.
function(weft_target_of result)
    set(targets "")
    foreach(name ${ARGN})
        if(IS_DIRECTORY ${CMAKE_SOURCE_DIR}/${name})
            string(REPLACE "/" "_" name weft_${name})
        endif()
        list(APPEND targets ${name})
    endforeach()
    set(${result} ${targets} PARENT_SCOPE)
endfunction()

# Links a header into an include path under its path from the root.
function(weft_link_header tree header)
    get_filename_component(folder ${WEFT_INCLUDE}/${tree}/${header} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${header} ${WEFT_INCLUDE}/${tree}/${header} SYMBOLIC)
endfunction()

# weft_show_headers(TARGET ROOM SHOWS FOLDERS): lays out the include path of a room.
function(weft_show_headers target room shows folders)
    set(headers "")
    foreach(folder . ${folders})
        file(GLOB found CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/${room} ${CMAKE_SOURCE_DIR}/${room}/${folder}/*.h)
        list(APPEND headers ${found})
    endforeach()
    foreach(header ${shows})
        if(NOT header IN_LIST headers)
            message(FATAL_ERROR "room ${room} shows ${header}, which it does not have")
        endif()
    endforeach()
    file(MAKE_DIRECTORY ${WEFT_INCLUDE}/${target}/shown ${WEFT_INCLUDE}/${target}/own)
    foreach(header ${headers})
        if(header IN_LIST shows)
            weft_link_header(${target}/shown ${room}/${header})
        else()
            weft_link_header(${target}/own ${room}/${header})
            weft_link_header(inside ${room}/${header})
        endif()
    endforeach()
    target_include_directories(${target} PUBLIC ${WEFT_INCLUDE}/${target}/shown PRIVATE ${WEFT_INCLUDE}/${target}/own)
endfunction()

# weft_room(FOLDER SHOWS header... SOURCES file... LINKS room|package... USES room|package... FOLDERS subfolder...): LINKS what its shown
# headers include, USES what only its sources need. FOLDERS are parts of the room that are no rooms of their own.
function(weft_room room)
    cmake_parse_arguments(room "" "" "SHOWS;SOURCES;LINKS;USES;FOLDERS" ${ARGN})
    weft_target_of(target ${room})
    set(sources ${room_SOURCES})
    list(TRANSFORM sources PREPEND ${CMAKE_SOURCE_DIR}/${room}/ REGEX "^[^/$]")
    add_library(${target} STATIC ${sources})
    weft_target_of(links ${room_LINKS})
    weft_target_of(uses ${room_USES})
    target_link_libraries(${target} PUBLIC weft_options ${links} PRIVATE ${uses})

    weft_show_headers(${target} ${room} "${room_SHOWS}" "${room_FOLDERS}")
endfunction()

# Modules are loaded while the program runs. Executables search this folder for them; RPATH, unlike RUNPATH, holds for a sanitizer's
# dlopen, too.
set(WEFT_MODULES ${CMAKE_BINARY_DIR}/modules)
set(CMAKE_BUILD_RPATH ${WEFT_MODULES})
add_link_options(-Wl,--disable-new-dtags)

# weft_module(ROOM NAME SOURCES file... USES room|package...): sources of a room whose packages are slow to load, as NAME.so, which
# that room opens when it is needed. Linking the room builds it.
function(weft_module room name)
    cmake_parse_arguments(module "" "" "SOURCES;USES" ${ARGN})
    weft_target_of(target ${room})
    weft_target_of(uses ${module_USES})
    list(TRANSFORM module_SOURCES PREPEND ${CMAKE_SOURCE_DIR}/${room}/)
    add_library(${name} MODULE ${module_SOURCES})
    target_link_libraries(${name} PRIVATE weft_options ${uses})
    target_include_directories(${name} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
    set_target_properties(${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${WEFT_MODULES})
    add_dependencies(${target} ${name})
endfunction()

# weft_stage(NAME): weft_NAME_stage is all rooms under one top folder, and those that they use, and all of base.
function(weft_stage name)
    get_property(targets DIRECTORY ${CMAKE_SOURCE_DIR}/${name} PROPERTY BUILDSYSTEM_TARGETS)
    list(FILTER targets INCLUDE REGEX "^weft_${name}")
    add_library(weft_${name}_stage INTERFACE)
    if(NOT name STREQUAL base)
        target_link_libraries(weft_${name}_stage INTERFACE weft_base_stage)
    endif()
    foreach(target ${targets})
        get_target_property(type ${target} TYPE)
        if(type STREQUAL "STATIC_LIBRARY")
            get_target_property(used ${target} LINK_LIBRARIES)
            target_link_libraries(weft_${name}_stage INTERFACE ${target} ${used})
        endif()
    endforeach()
endfunction()

# weft_kernels(ROOM file...): sources that use base/lanes.h, compiled once for each instruction set and added to the room. The
# instruction set is part of the names of their functions, so that none of another set is ever called by accident.
set(WEFT_INSTRUCTION_SETS baseline)
set(WEFT_FLAGS_baseline "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND WEFT_INSTRUCTION_SETS avx2 avx512)
    set(WEFT_FLAGS_avx2 -mavx2 -mfma -mf16c)
    set(WEFT_FLAGS_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx2 -mfma -mf16c -mprefer-vector-width=512)
endif()
function(weft_kernels room)
    weft_target_of(target ${room})
    set(sources ${ARGN})
    if(NOT target STREQUAL room)
        list(TRANSFORM sources PREPEND ${CMAKE_SOURCE_DIR}/${room}/)
    endif()
    foreach(set ${WEFT_INSTRUCTION_SETS})
        set(kernels ${target}_${set})
        add_library(${kernels} OBJECT ${sources})
        target_link_libraries(${kernels} PRIVATE weft_options)
        target_include_directories(${kernels} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
        target_compile_definitions(${kernels} PRIVATE WEFT_INSTRUCTION_SET=${set})
        # Multiply-adds in one rounding; vectors wider than a register never cross a call, so that their ABI does not matter.
        target_compile_options(${kernels} PRIVATE -O3 -ffp-contract=fast -fno-trapping-math -Wno-psabi ${WEFT_FLAGS_${set}})
        target_sources(${target} PRIVATE $<TARGET_OBJECTS:${kernels}>)
    endforeach()
endfunction()

# Tests and benches name their own headers from the root, too.
foreach(folder tests bench)
    file(MAKE_DIRECTORY ${WEFT_INCLUDE}/inside)
    file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${WEFT_INCLUDE}/inside/${folder} SYMBOLIC)
endforeach()

# weft_test(NAME SOURCES file... LINKS target... [LABELS label...]): a cmocka program run by ctest.
function(weft_test name)
    cmake_parse_arguments(test "" "" "SOURCES;LINKS;LABELS" ${ARGN})
    add_executable(test_${name} ${test_SOURCES})
    target_link_libraries(test_${name} PRIVATE weft_options weft_inside ${test_LINKS} cmocka)
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
