/* What the numbers of a picture mean: a tone curve, and what its red, green and blue are in linear sRGB. */
#ifndef WEFT_BASE_PICTURE_COLOUR_SPACE_H
#define WEFT_BASE_PICTURE_COLOUR_SPACE_H

#include "base/picture/colour.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WEFT_CURVE_STEPS = 4096 };

typedef enum weft_curve_kind { WEFT_CURVE_LINEAR, WEFT_CURVE_SRGB, WEFT_CURVE_POWER, WEFT_CURVE_TABLE } weft_curve_kind;

/* From an encoded value in 0..1 to linear light. */
typedef struct weft_curve {
    weft_curve_kind kind;
    double gamma; /* of a power: x^gamma */
    int count;    /* of a table: its entries, 2 or more, evenly from 0 to 1 */
    float table[WEFT_CURVE_STEPS];
} weft_curve;

typedef struct weft_colour_space {
    char name[128];      /* printable ASCII */
    weft_curve curve[3]; /* of each channel */
    double matrix[3][3]; /* from linear values to linear sRGB; rows sum to 1, except that of CIE XYZ */
} weft_colour_space;

typedef enum weft_known_colours {
    WEFT_COLOURS_SRGB,
    WEFT_COLOURS_GAMMA_22,   /* primaries of sRGB, the power 2.2 */
    WEFT_COLOURS_ADOBE_RGB,  /* Adobe RGB (1998): the power 2.19921875 */
    WEFT_COLOURS_DISPLAY_P3, /* primaries of DCI-P3, curve and white of sRGB */
    WEFT_COLOURS_XYZ         /* CIE XYZ under D65, linear: white is 0.95, 1, 1.09 */
} weft_known_colours;

void weft_colour_space_make(weft_known_colours which, weft_colour_space *space);

/* Linear values of which x, y of red, green, blue and white are known (the order of the OpenEXR attribute). White
 * becomes white. Primaries (1,0), (0,1), (0,0) are CIE XYZ, taken to be under D65. False where they span no colours. */
bool weft_colour_space_of_primaries(const double xy[8], weft_colour_space *space);

/* XYZ of full red, green and blue, one a row. */
typedef struct weft_colorants {
    double xyz[3][3];
} weft_colorants;

/* Linear values of which the colorants are known, whatever white they make together. False where
 * they span no colours. */
bool weft_colour_space_of_colorants(const weft_colorants *colorants, weft_colour_space *space);

/* Takes the curve away. */
void weft_colour_space_make_linear(weft_colour_space *space);

/* Takes the primaries away: grey is grey in all of them. */
void weft_colour_space_make_grey(weft_colour_space *space);

/* Names a curve and primaries that are those of sRGB within rounding what they are: then the values are exact. */
void weft_colour_space_round(weft_colour_space *space);

/* Whether the primaries are those of sRGB; and the curve, too. */
bool weft_colour_space_has_srgb_primaries(const weft_colour_space *space);
bool weft_colour_space_is_srgb(const weft_colour_space *space);

/* Linear light of an encoded value by a formula or a table. Below 0 the curve is odd; a table ends at 1. Pure. */
float weft_curve_compute(const weft_curve *curve, float encoded);

/* The same by any curve. Pure. */
static inline float weft_curve_decode(const weft_curve *curve, float encoded)
{
    if (curve->kind == WEFT_CURVE_LINEAR)
        return encoded;
    return curve->kind == WEFT_CURVE_SRGB ? weft_linear_of_srgb(encoded) : weft_curve_compute(curve, encoded);
}

/* Turns linear values [count][3] into linear sRGB in place. Colours outside sRGB are below 0 or above 1. Pure. */
void weft_colour_space_to_srgb(const weft_colour_space *space, float *rgb, size_t count);

/* ---- Icc profile ---- */

/* ICC profiles of curves and colorants (ICC.1:2010, the model of three components): what cameras, phones and converters
 * of raw files write. The one door to Little CMS. */

/* The space that a profile describes, with its name. Within rounding of sRGB it is sRGB. A profile of grey has one
 * curve for all. False for a profile of tables, of other colours than RGB and grey, or a damaged one; then only the
 * name is set, "" where there is none. Reads nothing outside of bytes [size]. Thread-safe. */
bool weft_icc_profile_read(const uint8_t *bytes, size_t size, weft_colour_space *space);

/* ---- Cie ---- */

/* Colours as the observer of 1931 sees them (CIE XYZ), and linear sRGB (IEC 61966-2-1, primaries of Rec. 709, D65). */

#ifdef __cplusplus
extern "C" {
#endif

/* XYZ of white: of D50, the connection space of ICC profiles, and of D65, that of sRGB. */
extern const double weft_d50[3], weft_d65[3];

/* Linear sRGB of a colour that is seen beside a white: adapted from that white to D65 by Bradford's transform, so that
 * the white becomes 1, 1, 1. Colours outside sRGB are below 0 or above 1. Pure. */
void weft_linear_srgb_of_xyz(const double xyz[3], const double white[3], double rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
