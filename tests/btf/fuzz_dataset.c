#include "btf/dataset/dataset.h"
#include "tests/support/fuzz.h"
#include "tests/support/tiny_dataset.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 4, HEIGHT = 3, VIEWS = 3, LIGHTS = 2 };

/* With all that is optional. */
static weft_code write_seed(const char *path, const weft_dataset_layout *layout)
{
    weft_half samples[WIDTH * HEIGHT * 3];
    uint8_t mask[WIDTH * HEIGHT];
    float opacity[WIDTH * HEIGHT * VIEWS] = {0}, frames[WIDTH * HEIGHT][6];
    weft_dataset_writer *writer;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        memcpy(frames[i], (float[6]){0.6f, 0, 0.8f, 0, 1, 0}, sizeof frames[i]);
    WEFT_TRY(weft_dataset_writer_create(path, layout, &writer, NULL));
    for (int image = 0; image < layout->image_count; image++) {
        tiny_image(layout, tiny_distinct, image, samples, mask);
        WEFT_TRY(weft_dataset_writer_put_image(writer, image, samples, mask, NULL));
    }
    WEFT_TRY(weft_dataset_writer_put_opacity(writer, opacity, NULL));
    WEFT_TRY(weft_dataset_writer_put_frames(writer, &frames[0][0], NULL));
    return weft_dataset_writer_finish(writer, NULL, NULL);
}

void fuzz_write_seed(const char *path)
{
    weft_dataset_layout layout = tiny_layout(WIDTH, HEIGHT, VIEWS, LIGHTS);
    if (write_seed(path, &layout) != WEFT_OK)
        abort();
    weft_dataset_layout_free(&layout);
}

static void read_all(weft_dataset *dataset)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t samples = (size_t)layout->width * (size_t)layout->image_count;
    weft_half *half = malloc(samples * 3 * sizeof *half);
    uint8_t *mask = malloc(samples);
    float *opacity = malloc((size_t)layout->width * (size_t)layout->view_count * sizeof *opacity);
    float *frames = malloc(6 * (size_t)layout->width * sizeof *frames);
    for (int y = 0; half && mask && opacity && frames && y < layout->height; y++) {
        weft_dataset_read_block(dataset, 0, y, layout->width, 1, half, mask, NULL);
        weft_dataset_read_opacity(dataset, y, 1, opacity, NULL);
        weft_dataset_read_frames(dataset, y, 1, frames, NULL);
    }
    free(half);
    free(mask);
    free(opacity);
    free(frames);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_dataset *dataset;
    weft_error error = {0};
    weft_code code = weft_dataset_open(fuzz_file(bytes, size), &dataset, &error);
    if (code != WEFT_OK && (error.code != code || !error.message[0]))
        abort();
    if (code == WEFT_OK)
        read_all(dataset);
    weft_dataset_close(dataset);
    return 0;
}
