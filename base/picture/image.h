/* Images: the one door to OpenImageIO, and to libpng for the PNG that Weft writes. Row 0 is the top row; samples are
 * interleaved RGB. */
#ifndef WEFT_BASE_PICTURE_IMAGE_H
#define WEFT_BASE_PICTURE_IMAGE_H

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* [height][width][3] floats. Integer files are scaled to 0..1; no colour conversion is done by the
 * reader and the writer (see base/picture/colour.h). Owned by the caller, freed with weft_image_free. */
typedef struct weft_image {
    int width, height;
    float *pixels;
    bool is_partial; /* the file does not hold all that it shows: pixels that it lacks are NaN */
} weft_image;

typedef enum weft_image_kind {
    WEFT_IMAGE_INTEGER, /* 8 or 16 bit per sample: by custom sRGB */
    WEFT_IMAGE_FLOAT    /* half or float: by custom linear; and camera raw, which is */
} weft_image_kind;

/* Allocates a black image. Errors: WEFT_SYSTEM. */
weft_code weft_image_create(int width, int height, weft_image *image, weft_error *error);
void weft_image_free(weft_image *image);

/* Reads any format OpenImageIO knows; one channel is repeated. Alpha is dropped and darkens nothing. Camera raw comes
 * as the sensor counted, from black to white level: linear, without white balance, its colour filters interpolated.
 * Of EXR the display window and the channels R, G, B of no layer, or of the only layer. `kind` may be NULL. Errors:
 * WEFT_BAD_INPUT for a missing, truncated, damaged or unreadable file, camera raw without the values of its sensor, a
 * picture over 2^28 pixels or of more than its bytes can hold, or an EXR without such channels. Thread-safe. */
weft_code weft_image_read(const char *path, weft_image *image, weft_image_kind *kind, weft_error *error);

/* Turns a picture as Exif says that it is shown: 1 leaves it, 2 to 8 mirror and turn it, and 5 to 8 exchange width and
 * height. Any other number leaves it. For pictures whose directions were noted by people who looked at them. Where a
 * lens is looked for, the pixels must stay as the sensor read them. Errors: WEFT_SYSTEM for memory; then the picture is
 * as it was. */
weft_code weft_image_turn(weft_image *image, int orientation, weft_error *error);

/* Writes atomically; the format follows the extension: .png 8 bit (values clamped to 0..1),
 * .exr half floats, .tif float. `description` (may be NULL) goes into the file's metadata.
 * Errors: WEFT_SYSTEM. */
weft_code weft_image_write(const char *path, const weft_image *image, const char *description, weft_error *error);

/* The same with a text of Weft's own (ASCII) in the attribute "weft:settings": a tEXt chunk of PNG, an attribute of
 * EXR; TIFF has no place for it. NULL: none. */
weft_code weft_image_write_settings(const char *path, const weft_image *image, const char *description,
                                    const char *settings, weft_error *error);

/* The text that weft_image_write_settings wrote, owned by the caller; NULL where the image has none. The pixels are not
 * read. Errors: WEFT_BAD_INPUT for a file that is no image. */
weft_code weft_image_read_settings(const char *path, char **settings, weft_error *error);

/* Raw camera values: [height][width][3] 16-bit samples, of which the low `bits` are used; TIFF without
 * compression, packed to `bits` (10, 12, 14 or 16) on disk. Writes to `path` directly: the caller names it atomically.
 */
weft_code weft_photograph_write(const char *path, int width, int height, int bits, const uint16_t *samples,
                                weft_error *error);

/* Reads a photograph of exactly width x height x 3 into `samples`, as raw camera values of `bits`
 * bits. Errors: WEFT_BAD_INPUT naming the file for missing, truncated, or another size. Thread-safe. */
weft_code weft_photograph_read(const char *path, int width, int height, int bits, uint16_t *samples, weft_error *error);

/* What a camera writes beside the pixels (Exif 2.3). */
typedef struct weft_camera_notes {
    const char *make, *model;
    const char *date; /* "YYYY:MM:DD HH:MM:SS" */
    int orientation;  /* 1 .. 8: how to turn the picture to see it upright; the pixels stay as the sensor read them */
    double exposure_s, f_number, iso, focal_length_mm, focal_length_35mm;
} weft_camera_notes;

/* Writes a photograph as cameras do, atomically; the format follows the extension: .jpg 8 bits of quality 93, .tif 16
 * bits, .exr half floats. Integers are clamped to 0..1 and rounded. The same arguments give the same bytes. Errors:
 * WEFT_SYSTEM. */
weft_code weft_snapshot_write(const char *path, const weft_image *image, const weft_camera_notes *notes,
                              weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
