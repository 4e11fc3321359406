# Updates the lists of file types, programs and icons after an installation that is not staged.
if("$ENV{DESTDIR}" STREQUAL "" AND NOT CMAKE_INSTALL_PREFIX MATCHES "_CPack_Packages")
    set(share ${CMAKE_INSTALL_PREFIX}/share)
    foreach(update "update-mime-database;${share}/mime" "update-desktop-database;-q;${share}/applications"
            "gtk-update-icon-cache;-qtf;${share}/icons/hicolor")
        list(GET update 0 program)
        find_program(WEFT_${program} ${program})
        if(WEFT_${program})
            list(REMOVE_AT update 0)
            execute_process(COMMAND ${WEFT_${program}} ${update} OUTPUT_QUIET ERROR_QUIET)
        endif()
    endforeach()
endif()
