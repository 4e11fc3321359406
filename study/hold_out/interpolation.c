#include "study/hold_out/interpolation.h"

#include "study/model/raw_directions.h"

#include <math.h>
#include <stdlib.h>

struct weft_interpolation {
    const weft_excerpt *excerpt;
    const int *image; /* [count] */
    int count;
    weft_view_order order;
    weft_raw_stencil *stencil; /* [count] of a far dataset, where all texels have the same; else NULL */
};

static weft_raw_stencil find_stencil(const weft_interpolation *interpolation, const weft_raw_directions *directions,
                                     int image, int x, int y)
{
    const weft_dataset_layout *layout = &interpolation->excerpt->layout;
    return weft_raw_stencil_of(directions, &interpolation->order, weft_dataset_light_direction(layout, image, x, y),
                               weft_dataset_view_direction(layout, layout->view_of_image[image], x, y));
}

static weft_code find_stencils(weft_interpolation *interpolation, weft_error *error)
{
    weft_raw_directions directions;
    interpolation->stencil = calloc((size_t)interpolation->count, sizeof *interpolation->stencil);
    if (!interpolation->stencil)
        return weft_fail_memory(error, "interpolation", (size_t)interpolation->count * sizeof(weft_raw_stencil));
    WEFT_TRY(
        weft_raw_directions_create(&interpolation->excerpt->layout, &interpolation->order, 0, 0, &directions, error));
    for (int i = 0; i < interpolation->count; i++)
        interpolation->stencil[i] = find_stencil(interpolation, &directions, interpolation->image[i], 0, 0);
    weft_raw_directions_free(&directions);
    return WEFT_OK;
}

weft_code weft_interpolation_create(const weft_excerpt *excerpt, const uint8_t *held_out, const int *image, int count,
                                    weft_interpolation **result, weft_error *error)
{
    weft_interpolation *interpolation = calloc(1, sizeof *interpolation);
    if (!interpolation)
        return weft_fail_memory(error, "interpolation", sizeof *interpolation);
    *interpolation = (weft_interpolation){.excerpt = excerpt, .image = image, .count = count};
    weft_code code = weft_view_order_create(&excerpt->layout, held_out, &interpolation->order, error);
    if (code == WEFT_OK && excerpt->layout.distance == WEFT_FAR)
        code = find_stencils(interpolation, error);
    if (code == WEFT_OK)
        *result = interpolation;
    else
        weft_interpolation_free(interpolation);
    return code;
}

void weft_interpolation_free(weft_interpolation *interpolation)
{
    if (!interpolation)
        return;
    weft_view_order_free(&interpolation->order);
    free(interpolation->stencil);
    free(interpolation);
}

/* The cosine that samples of an image hold as a factor. */
static double cosine_of(const weft_dataset_layout *layout, int image, int x, int y)
{
    return layout->values == WEFT_REFLECTANCE_COSINE ? (double)weft_dataset_light_direction(layout, image, x, y).z : 1;
}

static weft_rgb interpolate(const weft_excerpt *excerpt, const weft_raw_stencil *stencil, int image, int x, int y)
{
    const weft_dataset_layout *layout = &excerpt->layout;
    size_t texel = ((size_t)y * (size_t)layout->width + (size_t)x) * (size_t)layout->image_count;
    double sum[3] = {0}, weights = 0;
    for (int i = 0; i < stencil->count; i++) {
        size_t at = texel + (size_t)stencil->image[i];
        double cosine = cosine_of(layout, stencil->image[i], x, y);
        if (excerpt->mask[at] || !(cosine > 0))
            continue;
        for (size_t c = 0; c < 3; c++)
            sum[c] += stencil->weight[i] / cosine * (double)weft_float_of_half(excerpt->samples[3 * at + c]);
        weights += stencil->weight[i];
    }
    double scale = weights > 0 ? cosine_of(layout, image, x, y) / weights : NAN;
    return (weft_rgb){scale * sum[0], scale * sum[1], scale * sum[2]};
}

weft_code weft_interpolation_predict(const weft_interpolation *interpolation, int x, int y, weft_rgb *prediction,
                                     weft_error *error)
{
    const weft_excerpt *excerpt = interpolation->excerpt;
    weft_raw_directions own = {0};
    if (!interpolation->stencil)
        WEFT_TRY(weft_raw_directions_create(&excerpt->layout, &interpolation->order, x, y, &own, error));
    for (int i = 0; i < interpolation->count; i++) {
        int image = interpolation->image[i];
        weft_raw_stencil stencil =
            interpolation->stencil ? interpolation->stencil[i] : find_stencil(interpolation, &own, image, x, y);
        prediction[i] = interpolate(excerpt, &stencil, image, x, y);
    }
    weft_raw_directions_free(&own);
    return WEFT_OK;
}
