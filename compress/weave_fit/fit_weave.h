/* Fitting a weave to a dataset: pattern, sizes and kinds of the segments are known, as from a microscope; twist,
 * inclination, curvature, scattering and colours follow from the mean BRDF (Irawan and Marschner 2012, section 4). */
#ifndef WEFT_COMPRESS_WEAVE_FIT_FIT_WEAVE_H
#define WEFT_COMPRESS_WEAVE_FIT_FIT_WEAVE_H

#include "base/numeric/error_summary.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/direction/direction.h"
#include "edit/tile/tile.h"
#include "reflectance/weave/weave.h"

/* ---- Mean brdf ---- */

/* The mean BRDF of a dataset: what a reflectance model without texture has to explain. */

/* Owned by the caller. */
typedef struct weft_mean_brdf {
    int count;               /* images with a valid texel, light and view above the horizon */
    weft_vec3 *light, *view; /* [count] as the centre of the material sees them */
    weft_rgb *value;         /* [count] 1/sr, mean over the valid texels */
} weft_mean_brdf;

/* A part of the material, texels, x to the right and y down from its upper left corner. What repeats with a period, at
 * most the size of the window, counts once, as the mean of how often the window shows it; period 0: every texel counts
 * alike. */
typedef struct weft_texel_window {
    double left, top, width, height;
    double period_x, period_y;
} weft_texel_window;

/* Over `window`, texels that it cuts with the share inside; NULL: the whole material. Reads it block by block. Errors:
 * WEFT_BAD_INPUT where nothing is valid; those of reading; WEFT_SYSTEM for memory. */
weft_code weft_mean_brdf_of(weft_dataset *dataset, const weft_texel_window *window, const weft_progress *progress,
                            weft_mean_brdf *mean, weft_error *error);
void weft_mean_brdf_free(weft_mean_brdf *mean);

enum { WEFT_FIT_WEAVE_GROUPS = 8 };

/* Yarns of one direction with the same shape and colours: their fibres are fitted as one. */
typedef struct weft_fit_weave_group {
    bool warp, staple, width_fitted;
    int yarn;                               /* the first of them, index */
    double psi_deg, umax_deg, kappa, width; /* fitted; the width, in cells, is that of the start where not */
    double psi_deviation, umax_deviation, kappa_deviation, width_deviation; /* standard errors; INFINITY: unknown */
} weft_fit_weave_group;

/* Whether the sample's turn was fitted, or why the sample was held straight. */
typedef enum weft_fit_weave_turn {
    WEFT_TURN_FITTED,
    WEFT_TURN_VAGUE,   /* a standard error is above 0.2 degrees */
    WEFT_TURN_AT_BOUND /* about an axis it runs to 95 % of its bound of a degree: something else is amiss */
} weft_fit_weave_turn;

typedef struct weft_fit_weave_report {
    int image_count, group_count;
    weft_fit_weave_group group[WEFT_FIT_WEAVE_GROUPS];
    double alpha, beta, alpha_deviation, beta_deviation;
    weft_fit_weave_turn turn;
    double askew_deg[3], askew_deviation[3]; /* turn of the sample about x, y, z; all 0 where it was held straight */
    weft_error_summary before, after;        /* of the mean BRDF: the weave as it was given, and fitted */
    double seconds;
} weft_fit_weave_report;

/* Changes psi, umax, kappa, alpha, beta, widths, kd and ks of `weave` to what explains `mean` best; segments that the
 * model does not have stay as they are. For a trial shape the diffuse colour and the specular colour of every group are
 * non-negative least squares of the error relative to the data; the shape is found on a coarse grid, group by group,
 * then by non-linear least squares. A mean BRDF knows only the sum of the diffuse terms: kd of all yarns is scaled by
 * one factor a channel. psi keeps its sign, and a filament (psi = 0) stays one. The widths of a group change by one
 * factor, 0.4 to 2.5; they stay those of the start where its standard error is above 0.25 and the start does as well.
 * The sample may lie askew in the frame of lights and views by up to a degree; where the data do not tell that to 0.2
 * degrees, or want more, it is taken as straight. Standard errors take residuals of images with the same light or the
 * same view as correlated. Errors: WEFT_BAD_INPUT for a weave without admissible segment or with more than
 * WEFT_FIT_WEAVE_GROUPS kinds, or for fewer images than unknowns; WEFT_SYSTEM. */
weft_code weft_fit_weave(const weft_mean_brdf *mean, weft_weave *weave, const weft_progress *progress,
                         weft_fit_weave_report *report, weft_error *error);

/* The error of the mean BRDF of a weave as it is, over images and channels. Errors: WEFT_SYSTEM for memory. */
weft_code weft_fit_weave_measure(const weft_mean_brdf *mean, const weft_weave *weave, weft_error_summary *result,
                                 weft_error *error);

typedef struct weft_fit_weave_source {
    bool tiled;                        /* the mean is that of a tile */
    weft_tile_report tile;             /* their size, and where one begins */
    int tiles_x, tiles_y;              /* so many whole ones lie in the material */
    char why_whole[WEFT_MESSAGE_SIZE]; /* why the mean is that of the whole material, or "" */
} weft_fit_weave_source;

/* Finds the tile of the weave in the dataset (weft_tile_find), averages it over the material but for a sixteenth at
 * each edge, every place of the tile alike, and fits the weave to that mean BRDF (weft_fit_weave). Where no tile is
 * found, or none is whole, the mean is that of the whole material. The weave then lies (weave->layout) as the tiles do,
 * or anyhow. Errors: those of reading and of weft_fit_weave. */
weft_code weft_fit_weave_to_dataset(weft_dataset *dataset, weft_weave *weave, const weft_progress *progress,
                                    weft_fit_weave_source *source, weft_fit_weave_report *report, weft_error *error);

/* Writes a fitted weave whose first line tells the dataset (name and fingerprint) and the error. Atomic. Errors: those
 * of reading and writing. */
weft_code weft_fit_weave_write(const char *path, const weft_weave *weave, weft_dataset *dataset,
                               const weft_fit_weave_report *report, weft_error *error);

/* `origin`: "fitted to this dataset", "fitted to another dataset, ..." or "as its file gives it, fitted to no
 * dataset". Errors: those of reading. */
weft_code weft_fit_weave_origin(const char *path, weft_dataset *dataset, char origin[WEFT_MESSAGE_SIZE],
                                weft_error *error);

#endif
