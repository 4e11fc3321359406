/* What of a material the pictures of a scene reach: a material that was pruned for a scene (edit/prune) holds only
 * that, and a player can tell where it is asked for more. Every map is a square of cells: of directions by their place
 * (btf/direction/square_map.h), of the material by its texture coordinates, row 0 at the top. */
#ifndef WEFT_BTF_MATERIAL_SEEN_H
#define WEFT_BTF_MATERIAL_SEEN_H

#include "base/status.h"
#include "base/vector.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    WEFT_MATERIAL_VISIBILITY_LEAST_SIDE = 4,
    WEFT_MATERIAL_VISIBILITY_MOST_SIDE = 128,
    WEFT_MATERIAL_VISIBILITY_MOST_LEVELS = 16
};

/* The maps follow each other in `cell`. */
typedef enum weft_material_visibility_map {
    WEFT_MATERIAL_VISIBILITY_VIEWS,
    WEFT_MATERIAL_VISIBILITY_LIGHTS,
    WEFT_MATERIAL_VISIBILITY_PLACES /* of level 0; then of the others */
} weft_material_visibility_map;

typedef struct weft_material_visibility {
    int side;           /* cells along a side of every map */
    int level_count;    /* that of the material */
    int finer_levels;   /* that the material had before its level 0 */
    int coarser_levels; /* and after its last */
    uint8_t *cell;      /* [2 + level_count][side][side] 1: the whole cell is as it was; 0: some of it need not be */
} weft_material_visibility;

/* Zeroed maps. Errors: WEFT_BAD_USAGE for counts out of range, WEFT_SYSTEM. The caller frees with
 * weft_material_visibility_free.
 */
weft_code weft_material_visibility_create(int side, int level_count, weft_material_visibility **result,
                                          weft_error *error);
void weft_material_visibility_free(weft_material_visibility *visibility);

/* Takes the map of the finest level away; there must be another. */
void weft_material_visibility_drop_finest(weft_material_visibility *visibility);

/* The cells of a map: map WEFT_MATERIAL_VISIBILITY_PLACES + k is that of level k. */
uint8_t *weft_material_visibility_cells(const weft_material_visibility *visibility, int map);

/* Whether a direction above the horizon lies in a cell of the map of views or of lights that is 1. Pure. */
bool weft_material_visibility_direction(const weft_material_visibility *visibility, weft_material_visibility_map map,
                                        weft_vec3 direction);

/* Whether the material has, at texture coordinates (u, v), all that a pixel of this level, which may be fractional or
 * negative, asks for. Pure. */
bool weft_material_visibility_place(const weft_material_visibility *visibility, double level, double u, double v);

/* ---- The file (docs/reference/weft-format.md, 10) ---- */

/* Bytes of the section SEEN. Pure. */
size_t weft_material_visibility_size(const weft_material_visibility *visibility);

/* Writes the section SEEN to bytes [weft_material_visibility_size]. */
void weft_material_visibility_write(const weft_material_visibility *visibility, uint8_t *bytes);

/* Reads a section SEEN of `size` bytes for a material of so many levels. `fault` receives what is wrong with it ("holds
 * ...") or NULL. Errors: WEFT_BAD_INPUT where something is, WEFT_SYSTEM. */
weft_code weft_material_visibility_read(const uint8_t *bytes, size_t size, int level_count,
                                        weft_material_visibility **result, const char **fault, weft_error *error);

#endif
