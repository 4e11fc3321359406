/* The steps of pruning: what of levels and texels, tables, lobes and components a scene never shows is taken away.
 * Private to edit/prune. */
#ifndef WEFT_EDIT_PRUNE_STEPS_H
#define WEFT_EDIT_PRUNE_STEPS_H

#include "edit/prune/prune.h"
#include "edit/prune/visibility.h"
#include "player/draw/player.h"

/* ---- Texels ---- */

/* A material without the mip levels and texels that no pixel of a visibility reads. Private to edit/prune. */

/* Takes the finest levels away that are not reached, as long as the material keeps its proportions, and the coarsest.
 * Every other texel that is not reached becomes a copy of the nearest in its row that is, and rows without any of the
 * nearest row: copies take next to no room in the file. The visibility then is that of the new levels; *finer and
 * *coarser are how many are gone. Errors: WEFT_SYSTEM. */
weft_code weft_prune_texels(weft_visibility *visibility, weft_material *material, int *finer, int *coarser,
                            weft_error *error);

/* The maps of visibility (btf/material/visibility.h) of the material as it is now. Errors: WEFT_SYSTEM. */
weft_code weft_prune_note_seen(const weft_visibility *visibility, int finer, int coarser, weft_material *material,
                               weft_error *error);

/* ---- Table directions ---- */

/* Which entries of the view table the directions of a visibility interpolate between, and a material without the
 * others. Private to edit/prune. */

/* Leaves out the views of the table that no direction of the visibility takes a weight of. What is left is
 * interpolated as before in all cells that are reached, or nothing is left out: directions that lie on one circle could
 * be triangulated another way without their neighbours. Errors: WEFT_SYSTEM. */
weft_code weft_prune_tables(const weft_visibility *visibility, weft_material *material, weft_error *error);

/* ---- Lobes ---- */

/* A material without the lobes that are never seen. Private to edit/prune. */

/* Takes every lobe of a texel away whose value, BRDF times pi, is at most `least` in all three channels for all
 * directions of the visibility; and the last lobes of all texels where no texel has them any more. *count receives how
 * many lobes of texels are gone. */
void weft_prune_lobes(const weft_visibility *visibility, double least, weft_material *material, long *count);

/* The largest value that a lobe takes for a light and a view of the visibility, from the ranges of the products of
 * their coordinates: coefficient holds Cx, Cy, Cz, N. Pure. */
double weft_lobe_bound(const weft_visibility *visibility, const weft_frame *frame, const double coefficient[4]);

/* ---- Images ---- */

/* What all texels share of components, without what a visibility does not read of it. Private to edit/prune. */

/* Marks the images whose view is within an angle of that of a pair of the visibility, and whose light, or half vector,
 * whatever the maps are of, of that of the same pair: kept [image_count]. Errors: WEFT_SYSTEM. */
weft_code weft_prune_find_images(const weft_visibility *visibility, const weft_components *components,
                                 double margin_rad, bool *kept, int *kept_count, weft_error *error);

/* Gives every image that is not kept the values of the kept one that is nearest: of its own view, else of the nearest
 * view. Copies take next to no room in the file. */
void weft_prune_fill_images(const bool *kept, weft_components *components);

/* A copy with the first `count` components alone, a multiple of 4. The caller frees it. Errors: WEFT_SYSTEM. */
weft_code weft_prune_copy_components(const weft_components *from, int count, weft_components **copy, weft_error *error);

/* ---- Pictures ---- */

/* Pictures of a scene at some moments of its path, and how far those of a pruned material are from them. Private to
 * edit/prune. */

typedef struct weft_prune_pictures {
    weft_player *player;
    const weft_prune_scene *scene;
    bool whole; /* pictures as they are written; else a few frames of each */
    int count;
    double time_s[WEFT_PRUNE_MOMENTS];
    weft_image shown[WEFT_PRUNE_MOMENTS]; /* sRGB */
    uint8_t *covered[WEFT_PRUNE_MOMENTS]; /* [height][width] 1: the mesh */
} weft_prune_pictures;

/* Draws them with the material that the player has, at `count` times. The caller frees with weft_prune_pictures_free,
 * also on failure. Errors: those of drawing. */
weft_code weft_prune_pictures_draw(weft_player *player, const weft_prune_scene *scene, bool whole, const double *time_s,
                                   int count, weft_prune_pictures *pictures, weft_error *error);
void weft_prune_pictures_free(weft_prune_pictures *pictures);

/* Draws them again, with the first `components` components of what the player has now, and compares: over all of them,
 * the RMSE of the pixels of the mesh, and the mean of FLIP over these. Errors: those of drawing. */
weft_code weft_prune_pictures_compare(const weft_prune_pictures *pictures, int components, weft_prune_error *result,
                                      weft_error *error);

/* ---- Shrink ---- */

/* How little of the components will do: images, components and digits. Private to edit/prune. */

/* Takes away of the components of `material` what pictures allow: first images far from the pairs of the visibility,
 * then the last components, then digits of the values, each within a part of what is allowed. `pictures` are those of
 * the whole material. The player then shows the result. Errors: those of drawing; WEFT_SYSTEM. */
weft_code weft_prune_shrink(const weft_prune_pictures *pictures, const weft_visibility *visibility,
                            weft_prune_error allowed, weft_material *material, weft_prune_report *report,
                            weft_error *error);

#endif
