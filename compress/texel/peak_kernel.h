/* The loops of compress/texel/peak.h, compiled once for every instruction set. */
#ifndef WEFT_COMPRESS_TEXEL_PEAK_KERNEL_H
#define WEFT_COMPRESS_TEXEL_PEAK_KERNEL_H

#include "compress/fit/gram.h"
#include "compress/texel/peak.h"

/* spread: aim_r and aim_f of a lobe of this exponent. add_lobe: adds the largest values of lobe `lobe` of `point` to
 * the sums of every triangle; `lights`, spread for it, may be NULL. largest: that of T times the sums, over all
 * triangles.
 */
#define WEFT_DECLARE_PEAK_KERNELS_OF(set)                                                                              \
    void weft_peak_add_lobe_##set(const weft_peak_net *net, const weft_gram_point *point, int lobe,                    \
                                  const weft_peak_lights *lights);                                                     \
    void weft_peak_spread_##set(const weft_peak_lights *lights, float exponent);                                       \
    weft_peak weft_peak_largest_##set(const weft_peak_net *net)
#define WEFT_DECLARE_PEAK_KERNELS(set) WEFT_DECLARE_PEAK_KERNELS_OF(set)

#endif
