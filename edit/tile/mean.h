/* The mean of all tiles of a picture. Private to the room. */
#ifndef WEFT_EDIT_TILE_MEAN_H
#define WEFT_EDIT_TILE_MEAN_H

#include "edit/tile/textured_pictures.h"
#include "edit/tile/tile.h"

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
