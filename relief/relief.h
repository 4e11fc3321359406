/* The height of every texel of a dataset, from the parallax that is in its photographs, and whether it is worth having.
 *
 * A sweep of heights (relief/sweep.h) gives the heights. Whether they are used, leaving one view out decides: it is
 * predicted from the others through the heights, through the best plane, and as if all lay in the plane of the texels.
 * Shine that wanders over flat cloth makes heights, too, but they do not predict better than a plane does. */
#ifndef WEFT_RELIEF_RELIEF_H
#define WEFT_RELIEF_RELIEF_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"

typedef enum weft_relief_verdict {
    WEFT_RELIEF_NOTHING, /* the plane of the texels does as well */
    WEFT_RELIEF_PLANE,   /* one height for all */
    WEFT_RELIEF_HEIGHTS
} weft_relief_verdict;

typedef enum weft_relief_repeat {
    WEFT_RELIEF_REPEAT_AUTO, /* where its opposite borders fit */
    WEFT_RELIEF_REPEAT_ON,
    WEFT_RELIEF_REPEAT_OFF
} weft_relief_repeat;

typedef struct weft_relief_options {
    double low_mm, high_mm; /* where heights are looked for; equal: found */
    weft_relief_repeat repeat;
} weft_relief_options;

/* Heights are used where their error is at most this part of that of the plane, and the plane where its error is at
 * most this part of that without. Heights have to gain as much as a plane does, too, unless the texels lie on their
 * best plane already: there is no more to gain from one. */
#define WEFT_RELIEF_GAIN 0.9
#define WEFT_RELIEF_PLANE_GAIN 0.8

/* Relative RMSE of views that are left out. */
typedef struct weft_relief_errors {
    double flat, plane, heights;
} weft_relief_errors;

typedef struct weft_relief_view {
    weft_vec3 direction;
    weft_relief_errors error;
} weft_relief_view;

enum { WEFT_RELIEF_LEVELS = 4 };

typedef struct weft_relief_report {
    weft_relief_verdict verdict;
    int width, height;          /* places that have a height: two along each side of a texel */
    double width_mm, height_mm; /* of the material */
    float *height_mm_of;        /* [height][width] above the plane of the texels */
    float *confidence;          /* [height][width] 0 .. 1 */
    double plane_mm;
    double low_mm, high_mm; /* where heights were looked for */
    bool repeats;
    bool on_its_plane; /* the texels were put where the views agree, */
    double moved_mm;   /* this far above where they had been, by earlier moves */
    double seam;       /* how much opposite borders differ, as a multiple of neighbouring texels */
    weft_relief_errors error;
    int level_count; /* mip levels that were judged */
    weft_relief_errors level_error[WEFT_RELIEF_LEVELS];
    int levels_used; /* the finest levels on which what was decided is used */
    int view_count, compared_count, light_count;
    weft_relief_view *view; /* [compared_count] those that could be left out */
} weft_relief_report;

/* Reads the dataset once. The errors of heights are those of views that had no part in them: a third of the views is
 * left out of a search at a time. Errors: WEFT_BAD_INPUT for near lights and views, fewer than eight views under the
 * same lights or fewer than four that lie among others, all masked, or fewer than 4 x 4 texels; those of reading;
 * WEFT_SYSTEM. The caller frees with weft_relief_report_free. */
weft_code weft_relief_estimate(weft_dataset *dataset, const weft_relief_options *options, const weft_progress *progress,
                               weft_relief_report *report, weft_error *error);
void weft_relief_report_free(weft_relief_report *report);

/* ---- The surface as files that other programs read ---- */

/* The surface as a Wavefront OBJ file with texture coordinates, written atomically: a vertex in the middle of every
 * place, in mm, the lower left corner of the material at the origin. Errors: WEFT_SYSTEM. */
weft_code weft_surface_write_obj(const char *path, const weft_dataset_heights *heights, double width_mm,
                                 double height_mm, weft_error *error);

/* Its normals as a picture, a pixel a place: (n + 1) / 2 as red, green, blue with x to the right, y up and z toward the
 * viewer, not gamma-coded. The material repeats. Errors: WEFT_SYSTEM. */
weft_code weft_surface_write_normals(const char *path, const weft_dataset_heights *heights, double width_mm,
                                     double height_mm, weft_error *error);

#endif
