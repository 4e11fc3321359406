/* ICC profiles as cameras and converters write them, made here after ICC.1:2010. */
#ifndef WEFT_TESTS_SUPPORT_ICC_PROFILE_H
#define WEFT_TESTS_SUPPORT_ICC_PROFILE_H

#include <stddef.h>
#include <stdint.h>

enum { ICC_BYTES = 4096 };

typedef struct icc_profile {
    uint8_t bytes[ICC_BYTES];
    size_t size;
} icc_profile;

/* One tone curve for all channels: a formula where `kind` is 0 to 4, else a table of `count` values of 16 bits. */
typedef struct icc_curve {
    int kind; /* of the type "para"; -1: the type "curv" */
    double number[7];
    int count;
    uint16_t table[512];
} icc_curve;

/* XYZ of red, green and blue under D50, as published with Adobe RGB (1998), Apple's Display P3 and HP's sRGB. */
extern const double icc_adobe_rgb[3][3], icc_display_p3[3][3], icc_srgb[3][3];

/* The formula of sRGB (kind 3), and a table of one: a gamma. */
extern const icc_curve icc_srgb_curve;
icc_curve icc_gamma(double gamma);

/* Version 2, or 4 with its names in UTF-16. `colour` is "RGB " or another; its colorants may be NULL. */
icc_profile icc_profile_make(int version, const char *name, const char *colour, const double colorant[3][3],
                             const icc_curve *curve);

#endif
