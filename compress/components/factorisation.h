/* The factors of a set of texels: the principal components of their samples, over all images and channels. */
#ifndef WEFT_COMPRESS_COMPONENTS_FACTORISATION_H
#define WEFT_COMPRESS_COMPONENTS_FACTORISATION_H

#include "btf/material/components.h"
#include "compress/components/training.h"
#include "reflectance/components/components.h"

/* Freed with weft_factorisation_free. */
typedef struct weft_factorisation {
    int count;
    size_t length;
    float *vector; /* [count][length] orthonormal, the most important first, aligned to 64 bytes; 0 beyond the rank */
    double *variance; /* [count] mean square of the coefficients of the texels */
    double noise;     /* mean square of what they leave of a sample */
} weft_factorisation;

/* Computes `count` components (at most WEFT_COMPONENTS_MAX) by the eigenvectors of the products of the texels with each
 * other (Sirovich 1987). The mean is not taken away: it is the first component. What is masked is filled in meanwhile
 * by what the components say of the rest, a few times over, starting from the mean texel (Beckers and Rixen 2003); what
 * is clipped is at least as bright as it looks. Errors: WEFT_SYSTEM. */
weft_code weft_factorisation_find(const weft_training *training, int count, weft_factorisation *factorisation,
                                  weft_error *error);
void weft_factorisation_free(weft_factorisation *factorisation);

/* ---- Coefficients ---- */

/* Finds coefficients of texels for given factors, by least squares with a normal prior:
 *     c = argmin |y - B' c|^2 over the known samples + sum_k ridge_k c_k^2,  ridge_k = noise / variance_k
 * A clipped channel counts only while less is said of it than it looks. */
typedef struct weft_projector {
    int count, image_count;
    size_t length;
    const float *factor; /* [count][length], not owned */
    double *gram;        /* [count][count] of the factors over all images */
    double *root;        /* [count][count] Cholesky's factor of gram + ridge */
    double *ridge;       /* [count] */
} weft_projector;

/* `factor` and `components`, whose noise and variance are the prior, must outlive the projector. The caller frees.
 * Errors: WEFT_SYSTEM. */
weft_code weft_projector_create(const weft_factorisation *factorisation, const float *factor, int image_count,
                                weft_projector *projector, weft_error *error);
void weft_projector_free(weft_projector *projector);

/* Coefficients of texels whose directions are their own. */
typedef struct weft_near_projector {
    const weft_dataset_layout *layout;
    const weft_component_maps *maps;
    weft_component_images images; /* as the present texel sees them */
    weft_factorisation prior;     /* borrowed, but of the length of the images */
    float *factor;                /* [layer][images.length] */
} weft_near_projector;

/* All but the images are not owned. For one thread. The caller frees. Errors: WEFT_SYSTEM. */
weft_code weft_near_projector_create(const weft_dataset_layout *layout, const weft_factorisation *factorisation,
                                     const weft_component_maps *maps, const weft_component_images *images,
                                     weft_near_projector *projector, weft_error *error);
void weft_near_projector_free(weft_near_projector *projector);

/* Looks at the images from texel (x, y), before its samples are gathered. */
void weft_near_projector_move(weft_near_projector *projector, int x, int y);

/* Coefficients of that texel, as weft_projector_solve. Errors: WEFT_SYSTEM. */
weft_code weft_near_projector_solve(weft_near_projector *projector, const float *vector, const uint8_t *known,
                                    float *coefficient, weft_error *error);

/* Coefficients [texel_count][count] of vector [texel_count], unknown samples 0, known [texel_count][image_count]. No
 * texel leaves a trace in another. Thread-safe. Errors: WEFT_SYSTEM. */
weft_code weft_projector_solve(const weft_projector *projector, const float *const *vector, const uint8_t *const *known,
                               int texel_count, float *coefficient, weft_error *error);

#endif
