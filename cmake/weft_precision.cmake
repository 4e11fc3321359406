# The pure functions in other precisions: single, what a GPU can be expected to reach, and quadruple, which measures the rounding of the
# others. Only for tests and benches; never linked with the library itself.
set(pure base/status base/atomic_file base/text/csv base/text/lexer base/text/block_parser base/text/text_file
    btf/direction/direction btf/direction/frame btf/direction/convex_hull btf/direction/triangulation)
foreach(model quadrature lafortune bard microcylinder woven weave)
    file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/reflectance/${model}/*.c)
    list(TRANSFORM sources REPLACE "\\.c$" "")
    list(APPEND pure ${sources})
endforeach()
list(FILTER pure EXCLUDE REGEX "_kernel$|weave/batch$")
list(TRANSFORM pure PREPEND ${CMAKE_SOURCE_DIR}/)
list(TRANSFORM pure APPEND .c)

# weft_precision(TARGET DEFINITION...): the pure functions in another precision. Their names are hidden, so that a shared library can
# hold them beside those of a program.
function(weft_precision name)
    add_library(${name} STATIC EXCLUDE_FROM_ALL ${pure})
    set_target_properties(${name} PROPERTIES C_VISIBILITY_PRESET hidden)
    target_compile_definitions(${name} PUBLIC ${ARGN})
    target_link_libraries(${name} PUBLIC weft_options OpenMP::OpenMP_C)
    target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/include)
endfunction()

weft_precision(weft_single_precision WEFT_REAL_IS_FLOAT)
target_compile_options(weft_single_precision PUBLIC -fsingle-precision-constant)

# In binary128, where compiler and library have it: bench/numerics measures the rounding of the others with it. Tools that read the
# compile commands need not know the type.
include(CheckCSourceCompiles)
set(CMAKE_REQUIRED_DEFINITIONS -D_GNU_SOURCE)
set(CMAKE_REQUIRED_LIBRARIES m)
check_c_source_compiles("
    #include <tgmath.h>
    _Float128 root(_Float128 x) { return sqrt(x); }
    int main(void) { return 0; }" WEFT_HAVE_QUAD)
unset(CMAKE_REQUIRED_DEFINITIONS)
unset(CMAKE_REQUIRED_LIBRARIES)
if(WEFT_HAVE_QUAD)
    weft_precision(weft_quadruple_precision WEFT_REAL_IS_QUAD)
    set_target_properties(weft_quadruple_precision PROPERTIES EXPORT_COMPILE_COMMANDS OFF)
endif()
