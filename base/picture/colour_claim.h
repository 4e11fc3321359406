/* What follows from what a picture says of its colours. */
#ifndef WEFT_BASE_PICTURE_COLOUR_CLAIM_H
#define WEFT_BASE_PICTURE_COLOUR_CLAIM_H

#include "base/picture/colour_space.h"
#include "base/picture/colour_tags.h"

typedef enum weft_claim_kind {
    WEFT_CLAIM_NONE,   /* nothing is said: the space is what is taken by custom */
    WEFT_CLAIM_CLEAR,  /* the space is what is said */
    WEFT_CLAIM_UNCLEAR /* something else is said, which is not understood: the space is that of custom */
} weft_claim_kind;

/* The space is sRGB by custom, linear where samples are floats or camera raw. */
typedef struct weft_colour_claim {
    weft_claim_kind kind;
    char words[200]; /* "its ICC profile says Display P3"; "" where there is nothing to tell, as of sRGB; of what
                      * says nothing, that it well may be linear */
    bool has_more;   /* the file holds more pictures than the one that is read */
    bool is_grey;    /* the file has one channel */
    weft_colour_space space;
} weft_colour_claim;

/* What is said counts in the order of PNG (3rd edition): code points of ITU-T H.273 (cICP), an ICC profile, an sRGB
 * chunk, chromaticities and gamma; then Exif that says another space. Floats are linear, whatever curve or gamma is
 * named. Pure. */
void weft_colour_claim_of(const weft_colour_tags *tags, weft_colour_claim *claim);

/* Reads a picture with what follows from its tags, in one go; `image`, `kind` and `exif` may be NULL, as for
 * weft_picture_read. Errors: as of that, and WEFT_BAD_INPUT for CIE L*a*b*. Thread-safe. */
weft_code weft_colour_claim_read(const char *path, weft_image *image, weft_image_kind *kind, weft_exif *exif,
                                 weft_colour_claim *claim, weft_error *error);

#endif
