#include "import/bonn/images.h"

#include "base/integers.h"
#include "base/processor.h"
#include "import/bonn/product.h"

#include <stdlib.h>
#include <string.h>

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

/* ---- Frames of the texels ---- */

static weft_vec3 vector_at(const float *from)
{
    return weft_vec3_of((weft_real)from[0], (weft_real)from[1], (weft_real)from[2]);
}

static void store(weft_vec3 vector, float *to)
{
    to[0] = (float)vector.x;
    to[1] = (float)vector.y;
    to[2] = (float)vector.z;
}

static bool is_frame(weft_vec3 tangent, weft_vec3 bitangent, weft_vec3 normal)
{
    const weft_real tolerance = 1e-3;
    return weft_length(weft_subtract(weft_cross(normal, tangent), bitangent)) < tolerance &&
           fabs(weft_length(normal) - 1) < tolerance && fabs(weft_length(tangent) - 1) < tolerance &&
           fabs(weft_dot(normal, tangent)) < tolerance && normal.z >= 0;
}

/* Adds a frame to a sum. A tangent is an axis: its sign means nothing. */
static bool add_frame(const float from[9], float sum[6])
{
    weft_vec3 tangent = vector_at(from), normal = vector_at(from + 6), before = vector_at(sum + 3);
    if (!is_frame(tangent, vector_at(from + 3), normal))
        return false;
    store(weft_add(vector_at(sum), normal), sum);
    store(weft_add(before, weft_scale(tangent, weft_dot(before, tangent) < 0 ? -1 : 1)), sum + 3);
    return true;
}

static bool make_unit(float sum[6])
{
    const weft_real least = 1e-3;
    weft_vec3 normal = weft_unit(vector_at(sum)), tangent = weft_unit(vector_at(sum + 3));
    weft_vec3 across = weft_subtract(tangent, weft_scale(normal, weft_dot(normal, tangent)));
    store(normal, sum);
    store(weft_unit(across), sum + 3);
    return weft_length(normal) > least && weft_length(across) > least;
}

bool weft_bonn_frames_average(const weft_bonn_file *file, int width, int height, float *frames)
{
    bool good = true;
    memset(frames, 0, 6 * (size_t)width * (size_t)height * sizeof *frames);
    for (int y = 0; good && y < file->height; y++) {
        for (int x = 0; good && x < file->width; x++) {
            size_t column = (size_t)((2 * x + 1L) * width / (2 * file->width));
            size_t row = (size_t)((2 * y + 1L) * height / (2 * file->height));
            good = add_frame(file->frame[(size_t)y * (size_t)file->width + (size_t)x],
                             frames + 6 * (row * (size_t)width + column));
        }
    }
    for (size_t i = 0; good && i < (size_t)width * (size_t)height; i++)
        good = make_unit(frames + 6 * i);
    return good;
}
