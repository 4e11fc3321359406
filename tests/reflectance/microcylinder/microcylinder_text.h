/* A small valid microcylinder file, for tests that change it. */
#ifndef WEFT_TESTS_REFLECTANCE_MICROCYLINDER_TEXT_H
#define WEFT_TESTS_REFLECTANCE_MICROCYLINDER_TEXT_H

#define MICROCYLINDER_TEXT                                                                                             \
    "/* two threads */\n"                                                                                              \
    "microcylinder {\n"                                                                                                \
    "  name = \"Plain\", sigma = 20,\n"                                                                                \
    "  thread { axis = x, tilts { -25, 0, 25 }, lengths { 1, 2 }, samples = 4,\n"                                      \
    "    eta = 1.46, gammaS = 12, gammaV = 24, kd = 0.3, albedo = { 0.2, 0.8, 1 }, area = 0.33 },\n"                   \
    "  thread { axis = y, tilts { 0, 0 }, lengths { 1 }, samples = 2,\n"                                               \
    "    eta = 1.5, gammaS = 5, gammaV = 12, kd = 0.1, albedo = { 1, 0.9, 0.3 }, area = 0.5 }\n"                       \
    "}\n"

#endif
