# Programs for aarch64 on a machine of another kind, so that what NEON computes can be checked there: needs Debian's cross compiler
# and qemu-user, which runs the program.
find_program(WEFT_NEON_COMPILER aarch64-linux-gnu-gcc)
find_program(WEFT_NEON_RUNNER qemu-aarch64)

# weft_neon_program(NAME file...): from plain C sources, some of which may use base/lanes.h, without libraries: functions that nothing
# calls may lack what they call. Path: ${NAME}_PATH.
function(weft_neon_program name)
    # What is computed is checked here, not how fast: -O1 compiles in half the time.
    set(flags -std=c17 -D_GNU_SOURCE -I${CMAKE_SOURCE_DIR} -I${CMAKE_SOURCE_DIR}/include -O1 -Wall -Wextra -Werror -fno-math-errno
        -DWEFT_INSTRUCTION_SET=baseline -ffp-contract=fast -fno-trapping-math -Wno-psabi -ffunction-sections)
    set(objects)
    foreach(source ${ARGN})
        file(RELATIVE_PATH object ${CMAKE_SOURCE_DIR} ${source})
        string(REPLACE "/" "_" object ${object})
        set(object ${CMAKE_CURRENT_BINARY_DIR}/${name}_${object}.o)
        add_custom_command(OUTPUT ${object} DEPENDS ${source} DEPFILE ${object}.d
            COMMAND ${WEFT_NEON_COMPILER} ${flags} -MD -MF ${object}.d -MT ${object} -c ${source} -o ${object}
            COMMAND_EXPAND_LISTS)
        list(APPEND objects ${object})
    endforeach()
    set(program ${CMAKE_CURRENT_BINARY_DIR}/${name})
    add_custom_command(OUTPUT ${program} DEPENDS ${objects} COMMAND ${WEFT_NEON_COMPILER} -static -Wl,--gc-sections ${objects} -lm -o ${program})
    add_custom_target(build_${name} ALL DEPENDS ${program})
    set(${name}_PATH ${program} PARENT_SCOPE)
endfunction()
