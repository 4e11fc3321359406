#include "evaluate/error/predictor.h"

#include "reflectance/components/components.h"
#include "reflectance/lafortune/lafortune.h"
#include "reflectance/weave/batch.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

typedef void predict_function(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                              weft_rgb *prediction);

struct weft_predictor {
    predict_function *predict;
    const weft_dataset_layout *layout;
    const weft_material *material;
    weft_table_directions directions; /* of the material */
    weft_component_maps maps;         /* of its components, where directions differ from texel to texel */
    float *factor; /* of its components: [image][layer][3], and through heights [image][3 views][layer][3]; NULL
                      without, and beside maps */
    weft_material_relief relief;  /* through which the components are seen; of no view without */
    weft_barycentric *around;     /* [view] its stored views */
    weft_predicted_window window; /* of the heights, where the dataset lies */
    const weft_weave *weave;
    weft_woven_table *table; /* of the weave */
    weft_weave_layout tiles;
    weft_prepared_cloth threads;
    weft_dataset *other;
    int first_row;
    weft_half *samples; /* given, or of the other dataset: [rows][width][image_count][3] */
    uint8_t *mask;
};

static weft_code create(const weft_dataset_layout *layout, predict_function *predict, weft_predictor **result,
                        weft_error *error)
{
    *result = calloc(1, sizeof **result);
    if (!*result)
        return weft_fail_memory(error, "predictor", sizeof **result);
    (*result)->predict = predict;
    (*result)->layout = layout;
    return WEFT_OK;
}

void weft_predictor_free(weft_predictor *predictor)
{
    if (!predictor)
        return;
    weft_table_directions_free(&predictor->directions);
    weft_component_maps_free(&predictor->maps);
    free(predictor->factor);
    weft_material_relief_free(&predictor->relief);
    free(predictor->around);
    weft_woven_table_free(predictor->table);
    weft_dataset_close(predictor->other);
    free(predictor->samples);
    free(predictor->mask);
    free(predictor);
}

void weft_predictor_predict(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                            weft_rgb *prediction)
{
    predictor->predict(predictor, x, y, image, image_count, prediction);
}

/* Of a sample for a BRDF of 1 / pi, in the quantity of the dataset. */
static double quantity(const weft_dataset_layout *layout, weft_vec3 light)
{
    return layout->values == WEFT_REFLECTANCE_COSINE ? light.z : 1;
}

static weft_rgb scaled(double factor, weft_rgb value)
{
    return (weft_rgb){factor * value.r, factor * value.g, factor * value.b};
}

/* ---- Material ---- */

static void predict_by_material(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                                weft_rgb *prediction)
{
    const weft_dataset_layout *layout = predictor->layout;
    for (int i = 0; i < image_count; i++) {
        weft_vec3 light = weft_dataset_light_direction(layout, image[i], x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image[i]], x, y);
        weft_rgba value = weft_material_texel(predictor->material, &predictor->directions, 0, x, y, light, view);
        prediction[i] = scaled(quantity(layout, light), (weft_rgb){value.r, value.g, value.b});
    }
}

/* ---- Components of a material ---- */

static void predict_by_components(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                                  weft_rgb *prediction)
{
    const weft_dataset_layout *layout = predictor->layout;
    const weft_components *components = predictor->material->components;
    size_t series = 3 * (size_t)components->component_count;
    float own[3 * WEFT_COMPONENTS_MAX];
    for (int i = 0; i < image_count; i++) {
        weft_vec3 light = weft_dataset_light_direction(layout, image[i], x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image[i]], x, y);
        const float *factor = predictor->factor ? predictor->factor + (size_t)image[i] * series : own;
        if (!predictor->factor)
            weft_component_factors(&predictor->maps, light, view, own);
        weft_rgb value = weft_components_texel(components, components->component_count, factor, 0, x, y, light.z);
        prediction[i] = light.z > 0 && view.z > 0 ? scaled(quantity(layout, light) / light.z, value) : (weft_rgb){0};
    }
}

/* ---- Components through heights ---- */

/* The taps of a view from texel (x, y), in coordinates of the window. */
static void find_taps(const weft_predictor *predictor, int view, int x, int y, weft_relief_tap tap[3])
{
    const weft_dataset_layout *layout = predictor->layout;
    const weft_barycentric *around = &predictor->around[view];
    weft_window_taps(&predictor->relief.relief, &predictor->window, layout->width, layout->height, x, y,
                     layout->view[view], around->index, around->weight, tap);
}

static weft_rgb sample_taps(const weft_predictor *predictor, const weft_relief_tap tap[3], const float *factor,
                            weft_real light_z)
{
    const weft_components *components = predictor->material->components;
    weft_rgb sum = {0};
    for (int i = 0; i < 3; i++) {
        if (!(tap[i].weight > 0))
            continue;
        if (isnan(tap[i].u) || isnan(tap[i].v))
            return (weft_rgb){NAN, NAN, NAN};
        weft_rgb value = weft_components_sample(components, components->component_count,
                                                factor + 3 * (size_t)i * (size_t)components->component_count, 0,
                                                tap[i].u, tap[i].v, light_z);
        sum.r += tap[i].weight * value.r;
        sum.g += tap[i].weight * value.g;
        sum.b += tap[i].weight * value.b;
    }
    return sum;
}

static void predict_through_heights(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                                    weft_rgb *prediction)
{
    const weft_dataset_layout *layout = predictor->layout;
    size_t series = 9 * (size_t)predictor->material->components->component_count;
    weft_relief_tap tap[3] = {0};
    for (int i = 0, view = -1; i < image_count; i++) {
        weft_vec3 light = layout->light[image[i]];
        if (layout->view_of_image[image[i]] != view) {
            view = layout->view_of_image[image[i]];
            find_taps(predictor, view, x, y, tap);
        }
        weft_rgb value = sample_taps(predictor, tap, predictor->factor + (size_t)image[i] * series, light.z);
        prediction[i] = light.z > 0 ? scaled(quantity(layout, light) / light.z, value) : (weft_rgb){0};
    }
}

static weft_code prepare_heights(weft_predictor *predictor, weft_error *error)
{
    const weft_dataset_layout *layout = predictor->layout;
    size_t series = 3 * (size_t)predictor->material->components->component_count, views = (size_t)layout->view_count;
    size_t bytes = 3 * (size_t)layout->image_count * series * sizeof(float);
    WEFT_TRY(weft_material_relief_create(predictor->material, &predictor->relief, error));
    WEFT_TRY(weft_component_maps_keep_views(&predictor->maps, error));
    predictor->predict = predict_through_heights;
    predictor->around = calloc(views, sizeof *predictor->around);
    predictor->factor = calloc(1, bytes);
    if (!predictor->around || !predictor->factor)
        return weft_fail_memory(error, "factors of components", bytes);
    for (int view = 0; view < layout->view_count; view++)
        predictor->around[view] = weft_triangulation_lookup(predictor->relief.views, layout->view[view]);
    for (int i = 0; i < layout->image_count; i++)
        for (int k = 0; k < 3; k++) {
            int stored = predictor->around[layout->view_of_image[i]].index[k];
            if (stored >= 0)
                weft_component_factors_of_view(&predictor->maps, layout->light[i], stored,
                                               predictor->factor + (3 * (size_t)i + (size_t)k) * series);
        }
    weft_component_maps_free(&predictor->maps);
    return WEFT_OK;
}

/* ---- Components, however seen ---- */

/* In a far dataset all texels see an image under the same light and view. */
static weft_code prepare_far_components(weft_predictor *predictor, weft_error *error)
{
    const weft_dataset_layout *layout = predictor->layout;
    size_t series = 3 * (size_t)predictor->material->components->component_count;
    size_t bytes = (size_t)layout->image_count * series * sizeof(float);
    predictor->factor = malloc(bytes);
    if (!predictor->factor)
        return weft_fail_memory(error, "factors of components", bytes);
    for (int i = 0; i < layout->image_count; i++)
        weft_component_factors(&predictor->maps, weft_dataset_light_direction(layout, i, 0, 0),
                               weft_dataset_view_direction(layout, layout->view_of_image[i], 0, 0),
                               predictor->factor + (size_t)i * series);
    weft_component_maps_free(&predictor->maps);
    return WEFT_OK;
}

static weft_code prepare_components(weft_predictor *predictor, weft_error *error)
{
    WEFT_TRY(weft_component_maps_create(predictor->material->components, &predictor->maps, error));
    predictor->predict = predict_by_components;
    if (predictor->material->heights && predictor->layout->distance == WEFT_FAR)
        return prepare_heights(predictor, error);
    return predictor->layout->distance == WEFT_FAR ? prepare_far_components(predictor, error) : WEFT_OK;
}

weft_code weft_predictor_of_material(const weft_dataset_layout *layout, const weft_material *material,
                                     weft_predictor **result, weft_error *error)
{
    const weft_predicted_window whole = {0, 0, layout->width, layout->height};
    return weft_predictor_of_window(layout, &whole, material, result, error);
}

weft_code weft_predictor_of_window(const weft_dataset_layout *layout, const weft_predicted_window *window,
                                   const weft_material *material, weft_predictor **result, weft_error *error)
{
    if (material->level[0].width != layout->width || material->level[0].height != layout->height)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "the dataset has %d x %d texels, but the material %d x %d: it is not made from it",
                         layout->width, layout->height, material->level[0].width, material->level[0].height);
    WEFT_TRY(create(layout, predict_by_material, result, error));
    (*result)->material = material;
    (*result)->window = *window;
    weft_code code = weft_table_directions_create(material, &(*result)->directions, error);
    if (code == WEFT_OK && material->components)
        code = prepare_components(*result, error);
    if (code != WEFT_OK)
        weft_predictor_free(*result);
    return code;
}

/* ---- Weave ---- */

enum { SIDE = 4, POINTS = SIDE * SIDE };

static void locate_points(const weft_predictor *predictor, int x, int y, weft_weave_point point[POINTS])
{
    const weft_weave_layout *tiles = &predictor->tiles;
    const weft_predicted_window *window = &predictor->window;
    double texel_u = tiles->tiles_u / window->whole_width;
    double texel_v = tiles->tiles_v / window->whole_height;
    for (int i = 0; i < POINTS; i++) {
        double across = window->x + x + (i % SIDE + 0.5) / SIDE, down = window->y + y + (i / SIDE + 0.5) / SIDE;
        point[i] = weft_weave_locate(predictor->weave, across * texel_u - tiles->corner_u,
                                     tiles->tiles_v - down * texel_v - tiles->corner_v, 0);
    }
}

/* The mean BRDF of the points in one image. */
static weft_rgb mean_of_points(const weft_predictor *predictor, const weft_weave_point point[POINTS], weft_vec3 light,
                               weft_vec3 view)
{
    weft_weave_batch batch;
    weft_rgb sum = {0};
    if (!(light.z > 0 && view.z > 0))
        return sum;
    batch.count = 0;
    for (int i = 0; i < POINTS; i++)
        weft_weave_batch_put(&batch, &point[i], light, view);
    weft_weave_specular_batch(predictor->table, &batch);
    for (int i = 0; i < POINTS; i++) {
        const weft_yarn *yarn = &predictor->weave->yarn[point[i].yarn];
        weft_rgb brdf = weft_weave_shade(predictor->weave, yarn, (weft_real)batch.specular[i]);
        sum = (weft_rgb){sum.r + brdf.r, sum.g + brdf.g, sum.b + brdf.b};
    }
    return scaled(1.0 / POINTS, sum);
}

static void predict_by_weave(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                             weft_rgb *prediction)
{
    const weft_dataset_layout *layout = predictor->layout;
    weft_weave_point point[POINTS];
    locate_points(predictor, x, y, point);
    for (int i = 0; i < image_count; i++) {
        weft_vec3 light = weft_dataset_light_direction(layout, image[i], x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image[i]], x, y);
        prediction[i] = scaled(WEFT_PI * quantity(layout, light), mean_of_points(predictor, point, light, view));
    }
}

weft_code weft_predictor_of_weave(const weft_dataset_layout *layout, const weft_predicted_window *window,
                                  const weft_weave *weave, const weft_weave_layout *tiles, weft_predictor **result,
                                  weft_error *error)
{
    WEFT_TRY(create(layout, predict_by_weave, result, error));
    (*result)->window = window ? *window : (weft_predicted_window){0, 0, layout->width, layout->height};
    (*result)->weave = weave;
    (*result)->tiles = *tiles;
    weft_code code = weft_woven_table_create(weave, &(*result)->table, error);
    if (code != WEFT_OK)
        weft_predictor_free(*result);
    return code;
}

/* ---- Microcylinder cloth ---- */

static void predict_by_threads(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                               weft_rgb *prediction)
{
    const weft_dataset_layout *layout = predictor->layout;
    for (int i = 0; i < image_count; i++) {
        weft_vec3 light = weft_dataset_light_direction(layout, image[i], x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image[i]], x, y);
        weft_rgb brdf = weft_microcylinder_brdf(&predictor->threads, WEFT_CLOTH_BY_AREA, light, view);
        prediction[i] = scaled(WEFT_PI * quantity(layout, light), brdf);
    }
}

weft_code weft_predictor_of_threads(const weft_dataset_layout *layout, const weft_microcylinder_cloth *cloth,
                                    weft_predictor **result, weft_error *error)
{
    WEFT_TRY(create(layout, predict_by_threads, result, error));
    (*result)->threads = weft_microcylinder_prepare(cloth);
    return WEFT_OK;
}

/* ---- Samples, and another dataset ---- */

static void predict_by_samples(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                               weft_rgb *prediction)
{
    const weft_dataset_layout *layout = predictor->layout;
    size_t texel = (size_t)(y - predictor->first_row) * (size_t)layout->width + (size_t)x;
    for (int i = 0; i < image_count; i++) {
        size_t sample = texel * (size_t)layout->image_count + (size_t)image[i];
        const weft_half *half = predictor->samples + 3 * sample;
        prediction[i] = (weft_rgb){(double)weft_float_of_half(half[0]), (double)weft_float_of_half(half[1]),
                                   (double)weft_float_of_half(half[2])};
    }
}

weft_code weft_predictor_of_samples(const weft_dataset_layout *layout, weft_half *samples, weft_predictor **result,
                                    weft_error *error)
{
    weft_code code = create(layout, predict_by_samples, result, error);
    if (code == WEFT_OK)
        (*result)->samples = samples;
    else
        free(samples);
    return code;
}

static bool same_place(weft_vec3 a, weft_vec3 b)
{
    return weft_length(weft_subtract(a, b)) < 1e-4 * (1 + weft_length(a));
}

static bool same_images(const weft_dataset_layout *a, const weft_dataset_layout *b)
{
    bool same = a->width == b->width && a->height == b->height && a->image_count == b->image_count &&
                a->values == b->values && a->distance == b->distance;
    for (int i = 0; same && i < a->image_count; i++)
        same = same_place(a->light[i], b->light[i]) &&
               same_place(a->view[a->view_of_image[i]], b->view[b->view_of_image[i]]);
    return same;
}

weft_code weft_predictor_of_dataset(const weft_dataset *dataset, const char *path, weft_predictor **result,
                                    weft_error *error)
{
    weft_predictor *predictor;
    WEFT_TRY(create(weft_dataset_get_layout(dataset), predict_by_samples, &predictor, error));
    weft_code code = weft_dataset_open(path, &predictor->other, error);
    if (code == WEFT_OK && !same_images(predictor->layout, weft_dataset_get_layout(predictor->other)))
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' does not have the texels, images and quantity of '%s'", path,
                         weft_dataset_path(dataset));
    if (code != WEFT_OK)
        weft_predictor_free(predictor);
    else
        *result = predictor;
    return code;
}

weft_code weft_predictor_prepare_rows(weft_predictor *predictor, int y, int rows, weft_error *error)
{
    const weft_dataset_layout *layout = predictor->layout;
    if (!predictor->other)
        return WEFT_OK;
    size_t count = (size_t)rows * (size_t)layout->width * (size_t)layout->image_count;
    free(predictor->samples);
    free(predictor->mask);
    predictor->samples = malloc(3 * count * sizeof *predictor->samples);
    predictor->mask = malloc(count);
    if (!predictor->samples || !predictor->mask)
        return weft_fail_memory(error, "rows of texels", 7 * count);
    predictor->first_row = y;
    return weft_dataset_read_block(predictor->other, 0, y, layout->width, rows, predictor->samples, predictor->mask,
                                   error);
}

/* ---- Window ---- */

static weft_real coordinate_in_window(weft_real whole, int first, int count, int texels)
{
    if (count == texels)
        return whole;
    weft_real place = (whole - floor(whole)) * texels - first;
    bool inside = place >= (weft_real)0.5 && place <= count - (weft_real)0.5;
    return inside ? place / count : (weft_real)NAN;
}

void weft_window_taps(const weft_relief *relief, const weft_predicted_window *window, int width, int height, int x,
                      int y, weft_vec3 view, const int index[3], const weft_real weight[3], weft_relief_tap tap[3])
{
    weft_real u = (window->x + x + (weft_real)0.5) / window->whole_width;
    weft_real v = 1 - (window->y + y + (weft_real)0.5) / window->whole_height;
    weft_relief_taps(relief, 1, u, v, view, index, weight, tap);
    for (int i = 0; i < 3; i++) {
        tap[i].u = coordinate_in_window(tap[i].u, window->x, width, window->whole_width);
        tap[i].v = 1 - coordinate_in_window(1 - tap[i].v, window->y, height, window->whole_height);
    }
}
