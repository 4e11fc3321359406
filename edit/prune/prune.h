/* A material with only what a scene requires (docs/reference/pruning.md): mip levels, texels, entries of tables and
 * lobes that no pixel of it can reach are left out, by bounds (edit/prune/visibility.h); of components what of images,
 * components and digits changes pictures less than is allowed, by pictures of moments of the path. Pictures of other
 * moments tell how far the result is from the whole. */
#ifndef WEFT_EDIT_PRUNE_PRUNE_H
#define WEFT_EDIT_PRUNE_PRUNE_H

#include "edit/prune/visibility.h"
#include "player/draw/player.h"

#include <jansson.h>

enum { WEFT_PRUNE_MOMENTS = 4 }; /* of the path that are drawn, to decide and then to measure */

/* How far pictures are from those of the whole material, over the pixels of the mesh. */
typedef struct weft_prune_error {
    double rmse; /* of the sRGB values, in 1/255 */
    double flip; /* mean (compare/pictures/picture_quality.h) */
} weft_prune_error;

typedef struct weft_prune_count {
    long kept, of;
} weft_prune_count;

typedef struct weft_prune_report {
    double level_low, level_high;     /* of any pixel, in levels of the whole material */
    int finer_levels, coarser_levels; /* that are gone */
    long span_count;
    weft_prune_count texels;                       /* of all levels */
    weft_prune_count views;                        /* of the view table; of 0 without */
    weft_prune_count view_cells, light_cells;      /* of the hemisphere, by places in the square */
    long lobes_gone;                               /* of texels */
    weft_prune_count components, images;           /* of components; of 0 without */
    double value_step;                             /* that values of components are rounded to; 0: they are not */
    uint64_t bytes_before, bytes_after;            /* of the files */
    weft_prune_error allowed, predicted, measured; /* predicted: at the moments that decided */
    int decided_count, measured_count;             /* moments */
    double measured_time_s[WEFT_PRUNE_MOMENTS];
} weft_prune_report;

/* Prunes `material`, which `player` shows with the mesh of the scene. allowed: what pictures may differ by; pictures of
 * random moments, from `seed`, are held against it, and what does not hold is done again with half of it, in the end
 * with nothing but the bounds. The player then shows the pruned material. Errors: those of weft_visibility_find;
 * WEFT_BAD_INPUT for a material that was pruned before; those of drawing; WEFT_SYSTEM. */
weft_code weft_prune(weft_player *player, const weft_prune_scene *scene, weft_prune_error allowed, uint64_t seed,
                     const weft_progress *progress, weft_material *material, weft_prune_report *report,
                     weft_error *error);

/* Whether the measured error is within what was allowed, but for what rounding does: without its finest levels a
 * material is sampled at places that are rounded otherwise, and pictures differ by 1e-4 of 1/255. */
bool weft_prune_holds(const weft_prune_report *report);

/* What the metadata hold of it, as `pruned`. The caller owns it; NULL where memory is short. */
json_t *weft_prune_to_json(const weft_prune_report *report);

#endif
