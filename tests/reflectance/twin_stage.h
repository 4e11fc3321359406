/* Runs the GLSL twin of a function on many inputs at once, without a window. */
#ifndef WEFT_TESTS_REFLECTANCE_TWIN_STAGE_H
#define WEFT_TESTS_REFLECTANCE_TWIN_STAGE_H

#include "player/gl/context.h"

enum { TWIN_WIDTH = 256, TWIN_HEIGHT = 128, TWIN_QUERIES = TWIN_WIDTH * TWIN_HEIGHT, TWIN_BANDS = 3 };

/* Inputs of a query: three vectors of four floats. */
typedef float twin_queries[TWIN_BANDS][TWIN_QUERIES][4];

/* A table the function reads: width x height texels of four floats. */
typedef struct twin_table {
    const float *rgba;
    int width, height;
} twin_table;

/* Runs the fragment program made of the given sources (NULL-terminated); the last defines
 *     vec4 twin(sampler2D table, vec4 a, vec4 b, vec4 c)
 * which is called once a query. Skips the test where there is no OpenGL; fails it where the program does not compile.
 */
void twin_run(weft_gl_profile profile, const char *const *sources, const twin_table *table, twin_queries queries,
              float (*result)[4]);

/* The main program of such a test: runs `compare` in each dialect of GLSL as a test of the group `name`. */
int twin_main(const char *name, void (*compare)(weft_gl_profile profile));

#endif
