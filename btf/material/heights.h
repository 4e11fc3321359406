/* Heights of a material's surface, through which its stored views are seen (reflectance/relief/material_relief.h). */
#ifndef WEFT_BTF_MATERIAL_HEIGHTS_H
#define WEFT_BTF_MATERIAL_HEIGHTS_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

enum {
    WEFT_HEIGHTS_LARGEST_CODE = 255,
    WEFT_HEIGHTS_MOST_SIDE = 1 << 17, /* places along a side: eight of each texel of the largest material */
    WEFT_HEIGHTS_MOST_LEVELS = 16
};

/* Row 0 is the top row; the material repeats. */
typedef struct weft_material_heights {
    int width, height;     /* places; 1 x 1 is a plane */
    int level_count;       /* the finest mip levels that are seen through them, at least 1 */
    double size_mm[2];     /* of the material */
    float low_mm, high_mm; /* above the plane of the texels; alike in a plane */
    uint8_t *code;         /* [height][width] from low (0) to high (255) */
} weft_material_heights;

/* Codes of the heights value [height][width], in mm. Errors: WEFT_BAD_USAGE for sizes or heights that no file holds,
 * WEFT_SYSTEM. The caller frees with weft_material_heights_free. */
weft_code weft_material_heights_create(const float *value, int width, int height, int level_count,
                                       const double size_mm[2], weft_material_heights **result, weft_error *error);
void weft_material_heights_free(weft_material_heights *heights);

/* Of one place, in mm. Pure. */
float weft_material_height_mm(const weft_material_heights *heights, int x, int y);

/* ---- The file (docs/reference/weft-format.md, 9) ---- */

/* Bytes of the section HGHT. Pure. */
size_t weft_material_heights_size(const weft_material_heights *heights);

/* Writes the section HGHT to bytes [weft_material_heights_size]. */
void weft_material_heights_write(const weft_material_heights *heights, uint8_t *bytes);

/* Reads a section HGHT of `size` bytes. `fault` receives what is wrong with it ("holds ...") or NULL. Errors:
 * WEFT_BAD_INPUT where something is, WEFT_SYSTEM. */
weft_code weft_material_heights_read(const uint8_t *bytes, size_t size, weft_material_heights **result,
                                     const char **fault, weft_error *error);

#endif
