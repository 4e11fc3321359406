/* What `weft compress` predicts before its work: of the model that a preset chooses for a dataset. */
#ifndef WEFT_COMPARE_TRADEOFF_PRESET_H
#define WEFT_COMPARE_TRADEOFF_PRESET_H

#include "base/progress.h"
#include "compare/tradeoff/prediction.h"

/* What is wanted. */
typedef struct weft_preset_wish {
    weft_preset preset;
    double least_fps;    /* of frames as compare/tradeoff/frame_timer.h draws them, here; 0: any */
    bool times_frames;   /* says how long one takes, where it can be drawn; with least_fps in any case */
    int measured_splits; /* that are asked for afterwards; < 1: weft_hold_out_enough_splits */
} weft_preset_wish;

/* Chooses among the models that weft compress makes (compare/tradeoff/choice.h). Fits each to at most 24 x 24 texels,
 * or of a dataset with a surface measures each on 32 x 32, without the images of weft_hold_out_enough_splits splits,
 * none of which the measurement afterwards takes, and finds for the one that is chosen how large its file will be and
 * how long a frame takes (weft_prediction_find_costs). One that is too slow is chosen no longer, and the preset chooses
 * among the others. *options gets lobes, components and whether through heights, and keeps all else.
 * Writes to the folder of
 * `scratch_path`; nothing is left there. The result does not depend on the number of
 * threads; with least_fps it depends on the machine. Errors: WEFT_BAD_USAGE for a dataset of one image, where all that
 * was held out is masked, or where no model is fast enough; where frames are to be fast also WEFT_SYSTEM where there is
 * no OpenGL, and those of drawing; those of weft_compress, of reading and writing. */
weft_code weft_preset_predict(weft_dataset *dataset, const weft_preset_wish *wish, const char *scratch_path,
                              const weft_progress *progress, weft_compress_options *options,
                              weft_prediction *prediction, weft_error *error);

#endif
