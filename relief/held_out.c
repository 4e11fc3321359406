#include "relief/height_map.h"

#include "btf/direction/triangulation.h"
#include "reflectance/relief/relief.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of half a degree: how far a direction may lie from what its triangle gives. */
#define SAME_COSINE 0.99996192306

double weft_held_out_error(const weft_held_out *held_out)
{
    return held_out->energy > 0 ? sqrt(held_out->residual / held_out->energy) : 0;
}

/* The neighbours of a view among the others. */
static weft_code find_neighbours(const weft_features *features, int view, weft_vec3 *scratch, weft_left_out *result,
                                 weft_error *error)
{
    int count = 0;
    for (int k = 0; k < features->view_count; k++)
        if (k != view)
            scratch[count++] = features->direction[k];
    weft_triangulation *others;
    WEFT_TRY(weft_triangulation_build(scratch, count, &others, error));
    weft_barycentric corners = weft_triangulation_lookup(others, features->direction[view]);
    weft_triangulation_free(others);
    *result = (weft_left_out){.view = view};
    for (int i = 0; i < 3; i++) {
        result->neighbour[i] = corners.index[i] + (corners.index[i] >= view);
        result->weight[i] = corners.weight[i];
    }
    return WEFT_OK;
}

/* Whether the neighbours, as weighted, lie around the view. */
static bool is_inside(const weft_features *features, const weft_left_out *left_out)
{
    weft_vec3 sum = {0, 0, 0};
    for (int i = 0; i < 3; i++)
        if (left_out->neighbour[i] >= 0)
            sum = weft_add(sum, weft_scale(features->direction[left_out->neighbour[i]], left_out->weight[i]));
    return weft_dot(weft_unit(sum), features->direction[left_out->view]) >= SAME_COSINE;
}

weft_code weft_left_out_find(const weft_features *features, weft_left_out *result, int *count, weft_error *error)
{
    size_t bytes = (size_t)features->view_count * sizeof(weft_vec3);
    weft_vec3 *scratch = malloc(bytes);
    if (!scratch)
        return weft_fail_memory(error, "views", bytes);
    weft_code code = WEFT_OK;
    *count = 0;
    for (int view = 0; view < features->view_count && code == WEFT_OK; view++) {
        if (features->direction[view].z < WEFT_HELD_OUT_STEEPEST_COSINE)
            continue;
        code = find_neighbours(features, view, scratch, &result[*count], error);
        *count += code == WEFT_OK && is_inside(features, &result[*count]);
    }
    free(scratch);
    return code;
}

/* ---- One view ---- */

static int wrapped(int index, int count)
{
    return ((index % count) + count) % count;
}

/* Bilinear; false where a texel around the place is unknown or outside. */
static bool sample_feature(const weft_features *features, int view, weft_real u, weft_real v, float *result)
{
    weft_real x = u * features->width - (weft_real)0.5, y = (1 - v) * features->height - (weft_real)0.5;
    int left = (int)floor(x), upper = (int)floor(y);
    float right = (float)(x - left), down = (float)(y - upper);
    memset(result, 0, WEFT_FEATURES * sizeof *result);
    for (int i = 0; i < 4; i++) {
        float weight = (i & 1 ? right : 1 - right) * (i & 2 ? down : 1 - down);
        int column = left + (i & 1), row = upper + (i >> 1);
        if (!(weight > 1e-6f))
            continue;
        if (features->repeats) {
            column = wrapped(column, features->width);
            row = wrapped(row, features->height);
        }
        if (!weft_feature_known(features, view, column, row))
            return false;
        const float *from = weft_feature_at(features, view, column, row);
        for (int k = 0; k < WEFT_FEATURES; k++)
            result[k] += weight * from[k];
    }
    return true;
}

/* The blend of the neighbours through (u, v); false where none of them knows it. */
static bool blend(const weft_features *features, const weft_relief *relief, const weft_left_out *left_out, weft_real u,
                  weft_real v, float *result)
{
    weft_relief_tap tap[3];
    float sum = 0;
    weft_relief_taps(relief, 1, u, v, features->direction[left_out->view], left_out->neighbour, left_out->weight, tap);
    memset(result, 0, WEFT_FEATURES * sizeof *result);
    for (int i = 0; i < 3; i++) {
        float value[WEFT_FEATURES], weight = (float)tap[i].weight;
        if (!(weight > 0) || !sample_feature(features, left_out->neighbour[i], tap[i].u, tap[i].v, value))
            continue;
        sum += weight;
        for (int k = 0; k < WEFT_FEATURES; k++)
            result[k] += weight * value[k];
    }
    for (int k = 0; k < WEFT_FEATURES && sum > 0; k++)
        result[k] /= sum;
    return sum > 0;
}

static void add_texel(const weft_features *features, const weft_relief *relief, const weft_left_out *left_out, int x,
                      int y, weft_held_out *held_out)
{
    float predicted[WEFT_FEATURES];
    weft_real u = (x + (weft_real)0.5) / features->width, v = 1 - (y + (weft_real)0.5) / features->height;
    if (!weft_feature_known(features, left_out->view, x, y) || !blend(features, relief, left_out, u, v, predicted))
        return;
    const float *truth = weft_feature_at(features, left_out->view, x, y);
    for (int k = 0; k < WEFT_FEATURES; k++) {
        double apart = (double)(predicted[k] - truth[k]);
        held_out->residual += apart * apart;
        held_out->energy += (double)truth[k] * (double)truth[k];
    }
}

static weft_held_out predict(const weft_features *features, const weft_relief *relief, const weft_left_out *left_out,
                             long most_texels)
{
    weft_held_out result = {0};
    long texels = (long)features->width * features->height, step = texels / most_texels + 1;
    for (long i = 0; i < texels; i += step)
        add_texel(features, relief, left_out, (int)(i % features->width), (int)(i / features->width), &result);
    return result;
}

weft_code weft_held_out_predict(const weft_features *features, const float *height_mm, int width, int height,
                                const weft_left_out *left_out, int count, long most_texels, weft_held_out *result,
                                weft_error *error)
{
    weft_height_field field = weft_height_field_of(height_mm, width, height, features->width_mm, features->height_mm);
    weft_relief relief;
    WEFT_TRY(weft_relief_create(&field, features->direction, features->view_count, &relief, error));
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < count; i++)
        result[i] = predict(features, &relief, &left_out[i], most_texels);
    weft_relief_free(&relief);
    return WEFT_OK;
}
