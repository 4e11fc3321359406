/* How far apart two colours look. */
#ifndef WEFT_REGISTRATION_COLOUR_DIFFERENCE_H
#define WEFT_REGISTRATION_COLOUR_DIFFERENCE_H

/* CIE 1976 L*, a*, b* for the white D65 of linear sRGB (IEC 61966-2-1). Pure. */
void weft_lab_of_linear_srgb(const double rgb[3], double lab[3]);

/* Linear sRGB of CIE 1976 L*, a*, b* for the white D50 of ICC profiles, adapted to D65 by Bradford's transform (ICC.1,
 * annex E). Pure. */
void weft_linear_srgb_of_lab_d50(const double lab[3], double rgb[3]);

/* CIEDE2000 of two colours in L*, a*, b* with all weights 1 (CIE 142-2001, as Sharma, Wu and Dalal 2005 write it).
 * Symmetric; 0 for equal colours. Pure. */
double weft_ciede2000(const double lab[3], const double other[3]);

/* CIEDE2000 near a colour is a length: |metric d| for a small difference d of linear sRGB. Pure. */
void weft_ciede2000_metric(const double rgb[3], double metric[3][3]);

#endif
