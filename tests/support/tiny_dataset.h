/* A small dataset whose samples follow a formula, so that a test can say what it should read back. */
#ifndef WEFT_TESTS_TINY_DATASET_H
#define WEFT_TESTS_TINY_DATASET_H

#include "btf/dataset/dataset.h"

/* Far layout of ubo81 directions 0 .. views - 1 and 0 .. lights - 1, all pairs, lights fastest. Freed with
 * weft_dataset_layout_free. A failure ends the test. */
weft_dataset_layout tiny_layout(int width, int height, int views, int lights);

/* Fills in one sample and returns its mask. */
typedef uint8_t tiny_sample(const weft_dataset_layout *layout, int image, int x, int y, float rgb[3]);

/* A smooth positive function of place, light and view; nothing masked. */
tiny_sample tiny_smooth;

/* Values that differ in every sample and channel; every 7th sample is masked as saturated. */
tiny_sample tiny_distinct;

/* One image: samples [height][width][3], mask [height][width]. */
void tiny_image(const weft_dataset_layout *layout, tiny_sample *sample, int image, weft_half *samples, uint8_t *mask);

/* Writes a whole dataset. Errors: those of the writer. */
weft_code tiny_dataset_write(const char *path, const weft_dataset_layout *layout, tiny_sample *sample,
                             weft_error *error);

#endif
