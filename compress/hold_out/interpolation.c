#include "compress/hold_out/trial.h"

#include "evaluate/raw_directions.h"
#include "evaluate/texels_around.h"
#include "reflectance/relief/relief.h"

#include <math.h>
#include <stdlib.h>

/* The views around an image, and in each the lights around its own: places among the images of the view. */
typedef struct seen_image {
    int view[3]; /* -1: none */
    weft_real weight[3];
    weft_barycentric light[3];
} seen_image;

struct weft_interpolation {
    const weft_texel_subset *subset;
    const int *image; /* [count] */
    int count;
    weft_view_order order;
    weft_raw_stencil *stencil; /* [count] of a far dataset, where all texels have the same; else NULL */
    weft_relief relief;        /* through which all is seen; of no view without */
    seen_image *seen;          /* [count] through it; else NULL */
};

static weft_raw_stencil find_stencil(const weft_interpolation *interpolation, const weft_raw_directions *directions,
                                     int image, int x, int y)
{
    const weft_dataset_layout *layout = &interpolation->subset->layout;
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
        weft_raw_directions_create(&interpolation->subset->layout, &interpolation->order, 0, 0, &directions, error));
    for (int i = 0; i < interpolation->count; i++)
        interpolation->stencil[i] = find_stencil(interpolation, &directions, interpolation->image[i], 0, 0);
    weft_raw_directions_free(&directions);
    return WEFT_OK;
}

static seen_image see_image(const weft_interpolation *interpolation, const weft_raw_directions *directions, int image)
{
    const weft_dataset_layout *layout = &interpolation->subset->layout;
    weft_barycentric views = weft_triangulation_lookup(directions->views, layout->view[layout->view_of_image[image]]);
    seen_image seen = {{-1, -1, -1}, {0}, {{{0}, {0}}}};
    for (int i = 0; i < 3; i++) {
        if (views.index[i] < 0)
            continue;
        seen.view[i] = directions->view_of[views.index[i]];
        seen.weight[i] = views.weight[i];
        seen.light[i] = weft_triangulation_lookup(directions->lights[seen.view[i]], layout->light[image]);
    }
    return seen;
}

static weft_code see_images(weft_interpolation *interpolation, weft_error *error)
{
    const weft_texel_subset *subset = interpolation->subset;
    const weft_dataset_heights *surface = &subset->surface;
    const weft_dataset_layout *layout = &subset->layout;
    weft_raw_directions directions;
    interpolation->seen = calloc((size_t)interpolation->count, sizeof *interpolation->seen);
    if (!interpolation->seen)
        return weft_fail_memory(error, "interpolation", (size_t)interpolation->count * sizeof(seen_image));
    weft_height_field field =
        weft_height_field_of(surface->value, surface->width, surface->height, subset->whole_mm[0], subset->whole_mm[1]);
    WEFT_TRY(weft_relief_create(&field, layout->view, layout->view_count, &interpolation->relief, error));
    WEFT_TRY(weft_raw_directions_create(layout, &interpolation->order, 0, 0, &directions, error));
    for (int i = 0; i < interpolation->count && directions.views; i++)
        interpolation->seen[i] = see_image(interpolation, &directions, interpolation->image[i]);
    weft_raw_directions_free(&directions);
    return WEFT_OK;
}

weft_code weft_interpolation_create(const weft_texel_subset *subset, const uint8_t *held_out, const int *image,
                                    int count, bool through, weft_interpolation **result, weft_error *error)
{
    weft_interpolation *interpolation = calloc(1, sizeof *interpolation);
    if (!interpolation)
        return weft_fail_memory(error, "interpolation", sizeof *interpolation);
    *interpolation = (weft_interpolation){.subset = subset, .image = image, .count = count};
    weft_code code = weft_view_order_create(&subset->layout, held_out, &interpolation->order, error);
    if (code == WEFT_OK && through)
        code = see_images(interpolation, error);
    else if (code == WEFT_OK && subset->layout.distance == WEFT_FAR)
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
    weft_relief_free(&interpolation->relief);
    free(interpolation->seen);
    free(interpolation);
}

/* The cosine that samples of an image hold as a factor. */
static double cosine_of(const weft_dataset_layout *layout, int image, int x, int y)
{
    return layout->values == WEFT_REFLECTANCE_COSINE ? (double)weft_dataset_light_direction(layout, image, x, y).z : 1;
}

/* Weighted sum of valid samples without their cosine. */
typedef struct blend {
    double sum[3], weights;
} blend;

static void add_sample(const weft_texel_subset *subset, int image, int x, int y, double weight, blend *b)
{
    const weft_dataset_layout *layout = &subset->layout;
    size_t texel = (size_t)y * (size_t)layout->width + (size_t)x,
           at = texel * (size_t)layout->image_count + (size_t)image;
    double cosine = cosine_of(layout, image, x, y);
    if (subset->mask[at] || !(cosine > 0))
        return;
    for (size_t c = 0; c < 3; c++)
        b->sum[c] += weight / cosine * (double)weft_float_of_half(subset->samples[3 * at + c]);
    b->weights += weight;
}

/* In the quantity of the dataset; NaN of nothing. */
static weft_rgb value_of(const blend *b, double cosine)
{
    double scale = b->weights > 0 ? cosine / b->weights : NAN;
    return (weft_rgb){scale * b->sum[0], scale * b->sum[1], scale * b->sum[2]};
}

static weft_rgb interpolate(const weft_texel_subset *subset, const weft_raw_stencil *stencil, int image, int x, int y)
{
    blend b = {0};
    for (int i = 0; i < stencil->count; i++)
        add_sample(subset, stencil->image[i], x, y, stencil->weight[i], &b);
    return value_of(&b, cosine_of(&subset->layout, image, x, y));
}

/* ---- Through the surface ---- */

/* What one view saw at a tap. */
static void add_tap(const weft_interpolation *interpolation, int view, const weft_barycentric *light,
                    const weft_relief_tap *tap, blend *b)
{
    const int *image = interpolation->order.image + interpolation->order.first[view];
    weft_texels_around at = weft_texels_around_place(&interpolation->subset->layout, tap->u, tap->v);
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3 && at.weight[k] > 0; i++)
            if (light->index[i] >= 0 && light->weight[i] > 0)
                add_sample(interpolation->subset, image[light->index[i]], at.x[k], at.y[k],
                           (double)(tap->weight * light->weight[i]) * at.weight[k], b);
}

static weft_rgb look_through(const weft_interpolation *interpolation, const seen_image *seen,
                             const weft_relief_tap tap[3], double cosine)
{
    blend b = {0};
    for (int i = 0; i < 3; i++) {
        if (!(tap[i].weight > 0))
            continue;
        if (isnan(tap[i].u) || isnan(tap[i].v))
            return (weft_rgb){NAN, NAN, NAN};
        add_tap(interpolation, seen->view[i], &seen->light[i], &tap[i], &b);
    }
    return value_of(&b, cosine);
}

static void predict_through(const weft_interpolation *interpolation, int x, int y, weft_rgb *prediction)
{
    const weft_texel_subset *subset = interpolation->subset;
    const weft_dataset_layout *layout = &subset->layout;
    weft_relief_tap tap[3] = {0};
    for (int i = 0, view = -1; i < interpolation->count; i++) {
        const seen_image *seen = &interpolation->seen[i];
        int image = interpolation->image[i];
        if (layout->view_of_image[image] != view) {
            view = layout->view_of_image[image];
            weft_window_taps(&interpolation->relief, &subset->window, layout->width, layout->height, x, y,
                             layout->view[view], seen->view, seen->weight, tap);
        }
        prediction[i] = look_through(interpolation, seen, tap, cosine_of(layout, image, x, y));
    }
}

weft_code weft_interpolation_predict(const weft_interpolation *interpolation, int x, int y, weft_rgb *prediction,
                                     weft_error *error)
{
    const weft_texel_subset *subset = interpolation->subset;
    weft_raw_directions own = {0};
    if (interpolation->seen) {
        predict_through(interpolation, x, y, prediction);
        return WEFT_OK;
    }
    if (!interpolation->stencil)
        WEFT_TRY(weft_raw_directions_create(&subset->layout, &interpolation->order, x, y, &own, error));
    for (int i = 0; i < interpolation->count; i++) {
        int image = interpolation->image[i];
        weft_raw_stencil stencil =
            interpolation->stencil ? interpolation->stencil[i] : find_stencil(interpolation, &own, image, x, y);
        prediction[i] = interpolate(subset, &stencil, image, x, y);
    }
    weft_raw_directions_free(&own);
    return WEFT_OK;
}
