/* Dataset, material, analytic cloth and BARD side by side: one HTML page (docs/guide/compare.md). */
#ifndef WEFT_COMPARE_REPORT_COMPARE_H
#define WEFT_COMPARE_REPORT_COMPARE_H

#include "base/progress.h"
#include "btf/material/held_out.h"
#include "compare/report/leave_one_out.h"
#include "compare/report/scenes.h"
#include "compare/report/slices.h"
#include "compare/truth/comparison.h"
#include "compress/weave_fit/fit_weave.h"
#include "evaluate/error/measurement.h"

typedef struct weft_compare_options {
    const char *dataset;     /* NAME.btf.h5 */
    const char *material;    /* NAME.weft, fitted to it */
    const char *weave;       /* CLOTH.wv or CLOTH.mc, or NULL */
    bool fit;                /* the weave to the dataset first, with CLOTH.wv as the start */
    const char *bard;        /* NAME.bard.h5 as `weft bard` writes it, or NULL */
    const char *truth;       /* FILE.stitch from which the dataset was simulated, or NULL */
    int truth_paths;         /* of a pixel */
    int picture_side;        /* of the scenes, pixels; 0 = WEFT_COMPARE_PICTURE_SIDE */
    double tiles_u, tiles_v; /* of the weave for one material; 0 = as many as the virtual rig would lay out */
    const char *folder;      /* for the page and its pictures */
} weft_compare_options;

enum { WEFT_COMPARE_PICTURE_SIDE = 400 };

/* A dataset of fewer images than these is also fitted with each of them left out. */
enum { WEFT_LEAVE_ONE_OUT_LIMIT = 30 };

/* A model against the data. */
typedef struct weft_compared_model {
    const char *name;         /* "compressed", "analytic", "BARD" */
    weft_measurement texture; /* sample by sample */
    weft_error_summary mean;  /* of the mean BRDF over the directions of the images */
} weft_compared_model;

/* What was measured. Freed with weft_comparison_free. */
typedef struct weft_comparison {
    int model_count;
    weft_compared_model model[WEFT_CONTENDER_COUNT - 1]; /* the first is the material */
    char weave_name[128];                                /* of the analytic cloth, empty without one */
    char weave_origin[WEFT_MESSAGE_SIZE];                /* what it was fitted to, if anything */
    bool weave_is_threads;                               /* microcylinder cloth, which has neither fit nor layout */
    weft_fit_weave_report fit;                           /* where it was fitted here: image_count > 0 */
    weft_weave_layout weave_layout;                      /* of it on the material */
    bool weave_on_yarns;                                 /* laid by the tiles that a fit found */
    weft_slices slices;
    weft_leave_one_out left_out; /* count 0 where the dataset has too many images */
    bool has_held_out;
    weft_hold_out held_out; /* what the material says of its error where it was not fitted, if it does */
    double dataset_bytes, half_float_bytes, material_bytes;
    weft_scenes scenes;
    weft_traced_truth truth;         /* nothing drawn without a stitch */
    char warning[WEFT_MESSAGE_SIZE]; /* that the material was made from another dataset, or "" */
} weft_comparison;

/* Measures, renders, and writes folder/index.html with its pictures; the page appears when it is complete. Without
 * OpenGL the page says that the pictures of the scenes are missing, and why. Errors: WEFT_BAD_INPUT for files that
 * cannot be read or do not belong together; WEFT_SYSTEM from writing. */
weft_code weft_compare(const weft_compare_options *options, const weft_progress *progress, weft_comparison *comparison,
                       weft_error *error);
void weft_comparison_free(weft_comparison *comparison);

#endif
