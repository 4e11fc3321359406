#include "import/bonn/matrix.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A pair of matrices as the file has it: left [rows][components], right [columns][components]. */
typedef struct pair {
    const weft_bonn_matrices *of;
    weft_bonn_reader *reader;
    int channel;           /* the first that it makes */
    int channel_count;     /* that it makes: 1 or all */
    bool left_is_textures; /* the left one belongs to the texels, the right one to the images */
    uint32_t scalar_size, component_count, rows, columns;
} pair;

/* ---- Sizes ---- */

static weft_code refuse_sizes(const pair *p, weft_error *error)
{
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': its matrix of %s is %u x %u, must be %zu x %zu (images by texels)",
                     p->reader->path, p->reader->section, p->rows, p->columns,
                     (size_t)p->channel_count * p->of->image_count, p->of->texel_count);
}

/* Which of the two belongs to the images; the left one does, unless only the other way fits. */
static weft_code choose_sides(pair *p, weft_error *error)
{
    uint64_t images = p->of->image_count, texels = p->of->texel_count, channels = (uint64_t)p->channel_count;
    bool plain = p->rows == channels * images && p->columns == texels;
    p->left_is_textures = !plain && p->rows == channels * texels && p->columns == images;
    return plain || p->left_is_textures ? WEFT_OK : refuse_sizes(p, error);
}

static weft_code check_scalars(const pair *p, weft_error *error)
{
    if (p->scalar_size != 2 && p->scalar_size != 4 && p->scalar_size != 8)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the numbers of its %s are of %u bytes, not 2, 4 or 8",
                         p->reader->path, p->reader->section, p->scalar_size);
    return WEFT_OK;
}

/* Components beyond the images (each of all channels) are none: the rest of memory is bounded by this. */
static weft_code check_components(const pair *p, weft_error *error)
{
    uint64_t most = (uint64_t)p->of->image_count * (uint64_t)p->channel_count;
    if (p->component_count < 1 || p->component_count > most)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': its %s has %u components, must be 1 to %llu", p->reader->path,
                         p->reader->section, p->component_count, (unsigned long long)most);
    return WEFT_OK;
}

static weft_code read_sizes(pair *p, weft_error *error)
{
    uint8_t scalar_size;
    WEFT_TRY(weft_bonn_reader_byte(p->reader, &scalar_size, error));
    p->scalar_size = scalar_size;
    WEFT_TRY(check_scalars(p, error));
    WEFT_TRY(weft_bonn_reader_whole(p->reader, &p->component_count, error));
    WEFT_TRY(weft_bonn_reader_whole(p->reader, &p->rows, error));
    WEFT_TRY(weft_bonn_reader_whole(p->reader, &p->columns, error));
    WEFT_TRY(choose_sides(p, error));
    WEFT_TRY(check_components(p, error));
    /* 2^34 vectors of 2^26 components of 8 bytes at most: no overflow. */
    uint64_t scalars = (1 + (uint64_t)p->rows + p->columns) * p->component_count;
    return weft_bonn_reader_expect(p->reader, scalars * p->scalar_size, error);
}

/* ---- Numbers ---- */

static float single_of(const uint8_t *bytes, uint32_t scalar_size)
{
    switch (scalar_size) {
    case 2:
        return weft_float_of_half((weft_half)(bytes[0] | bytes[1] << 8));
    case 4:
        return weft_bonn_single_of(bytes);
    default:
        return (float)weft_bonn_double_of(bytes);
    }
}

/* The next vector of a matrix, `buffer` [components of scalar_size]. */
static weft_code read_vector(const pair *p, uint32_t index, uint8_t *buffer, float *vector, weft_error *error)
{
    WEFT_TRY(weft_bonn_reader_take(p->reader, buffer, (uint64_t)p->component_count * p->scalar_size, error));
    for (uint32_t k = 0; k < p->component_count; k++) {
        vector[k] = single_of(buffer + (size_t)k * p->scalar_size, p->scalar_size);
        if (!isfinite(vector[k]))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': number %u of vector %u of its %s is %g", p->reader->path, k,
                             index, p->reader->section, (double)vector[k]);
    }
    return WEFT_OK;
}

typedef void keep_vector(const pair *p, void *to, uint32_t index, const float *vector);

static weft_code read_vectors(const pair *p, uint32_t count, keep_vector *keep, void *to, weft_error *error)
{
    size_t components = p->component_count;
    uint8_t *buffer = malloc(components * p->scalar_size);
    float *vector = malloc(components * sizeof *vector);
    weft_code code = buffer && vector ? WEFT_OK : weft_fail_memory(error, "vector", components * sizeof *vector);
    for (uint32_t i = 0; code == WEFT_OK && i < count; i++) {
        code = read_vector(p, i, buffer, vector, error);
        if (code == WEFT_OK)
            keep(p, to, i, vector);
    }
    free(buffer);
    free(vector);
    return code;
}

/* ---- The side of the images ---- */

static void keep_weights(const pair *p, void *to, uint32_t index, const float *vector)
{
    float *weights = to;
    memcpy(weights + (size_t)index * p->component_count, vector, p->component_count * sizeof *vector);
}

/* `channels` of them follow one another for every image. */
static weft_code read_weights(const pair *p, weft_bonn_matrices *matrices, int channels, weft_error *error)
{
    size_t components = p->component_count, count = matrices->image_count * (size_t)channels;
    float *weights = malloc(count * components * sizeof *weights);
    if (!weights)
        return weft_fail_memory(error, "matrix", count * components * sizeof *weights);
    matrices->owned[2 * p->channel] = weights;
    for (int c = 0; c < p->channel_count; c++) {
        size_t first = channels > 1 ? (size_t)c * components : 0;
        matrices->channel[p->channel + c].weights = (weft_bonn_weights){weights + first, (size_t)channels * components};
    }
    return read_vectors(p, (uint32_t)count, keep_weights, weights, error);
}

/* ---- The side of the texels ---- */

/* Where the textures of each channel begin, and how many channels of a texel follow one another. */
typedef struct texture_places {
    size_t channels, bytes; /* of one channel */
    char *first;
} texture_places;

static void keep_textures(const pair *p, void *to, uint32_t index, const float *vector)
{
    const texture_places *places = to;
    size_t texel = index / places->channels, components = p->component_count;
    size_t at = texel / WEFT_BONN_BLOCK * components * WEFT_BONN_BLOCK + texel % WEFT_BONN_BLOCK;
    void *channel = places->first + index % places->channels * places->bytes;
    for (size_t k = 0; k < components; k++) {
        if (p->scalar_size == 2)
            ((weft_half *)channel)[at + k * WEFT_BONN_BLOCK] = weft_half_of_float(vector[k]);
        else
            ((float *)channel)[at + k * WEFT_BONN_BLOCK] = vector[k];
    }
}

static weft_code read_textures(const pair *p, weft_bonn_matrices *matrices, int channels, weft_error *error)
{
    size_t blocks = (matrices->texel_count + WEFT_BONN_BLOCK - 1) / WEFT_BONN_BLOCK;
    size_t scalar = p->scalar_size == 2 ? sizeof(weft_half) : sizeof(float);
    size_t bytes = blocks * WEFT_BONN_BLOCK * p->component_count * scalar, all = (size_t)channels * bytes;
    texture_places places = {(size_t)channels, bytes, aligned_alloc(WEFT_BONN_BLOCK, all)};
    if (!places.first)
        return weft_fail_memory(error, "matrix", all);
    memset(places.first, 0, all);
    matrices->owned[2 * p->channel + 1] = places.first;
    for (int c = 0; c < p->channel_count; c++) {
        const void *textures = places.first + (channels > 1 ? (size_t)c * bytes : 0);
        matrices->channel[p->channel + c].textures =
            p->scalar_size == 2 ? (weft_bonn_textures){.half = textures} : (weft_bonn_textures){.single = textures};
    }
    return read_vectors(p, (uint32_t)(matrices->texel_count * (size_t)channels), keep_textures, &places, error);
}

/* ---- Both ---- */

static weft_code read_pair(pair *p, weft_bonn_matrices *matrices, weft_error *error)
{
    WEFT_TRY(read_sizes(p, error));
    for (int c = 0; c < p->channel_count; c++)
        matrices->channel[p->channel + c].component_count = (int)p->component_count;
    /* The singular values are in the right matrix already. */
    WEFT_TRY(weft_bonn_reader_skip(p->reader, (uint64_t)p->component_count * p->scalar_size, error));
    if (p->left_is_textures) {
        WEFT_TRY(read_textures(p, matrices, p->channel_count, error));
        return read_weights(p, matrices, 1, error);
    }
    WEFT_TRY(read_weights(p, matrices, p->channel_count, error));
    return read_textures(p, matrices, 1, error);
}

weft_code weft_bonn_matrices_read_channel(weft_bonn_matrices *matrices, int channel, weft_bonn_reader *reader,
                                          weft_error *error)
{
    static const char *const section[WEFT_BONN_CHANNELS] = {"channel 1", "channel 2", "channel 3"};
    pair p = {.of = matrices, .reader = reader, .channel = channel, .channel_count = 1};
    reader->section = section[channel];
    return read_pair(&p, matrices, error);
}

weft_code weft_bonn_matrices_read_joint(weft_bonn_matrices *matrices, weft_bonn_reader *reader, weft_error *error)
{
    pair p = {.of = matrices, .reader = reader, .channel_count = WEFT_BONN_CHANNELS};
    reader->section = "all channels";
    return read_pair(&p, matrices, error);
}

void weft_bonn_matrices_free(weft_bonn_matrices *matrices)
{
    for (int i = 0; i < 2 * WEFT_BONN_CHANNELS; i++)
        free(matrices->owned[i]);
    *matrices = (weft_bonn_matrices){0};
}
