/* A preset of `weft compress`: the model that it chooses for a dataset, with what is predicted of it. */
#ifndef WEFT_STUDY_TRADEOFF_PRESET_H
#define WEFT_STUDY_TRADEOFF_PRESET_H

#include "base/progress.h"
#include "study/tradeoff/choice.h"
#include "study/tradeoff/priced_model.h"

#include <jansson.h>

/* What is wanted. */
typedef struct weft_preset_wish {
    weft_preset preset;
    double least_fps;  /* of frames as study/tradeoff/frame_timer.h draws them, here; 0: any */
    bool times_frames; /* says how long one takes, where it can be drawn; with least_fps in any case */
} weft_preset_wish;

typedef struct weft_preset_prediction {
    weft_preset_wish wish;
    char model[WEFT_PRICED_NAME], arguments[WEFT_PRICED_ARGUMENTS]; /* what it chose */
    double bytes;                                                   /* of the file */
    double error;    /* relative RMSE on directions that are not fitted */
    double frame_ms; /* 0 where nothing was drawn */
} weft_preset_prediction;

/* Chooses among the models that weft compress makes (study/tradeoff/choice.h), without those of a light table, which
 * take many times as long and are seldom worth it. Fits each to at most 24 x 24 texels, or of a dataset with a surface
 * measures each on 32 x 32, without the images of a split that the measurement afterwards does not begin with
 * (study/hold_out/split.h), and fits the one that is chosen to a block of at most 32 x 32 neighbours with all images,
 * which says how large it will be and how long a frame takes. One that is too slow is chosen no longer, and the preset
 * chooses among the others. *options gets lobes, tables, frames, layers and whether through heights, and keeps
 * all else. Writes to the folder of `scratch_path`; nothing is left there. The result does not depend on the number of
 * threads; with least_fps it depends on the machine. Errors: WEFT_BAD_USAGE for a dataset of one image, where all that
 * was held out is masked, or where no model is fast enough; where frames are to be fast also WEFT_SYSTEM where there is
 * no OpenGL, and those of drawing; those of weft_compress, of reading and writing. */
weft_code weft_preset_predict(weft_dataset *dataset, const weft_preset_wish *wish, const char *scratch_path,
                              const weft_progress *progress, weft_compress_options *options,
                              weft_preset_prediction *prediction, weft_error *error);

/* As a JSON object (docs/reference/weft-format.md, "predicted"). The caller owns it; NULL where memory is short. */
json_t *weft_preset_to_json(const weft_preset_prediction *prediction);

/* The same for those who look on: with the time of a frame wherever one was drawn, asked for or not. */
json_t *weft_preset_to_event(const weft_preset_prediction *prediction);

#endif
