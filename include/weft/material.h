/* The material NAME.weft: what `weft compress` writes, and what the player and other renderers read. The file format is
 * docs/reference/weft-format.md. To evaluate one, see weft/evaluate.h. */
#ifndef WEFT_MATERIAL_H
#define WEFT_MATERIAL_H

#include "weft/status.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* May be read from several threads at once while none changes it. */
typedef struct weft_material weft_material;

/* Reads and checks all of a file: every size against the file before anything is allocated, every checksum. The caller
 * closes the material with weft_material_close. Errors: WEFT_MISSING, WEFT_DAMAGED naming the file and the section,
 * WEFT_NOT_SUPPORTED for a newer version, WEFT_BAD_INPUT for a file that is no material, WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_material_open(const char *path, weft_material **result, weft_error *error);

/* NULL is fine. */
WEFT_API void weft_material_close(weft_material *material);

/* Writes version 2 of the format, atomically: the file is whole or as it was. The values of components are rounded, by
 * less than half a step of their codes. Errors: WEFT_BAD_USAGE for a material with a light table, which only files of
 * version 1 have, and for contents that could not be read back: numbers that are not finite, negative diffuse terms or
 * exponents, directions that are no unit vectors of the upper hemisphere, metadata that is no JSON object;
 * WEFT_SYSTEM. */
WEFT_API weft_code weft_material_write(const char *path, const weft_material *material, weft_error *error);

/* ---- What it holds. All functions are pure. ---- */

/* Level k + 1 has half the size of level k, rounded up; without mip levels 1. */
WEFT_API int weft_material_level_count(const weft_material *material);

/* Texels of a level, 0 <= level < weft_material_level_count. */
WEFT_API int weft_material_width(const weft_material *material, int level);
WEFT_API int weft_material_height(const weft_material *material, int level);

/* Size of a texel of level 0, mm. */
WEFT_API double weft_material_texel_pitch_mm(const weft_material *material);

/* Components of its factorisation; 0 where it has none. */
WEFT_API int weft_material_component_count(const weft_material *material);

/* Lafortune lobes of a texel and channel; 0 where it has none. */
WEFT_API int weft_material_lobe_count(const weft_material *material);

/* Whether some texel is transparent in some view. Looks at all of them. */
WEFT_API bool weft_material_has_holes(const weft_material *material);

/* JSON text: where it comes from, how it was fitted, its errors. Owned by the material. */
WEFT_API const char *weft_material_metadata(const weft_material *material);

/* ---- Changes ---- */

/* Takes the finest level away: the same material with a quarter of the texels. Does nothing where there is but one. */
WEFT_API void weft_material_drop_finest(weft_material *material);

/* Takes the coarsest level away. Does nothing where there is but one. */
WEFT_API void weft_material_drop_coarsest(weft_material *material);

#ifdef __cplusplus
}
#endif
#endif
