#include "compare/tradeoff/factorised.h"

#include "base/half.h"
#include "compress/components/factorisation.h"
#include "import/bonn/colour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TEXELS = 1024, CHANNELS = 3, LANES = 16, FEWEST_VIEWS = 4 };

/* Terms of each matrix; a matrix of all channels is the first. */
static const struct {
    const char *name;
    bool is_log, is_split;
    int terms[CHANNELS];
} table[WEFT_FACTORISED_KINDS] = {
    {"full matrix, linear", false, false, {16, 0, 0}},
    {"full matrix, log luminance", true, false, {16, 0, 0}},
    {"matrix per channel, linear", false, true, {5, 6, 5}},
    {"matrix per channel, log luminance", true, true, {8, 4, 4}},
};

const char *weft_factorised_name(weft_factorised_kind kind)
{
    return table[kind].name;
}

bool weft_factorised_is_for(const weft_dataset_layout *layout)
{
    return layout->distance == WEFT_FAR && layout->view_count >= FEWEST_VIEWS &&
           layout->image_count >= FEWEST_VIEWS * layout->view_count;
}

double weft_factorised_bytes(weft_factorised_kind kind, double texels, int image_count)
{
    double bytes = 0;
    for (int m = 0; m < CHANNELS; m++)
        bytes += sizeof(weft_half) * table[kind].terms[m] * (texels + image_count * (table[kind].is_split ? 1.0 : 3.0));
    return bytes;
}

/* ---- Colours ---- */

static const weft_bonn_colour log_colours = {.model = WEFT_BONN_LOG_Y_RATIO};
static const float offset = 1e-5f;

/* The other way round from weft_bonn_colour_restore, whose G is Y - 0.39465 U - 0.5806 V. */
static void code_log(float channel[CHANNELS])
{
    const float of_u = 2.03211f, of_v = 1.13983f, blue = 0.39465f / of_u, red = 0.5806f / of_v;
    float y = fmaxf((channel[1] + blue * channel[2] + red * channel[0]) / (1 + blue + red), 0), raised = y + offset;
    float u = (channel[2] - y) / of_u, v = (channel[0] - y) / of_v;
    memcpy(channel, (float[]){logf(raised), u / raised, v / raised}, CHANNELS * sizeof *channel);
}

/* ---- The matrices ---- */

typedef struct matrices {
    weft_factorised_kind kind;
    const weft_texel_subset *subset;
    int *image; /* [image_count] that are fitted */
    int image_count, matrix_count;
    size_t length; /* of the samples of a texel, in whole lanes */
    weft_factorisation factorisation[CHANNELS];
    weft_projector projector[CHANNELS];
} matrices;

static void free_matrices(matrices *m)
{
    free(m->image);
    for (int i = 0; i < CHANNELS; i++) {
        weft_projector_free(&m->projector[i]);
        weft_factorisation_free(&m->factorisation[i]);
    }
}

/* The samples of a texel that a matrix is of: those of one channel, or all. */
static void gather(const matrices *m, int matrix, size_t texel, float *vector, uint8_t *known)
{
    size_t images = (size_t)m->subset->layout.image_count;
    memset(vector, 0, m->length * sizeof *vector);
    for (int i = 0; i < m->image_count; i++) {
        size_t at = texel * images + (size_t)m->image[i];
        float channel[CHANNELS];
        known[i] = !m->subset->mask[at];
        for (int c = 0; c < CHANNELS; c++)
            channel[c] = weft_float_of_half(m->subset->samples[CHANNELS * at + (size_t)c]);
        if (table[m->kind].is_log)
            code_log(channel);
        for (int c = 0; c < CHANNELS && known[i]; c++)
            vector[CHANNELS * i + c] = m->matrix_count == 1 || c == matrix ? channel[c] : 0;
    }
}

static weft_code find_matrix(matrices *m, int matrix, weft_error *error)
{
    const weft_dataset_layout *layout = &m->subset->layout;
    int texels = layout->width * layout->height, step = (texels + MOST_TEXELS - 1) / MOST_TEXELS;
    weft_training training;
    WEFT_TRY(weft_training_allocate((texels + step - 1) / step, m->length, (size_t)m->image_count, &training, error));
    for (int t = 0; t < training.texel_count; t++)
        gather(m, matrix, (size_t)t * (size_t)step, training.vector + (size_t)t * m->length,
               training.known + (size_t)t * (size_t)m->image_count);
    weft_factorisation *factorisation = &m->factorisation[matrix];
    weft_code code = weft_factorisation_find(&training, table[m->kind].terms[matrix], factorisation, error);
    weft_training_free(&training);
    WEFT_TRY(code);
    return weft_projector_create(factorisation, factorisation->vector, m->image_count, &m->projector[matrix], error);
}

static weft_code find_matrices(matrices *m, const uint8_t *left_out, weft_error *error)
{
    const weft_dataset_layout *layout = &m->subset->layout;
    m->image = malloc((size_t)layout->image_count * sizeof *m->image);
    if (!m->image)
        return weft_fail_memory(error, "images", (size_t)layout->image_count);
    for (int i = 0; i < layout->image_count; i++) {
        if (!left_out[i])
            m->image[m->image_count++] = i;
    }
    m->length = (CHANNELS * (size_t)m->image_count + LANES - 1) / LANES * LANES;
    m->matrix_count = table[m->kind].is_split ? CHANNELS : 1;
    for (int matrix = 0; matrix < m->matrix_count; matrix++)
        WEFT_TRY(find_matrix(m, matrix, error));
    return WEFT_OK;
}

/* ---- Their product ---- */

static weft_code multiply(const matrices *m, int matrix, const float *vector, const uint8_t *known, float *sum,
                          weft_error *error)
{
    float coefficient[WEFT_COMPONENTS_MAX];
    const weft_factorisation *factorisation = &m->factorisation[matrix];
    WEFT_TRY(weft_projector_solve(&m->projector[matrix], &vector, &known, 1, coefficient, error));
    for (int k = 0; k < factorisation->count; k++)
        for (size_t i = 0; i < CHANNELS * (size_t)m->image_count; i++)
            sum[i] += coefficient[k] * factorisation->vector[(size_t)k * factorisation->length + i];
    return WEFT_OK;
}

/* `vector` and `sum` are of the length of the samples, `sum` is 0. */
static weft_code restore_texel(const matrices *m, size_t texel, float *vector, float *sum, uint8_t *known,
                               weft_half *samples, weft_error *error)
{
    for (int matrix = 0; matrix < m->matrix_count; matrix++) {
        gather(m, matrix, texel, vector, known);
        WEFT_TRY(multiply(m, matrix, vector, known, sum, error));
    }
    for (int i = 0; i < m->image_count; i++) {
        float *channel = sum + CHANNELS * i;
        weft_half *sample = samples + CHANNELS * (texel * (size_t)m->subset->layout.image_count + (size_t)m->image[i]);
        if (table[m->kind].is_log)
            weft_bonn_colour_restore(&log_colours, channel, 1, 1);
        for (int c = 0; c < CHANNELS && known[i]; c++)
            sample[c] = weft_half_of_float(channel[c]);
    }
    return WEFT_OK;
}

static weft_code restore_texels(const matrices *m, weft_half *samples, weft_error *error)
{
    size_t texels = (size_t)m->subset->layout.width * (size_t)m->subset->layout.height;
    float *vector = aligned_alloc(64, 2 * m->length * sizeof *vector);
    uint8_t *known = calloc((size_t)m->image_count, 1);
    weft_code code = vector && known ? WEFT_OK : weft_fail_memory(error, "samples", m->length * sizeof *vector);
    for (size_t t = 0; t < texels && code == WEFT_OK; t++) {
        memset(vector + m->length, 0, m->length * sizeof *vector);
        code = restore_texel(m, t, vector, vector + m->length, known, samples, error);
    }
    free(vector);
    free(known);
    return code;
}

weft_code weft_factorised_restore(weft_factorised_kind kind, const weft_texel_subset *subset, const uint8_t *left_out,
                                  weft_half *samples, weft_error *error)
{
    matrices m = {.kind = kind, .subset = subset};
    weft_code code = find_matrices(&m, left_out, error);
    if (code == WEFT_OK)
        code = restore_texels(&m, samples, error);
    free_matrices(&m);
    return code;
}
