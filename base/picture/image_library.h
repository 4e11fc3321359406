/* OpenImageIO, loaded when the first picture is read or written: it brings some 250 shared libraries with it, which
 * take ten times as long to load as the rest of the program. */
#ifndef WEFT_BASE_PICTURE_IMAGE_LIBRARY_H
#define WEFT_BASE_PICTURE_IMAGE_LIBRARY_H

#include "base/picture/colour_tags.h"
#include "base/picture/exif.h"
#include "base/picture/image.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- PNG ---- */

/* PNG by libpng alone, which every desktop has loaded: OpenImageIO brings two hundred libraries, and a picture of a
 * material would wait for them longer than for its pixels. */

/* The key of the tEXt chunk for Weft's own text. */
#define WEFT_PNG_SETTINGS "weft:settings"

/* Whether a path ends in .png, in any case. */
bool weft_png_is_named(const char *path);

/* Writes 8-bit sRGB atomically: values are clamped to 0..1 and rounded, what is no number is 0. The texts (ASCII, may
 * be NULL) go into tEXt chunks "Description" and "weft:settings". The same arguments give the same bytes. Thread-safe.
 * Errors: WEFT_SYSTEM. */
weft_code weft_png_write(const char *path, const weft_image *image, const char *description, const char *settings,
                         weft_error *error);

/* ---- The library ---- */

/* What the module weft_image_library.so does. Each entry is the public function of that name, or is called by it. */
typedef struct weft_image_library {
    weft_code (*picture_read)(const char *path, weft_image *image, weft_image_kind *kind, weft_exif *exif,
                              weft_colour_tags *tags, weft_error *error);
    weft_code (*image_write)(const char *path, const weft_image *image, const char *description, const char *settings,
                             weft_error *error);
    weft_code (*image_read_settings)(const char *path, char **settings, weft_error *error);
    weft_code (*photograph_write)(const char *path, int width, int height, int bits, const uint16_t *samples,
                                  weft_error *error);
    weft_code (*photograph_read)(const char *path, int width, int height, int bits, uint16_t *samples,
                                 weft_error *error);
    weft_code (*snapshot_write)(const char *path, const weft_image *image, const weft_camera_notes *notes,
                                weft_error *error);
} weft_image_library;

/* What the module exports under this name. */
extern const weft_image_library weft_image_library_table;

/* Loads the module at the first call, from the folders that the program was linked to search, and keeps it. Errors:
 * WEFT_SYSTEM where it is missing or damaged. Thread-safe. */
weft_code weft_image_library_open(const weft_image_library **library, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
