/* What is said of a material before it is made, and kept in its file: how large it will be, how well it will predict,
 * and how long a frame will take. */
#ifndef WEFT_COMPARE_TRADEOFF_PREDICTION_H
#define WEFT_COMPARE_TRADEOFF_PREDICTION_H

#include "compare/tradeoff/choice.h"
#include "compare/tradeoff/frame_timer.h"
#include "compare/tradeoff/priced_model.h"

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

#endif
