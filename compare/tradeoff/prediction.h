/* What is said of a material before it is made, and kept in its file: how large it will be, how well it will predict,
 * and how long a frame will take. */
#ifndef WEFT_COMPARE_TRADEOFF_PREDICTION_H
#define WEFT_COMPARE_TRADEOFF_PREDICTION_H

#include "base/progress.h"
#include "compare/tradeoff/frame_timer.h"
#include "compare/tradeoff/priced_model.h"
#include "compress/hold_out/hold_out.h"

#include <jansson.h>

typedef struct weft_prediction {
    weft_preset preset; /* that chose the model; WEFT_PRESET_NONE where a budget did */
    double least_fps;   /* of frames that were asked for; 0: any */
    char model[WEFT_PRICED_NAME], arguments[WEFT_PRICED_ARGUMENTS];
    double bytes;    /* of the file; 0: nothing is predicted */
    double error;    /* relative RMSE on directions that are not fitted */
    double frame_ms; /* 0 where nothing was drawn */
} weft_prediction;

/* Finds bytes and, where `timer` is not NULL, frame_ms; the other members are set. Fits the model to some texels with
 * all images: at most 64 x 64 in squares of 16 x 16 that lie spread over the dataset, fewer of more than 8192
 * images; of near images a block of neighbours, half a million samples at most or 32 x 32 texels. Weighs these with the
 * metadata that the file will have, as far as their length can be known. Heights
 * are those of the whole dataset, and are weighed as they are. Where nothing can be drawn frame_ms is 0 unless
 * least_fps is asked for. Writes to the folder of `scratch_path`; nothing is left there. Errors: those of
 * weft_compress, of reading, writing and drawing; WEFT_BAD_USAGE for a dataset of one image; WEFT_SYSTEM. */
weft_code weft_prediction_find_costs(weft_dataset *dataset, const weft_compress_options *options,
                                     const char *scratch_path, weft_frame_timer *timer, weft_prediction *prediction,
                                     weft_error *error);

/* As a JSON object (docs/reference/weft-format.md, "predicted"). The caller owns it; NULL where memory is short. */
json_t *weft_prediction_to_json(const weft_prediction *prediction);

/* The same for those who look on: with the time of a frame wherever one was drawn, asked for or not. */
json_t *weft_prediction_to_event(const weft_prediction *prediction);

/* ---- Presets ---- */

/* What `weft compress` predicts before its work: of the model that a preset chooses for a dataset. */

/* What is wanted. */
typedef struct weft_preset_wish {
    weft_preset preset;
    double least_fps;    /* of frames as compare/tradeoff/frame_timer.h draws them, here; 0: any */
    bool times_frames;   /* says how long one takes, where it can be drawn; with least_fps in any case */
    int measured_splits; /* that are asked for afterwards; < 1: weft_hold_out_enough_splits */
} weft_preset_wish;

/* Chooses among the models that weft compress makes (compare/tradeoff/priced_model.h). Fits each to at most 24 x 24
 * texels, or of a dataset with a surface measures each on 32 x 32, without the images of weft_hold_out_enough_splits
 * splits, none of which the measurement afterwards takes, and finds for the one that is chosen how large its file will
 * be and how long a frame takes (weft_prediction_find_costs). One that is too slow is chosen no longer, and the preset
 * chooses among the others. *options gets lobes, components and whether through heights, and keeps all else. Writes to
 * the folder of `scratch_path`; nothing is left there. The result does not depend on the number of threads; with
 * least_fps it depends on the machine. Errors: WEFT_BAD_USAGE for a dataset of one image, where all that was held out
 * is masked, or where no model is fast enough; where frames are to be fast also WEFT_SYSTEM where there is no OpenGL,
 * and those of drawing; those of weft_compress, of reading and writing. */
weft_code weft_preset_predict(weft_dataset *dataset, const weft_preset_wish *wish, const char *scratch_path,
                              const weft_progress *progress, weft_compress_options *options,
                              weft_prediction *prediction, weft_error *error);

/* ---- Expected record ---- */

/* What a file will say of its error once that is measured, with numbers that are not known but as long as they will be:
 * for its size. */

/* The same kinds of images are held out, and the same errors told, as weft_hold_out_measure does of this dataset by
 * weft_hold_out_enough_splits. No digit repeats another, so that they take the room that others take, compressed too.
 * Errors: WEFT_BAD_USAGE for a dataset of one image; those of reading; WEFT_SYSTEM for memory. */
weft_code weft_expected_record(weft_dataset *dataset, const weft_compress_options *options, weft_hold_out *expected,
                               weft_error *error);

#endif
