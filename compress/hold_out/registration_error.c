#include "compress/hold_out/certify.h"

#include "base/text/json_text.h"
#include "compress/hold_out/texel_subset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, ENOUGH_IMAGES = 1024 };

static const double deviations = 1.96; /* of a normal distribution hold 95 % */

/* ---- What the dataset says ---- */

/* Of each view [view_count] the largest standard error of its stays, texels; 0 where none is known. */
static bool read_stays(const json_t *stays, int view_count, double *displacement)
{
    bool known = false;
    for (size_t i = 0; i < json_array_size(stays); i++) {
        const json_t *stay = json_array_get(stays, i);
        json_int_t view = json_integer_value(json_object_get(stay, "view"));
        double texels = json_number_value(json_object_get(stay, "standard_error_texels"));
        if (view < 0 || view >= view_count || !(texels > 0) || json_integer_value(json_object_get(stay, "used")) < 1)
            continue;
        displacement[view] = fmax(displacement[view], texels);
        known = true;
    }
    return known;
}

static weft_code read_displacements(const weft_dataset_layout *layout, double *displacement, bool *known,
                                    weft_error *error)
{
    errno = 0;
    json_t *provenance = json_loads(layout->provenance, JSON_DECODE_ANY, NULL);
    if (!provenance && errno == ENOMEM)
        return weft_fail_memory(error, "provenance", strlen(layout->provenance));
    *known = read_stays(json_object_get(provenance, "stays"), layout->view_count, displacement);
    json_decref(provenance);
    return WEFT_OK;
}

/* ---- Gradients ---- */

/* One channel of one image of a level, NaN where it is masked. */
typedef struct plane {
    int width, height;
    float value[SIDE * SIDE];
} plane;

static plane plane_of(const weft_texel_subset *subset, int image, size_t channel)
{
    const weft_dataset_layout *layout = &subset->layout;
    plane p = {.width = layout->width, .height = layout->height};
    double cosine = (double)weft_dataset_light_direction(layout, image, p.width / 2, p.height / 2).z;
    for (size_t texel = 0; texel < (size_t)p.width * (size_t)p.height; texel++) {
        size_t at = texel * (size_t)layout->image_count + (size_t)image;
        double sample = (double)weft_float_of_half(subset->samples[3 * at + channel]);
        if (layout->values == WEFT_REFLECTANCE)
            sample *= cosine;
        p.value[texel] = subset->mask[at] ? NAN : (float)sample;
    }
    return p;
}

static void halve(plane *p)
{
    int width = p->width / 2, height = p->height / 2;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float *at = p->value + 2 * y * p->width + 2 * x;
            p->value[y * width + x] = (at[0] + at[1] + at[p->width] + at[p->width + 1]) / 4;
        }
    p->width = width;
    p->height = height;
}

/* ---- Shares ---- */

/* Squares of what a displacement does, in half widths. */
typedef struct ring_sums {
    double square[WEFT_RING_COUNT], count[WEFT_RING_COUNT];
} ring_sums;

typedef struct view_of_plane {
    weft_vec3 light, view;
    double displacement; /* texels of the level */
    int ring, level;
} view_of_plane;

static void add_plane(const plane *p, const view_of_plane *seen, const weft_certificate *c, ring_sums *sums)
{
    for (int y = 0; y + 1 < p->height; y++)
        for (int x = 0; x + 1 < p->width; x++) {
            const float *at = p->value + y * p->width + x;
            double across = (double)at[1] - (double)at[0], down = (double)at[p->width] - (double)at[0];
            double half_width = weft_certificate_half_width(c, seen->level, (double)at[0], seen->light, seen->view);
            double share = seen->displacement * hypot(across, down) / half_width;
            if (!isfinite(share))
                continue;
            sums->square[seen->ring] += share * share;
            sums->count[seen->ring] += 1;
        }
}

static void add_image(const weft_texel_subset *subset, int image, double displacement, const weft_certificate *c,
                      ring_sums sums[WEFT_MATERIAL_MAX_LEVELS])
{
    const weft_dataset_layout *layout = &subset->layout;
    int x = layout->width / 2, y = layout->height / 2;
    view_of_plane seen = {.light = weft_dataset_light_direction(layout, image, x, y),
                          .view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y)};
    seen.ring = weft_ubo81_ring(weft_angles_of_direction(seen.view).theta_rad);
    for (size_t channel = 0; channel < 3; channel++) {
        plane p = plane_of(subset, image, channel);
        for (seen.level = 0; seen.level < c->level_count; seen.level++) {
            seen.displacement = displacement / (1 << seen.level);
            add_plane(&p, &seen, c, &sums[seen.level]);
            halve(&p);
        }
    }
}

static void take_shares(const ring_sums sums[WEFT_MATERIAL_MAX_LEVELS], weft_certificate *c)
{
    for (int k = 0; k < c->level_count; k++)
        for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
            if (sums[k].count[ring] > 0)
                c->level[k].registration[ring] = deviations * sqrt(sums[k].square[ring] / sums[k].count[ring]);
            else if (k > 0) /* the block has no more squares: as one level finer */
                c->level[k].registration[ring] = c->level[k - 1].registration[ring];
        }
    c->has_registration = true;
    weft_certificate_round(c);
}

static weft_code certify(weft_dataset *dataset, const double *displacement, weft_certificate *c, weft_error *error)
{
    weft_texel_subset subset;
    ring_sums sums[WEFT_MATERIAL_MAX_LEVELS] = {0};
    WEFT_TRY(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, SIDE, &subset, error));
    /* Odd, so that it goes through all lights of a view in the course of the views. */
    int stride = (subset.layout.image_count / ENOUGH_IMAGES) | 1;
    for (int image = 0; image < subset.layout.image_count; image += stride) {
        double texels = displacement[subset.layout.view_of_image[image]];
        if (texels > 0)
            add_image(&subset, image, texels, c, sums);
    }
    weft_texel_subset_free(&subset);
    take_shares(sums, c);
    return WEFT_OK;
}

weft_code weft_certify_registration(weft_dataset *dataset, weft_certificate *c, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    bool known = false;
    double *displacement = calloc((size_t)layout->view_count, sizeof *displacement);
    if (!displacement)
        return weft_fail_memory(error, "displacements", (size_t)layout->view_count * sizeof *displacement);
    weft_code code = read_displacements(layout, displacement, &known, error);
    if (code == WEFT_OK && known)
        code = certify(dataset, displacement, c, error);
    free(displacement);
    return code;
}
