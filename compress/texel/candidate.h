/* Models that compete for the texels of a material: the same material fitted with more and less. */
#ifndef WEFT_COMPRESS_TEXEL_CANDIDATE_H
#define WEFT_COMPRESS_TEXEL_CANDIDATE_H

#include "btf/material/models.h"

typedef struct weft_candidate {
    const weft_material *material; /* every texel of it, tables in 8 bits */
    weft_model_parts parts;        /* how many bits of its tables are used */
} weft_candidate;

/* What weft_texel_fit does instead of fitting: measures candidates against the samples. */
typedef struct weft_judgement {
    int count;
    const weft_candidate *candidate;               /* [count] */
    float *square_error[WEFT_MATERIAL_MAX_LEVELS]; /* [texel][count], infinite where rounded tables glare; NULL where
                                                      only sums are wanted */
} weft_judgement;

/* Bytes of a texel before any coding: rho, lobes as half floats, the bits of T and S. Pure. */
double weft_candidate_bytes(const weft_candidate *candidate);

/* Copies a texel of a level of the candidate into `to`, a material of the same size with at least as many lobes and the
 * same directions. What the candidate lacks becomes neutral; opacity stays. */
void weft_candidate_copy_texel(const weft_candidate *candidate, int level, size_t texel, weft_material *to);

#endif
