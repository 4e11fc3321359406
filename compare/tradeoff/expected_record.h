/* What a file will say of its error once that is measured, with numbers that are not known but as long as they will be:
 * for its size. */
#ifndef WEFT_COMPARE_TRADEOFF_EXPECTED_RECORD_H
#define WEFT_COMPARE_TRADEOFF_EXPECTED_RECORD_H

#include "compress/hold_out/hold_out.h"

/* The same kinds of images are held out, and the same errors told, as weft_hold_out_measure does of this dataset by
 * weft_hold_out_enough_splits. No digit repeats another, so that they take the room that others take, compressed too.
 * Errors: WEFT_BAD_USAGE for a dataset of one image; those of reading; WEFT_SYSTEM for memory. */
weft_code weft_expected_record(weft_dataset *dataset, const weft_compress_options *options, weft_hold_out *expected,
                               weft_error *error);

#endif
