/* Fits as they are stored: half-float lobes, T in 8 bits square-root coded, frames in 16 bits. */
#ifndef WEFT_COMPRESS_TEXEL_PACK_H
#define WEFT_COMPRESS_TEXEL_PACK_H

#include "compress/fit/fit.h"

#include <math.h>

/* One channel of one texel. */
typedef struct weft_packed {
    weft_half diffuse;
    weft_half lobe[WEFT_MATERIAL_MAX_LOBES][4]; /* Cx, Cy, Cz, N */
} weft_packed;

/* The nearest storable frame, so that lobes can be fitted in the frame that will be read. Pure. */
weft_frame weft_pack_frame(const weft_frame *frame, int16_t code[3]);

/* Rounds a fit whose frame came from weft_pack_frame. To be called right after the fit of this channel on all lights:
 * it goes on with the sums of the last pass in the workspace. The largest T goes into rho and C; high exponents are
 * rounded first, and T and then rho and the lower lobes are solved for again against what the reader will decode: a C
 * rounded to a half float errs by N 2^-12 in C^N. `code` [view_count] receives T (unused when options->table is off).
 */
void weft_pack_channel(const weft_bundle *bundle, const weft_samples *samples, int channel,
                       const weft_fit_options *options, weft_fit_workspace *workspace, const weft_fit *fit,
                       const double *table, weft_packed *packed, uint8_t *code);

/* Rounds a fit as it is, `scale` times larger. Pure. */
void weft_pack_rounded(const weft_fit *fit, double scale, weft_packed *packed);

/* The reader's view of it: lobes in scaled units (divided by samples->scale), c with its largest component +-1. Pure.
 */
weft_fit weft_unpack(const weft_packed *packed, int lobe_count, const weft_frame *frame, double scale);

/* The nearest code of T or S. */
static inline uint8_t weft_code_of_table(double t)
{
    double code = 255 * sqrt(fmax(t, 0)) + 0.5;
    return code < 255 ? (uint8_t)code : 255;
}

/* (code / 255)^2. */
static inline double weft_table_of_code(uint8_t code)
{
    return code / 255.0 * (code / 255.0);
}

#endif
