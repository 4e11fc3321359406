/* The certificate of a material, made of the residuals of photographs that were held out of fits like it. */
#ifndef WEFT_COMPRESS_HOLD_OUT_CERTIFY_H
#define WEFT_COMPRESS_HOLD_OUT_CERTIFY_H

#include "btf/material/certificate.h"
#include "compress/hold_out/residuals.h"

/* The certificate for `probability`, from residuals of images that were held out, and those of images that were fitted,
 * of the same fits. The levels may be of different texels; the scale is that of level 0. It is a normalised split
 * conformal interval (Lei et al. 2018, 5.2), of images as groups (Lee, Barber and Willett 2023). The scale is the
 * quantile of the residuals by predicted value, times a factor for each ring of the view and one for each ring of the
 * light, found in turns. Squares of at most `neighbours` texels along a side, a power of two, are of texels that lie
 * beside each other: level k of a material takes its quantile from squares of 2^k of those. A larger square of the
 * excerpt is of texels that lie `spacing` apart, in texels: coarser levels take theirs from the largest one that lies
 * within their texels, which has no more texels than they, so that it is rather too large. Sets everything but
 * direction_count and registration. *found is false where nothing was held out or all of it is black. Errors:
 * WEFT_SYSTEM for memory.
 */
weft_code weft_certify(const weft_residuals *held, const weft_residuals *fitted, double probability, double spacing,
                       int neighbours, weft_certificate *certificate, bool *found, weft_error *error);

#endif
