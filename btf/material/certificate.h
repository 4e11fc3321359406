/* What a material says of its own error: an interval for any pixel, found from photographs that were held out of its
 * fit. For a value of reflectance times cosine r, as the material has it, under light l and view v on a mip level,
 *
 *     |r - truth| <= q(level) spread(r) view(ring of v) light(ring of l)     with the stated probability
 *
 * spread is linear between its knots, and constant beyond them. q is the conformal quantile of the held-out residuals
 * in units of the three factors (docs/reference/compression.md, "The certificate"). */
#ifndef WEFT_BTF_MATERIAL_CERTIFICATE_H
#define WEFT_BTF_MATERIAL_CERTIFICATE_H

#include "btf/direction/direction.h"
#include "btf/material/material.h"

#include <jansson.h>

enum { WEFT_CERTIFICATE_KNOTS = 8 };

/* Of one mip level. The last three are parts of the error by ring of the view, as shares of the half width: the
 * quantile of each part's own residuals at the same probability. */
typedef struct weft_certificate_level {
    double quantile;
    double fitted[WEFT_RING_COUNT];       /* where photographs were fitted: model, storage and registration together */
    double storage[WEFT_RING_COUNT];      /* of numbers that are rounded to be stored */
    double registration[WEFT_RING_COUNT]; /* 0 where nothing is known of it */
} weft_certificate_level;

typedef struct weft_certificate {
    double probability; /* 0.95 */
    bool over_images;   /* it holds for images not seen; else these were too few, and it holds for pixels within them */
    int image_count;    /* held out, of all splits */
    int direction_count; /* views and lights that they share; images where each has its own */
    double mean;         /* of what was predicted of them */
    double value[WEFT_CERTIFICATE_KNOTS], spread[WEFT_CERTIFICATE_KNOTS]; /* in units of the mean; values ascend */
    double view[WEFT_RING_COUNT], light[WEFT_RING_COUNT];                 /* factors */
    int view_images[WEFT_RING_COUNT], light_images[WEFT_RING_COUNT]; /* 0: the factor is that of the nearest ring */
    bool has_registration;
    int level_count;     /* coarser levels have the last one's */
    int measured_levels; /* of these, whose residuals are means over as many texels as theirs, neighbours; others have
                            the quantile of fewer texels, rather too large. 0: not known */
    weft_certificate_level level[WEFT_MATERIAL_MAX_LEVELS];
} weft_certificate;

/* Half the width of the interval about `value`, which is reflectance times cosine; from `level` on down to the next
 * whole one. 0 below the horizon. Pure. */
double weft_certificate_half_width(const weft_certificate *certificate, double level, double value, weft_vec3 light,
                                   weft_vec3 view);

/* Whether its quantile was measured for that level, and is not that of fewer texels, or not known to be. Pure. */
bool weft_certificate_is_measured(const weft_certificate *certificate, double level);

/* Half the width without q, for directions of these rings: what residuals are divided by. Pure. */
double weft_certificate_scale_of_rings(const weft_certificate *certificate, double value, int light_ring,
                                       int view_ring);

/* Parts as shares of the half width: sampling = 1 - fitted, at least 0; model^2 = fitted^2 - storage^2 -
 * registration^2, at least 0. */
typedef struct weft_certificate_parts {
    double sampling, registration, model, storage;
} weft_certificate_parts;

/* Of views of a ring. Pure. */
weft_certificate_parts weft_certificate_parts_of(const weft_certificate *certificate, int level, int view_ring);

/* Rounds what is stored in thousandths, so that it is as it will be read; no factor falls below one. The quantiles are
 * rounded up. Pure. */
void weft_certificate_round(weft_certificate *certificate);

/* As the JSON object "certificate" (docs/reference/weft-format.md). The caller owns it; NULL where memory is short. */
json_t *weft_certificate_pack(const weft_certificate *certificate);

/* From such an object; returns what is wrong with it ("holds a certificate ..."), or NULL. */
const char *weft_certificate_unpack(const json_t *object, weft_certificate *certificate);

/* From the metadata of a material, JSON text; *found is false where they have none. Errors: WEFT_BAD_INPUT for one that
 * is damaged, WEFT_SYSTEM for memory. */
weft_code weft_certificate_read(const char *metadata, bool *found, weft_certificate *certificate, weft_error *error);

#endif
