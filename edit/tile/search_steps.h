/* The steps of the search for a tile: its size, the size more exactly, and where it begins. Private to the room. */
#ifndef WEFT_EDIT_TILE_SEARCH_STEPS_H
#define WEFT_EDIT_TILE_SEARCH_STEPS_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "edit/tile/tile.h"

/* ---- Pictures ---- */

/* The photographs of a dataset in which a tile is looked for. Private to the room. */

enum { WEFT_TILE_PICTURES = 24 };

/* Owned by the caller, freed with weft_tile_pictures_free. */
typedef struct weft_tile_pictures {
    int width, height, count;
    int image[WEFT_TILE_PICTURES];
    float *value; /* [count][height][width] mean of the channels relative to that of the image, less 1; masked: the mean
                     of its valid neighbours, or 0 */
    uint8_t *mask; /* [count][height][width] 0: valid */
} weft_tile_pictures;

/* The photographs with the largest covariance of neighbouring texels relative to their mean, which noise does not
 * raise; none steeper than 65 degrees or less than half valid. Fewer than WEFT_TILE_PICTURES where the material is
 * large. Errors: WEFT_BAD_INPUT where there is none; those of reading; WEFT_SYSTEM. */
weft_code weft_tile_pictures_read(weft_dataset *dataset, const weft_progress *progress, weft_tile_pictures *pictures,
                                  weft_error *error);
void weft_tile_pictures_free(weft_tile_pictures *pictures);

/* Sets width, height, repeat_x and repeat_y of the report. `path` names the dataset in messages. Errors: WEFT_BAD_INPUT
 * where the pictures do not repeat at least about twice along both axes; WEFT_SYSTEM. */
weft_code weft_tile_period_find(const weft_tile_pictures *pictures, const char *path, weft_tile_report *report,
                                weft_error *error);

/* Width and height, known to about a texel over the whole material, where a Fourier series of the tile, down to waves
 * of three texels, explains most of the pictures. Errors: WEFT_SYSTEM. */
weft_code weft_tile_period_refine(const weft_tile_pictures *pictures, weft_tile *tile, weft_error *error);

/* Takes the shortest repeat in the report for a fraction of the tile of the weave, 1 to 3 along each axis, renders that
 * tile under the lights and views of the pictures, and correlates it with theirs. Sets the tile and likeness. Errors:
 * WEFT_BAD_INPUT where the likeness stays below 0.3; WEFT_SYSTEM. */
weft_code weft_tile_phase_find(const weft_tile_pictures *pictures, const weft_dataset_layout *layout, const char *path,
                               const weft_weave *weave, weft_tile_report *report, weft_error *error);

/* Where `function` is largest within [low, high], to `tolerance`, if it has one peak there: by golden section (Kiefer
 * 1953). */
double weft_golden_section(double (*function)(void *context, double x), void *context, double low, double high,
                           double tolerance);

/* ---- Mean ---- */

/* The mean of all tiles of a picture. Private to the room. */

/* The two texels of the tile, along one axis, between whose centres a point of the material lies. */
typedef struct weft_tile_place {
    int low, high;
    double share; /* of `high`; the rest is of `low` */
} weft_tile_place;

/* Point `at` (texels of the material) of a tile that begins at `start`, is `period` long and has `count` texels. Pure.
 */
weft_tile_place weft_tile_place_of(double at, double start, double period, int count);

/* Room for the mean of one picture, freed with weft_tile_mean_free. */
typedef struct weft_tile_mean {
    int columns, rows;
    double *sum, *weight;   /* [rows][columns] */
    weft_tile_place *place; /* [picture width], then [picture height] */
} weft_tile_mean;

/* Errors: WEFT_SYSTEM. */
weft_code weft_tile_mean_create(const weft_tile_pictures *pictures, int columns, int rows, weft_tile_mean *mean,
                                weft_error *error);
void weft_tile_mean_free(weft_tile_mean *mean);

/* Averages the tiles of picture k: sum becomes the mean, 0 where no valid texel is near. */
void weft_tile_mean_make(const weft_tile_pictures *pictures, int k, const weft_tile *tile, weft_tile_mean *mean);

#endif
