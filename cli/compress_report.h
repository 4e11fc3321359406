/* What `weft compress` prints: what was predicted or chosen, and what became of the dataset. */
#ifndef WEFT_CLI_COMPRESS_REPORT_H
#define WEFT_CLI_COMPRESS_REPORT_H

#include "cli/command/arguments.h"
#include "compare/tradeoff/component_count.h"
#include "compare/tradeoff/prediction.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"

/* A dataset that has been compressed, and written to `output`. */
typedef struct weft_compressed {
    const weft_common_options *common;
    const char *input, *output;
    const weft_compress_options *options; /* settled */
    const weft_dataset *dataset;
    const weft_material *material;
    const weft_compress_report *report;
    const weft_hold_out *held_out;     /* without splits where nothing was held out */
    const weft_prediction *prediction; /* of no bytes where nothing was predicted */
} weft_compressed;

/* What a preset chose, and what is predicted of it; lines or an event. Errors: WEFT_SYSTEM for memory. */
weft_code weft_report_prediction(const weft_common_options *common, const weft_prediction *prediction,
                                 weft_error *error);

/* The number of components that an error or a budget chose, and why; a line or an event. Errors: WEFT_SYSTEM for
 * memory.
 */
weft_code weft_report_components_for_error(const weft_common_options *common, double wished,
                                           const weft_component_count *chosen, weft_error *error);
weft_code weft_report_components_for_budget(const weft_common_options *common, uint64_t bytes,
                                            const weft_component_count *chosen, weft_error *error);

/* Model, errors, sizes, and what was predicted against what is; lines, and events of levels and of what was held out.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_report_compressed(const weft_compressed *done, weft_error *error);

#endif
