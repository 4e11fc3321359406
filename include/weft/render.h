/* Rendering: a picture of a material on a mesh, drawn by OpenGL without a display. */
#ifndef WEFT_RENDER_H
#define WEFT_RENDER_H

#include "weft/progress.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Draws a picture as `weft render` does and writes it, atomically, with its settings: .png as sRGB, .exr and .tif
 * linear. Each pixel is the radiance toward the camera, BRDF x pi x sum over the lights of irradiance / pi x
 * cos(theta_light) x exposure (docs/reference/scene.md).
 *
 * `options` are those of `weft render`, without dashes: "NAME=VALUE", or "NAME" where there is no value, and NULL at
 * the end; "material=FILE" names the material:
 *
 *     const char *const options[] = {"material=silk.weft", "mesh=sphere", "environment=studio", "size=640x640", NULL};
 *
 * `progress` and `log` may be NULL; `log` hears what the user should know of the files. One thread at a time may draw;
 * the current OpenGL context of that thread is another afterwards. Errors: WEFT_BAD_USAGE for an option that cannot be
 * understood; WEFT_BAD_INPUT (WEFT_MISSING, WEFT_DAMAGED, WEFT_NOT_SUPPORTED) for a file that cannot be used;
 * WEFT_SYSTEM where there is no OpenGL 3.3 or the picture cannot be written; WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_render(const char *const *options, const char *output, const weft_progress *progress,
                               const weft_log *log, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
