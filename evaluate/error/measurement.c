#include "evaluate/error/measurement.h"

#include "btf/dataset/dataset.h"
#include "btf/direction/direction.h"

#include <stdlib.h>
#include <string.h>

/* More samples than these do not change a median that is printed with three digits. */
static const long enough_samples = 2000000;
static const uint8_t no_ring = 0xff;

enum { IMAGES_AT_ONCE = 512 };

/* What the pass over the rows carries along. */
typedef struct measuring {
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    weft_predictor *predictor;
    const weft_certificate *certificate; /* or NULL */
    int *every_image;                    /* [image_count] 0, 1, 2, ... */
    weft_measurement *measurement;
    int band_height, band_y;         /* the rows held now */
    weft_half *samples;              /* [band_height][width][image_count][3] */
    uint8_t *mask;                   /* [band_height][width][image_count] */
    long stride;                     /* every stride-th texel is measured */
    size_t value_count;              /* texel_count * image_count * 3 until the empty slots are dropped */
    weft_compared *value;            /* [value_count] */
    uint8_t *view_ring, *light_ring; /* [value_count] of ubo81 */
    float *half_width;               /* [value_count] of the certificate; NULL without */
} measuring;

static void count_masks(const measuring *pass, int rows)
{
    weft_measurement *measurement = pass->measurement;
    long count = (long)rows * pass->layout->width * pass->layout->image_count;
    measurement->sample_count += count;
    for (long i = 0; i < count; i++) {
        measurement->missing += (pass->mask[i] & WEFT_MASK_MISSING) != 0;
        measurement->saturated += (pass->mask[i] & WEFT_MASK_SATURATED) != 0;
        measurement->other += (pass->mask[i] & ~(WEFT_MASK_MISSING | WEFT_MASK_SATURATED)) != 0;
    }
}

/* Index of a sample in the band of rows that is held. */
static size_t index_of(const measuring *pass, int x, int y, int image)
{
    size_t texel = (size_t)(y - pass->band_y) * (size_t)pass->layout->width + (size_t)x;
    return texel * (size_t)pass->layout->image_count + (size_t)image;
}

static weft_rgb sample_at(const measuring *pass, int x, int y, int image)
{
    const weft_half *half = pass->samples + 3 * index_of(pass, x, y, image);
    return (weft_rgb){(double)weft_float_of_half(half[0]), (double)weft_float_of_half(half[1]),
                      (double)weft_float_of_half(half[2])};
}

/* In the quantity of the dataset. */
static double half_width_of(const measuring *pass, double prediction, weft_vec3 light, weft_vec3 view)
{
    double missing = pass->layout->values == WEFT_REFLECTANCE ? (double)light.z : 1;
    return weft_certificate_half_width(pass->certificate, 0, missing * prediction, light, view) / missing;
}

/* The three channels of a sample into the slots from `slot` on; they are untouched where it does not count. */
static void measure_sample(const measuring *pass, int image, int x, int y, weft_rgb p, size_t slot)
{
    const weft_dataset_layout *layout = pass->layout;
    weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
    weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
    if (pass->mask[index_of(pass, x, y, image)] || !(light.z > 0 && view.z > 0))
        return;
    weft_rgb s = sample_at(pass, x, y, image);
    uint8_t view_ring = (uint8_t)weft_ubo81_ring(weft_angles_of_direction(view).theta_rad);
    uint8_t light_ring = (uint8_t)weft_ubo81_ring(weft_angles_of_direction(light).theta_rad);
    const double prediction[3] = {p.r, p.g, p.b}, sample[3] = {s.r, s.g, s.b};
    for (size_t c = 0; c < 3; c++) {
        pass->value[slot + c] = (weft_compared){.sample = (float)sample[c], .prediction = (float)prediction[c]};
        pass->view_ring[slot + c] = view_ring;
        pass->light_ring[slot + c] = light_ring;
        if (pass->certificate)
            pass->half_width[slot + c] = (float)half_width_of(pass, prediction[c], light, view);
    }
}

/* Texels are measured in parallel, each into its own slots; slots without a sample stay marked. */
static void measure_texel(const measuring *pass, long texel)
{
    int images = pass->layout->image_count, x = (int)(texel % pass->layout->width),
        y = (int)(texel / pass->layout->width);
    size_t slot = (size_t)(texel / pass->stride) * 3 * (size_t)images;
    weft_rgb prediction[IMAGES_AT_ONCE];
    for (int first = 0; first < images; first += IMAGES_AT_ONCE) {
        int count = images - first < IMAGES_AT_ONCE ? images - first : IMAGES_AT_ONCE;
        weft_predictor_predict(pass->predictor, x, y, pass->every_image + first, count, prediction);
        for (int i = 0; i < count; i++)
            measure_sample(pass, first + i, x, y, prediction[i], slot + 3 * (size_t)(first + i));
    }
}

static weft_code read_bands(measuring *pass, const char *what, const weft_progress *progress, weft_error *error)
{
    const weft_dataset_layout *layout = pass->layout;
    for (pass->band_y = 0; pass->band_y < layout->height; pass->band_y += pass->band_height) {
        int left = layout->height - pass->band_y, rows = pass->band_height < left ? pass->band_height : left;
        WEFT_TRY(weft_dataset_read_block(pass->dataset, 0, pass->band_y, layout->width, rows, pass->samples, pass->mask,
                                         error));
        WEFT_TRY(weft_predictor_prepare_rows(pass->predictor, pass->band_y, rows, error));
        count_masks(pass, rows);
        for (int i = 0; i < pass->measurement->pair_count; i++)
            weft_image_pair_fill(&pass->measurement->pair[i], layout, pass->predictor, pass->band_y, rows,
                                 pass->samples, pass->mask);
        long first = (long)pass->band_y * layout->width, end = first + (long)rows * layout->width;
        first = (first + pass->stride - 1) / pass->stride * pass->stride;
#pragma omp parallel for schedule(dynamic, 1)
        for (long texel = first; texel < end; texel += pass->stride)
            measure_texel(pass, texel);
        weft_progress_report(progress, what, pass->band_y + rows, layout->height);
    }
    return WEFT_OK;
}

static void drop_empty_slots(measuring *pass)
{
    size_t kept = 0;
    for (size_t i = 0; i < pass->value_count; i++) {
        if (pass->view_ring[i] == no_ring)
            continue;
        pass->value[kept] = pass->value[i];
        pass->view_ring[kept] = pass->view_ring[i];
        if (pass->certificate)
            pass->half_width[kept] = pass->half_width[i];
        pass->light_ring[kept++] = pass->light_ring[i];
    }
    pass->value_count = kept;
}

static weft_code summarise(const measuring *pass, weft_error *error)
{
    weft_measurement *measurement = pass->measurement;
    const weft_compared *value = pass->value;
    size_t count = pass->value_count;
    WEFT_TRY(weft_error_summary_of(value, count, &measurement->all, error));
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        WEFT_TRY(weft_error_summary_of_group(value, pass->view_ring, count, ring, &measurement->by_view[ring], error));
        WEFT_TRY(
            weft_error_summary_of_group(value, pass->light_ring, count, ring, &measurement->by_light[ring], error));
    }
    return WEFT_OK;
}

static weft_code measure_coverage(const measuring *pass, weft_error *error)
{
    weft_covered *covered = malloc((pass->value_count + 1) * sizeof *covered);
    if (!covered)
        return weft_fail_memory(error, "samples", pass->value_count * sizeof *covered);
    for (size_t i = 0; i < pass->value_count; i++)
        covered[i] = (weft_covered){pass->value[i], pass->half_width[i], pass->view_ring[i], pass->light_ring[i]};
    weft_code code = weft_coverage_of(covered, pass->value_count, &pass->measurement->coverage, error);
    free(covered);
    return code;
}

static weft_code create_pairs(measuring *pass, const int *image, int image_count, weft_error *error)
{
    weft_measurement *measurement = pass->measurement;
    measurement->pair = calloc((size_t)image_count + 1, sizeof *measurement->pair);
    if (!measurement->pair)
        return weft_fail_memory(error, "pictures", (size_t)image_count * sizeof *measurement->pair);
    measurement->pair_count = image_count;
    for (int i = 0; i < image_count; i++)
        WEFT_TRY(weft_image_pair_create(pass->layout, image[i], &measurement->pair[i], error));
    return WEFT_OK;
}

/* An odd stride that no common width divides spreads the chosen texels over all columns. */
static long choose_stride(const weft_dataset_layout *layout)
{
    long stride = ((long)layout->width * layout->height * layout->image_count + enough_samples - 1) / enough_samples;
    return stride <= 1 ? 1 : stride | 1;
}

static weft_code allocate(measuring *pass, weft_error *error)
{
    const weft_dataset_layout *layout = pass->layout;
    pass->band_height = weft_dataset_rows_at_once(layout);
    pass->stride = choose_stride(layout);
    size_t band = (size_t)pass->band_height * (size_t)layout->width * (size_t)layout->image_count;
    pass->measurement->texel_count = ((long)layout->width * layout->height + pass->stride - 1) / pass->stride;
    pass->value_count = 3 * (size_t)pass->measurement->texel_count * (size_t)layout->image_count;
    pass->samples = malloc(3 * band * sizeof *pass->samples);
    pass->mask = malloc(band);
    pass->value = malloc(pass->value_count * sizeof *pass->value);
    pass->view_ring = malloc(pass->value_count);
    pass->light_ring = calloc(pass->value_count, 1);
    pass->every_image = malloc((size_t)layout->image_count * sizeof *pass->every_image);
    pass->half_width = pass->certificate ? malloc(pass->value_count * sizeof *pass->half_width) : NULL;
    if (pass->certificate && !pass->half_width)
        return weft_fail_memory(error, "intervals", pass->value_count * sizeof *pass->half_width);
    if (!pass->samples || !pass->mask || !pass->value || !pass->view_ring || !pass->light_ring || !pass->every_image)
        return weft_fail_memory(error, "samples", pass->value_count * (sizeof *pass->value + 2) + 7 * band);
    memset(pass->view_ring, no_ring, pass->value_count);
    for (int i = 0; i < layout->image_count; i++)
        pass->every_image[i] = i;
    return WEFT_OK;
}

weft_code weft_measurement_make(weft_dataset *dataset, weft_predictor *predictor, const weft_certificate *certificate,
                                const char *what, const int *image, int image_count, const weft_progress *progress,
                                weft_measurement *measurement, weft_error *error)
{
    *measurement = (weft_measurement){0};
    measuring pass = {.dataset = dataset,
                      .layout = weft_dataset_get_layout(dataset),
                      .predictor = predictor,
                      .certificate = certificate,
                      .measurement = measurement};
    weft_code code = create_pairs(&pass, image, image_count, error);
    if (code == WEFT_OK)
        code = allocate(&pass, error);
    if (code == WEFT_OK)
        code = read_bands(&pass, what, progress, error);
    if (code == WEFT_OK) {
        drop_empty_slots(&pass);
        code = summarise(&pass, error);
    }
    if (code == WEFT_OK && certificate)
        code = measure_coverage(&pass, error);
    free(pass.half_width);
    free(pass.samples);
    free(pass.mask);
    free(pass.value);
    free(pass.view_ring);
    free(pass.light_ring);
    free(pass.every_image);
    if (code != WEFT_OK)
        weft_measurement_free(measurement);
    return code;
}

void weft_measurement_free(weft_measurement *measurement)
{
    for (int i = 0; i < measurement->pair_count; i++)
        weft_image_pair_free(&measurement->pair[i]);
    free(measurement->pair);
    *measurement = (weft_measurement){0};
}
