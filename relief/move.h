/* A dataset whose texels are moved onto another plane. */
#ifndef WEFT_RELIEF_MOVE_H
#define WEFT_RELIEF_MOVE_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"

#include <jansson.h>

typedef struct weft_move {
    double plane_mm; /* where the texels lie from now on, above where they lie */
    bool repeats;    /* the material continues at its opposite border; else nothing is known beyond */
    const weft_dataset_heights *heights; /* of the dataset that is written, above its new plane; NULL: none */
} weft_move;

/* Writes the dataset as if it had been photographed on a plane at height h = plane_mm: the sample of place p in a view
 * of direction v is that of the given dataset where the sight line through p meets its plane,
 *
 *     q = p - h (v.x, v.y) / v.z,
 *
 * bilinear between texels, as steep as playback follows (WEFT_RELIEF_LEAST_COSINE). Masked where one of these is, and
 * beyond the border. Opacity moves alike; frames, which no view changes, stay. What lies at height h then stands still
 * as the view turns, which every model of single texels wants. `made` (taken) goes into the provenance under "relief".
 * Errors: WEFT_BAD_INPUT for near lights and views; WEFT_BAD_USAGE where the output is the dataset itself; those of
 * reading and writing; WEFT_SYSTEM. */
weft_code weft_relief_move(weft_dataset *dataset, const weft_move *move, const char *output, json_t *made,
                           const weft_progress *progress, weft_error *error);

#endif
