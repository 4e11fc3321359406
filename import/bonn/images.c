#include "import/bonn/images.h"

#include "base/integers.h"
#include "base/processor.h"
#include "import/bonn/product.h"

#include <stdlib.h>

/* What one thread needs while it makes a group of images. */
typedef struct scratch {
    const weft_bonn_kernels *kernels;
    float *texels;        /* [component][WEFT_BONN_BLOCK] of one channel and block */
    float *values;        /* [channel][image of the group][WEFT_BONN_BLOCK] */
    const void *unpacked; /* of which texels hold the block */
} scratch;

enum { ALIGNMENT = 64, VALUES = WEFT_BONN_GROUP * WEFT_BONN_BLOCK };

int weft_bonn_group_size(const weft_bonn_file *file)
{
    const size_t most_bytes = (size_t)64 << 20;
    size_t bytes = file->matrices.texel_count * 3 * sizeof(float);
    return bytes >= most_bytes ? 1 : weft_smaller(WEFT_BONN_GROUP, (int)(most_bytes / bytes));
}

static weft_code create_scratch(const weft_bonn_file *file, scratch *with, weft_error *error)
{
    size_t components = 0;
    for (int c = 0; c < WEFT_BONN_CHANNELS; c++)
        components = (size_t)weft_larger((int)components, file->matrices.channel[c].component_count);
    size_t bytes = components * WEFT_BONN_BLOCK * sizeof *with->texels;
    *with = (scratch){.kernels = WEFT_DISPATCH(&weft_bonn_kernels),
                      .texels = aligned_alloc(ALIGNMENT, bytes),
                      .values = aligned_alloc(ALIGNMENT, WEFT_BONN_CHANNELS * VALUES * sizeof *with->values)};
    return with->texels && with->values ? WEFT_OK : weft_fail_memory(error, "block of texels", bytes);
}

/* The textures of a channel for one block of texels, as single precision floats. Channels may share them. */
static const float *unpack(const weft_bonn_channel *channel, size_t block, scratch *with)
{
    size_t size = (size_t)channel->component_count * WEFT_BONN_BLOCK;
    if (channel->textures.single)
        return channel->textures.single + block * size;
    const weft_half *half = channel->textures.half + block * size;
    if (with->unpacked != half)
        with->kernels->widen(half, size, with->texels);
    with->unpacked = half;
    return with->texels;
}

static void multiply_block(const weft_bonn_file *file, const int *number, int count, size_t block, scratch *with)
{
    for (int c = 0; c < WEFT_BONN_CHANNELS; c++) {
        const weft_bonn_channel *channel = &file->matrices.channel[c];
        const float *row[WEFT_BONN_GROUP];
        for (int i = 0; i < count; i++)
            row[i] = channel->weights.value + (size_t)number[i] * channel->weights.stride;
        with->kernels->multiply(row, count, unpack(channel, block, with), channel->component_count,
                                with->values + (size_t)c * VALUES);
    }
}

static void make_block(const weft_bonn_file *file, const int *number, int count, size_t block, scratch *with,
                       weft_image *image)
{
    size_t first = block * WEFT_BONN_BLOCK, left = file->matrices.texel_count - first;
    size_t texels = left < WEFT_BONN_BLOCK ? left : WEFT_BONN_BLOCK;
    multiply_block(file, number, count, block, with);
    for (int i = 0; i < count; i++) {
        float *values = with->values + (size_t)i * WEFT_BONN_BLOCK, *pixel = image[i].pixels + 3 * first;
        weft_bonn_colour_restore(&file->colour, values, VALUES, texels);
        for (size_t t = 0; t < texels; t++)
            for (size_t c = 0; c < WEFT_BONN_CHANNELS; c++)
                pixel[3 * t + c] = values[c * VALUES + t];
    }
}

weft_code weft_bonn_images_make(const weft_bonn_file *file, const int *number, int count, weft_image *image,
                                weft_error *error)
{
    scratch with;
    weft_code code = create_scratch(file, &with, error);
    size_t blocks = (file->matrices.texel_count + WEFT_BONN_BLOCK - 1) / WEFT_BONN_BLOCK;
    for (size_t block = 0; code == WEFT_OK && block < blocks; block++)
        make_block(file, number, count, block, &with, image);
    free(with.texels);
    free(with.values);
    return code;
}
