/* The search for the shape of every texel's lobe: all slopes and exponents tried on the whole field, errors pooled over
 * neighbourhoods, the best kept under each of several settings at once. */
#ifndef WEFT_COMPRESS_SPARSE_SEARCH_H
#define WEFT_COMPRESS_SPARSE_SEARCH_H

#include "compress/sparse/sparse.h"

#include <stdint.h>

enum {
    WEFT_SPARSE_EXPONENTS = 12, /* 4 .. 181, half an octave apart */
    WEFT_SPARSE_SETTINGS = 32   /* at most */
};

#define WEFT_SPARSE_FIRST_EXPONENT 4.0f

typedef struct weft_sparse_shape {
    float slope_x, slope_y, exponent;
} weft_sparse_shape;

/* Set field, left_out, setting_count and setting, then call create. */
typedef struct weft_sparse_search {
    const weft_sparse_field *field;
    int left_out; /* image that must not be seen, -1: none */
    int setting_count;
    const weft_sparse_setting *setting; /* [setting_count] */
    int worker_count;
    struct weft_sparse_worker *worker; /* [worker_count] one per thread */
    float *weight;                     /* [texel][image] of the relative error */
    float *grey;                       /* [texel][image] */
    weft_sparse_shape *shape;          /* [setting][texel] the choices, smoothed */
} weft_sparse_search;

/* Errors: WEFT_SYSTEM for memory; free it all the same. */
weft_code weft_sparse_search_create(weft_sparse_search *search, weft_error *error);
void weft_sparse_search_free(weft_sparse_search *search);

/* Fills `shape` for the present left_out. The number of threads leaves no trace. */
void weft_sparse_search_run(weft_sparse_search *search);

/* The texel's own rho and amplitudes for the shape chosen under a setting. Thread-safe. */
weft_sparse_texel weft_sparse_search_texel(const weft_sparse_search *search, int setting, size_t texel);

static inline size_t weft_sparse_texel_count(const weft_sparse_field *field)
{
    return (size_t)field->width * (size_t)field->height;
}

#endif
