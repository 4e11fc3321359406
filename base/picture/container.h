/* The containers of pictures: whether a file holds all its bytes, and the colours that OpenImageIO does not tell. */
#ifndef WEFT_BASE_PICTURE_CONTAINER_H
#define WEFT_BASE_PICTURE_CONTAINER_H

#include "base/picture/colour_tags.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the first bytes of a file say that it is, whatever its name. */
typedef enum weft_container {
    WEFT_CONTAINER_OTHER,
    WEFT_CONTAINER_PNG,
    WEFT_CONTAINER_TIFF,
    WEFT_CONTAINER_RAW, /* of a camera: DNG, NEF, CR2, CR3, ARW, PEF, SRW, ORF, RW2, RAF */
    WEFT_CONTAINER_EXR,
    WEFT_CONTAINER_HEIF
} weft_container;

/* Reads the structure of a file, not its pixels:
 *   - PNG (3rd edition): length and checksum of each chunk that pixels need; the chunks cICP, sRGB, gAMA and cHRM;
 *   - JPEG: whether data of a sequential one were replaced by zeros; how many scans a progressive one has;
 *   - TIFF (6.0, BigTIFF) and camera raw on top of it: whether strips and tiles lie within the file;
 *   - OpenEXR: whether each attribute of its headers lies within the file;
 *   - HEIF (ISO 23008-12): whether each box does; colours and turn of the primary picture;
 *   - RAF: whether its sections do.
 * Sets those members of `tags` of which only the container knows, and a profile of HEIF; the caller frees them. Nothing
 * is said of other files. Errors: WEFT_DAMAGED for a file that was cut short or fails a checksum, WEFT_NOT_SUPPORTED
 * for deep OpenEXR, WEFT_MISSING, WEFT_SYSTEM. Thread-safe. */
weft_code weft_container_read(const char *path, weft_container *container, weft_colour_tags *tags, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
