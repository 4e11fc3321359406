# How tests are declared. A file test_NAME.c is a suite: a function `int test_NAME(void)` that runs its cmocka tests. All suites of a
# folder are one program; ctest runs each of them by itself.

# weft_suites(PROGRAM PREFIX prefix SUFFIX suffix SUITES file... FOLDERS folder... EXCEPT file... SOURCES file... LINKS target... LABELS label...)
# The suites are those of SUITES, or all test_*.c of the folder and of FOLDERS in it but for EXCEPT. Other C files of these folders, and
# SOURCES, serve them. The test of test_NAME.c is called PREFIX NAME SUFFIX.
function(weft_suites program)
    cmake_parse_arguments(suites "" "PREFIX;SUFFIX" "SUITES;FOLDERS;EXCEPT;SOURCES;LINKS;LABELS" ${ARGN})
    if(NOT suites_SUITES)
        foreach(folder . ${suites_FOLDERS})
            file(GLOB found CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/test_*.c)
            list(APPEND suites_SUITES ${found})
        endforeach()
        list(REMOVE_ITEM suites_SUITES ${suites_EXCEPT})
    endif()
    set(declarations "")
    set(entries "")
    foreach(file ${suites_SUITES})
        get_filename_component(suite ${file} NAME_WE)
        string(APPEND declarations "int ${suite}(void);\n")
        string(APPEND entries "    {\"${suite}\", ${suite}},\n")
    endforeach()
    set(main ${CMAKE_CURRENT_BINARY_DIR}/${program}_main.c)
    configure_file(${CMAKE_SOURCE_DIR}/cmake/suite_main.c.in ${main} @ONLY)
    add_executable(${program} ${main} ${suites_SUITES} ${suites_SOURCES})
    # A suite is declared by the list of suites alone.
    set_target_properties(${program} PROPERTIES WEFT_HAS_SUITES ON)
    # The pure functions in another precision are a library of their own.
    if("weft_single_precision" IN_LIST suites_LINKS)
        target_link_libraries(${program} PRIVATE ${suites_LINKS} cmocka)
    else()
        target_link_libraries(${program} PRIVATE ${suites_LINKS} weft_test_support weft_static cmocka)
    endif()
    add_dependencies(${program} weft)
    foreach(file ${suites_SUITES})
        get_filename_component(suite ${file} NAME_WE)
        string(REGEX REPLACE "^test_" "${suites_PREFIX}" name ${suite}${suites_SUFFIX})
        add_test(NAME ${name} COMMAND ${program} ${suite})
        set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS "${suites_LABELS}")
    endforeach()
endfunction()

# weft_fuzz(NAME ITERATIONS FROM file SOURCES file... LABELS label...): the fuzz target fuzz_NAME.c, or that of FROM. A tenth of the mutations are
# tried by `make test`, all by `make test-all`. With clang's libFuzzer the same sources fuzz without end.
function(weft_fuzz name iterations)
    cmake_parse_arguments(fuzz "" "FROM" "SOURCES;LABELS" ${ARGN})
    if(NOT fuzz_FROM)
        set(fuzz_FROM fuzz_${name}.c)
    endif()
    add_executable(fuzz_${name} ${fuzz_FROM} ${fuzz_SOURCES} ${CMAKE_SOURCE_DIR}/tests/support/fuzz_main.c)
    target_link_libraries(fuzz_${name} PRIVATE weft_test_support weft_static cmocka)
    math(EXPR few "${iterations} / 10")
    add_test(NAME fuzz_${name} COMMAND fuzz_${name} ${few})
    add_test(NAME fuzz_${name}_long COMMAND fuzz_${name} ${iterations})
    set_tests_properties(fuzz_${name} PROPERTIES LABELS "${fuzz_LABELS}")
    set_tests_properties(fuzz_${name}_long PROPERTIES LABELS long)
endfunction()

# weft_threads_test(NAME...): tests of what starts threads of its own. They also run under ThreadSanitizer (preset tsan), whose build needs no
# more than the target threads_tests.
add_custom_target(threads_tests)
function(weft_threads_test program)
    add_dependencies(threads_tests ${program})
    set_property(TEST ${ARGN} APPEND PROPERTY LABELS threads)
endfunction()
