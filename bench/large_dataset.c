/* Writes a large dataset of invented cloth for timing the whole job: `weft compress` from the page cache, with limits
 * on memory and with kills (docs/reference/compression.md, "Large datasets"). */
#include "btf/dataset/write_blocks.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

/* Inventing a texel takes longer than fitting it. A few are invented, and every texel of the cloth is a blend of two of
 * them in a colour of its own. */
enum { POOL = 48, YARN_TEXELS = 8 };

typedef struct cloth {
    weft_dataset_layout layout;
    float *pool; /* [POOL][image_count][3] */
} cloth;

static weft_code invent_pool(cloth *to, weft_error *error)
{
    size_t texel = 3 * (size_t)to->layout.image_count;
    to->pool = malloc(POOL * texel * sizeof *to->pool);
    if (!to->pool)
        return weft_fail_memory(error, "invented texels", POOL * texel * sizeof *to->pool);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < POOL; i++)
        synthetic_texel(&to->layout, (synthetic_kind)(i % SYNTHETIC_KINDS), (uint64_t)(64 * i), 0.01,
                        to->pool + (size_t)i * texel);
    return WEFT_OK;
}

/* Warp and weft alternate as in plain weave; place in the yarn and in the cloth decide blend and colour. */
static void fill_texel(const cloth *of, int x, int y, weft_half *samples)
{
    int column = x / YARN_TEXELS, row = y / YARN_TEXELS, warp = (column + row) % 2;
    size_t count = 3 * (size_t)of->layout.image_count;
    const float *one = of->pool + (size_t)((warp ? column : 7 * row) % POOL) * count;
    const float *two = of->pool + (size_t)((warp ? 5 * column + 1 : row + 2) % POOL) * count;
    double across = ((warp ? x : y) % YARN_TEXELS + 0.5) / YARN_TEXELS;
    float blend = (float)(across * across), gain[3];
    for (int k = 0; k < 3; k++)
        gain[k] = (float)(0.6 + 0.2 * sin(0.05 * x + 1.3 * k) + 0.2 * cos(0.07 * y + 0.7 * k * warp));
    for (size_t i = 0; i < count; i++)
        samples[i] = weft_half_of_float(gain[i % 3] * (one[i] + blend * (two[i] - one[i])));
}

static weft_code put_block(const cloth *of, weft_dataset_block_writer *writer, int x, int y, int width, int height,
                           weft_half *samples, const uint8_t *mask, weft_error *error)
{
    int w = width < of->layout.width - x ? width : of->layout.width - x;
    int h = height < of->layout.height - y ? height : of->layout.height - y;
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < w * h; i++)
        fill_texel(of, x + i % w, y + i / w, samples + (size_t)i * 3 * (size_t)of->layout.image_count);
    return weft_dataset_block_writer_put(writer, x, y, w, h, samples, mask, error);
}

static weft_code put_blocks(const cloth *of, weft_dataset_block_writer *writer, weft_error *error)
{
    int width, height;
    weft_dataset_block_size(&of->layout, &width, &height);
    size_t count = (size_t)width * (size_t)height * (size_t)of->layout.image_count;
    weft_half *samples = malloc(3 * count * sizeof *samples);
    uint8_t *mask = calloc(count, 1);
    weft_code code = samples && mask ? WEFT_OK : weft_fail_memory(error, "a block of texels", 7 * count);
    for (int y = 0; code == WEFT_OK && y < of->layout.height; y += height) {
        for (int x = 0; code == WEFT_OK && x < of->layout.width; x += width)
            code = put_block(of, writer, x, y, width, height, samples, mask, error);
    }
    free(samples);
    free(mask);
    return code;
}

static weft_code write_cloth(const char *path, int size, weft_error *error)
{
    cloth made = {0};
    weft_dataset_block_writer *writer = NULL;
    WEFT_TRY(synthetic_layout(size, size, &made.layout, error));
    weft_code code = invent_pool(&made, error);
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_create(path, &made.layout, &writer, error);
    if (code == WEFT_OK)
        code = put_blocks(&made, writer, error);
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_finish(writer, "{\"what\":\"invented cloth\"}", error);
    else
        weft_dataset_block_writer_abandon(writer);
    free(made.pool);
    weft_dataset_layout_free(&made.layout);
    return code;
}

int main(int argc, char **argv)
{
    int size = argc > 2 ? atoi(argv[2]) : 256;
    if (argc < 2 || argc > 3 || argv[1][0] == '-' || size < 1 || size > 4096) {
        fprintf(stderr, "usage: bench_large_dataset NAME.btf.h5 [SIZE]\n"
                        "SIZE x SIZE texels, 81 x 81 images; 256, the default, makes 2.6 GB\n");
        return WEFT_BAD_USAGE;
    }
    weft_error error = {0};
    weft_code code = write_cloth(argv[1], size, &error);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_large_dataset: %s\n", error.message);
    return (int)code;
}
