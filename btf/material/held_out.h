/* What a material says of its error on directions that it was not fitted to. */
#ifndef WEFT_BTF_MATERIAL_HELD_OUT_H
#define WEFT_BTF_MATERIAL_HELD_OUT_H

#include "base/numeric/error_summary.h"
#include "btf/material/certificate.h"
#include "btf/material/material.h"

#include <jansson.h>

enum { WEFT_HOLD_OUT_LINE = 512 };

/* What was left out of the fits. */
typedef enum weft_split_kind {
    WEFT_SPLIT_DIRECTIONS,  /* views and lights of a grid, each with all of its images */
    WEFT_SPLIT_PHOTOGRAPHS, /* a tenth of a list of images that is no grid */
    WEFT_SPLIT_EACH         /* of a handful of images each in turn */
} weft_split_kind;

/* Means over the splits of their errors (base/numeric/error_summary.h); counts are sums. Zero where a split holds out
 * none of the kind. */
typedef struct weft_hold_out_error {
    weft_error_summary all;               /* of all images that were held out */
    weft_error_summary view, light, both; /* of those whose view alone, whose light alone, and both of whose were */
} weft_hold_out_error;

/* Whether components are to be seen through the heights of the dataset: relative RMSE over all samples of what was held
 * out that can be predicted through them, means over the splits. */
typedef struct weft_hold_out_heights {
    bool asked, used;
    double with, without;
} weft_hold_out_heights;

typedef struct weft_hold_out {
    weft_split_kind kind;
    int split_count;
    int view_count, view_held_count, light_count, light_held_count; /* of a split, the mean rounded */
    int image_count, image_held_count;
    long texel_count, dataset_texel_count; /* measured, and all */
    bool smaller_model;                    /* the images that were left carry less than all of them do */
    weft_hold_out_heights heights;
    weft_hold_out_error material;    /* as it is to be played: through heights where they are used */
    weft_hold_out_error photographs; /* interpolated between those that were not held out, as raw is played: through
                                        the surface of the dataset where it has one */
    double photographs_flat;         /* relative RMSE of the same samples without it; 0 where there is none */
    weft_error_summary fitted;       /* of the same fits where they were fitted: on what the next split holds out, which
                                        lies in the same rings. Zero where there is no next one */
    bool has_certificate;            /* not where all that is predicted is black */
    weft_certificate certificate;    /* an interval for any pixel, at 0.95 */
} weft_hold_out;

/* ---- In the metadata of a material ---- */

/* As a JSON object (docs/reference/weft-format.md, "held_out"). The caller owns it; NULL where memory is short. */
json_t *weft_hold_out_to_json(const weft_hold_out *result);

/* Puts it into the metadata of a material, where weft_hold_out_read finds it. Errors: WEFT_SYSTEM for memory. */
weft_code weft_hold_out_store(const weft_hold_out *result, weft_material *material, weft_error *error);

/* Reads it from the metadata of a material, with the certificate; *found is false where there is none, or none that
 * this version understands. Errors: WEFT_BAD_INPUT for a damaged certificate, WEFT_SYSTEM for memory. */
weft_code weft_hold_out_read(const char *metadata, bool *found, weft_hold_out *result, weft_error *error);

/* ---- In words ---- */

/* "on directions that were not fitted": what the headline is about. Pure. */
const char *weft_hold_out_about(const weft_hold_out *result);

/* The headline, such as "on directions that were not fitted: relative RMSE 0.412 (the photographs themselves,
 * interpolated: 0.336); on those that were: 0.391". Pure. */
void weft_hold_out_headline(const weft_hold_out *result, char line[WEFT_HOLD_OUT_LINE]);

/* What the intervals of a certificate hold for: "95 % of the pixels of images not seen, ...". Pure. */
void weft_certificate_describe(const weft_certificate *certificate, char line[WEFT_HOLD_OUT_LINE]);

/* Half the width at the mean value for views of a ring, under light at 30 degrees, and its parts: "+-0.0213 (34 %):
 * sampling 14 %, ...". Pure. */
void weft_certificate_row(const weft_certificate *certificate, int view_ring, char line[WEFT_HOLD_OUT_LINE]);

/* On which levels it was measured, and why coarser ones are rather too wide; "" where that is not known. Pure. */
void weft_certificate_describe_levels(const weft_certificate *certificate, char line[WEFT_HOLD_OUT_LINE]);

/* How it was measured: what was held out, and on which texels. Pure. */
void weft_hold_out_explain(const weft_hold_out *result, char line[WEFT_HOLD_OUT_LINE]);

#endif
