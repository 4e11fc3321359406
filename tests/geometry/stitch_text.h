/* A small valid stitch for tests of the parser. */
#ifndef WEFT_TESTS_STITCH_TEXT_H
#define WEFT_TESTS_STITCH_TEXT_H

#define STITCH_TEXT                                                                                                    \
    "stitch { /* two yarns */\n"                                                                                       \
    "  name = \"Plain\", tile = {2, 1}, resolution = 20, blend = 0.01,\n"                                              \
    "  yarn {\n"                                                                                                       \
    "    radius = {0.2, 0.18}, plies = 2, twist = 0.6, fibreTwist = 0.5,\n"                                            \
    "    diffuse = {0.5, 0.4, 0.3}, specular = {0.1, 0.2, 0.3}, highlight = 10, index = 1.5,\n"                        \
    "    points { {0, 0.5, 0}, {1, 0.5, 0.2}, {2, 0.5, 0} }\n"                                                         \
    "  },\n"                                                                                                           \
    "  yarn { radius = 0.2, diffuse = {0, 0.5, 1}, copies { {0, 0, 0}, {1, 0, 0} },\n"                                 \
    "    points { {0.5, 0, -0.6}, {0.5, 1, -0.6} } }\n"                                                                \
    "}\n"

#endif
