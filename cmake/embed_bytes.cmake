# Turns a file into a C array, run as
#     cmake -DINPUT=FILE -DOUTPUT=FILE.c -DNAME=identifier -P embed_bytes.cmake
file(READ "${INPUT}" bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "extern const unsigned char ${NAME}[];\nextern const unsigned int ${NAME}_size;\n"
    "const unsigned char ${NAME}[] = {${bytes}};\nconst unsigned int ${NAME}_size = ${size};\n")
