/* Heights on their way to the graphics card and on it, and what stored views see of them (shader:
 * reflectance/relief/relief.glsl).
 */
#ifndef WEFT_PLAYER_TEXTURE_RELIEF_MAP_H
#define WEFT_PLAYER_TEXTURE_RELIEF_MAP_H

#include "base/status.h"
#include "player/gl/gl.h"
#include "reflectance/relief/relief.h"

#include <stddef.h>
#include <stdint.h>

typedef struct weft_relief_map {
    int width, height, view_count; /* width 0: there are no heights */
    int level_count;               /* the finest levels on which they count */
    double range_mm[2], size_mm[2];
    uint16_t *share; /* [height][width] of 65535: the height within the range */
    uint8_t *seen;   /* [view_count][height][width] */
    float *slope;    /* [view_count][2] */
} weft_relief_map;

/* Of a height field and the views that are stored. Errors: WEFT_SYSTEM. The caller frees with weft_relief_map_free. */
weft_code weft_relief_map_make(const weft_height_field *field, const weft_vec3 *view, int view_count, int level_count,
                               weft_relief_map *map, weft_error *error);
void weft_relief_map_free(weft_relief_map *map);

typedef struct weft_relief_texture {
    GLuint height, seen, slope; /* 0: there are no heights */
    double range_mm[2], size_mm[2];
    int level_count;
    size_t bytes; /* of graphics memory */
} weft_relief_texture;

/* Errors: WEFT_SYSTEM. The caller frees with weft_relief_texture_free, also on failure. */
weft_code weft_relief_texture_upload(const weft_relief_map *map, weft_relief_texture *texture, weft_error *error);
void weft_relief_texture_free(weft_relief_texture *texture);

/* Sets the uniforms of relief.glsl, from texture unit `unit` on (three of them); does nothing without heights.
 * `program` is in use. */
void weft_relief_texture_bind(const weft_relief_texture *texture, GLuint program, int unit);

#endif
