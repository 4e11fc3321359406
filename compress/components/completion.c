#include "compress/components/completion.h"

#include "btf/direction/direction.h"
#include "compress/components/dots.h"
#include "compress/components/known.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_LEARNED = 1500,
    MOST_NEAR_LEARNED = 256,
    MOST_LEFT_OUT = 200,
    MOST_NEAR_LEFT_OUT = 128,
    MOST_NEAR_SETS = 12,
    MOST_NEAR_TEXELS = 96,
    ROWS = 64, /* directions that are predicted together */
    SWEEPS = 8,
    WHOLE_LANES = 16,
    ALIGNMENT = 64,
    GRID = WEFT_UBO81_COUNT
};

void weft_completion_free(weft_completion *completion)
{
    weft_component_images_free(&completion->images);
    weft_training_free(&completion->training);
}

/* ---- The directions ---- */

static void add_grid_view(weft_component_images *images, weft_vec3 view)
{
    for (int light = 0; light < GRID; light++) {
        int i = images->image_count++;
        images->image[i] = i;
        images->light[i] = weft_direction_of_angles(weft_ubo81_angles(light));
        images->height[i] = (float)images->light[i].z;
        images->cosine[i] = images->weight[i] = 1;
    }
    images->view[images->view_count++] = view;
    images->first[images->view_count] = (uint32_t)images->image_count;
}

static weft_code make_directions(const weft_component_images *from, weft_component_images *images, weft_error *error)
{
    int views = from->view_count == 1 ? 1 : GRID;
    WEFT_TRY(weft_component_images_allocate(views * GRID, views, images, error));
    images->dataset_image_count = views * GRID;
    images->length = (3 * (size_t)images->dataset_image_count + WHOLE_LANES - 1) / WHOLE_LANES * WHOLE_LANES;
    if (views == 1)
        add_grid_view(images, from->view[0]);
    for (int view = 0; view < views && views > 1; view++)
        add_grid_view(images, weft_direction_of_angles(weft_ubo81_angles(view)));
    return WEFT_OK;
}

/* ---- Far lights and cameras: all texels have the same directions ---- */

static weft_code choose_far(const weft_component_images *images, const weft_training *training,
                            const weft_progress *progress, weft_completion *c, weft_error *error)
{
    weft_known k;
    WEFT_TRY(weft_known_take(training, images, 0, training->texel_count - 1, MOST_LEFT_OUT, &k, error));
    weft_kriging_samples set = {weft_known_places(&k), k.series_count, k.sample};
    c->left_out_count = k.count;
    weft_code code = weft_kriging_choose(&set, 1, progress, &c->covariance, &c->left_out_error, error);
    if (code == WEFT_OK)
        code = weft_mean_texel_choose(&k, &c->covariance, progress, &c->mean, c->mean_error, error);
    weft_known_free(&k);
    return code;
}

/* What is masked becomes what kriging says of it from the rest: there the weight [A y]_i is 0. Gauss and Seidel's
 * iteration, from the mean texel on. */
static void fill_series(const weft_kriging *inverse, const uint8_t *known, const int *image, double *y)
{
    size_t count = (size_t)inverse->count;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (size_t i = 0; i < count; i++) {
            const double *row = inverse->root + i * count;
            double weight = 0;
            if (known[image[i]])
                continue;
            for (size_t j = 0; j < count; j++)
                weight += row[j] * y[j];
            y[i] -= weight / row[i];
        }
}

static weft_code fill_masked(const weft_training *training, const weft_covariance *covariance, weft_known *k,
                             weft_error *error)
{
    weft_kriging inverse;
    weft_kriging_places places = weft_known_places(k);
    WEFT_TRY(weft_kriging_create(covariance, &places, &inverse, error));
    weft_kriging_invert(&inverse);
#pragma omp parallel for schedule(dynamic, 8)
    for (int series = 0; series < k->series_count; series++)
        fill_series(&inverse, training->known + (size_t)(series / 3) * training->image_count, k->image,
                    k->sample + (size_t)series * (size_t)k->count);
    weft_kriging_free(&inverse);
    return WEFT_OK;
}

/* What all threads read while directions are predicted. */
typedef struct prediction {
    weft_kriging_places places;
    weft_covariance_terms terms;
    size_t length;        /* of a row: places.count in whole lanes */
    const float **weight; /* [series_count] rows */
    int series_count;
    weft_completion *completion;
} prediction;

static weft_direction_pair grid_pair(const weft_component_images *images, int i)
{
    return weft_direction_pair_of(images->light[i], images->view[i / GRID]);
}

/* Directions first .. first + count; `row` [ROWS][length] is 0 beyond the places; `value` [ROWS][series_count]. */
static void predict_rows(const prediction *p, int first, int count, float *row, float *value)
{
    const float *rows[ROWS] = {0};
    weft_training *to = &p->completion->training;
    for (int i = 0; i < count; i++) {
        weft_direction_pair pair = grid_pair(&p->completion->images, first + i);
        rows[i] = row + (size_t)i * p->length;
        weft_kriging_row(&p->terms, &p->places, &pair, row + (size_t)i * p->length);
    }
    weft_dots(rows, count, p->weight, p->series_count, p->length, value);
    for (int i = 0; i < count; i++)
        for (int series = 0; series < p->series_count; series++)
            to->vector[(size_t)(series / 3) * to->length + 3 * (size_t)(first + i) + (size_t)(series % 3)] =
                fmaxf(value[(size_t)i * (size_t)p->series_count + (size_t)series], 0);
}

static weft_code predict_all(const prediction *p, weft_error *error)
{
    int directions = p->completion->images.image_count, chunks = (directions + ROWS - 1) / ROWS, failures = 0;
    size_t row_bytes = ROWS * p->length * sizeof(float), value_bytes = ROWS * (size_t)p->series_count * sizeof(float);
#pragma omp parallel for schedule(dynamic) reduction(+ : failures)
    for (int chunk = 0; chunk < chunks; chunk++) {
        float *row = aligned_alloc(ALIGNMENT, row_bytes), *value = malloc(value_bytes);
        failures += !row || !value;
        if (row && value) {
            memset(row, 0, row_bytes);
            predict_rows(p, chunk * ROWS, weft_at_most(ROWS, directions - chunk * ROWS), row, value);
        }
        free(row);
        free(value);
    }
    return failures > 0 ? weft_fail_memory(error, "predictions", row_bytes + value_bytes) : WEFT_OK;
}

/* Weights as rows of floats in whole lanes. */
static weft_code predict_far(const weft_known *k, weft_completion *c, weft_error *error)
{
    prediction p = {.places = weft_known_places(k),
                    .terms = weft_covariance_terms_of(&c->covariance),
                    .length = ((size_t)k->count + WHOLE_LANES - 1) / WHOLE_LANES * WHOLE_LANES,
                    .series_count = k->series_count,
                    .completion = c};
    size_t series_count = (size_t)k->series_count, bytes = series_count * p.length * sizeof(float);
    float *weight = aligned_alloc(ALIGNMENT, bytes);
    const float **row = malloc(series_count * sizeof *row);
    weft_code code = weight && row ? WEFT_OK : weft_fail_memory(error, "weights of kriging", bytes);
    if (code == WEFT_OK) {
        memset(weight, 0, bytes);
        for (size_t series = 0; series < series_count; series++) {
            row[series] = weight + series * p.length;
            for (size_t i = 0; i < (size_t)k->count; i++)
                weight[series * p.length + i] = (float)k->sample[series * (size_t)k->count + i];
        }
        p.weight = row;
        code = predict_all(&p, error);
    }
    free(weight);
    free(row);
    return code;
}

static weft_code complete_known(const weft_known *k, weft_completion *c, weft_error *error)
{
    weft_kriging kriging;
    weft_kriging_places places = weft_known_places(k);
    double *mean;
    WEFT_TRY(weft_mean_texel_take(k, &mean, error));
    weft_code code = weft_kriging_create(&c->covariance, &places, &kriging, error);
    if (code == WEFT_OK) {
        weft_kriging_solve(&kriging, k->sample, k->series_count);
        weft_kriging_free(&kriging);
        code = predict_far(k, c, error);
    }
    if (code == WEFT_OK && c->mean.is_of_mean)
        code = weft_mean_texel_impose(k, mean, &c->mean, &c->images, &c->training, error);
    free(mean);
    return code;
}

static weft_code complete_filled(const weft_component_images *images, const weft_training *training,
                                 const weft_progress *progress, weft_completion *c, weft_error *error)
{
    weft_known k;
    WEFT_TRY(choose_far(images, training, progress, c, error));
    WEFT_TRY(weft_known_take(training, images, 0, training->texel_count - 1, MOST_LEARNED, &k, error));
    weft_code code = weft_training_is_whole(training) ? WEFT_OK : fill_masked(training, &c->covariance, &k, error);
    c->noise = weft_known_mean_square(&k);
    if (code == WEFT_OK)
        code = complete_known(&k, c, error);
    weft_known_free(&k);
    return code;
}

static weft_code complete_far(const weft_component_images *images, const weft_training *training,
                              const weft_progress *progress, weft_completion *c, weft_error *error)
{
    weft_training filled;
    WEFT_TRY(weft_training_thin(training, training->texel_count, &filled, error));
    weft_code code = weft_training_fill_by_mean(&filled, error);
    if (code == WEFT_OK)
        code = complete_filled(images, &filled, progress, c, error);
    weft_training_free(&filled);
    return code;
}

/* ---- Near ones: every texel has its own ---- */

typedef struct nearby {
    const weft_dataset_layout *layout;
    const weft_component_images *images;
    const weft_training *training;
} nearby;

/* The training texel `index` of `count`. */
static weft_code take_nearby(const nearby *n, int index, int count, int most, weft_known *k, weft_error *error)
{
    weft_component_images seen;
    int texel = weft_even_choice(index, count, n->training->texel_count);
    const weft_training_place *place = &n->training->place[texel];
    *k = (weft_known){0};
    WEFT_TRY(weft_component_images_copy(n->images, &seen, error));
    weft_component_images_look_from(n->layout, place->x, place->y, &seen);
    weft_code code = weft_known_take(n->training, &seen, texel, texel, most, k, error);
    weft_component_images_free(&seen);
    return code;
}

static weft_code choose_near(const nearby *n, const weft_progress *progress, weft_completion *c, weft_error *error)
{
    weft_known k[MOST_NEAR_SETS] = {0};
    weft_kriging_samples set[MOST_NEAR_SETS];
    int count = weft_at_most(n->training->texel_count, MOST_NEAR_SETS);
    weft_code code = WEFT_OK;
    for (int i = 0; i < count && code == WEFT_OK; i++) {
        code = take_nearby(n, i, count, MOST_NEAR_LEFT_OUT, &k[i], error);
        set[i] = (weft_kriging_samples){weft_known_places(&k[i]), k[i].series_count, k[i].sample};
        c->left_out_count = k[i].count > c->left_out_count ? k[i].count : c->left_out_count;
    }
    if (code == WEFT_OK)
        code = weft_kriging_choose(set, count, progress, &c->covariance, &c->left_out_error, error);
    for (int i = 0; i < count; i++) {
        c->noise += weft_known_mean_square(&k[i]) / count;
        weft_known_free(&k[i]);
    }
    return code;
}

static void predict_near(const weft_known *k, const weft_completion *c, float *vector)
{
    weft_covariance_terms terms = weft_covariance_terms_of(&c->covariance);
    size_t count = (size_t)k->count;
    for (int i = 0; i < c->images.image_count; i++) {
        weft_direction_pair pair = grid_pair(&c->images, i);
        double sum[3] = {0};
        for (size_t j = 0; j < count; j++) {
            double covariance = weft_covariance_between(&terms, &pair, &k->pair[j]);
            for (size_t channel = 0; channel < 3; channel++)
                sum[channel] += covariance * k->sample[channel * count + j];
        }
        for (int channel = 0; channel < 3; channel++)
            vector[3 * i + channel] = (float)fmax(sum[channel], 0);
    }
}

static weft_code complete_texel(const nearby *n, int index, weft_completion *c, weft_error *error)
{
    weft_known k;
    weft_kriging kriging = {0};
    WEFT_TRY(take_nearby(n, index, c->training.texel_count, MOST_NEAR_LEARNED, &k, error));
    weft_kriging_places places = weft_known_places(&k);
    weft_code code = weft_kriging_create(&c->covariance, &places, &kriging, error);
    if (code == WEFT_OK) {
        weft_kriging_solve(&kriging, k.sample, k.series_count);
        predict_near(&k, c, c->training.vector + (size_t)index * c->training.length);
    }
    weft_kriging_free(&kriging);
    weft_known_free(&k);
    return code;
}

static weft_code complete_near(const nearby *n, const weft_progress *progress, weft_completion *c, weft_error *error)
{
    weft_code result = WEFT_OK;
    WEFT_TRY(choose_near(n, progress, c, error));
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < c->training.texel_count; i++) {
        weft_error own = {0};
        weft_code code = complete_texel(n, i, c, &own);
        if (code == WEFT_OK)
            continue;
#pragma omp critical(weft_complete_near)
        {
            result = code;
            *error = own;
        }
    }
    return result;
}

/* ---- The whole ---- */

/* From above. */
static uint64_t bytes_for(const weft_component_images *images, const weft_training *training, const weft_completion *c)
{
    bool near_images = c->training.texel_count < training->texel_count;
    uint64_t learned = (uint64_t)weft_at_most(images->image_count, near_images ? MOST_NEAR_LEARNED : MOST_LEARNED);
    uint64_t texels = (uint64_t)training->texel_count, threads = (uint64_t)omp_get_max_threads();
    uint64_t matrices =
        8 * learned * learned * (near_images ? threads : 1) + threads * 24 * MOST_LEFT_OUT * MOST_LEFT_OUT;
    return matrices + 36 * texels * learned + threads * 4 * ROWS * (learned + 3 * texels) +
           12 * texels * (uint64_t)c->images.image_count;
}

weft_code weft_completion_make(const weft_dataset_layout *layout, const weft_component_images *images,
                               const weft_training *training, const weft_memory_budget *budget, const char *path,
                               const weft_progress *progress, weft_completion *completion, weft_error *error)
{
    bool is_near = layout->distance == WEFT_NEAR;
    int texels = is_near ? weft_at_most(training->texel_count, MOST_NEAR_TEXELS) : training->texel_count;
    *completion = (weft_completion){0};
    WEFT_TRY(make_directions(images, &completion->images, error));
    completion->training.texel_count = texels;
    weft_code code = weft_memory_budget_require(budget, bytes_for(images, training, completion), path,
                                                "completing its texels", error);
    if (code == WEFT_OK)
        code = weft_training_allocate(texels, completion->images.length, (size_t)completion->images.image_count,
                                      &completion->training, error);
    nearby n = {layout, images, training};
    if (code == WEFT_OK)
        code = is_near ? complete_near(&n, progress, completion, error)
                       : complete_far(images, training, progress, completion, error);
    completion->noise *= exp2(completion->covariance.number[WEFT_NOISE]);
    if (code != WEFT_OK)
        weft_completion_free(completion);
    return code;
}
