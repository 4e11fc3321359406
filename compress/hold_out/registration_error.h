/* What it costs that photographs do not lie on each other exactly. */
#ifndef WEFT_COMPRESS_HOLD_OUT_REGISTRATION_ERROR_H
#define WEFT_COMPRESS_HOLD_OUT_REGISTRATION_ERROR_H

#include "btf/dataset/dataset.h"
#include "btf/material/certificate.h"

/* The part of registration in a certificate that has all else: a photograph that is displaced by d texels along each
 * axis, as a standard error, is off by d |gradient| where the texture has that gradient. d is the standard error of
 * the photograph's stay, as `weft register` wrote it to the provenance of the dataset; the gradient is that of at most
 * 16 x 16 texels from the middle, and of means over squares of them for coarser levels, where d counts in their texels.
 * The share is 1.96 times the root mean square over the views of a ring, in half widths. A dataset that does not say
 * how well it was registered leaves has_registration false. Errors: those of reading; WEFT_SYSTEM for memory. */
weft_code weft_certify_registration(weft_dataset *dataset, weft_certificate *certificate, weft_error *error);

#endif
