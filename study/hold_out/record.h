/* What a material says of its error on directions that it was not fitted to. */
#ifndef WEFT_STUDY_HOLD_OUT_RECORD_H
#define WEFT_STUDY_HOLD_OUT_RECORD_H

#include "btf/material/material.h"
#include "study/hold_out/hold_out.h"

#include <jansson.h>

enum { WEFT_HOLD_OUT_LINE = 512 };

/* As a JSON object (docs/reference/weft-format.md, "held_out"). The caller owns it; NULL where memory is short. */
json_t *weft_hold_out_to_json(const weft_hold_out *result);

/* Puts it into the metadata of a material, where weft_hold_out_read finds it. Errors: WEFT_SYSTEM for memory. */
weft_code weft_hold_out_store(const weft_hold_out *result, weft_material *material, weft_error *error);

/* Bytes that weft_hold_out_store adds to the file of a material, at most. Errors: WEFT_SYSTEM for memory. */
weft_code weft_hold_out_bytes(const weft_hold_out *result, uint64_t *bytes, weft_error *error);

/* Reads it from the metadata of a material, with the certificate; *found is false where there is none, or none that
 * this version understands. Errors: WEFT_BAD_INPUT for a damaged certificate, WEFT_SYSTEM for memory. */
weft_code weft_hold_out_read(const char *metadata, bool *found, weft_hold_out *result, weft_error *error);

/* "on directions that were not fitted": what the headline is about. Pure. */
const char *weft_hold_out_about(const weft_hold_out *result);

/* The headline, such as "on directions that were not fitted: relative RMSE 0.412 (the photographs themselves,
 * interpolated: 0.336); on those that were: 0.391". Pure. */
void weft_hold_out_headline(const weft_hold_out *result, char line[WEFT_HOLD_OUT_LINE]);

/* What the intervals of a certificate hold for: "95 % of the pixels of images not seen, ...". Pure. */
void weft_certificate_describe(const weft_certificate *certificate, char line[WEFT_HOLD_OUT_LINE]);

/* Half the width at the mean value for views of a ring, under light at 30 degrees, and its parts: "+-0.0213 (34 %):
 * sampling 14 %, ...". Pure. */
void weft_certificate_row(const weft_certificate *certificate, int view_ring, char line[WEFT_HOLD_OUT_LINE]);

/* On which levels it was measured, and why coarser ones are rather too wide; "" where that is not known. Pure. */
void weft_certificate_describe_levels(const weft_certificate *certificate, char line[WEFT_HOLD_OUT_LINE]);

/* How it was measured: what was held out, and on which texels. Pure. */
void weft_hold_out_explain(const weft_hold_out *result, char line[WEFT_HOLD_OUT_LINE]);

#endif
