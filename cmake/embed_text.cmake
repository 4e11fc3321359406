# Turns text files into one C file of NUL-terminated arrays, run as
#     cmake -DOUTPUT=FILE.c -DPREFIX=NAME_ "-DINPUTS=a.glsl;b.vert.glsl" -P embed_text.cmake
# b.vert.glsl becomes NAME_b_vert. Bytes rather than a string: C promises only 4095 characters of those.
set(text "")
foreach(input IN LISTS INPUTS)
    get_filename_component(name "${input}" NAME)
    string(REGEX REPLACE "\\.glsl$" "" name "${name}")
    string(REPLACE "." "_" name "${name}")
    file(READ "${input}" bytes HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
    string(APPEND text "extern const char ${PREFIX}${name}[];\nconst char ${PREFIX}${name}[] = {${bytes}0};\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}")
