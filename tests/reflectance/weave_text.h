/* A small valid weave file, for tests that change it. */
#ifndef WEFT_TESTS_REFLECTANCE_WEAVE_TEXT_H
#define WEFT_TESTS_REFLECTANCE_WEAVE_TEXT_H

#define WEAVE_TEXT                                                                                                     \
    "/* plain weave */\n"                                                                                              \
    "weave {\n"                                                                                                        \
    "  name = \"Plain\",\n"                                                                                            \
    "  tileWidth = 2, tileHeight = 2,\n"                                                                               \
    "  alpha = 0.02, beta = 3, ss = 0.5, hWidth = 0.5,\n"                                                              \
    "  warpArea = 2, weftArea = 2,\n"                                                                                  \
    "  dWarpUmaxOverDWarp = 8, period = 50, fineness = 3,\n"                                                           \
    "  pattern { 1, 3,\n"                                                                                              \
    "            4, 2 },\n"                                                                                            \
    "  yarn { type = warp, psi = -30, umax = 30, kappa = -0.5, width = 1, length = 1,\n"                               \
    "    centerU = 0.25, centerV = 0.75, kd = {0.1, 0.2, 0.3}, ks = {0.4, 0.5, 0.6} },\n"                              \
    "  yarn { type = warp, psi = -30, umax = 30, kappa = -0.5, width = 1, length = 1,\n"                               \
    "    centerU = 0.75, centerV = 0.25, kd = {0.1, 0.2, 0.3}, ks = {0.4, 0.5, 0.6} },\n"                              \
    "  yarn { type = weft, psi = 0, umax = 20, kappa = 0, width = 1, length = 1,\n"                                    \
    "    centerU = 0.75, centerV = 0.75, kd = {0.3, 0.2, 0.1}, ks = {1, 1, 1} },\n"                                    \
    "  yarn { type = weft, psi = 0, umax = 20, kappa = 0, width = 1, length = 1,\n"                                    \
    "    centerU = 0.25, centerV = 0.25, kd = {0.3, 0.2, 0.1}, ks = {1, 1, 1} }\n"                                     \
    "}\n"

#endif
