/* Places that lie evenly over a material without a period, so that no repeat of the cloth is hit again and again. */
#ifndef WEFT_COMPRESS_HOLD_OUT_SCATTERED_H
#define WEFT_COMPRESS_HOLD_OUT_SCATTERED_H

/* Number 1, 2 .. of an additive sequence that fills a square evenly: along `axis` 0 or 1, from 0 to below 1. Pure. */
double weft_scattered_number(int axis, double number);

/* The texel that stands for cell (i, j) of a grid of columns x rows over width x height texels. Pure. */
void weft_scattered_texel(int columns, int rows, int width, int height, int i, int j, int *x, int *y);

#endif
