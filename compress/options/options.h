/* Of the options of a compression (weft/compress.h) what only the library needs. */
#ifndef WEFT_COMPRESS_OPTIONS_OPTIONS_H
#define WEFT_COMPRESS_OPTIONS_OPTIONS_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "weft/compress.h"

/* A ceiling is so many times the brightest sample (compress/texel/texel.h, compress/components/levels.c). */
enum { WEFT_BRIGHTEST_MULTIPLE = 4 };

/* Images that are not held out. Pure. */
int weft_compress_options_count_images(const weft_compress_options *options, const weft_dataset_layout *layout);

/* Errors: WEFT_BAD_USAGE for options out of range, or where every image is held out. */
weft_code weft_compress_options_check(const weft_compress_options *options, const weft_dataset *dataset,
                                      weft_error *error);

#endif
