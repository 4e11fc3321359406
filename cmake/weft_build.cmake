# What every target of Weft shares: language, warnings, packages, and how modules, plugins, kernels and tests are declared.
set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# One set of objects serves the shared library, the static one and the program. What is not public is hidden.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)

# Compiled again, the same sources come from ccache, in whatever folder the clone lies.
find_program(WEFT_CCACHE ccache)
if(WEFT_CCACHE)
    set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${WEFT_CCACHE})
    set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
endif()

set(WEFT_SANITIZE "" CACHE STRING "In every target: 'address' (AddressSanitizer and UndefinedBehaviorSanitizer) or 'thread' (ThreadSanitizer)")
set_property(CACHE WEFT_SANITIZE PROPERTY STRINGS "" address thread)

add_library(weft_options INTERFACE)
target_compile_definitions(weft_options INTERFACE _GNU_SOURCE WEFT_VERSION="${PROJECT_VERSION}")
target_compile_options(weft_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wvla -Werror
    $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes> $<$<AND:$<COMPILE_LANGUAGE:C>,$<NOT:$<BOOL:$<TARGET_PROPERTY:WEFT_HAS_SUITES>>>>:-Wmissing-prototypes> -fno-math-errno)
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

# ---- Modules ----
#
# A module is a folder. All modules make one library. weft_module(FOLDER USES module...) adds its sources: every C file, and the kernels
# among them once for each instruction set. scripts/check_includes.py holds the sources to the modules that theirs USES.
add_library(weft_objects OBJECT)
target_include_directories(weft_objects PUBLIC ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/include)
target_link_libraries(weft_objects PUBLIC weft_options OpenMP::OpenMP_C Threads::Threads ${CMAKE_DL_LIBS} PkgConfig::HDF5 PkgConfig::ZSTD PkgConfig::ZLIB
    PkgConfig::PNG PkgConfig::LCMS PkgConfig::JANSSON PkgConfig::GLFW PkgConfig::LAPACKE PkgConfig::IMGUI PkgConfig::STB PkgConfig::EPOXY PkgConfig::EGL
    PkgConfig::CONFUSE PkgConfig::GPHOTO2 PkgConfig::HIDAPI PkgConfig::CAIRO embree Ceres::ceres opencv_core opencv_imgproc opencv_calib3d opencv_aruco)

# weft_module(NAME USES module... EXCEPT file... GENERATED file... FOLDERS folder...): EXCEPT are sources of a plugin; FOLDERS are those of the module,
# if it has more than the one of its name.
function(weft_module folder)
    cmake_parse_arguments(module "" "" "USES;EXCEPT;GENERATED;FOLDERS" ${ARGN})
    set(sources ${module_GENERATED})
    if(NOT module_FOLDERS)
        set(module_FOLDERS ${folder})
    endif()
    foreach(part ${module_FOLDERS})
        file(GLOB found CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${part}/*.c ${CMAKE_SOURCE_DIR}/${part}/*.cpp)
        list(APPEND sources ${found})
    endforeach()
    foreach(file ${module_EXCEPT})
        list(FILTER sources EXCLUDE REGEX "/${file}$")
    endforeach()
    set(kernels ${sources})
    list(FILTER kernels INCLUDE REGEX "_kernel\\.c$")
    list(FILTER sources EXCLUDE REGEX "_kernel\\.c$")
    target_sources(weft_objects PRIVATE ${sources})
    foreach(set ${WEFT_INSTRUCTION_SETS})
        target_sources(weft_kernels_${set} PRIVATE ${kernels})
    endforeach()
endfunction()

# Kernels use base/lanes.h. The instruction set is part of the names of their functions, so that none of another set is called by accident.
set(WEFT_INSTRUCTION_SETS baseline)
set(WEFT_FLAGS_baseline "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND WEFT_INSTRUCTION_SETS avx2 avx512)
    set(WEFT_FLAGS_avx2 -mavx2 -mfma -mf16c)
    set(WEFT_FLAGS_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx2 -mfma -mf16c -mprefer-vector-width=512)
endif()
# weft_kernel_options(TARGET SET). Multiply-adds in one rounding; vectors wider than a register never cross a call, so that their ABI does not matter.
function(weft_kernel_options target set)
    target_link_libraries(${target} PRIVATE weft_options)
    target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/include)
    target_compile_definitions(${target} PRIVATE WEFT_INSTRUCTION_SET=${set})
    target_compile_options(${target} PRIVATE -O3 -ffp-contract=fast -fno-trapping-math -Wno-psabi ${WEFT_FLAGS_${set}})
endfunction()
foreach(set ${WEFT_INSTRUCTION_SETS})
    add_library(weft_kernels_${set} OBJECT)
    weft_kernel_options(weft_kernels_${set} ${set})
endforeach()

# Executables and the shared library search this folder for plugins; RPATH, unlike RUNPATH, holds for a sanitizer's dlopen, too.
set(WEFT_PLUGINS ${CMAKE_BINARY_DIR}/plugins)
set(CMAKE_BUILD_RPATH ${WEFT_PLUGINS})
add_link_options(-Wl,--disable-new-dtags)

# weft_libraries(): the static library, for the program, tests and benches, and the shared one, for everybody else's programs.
function(weft_libraries)
    set(objects $<TARGET_OBJECTS:weft_objects>)
    foreach(set ${WEFT_INSTRUCTION_SETS})
        list(APPEND objects $<TARGET_OBJECTS:weft_kernels_${set}>)
    endforeach()
    add_library(weft_static STATIC ${objects})
    set_target_properties(weft_static PROPERTIES OUTPUT_NAME weft)
    target_include_directories(weft_static PUBLIC ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/include)
    target_link_libraries(weft_static PUBLIC $<TARGET_PROPERTY:weft_objects,INTERFACE_LINK_LIBRARIES>)
    # It shows the functions of include/weft and nothing else, not even templates of C++.
    add_library(weft_shared SHARED ${objects})
    set_target_properties(weft_shared PROPERTIES OUTPUT_NAME weft EXPORT_NAME weft VERSION ${PROJECT_VERSION} SOVERSION 0
        LINK_DEPENDS ${CMAKE_SOURCE_DIR}/cmake/weft.map)
    target_include_directories(weft_shared INTERFACE $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
    target_link_libraries(weft_shared PRIVATE $<TARGET_PROPERTY:weft_objects,INTERFACE_LINK_LIBRARIES>)
    target_link_options(weft_shared PRIVATE -Wl,--as-needed -Wl,--version-script=${CMAKE_SOURCE_DIR}/cmake/weft.map)
endfunction()

# ---- Plugins ----
#
# weft_plugin(NAME FOLDER SOURCES file... USES package...): sources whose packages are slow to load, as NAME.so, which the library opens when
# it is needed.
add_custom_target(weft_plugins)
function(weft_plugin name folder)
    cmake_parse_arguments(plugin "" "" "SOURCES;USES" ${ARGN})
    list(TRANSFORM plugin_SOURCES PREPEND ${CMAKE_SOURCE_DIR}/${folder}/)
    add_library(${name} MODULE ${plugin_SOURCES})
    target_link_libraries(${name} PRIVATE weft_static ${plugin_USES})
    # The table of functions that the library looks up is all that a plugin shows.
    set_target_properties(${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${WEFT_PLUGINS} C_VISIBILITY_PRESET default CXX_VISIBILITY_PRESET default)
    add_dependencies(weft_plugins ${name})
endfunction()
