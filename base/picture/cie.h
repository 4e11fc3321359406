/* Colours as the observer of 1931 sees them (CIE XYZ), and linear sRGB (IEC 61966-2-1, primaries of Rec. 709, D65). */
#ifndef WEFT_BASE_PICTURE_CIE_H
#define WEFT_BASE_PICTURE_CIE_H

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
