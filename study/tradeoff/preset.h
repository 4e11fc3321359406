/* A preset of `weft compress`: the model that it chooses for a dataset, with what is predicted of it. */
#ifndef WEFT_STUDY_TRADEOFF_PRESET_H
#define WEFT_STUDY_TRADEOFF_PRESET_H

#include "base/progress.h"
#include "study/tradeoff/choice.h"
#include "study/tradeoff/priced_model.h"

#include <jansson.h>

typedef struct weft_preset_prediction {
    weft_preset preset;
    char model[WEFT_PRICED_NAME], arguments[WEFT_PRICED_ARGUMENTS]; /* what it chose */
    double bytes;                                                   /* of the file */
    double error; /* relative RMSE on directions that are not fitted */
} weft_preset_prediction;

/* Chooses among the models that weft compress makes (study/tradeoff/choice.h), without those of a light table, which
 * take many times as long and are seldom worth it. Fits each to at most 24 x 24 texels, or of a dataset with a surface
 * measures each on 32 x 32, without the images of a split that the measurement afterwards does not begin with
 * (study/hold_out/split.h), and fits the one that is chosen to a block of at most 32 x 32 neighbours with all images,
 * which says how large it will be. *options gets lobes, tables, frames, layers and whether through heights, and keeps
 * all else. Writes to the folder of `scratch_path`; nothing is left there. The result does not depend on the number of
 * threads. Errors: WEFT_BAD_USAGE for a dataset of one image, or where all that was held out is masked; those of
 * weft_compress, of reading and writing. */
weft_code weft_preset_predict(weft_dataset *dataset, weft_preset preset, const char *scratch_path,
                              const weft_progress *progress, weft_compress_options *options,
                              weft_preset_prediction *prediction, weft_error *error);

/* As a JSON object (docs/reference/weft-format.md, "predicted"). The caller owns it; NULL where memory is short. */
json_t *weft_preset_to_json(const weft_preset_prediction *prediction);

#endif
