/* Which kind of maps a material has: decided by images that were held out. */
#include "compress/components/model.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64, EVERY = 10, LEAST_VIEWS = 20, LEAST_LIGHTS = 20, MOST_REFERENCES = 64 };

/* Between these there are measured directions on all sides: what is held out is interpolated, not extrapolated. Lights
 * this near to one that is held out are held out, too, so that jitter between views gives nothing away. */
static const double least_theta_deg = 10, most_theta_deg = 62, same_light_deg = 5;

static bool is_inside(weft_vec3 direction)
{
    double cosine = (double)direction.z;
    return cosine < cos(least_theta_deg * WEFT_PI / 180) && cosine > cos(most_theta_deg * WEFT_PI / 180);
}

/* Every tenth of the directions that lie inside. */
static int pick(const weft_vec3 *direction, int count, weft_vec3 *picked)
{
    int inside = 0, found = 0;
    for (int i = 0; i < count && found < MOST_REFERENCES; i++) {
        if (is_inside(direction[i]) && inside++ % EVERY == EVERY / 2)
            picked[found++] = direction[i];
    }
    return found;
}

static bool is_near(weft_vec3 direction, const weft_vec3 *picked, int count, double degrees)
{
    for (int i = 0; i < count; i++) {
        if ((double)weft_dot(direction, picked[i]) > cos(degrees * WEFT_PI / 180))
            return true;
    }
    return false;
}

/* ---- The split ---- */

typedef struct split {
    weft_component_images fitted; /* its own arrays, but `image` is an index into the images of the whole */
    int *held;                    /* [held_count] index into the images of the whole */
    weft_vec3 *held_view;         /* [held_count] */
    int held_count;
} split;

static void split_free(split *s)
{
    weft_component_images_free(&s->fitted);
    free(s->held);
    free(s->held_view);
}

static weft_code split_allocate(const weft_component_images *images, split *s, weft_error *error)
{
    size_t count = (size_t)images->image_count;
    *s = (split){.held = malloc(count * sizeof *s->held), .held_view = malloc(count * sizeof *s->held_view)};
    WEFT_TRY(weft_component_images_allocate(images->image_count, images->view_count, &s->fitted, error));
    return s->held && s->held_view ? WEFT_OK
                                   : weft_fail_memory(error, "images of components", count * sizeof *s->held_view);
}

static void add_view(const weft_component_images *images, int view, bool held_view, const weft_vec3 *lights,
                     int light_count, split *s)
{
    weft_component_images *fitted = &s->fitted;
    int before = fitted->image_count;
    for (int i = (int)images->first[view]; i < (int)images->first[view + 1]; i++) {
        if (held_view || is_near(images->light[i], lights, light_count, same_light_deg)) {
            s->held_view[s->held_count] = images->view[view];
            s->held[s->held_count++] = i;
        } else {
            weft_component_images_add(fitted, images, i, i);
        }
    }
    if (fitted->image_count == before)
        return;
    fitted->view[fitted->view_count] = images->view[view];
    fitted->first[++fitted->view_count] = (uint32_t)fitted->image_count;
}

static weft_code split_create(const weft_component_images *images, split *s, weft_error *error)
{
    weft_vec3 views[MOST_REFERENCES], lights[MOST_REFERENCES];
    int view_count = 0, light_count = 0, first_lights = (int)images->first[1];
    WEFT_TRY(split_allocate(images, s, error));
    if (images->view_count >= LEAST_VIEWS)
        view_count = pick(images->view, images->view_count, views);
    if (first_lights >= LEAST_LIGHTS)
        light_count = pick(images->light, first_lights, lights);
    for (int view = 0; view < images->view_count; view++)
        add_view(images, view, is_near(images->view[view], views, view_count, 1e-3), lights, light_count, s);
    s->fitted.length = (3 * (size_t)s->fitted.image_count + 15) / 16 * 16;
    return WEFT_OK;
}

/* ---- One kind ---- */

typedef struct squares {
    double error, sample;
} squares;

typedef struct trial {
    const weft_component_images *images;
    const weft_training *whole, *part;
    const weft_factorisation *components;
    const split *split;
    float *factor;      /* [layer][fitted length] */
    float *coefficient; /* [texel][layer] */
    squares *sum;       /* [held_count] over the texels */
} trial;

static weft_code find_coefficients(const trial *t, weft_error *error)
{
    weft_projector projector;
    int texels = t->part->texel_count, count = t->components->count;
    WEFT_TRY(weft_projector_create(t->components, t->factor, t->split->fitted.image_count, &projector, error));
    weft_code result = WEFT_OK;
#pragma omp parallel for schedule(dynamic, 8)
    for (int i = 0; i < texels; i++) {
        const float *vector = t->part->vector + (size_t)i * t->part->length;
        const uint8_t *valid = t->part->valid + (size_t)i * t->part->image_count;
        weft_error own = {0};
        weft_code code =
            weft_projector_solve(&projector, &vector, &valid, 1, t->coefficient + (size_t)i * (size_t)count, &own);
        if (code == WEFT_OK)
            continue;
#pragma omp critical(weft_find_coefficients)
        {
            result = code;
            *error = own;
        }
    }
    weft_projector_free(&projector);
    return result;
}

/* Sums over the texels for one image that was held out. */
static squares squares_of(const trial *t, const weft_component_maps *maps, int held)
{
    int image = t->split->held[held], count = t->components->count;
    float factor[3 * WEFT_COMPONENTS_MAX] = {0}, weight = t->images->weight[image];
    squares sum = {0};
    weft_component_factors(maps, t->images->light[image], t->split->held_view[held], factor);
    for (int texel = 0; texel < t->whole->texel_count; texel++) {
        const float *own = t->coefficient + (size_t)texel * (size_t)count;
        const float *sample = t->whole->vector + (size_t)texel * t->whole->length + 3 * (size_t)image;
        if (!t->whole->valid[(size_t)texel * t->whole->image_count + (size_t)image])
            continue;
        for (int c = 0; c < 3; c++) {
            float value = 0;
            for (int k = 0; k < count; k++)
                value += own[k] * factor[3 * k + c];
            double difference = (double)(weight * fmaxf(value, 0) - sample[c]);
            sum.error += difference * difference;
            sum.sample += (double)sample[c] * (double)sample[c];
        }
    }
    return sum;
}

/* Relative RMSE of the images that were held out. Images are added in their order, however many threads there are. */
static double error_of_held(const trial *t, const weft_component_maps *maps)
{
    squares all = {0};
#pragma omp parallel for schedule(dynamic, 8)
    for (int i = 0; i < t->split->held_count; i++)
        t->sum[i] = squares_of(t, maps, i);
    for (int i = 0; i < t->split->held_count; i++) {
        all.error += t->sum[i].error;
        all.sample += t->sum[i].sample;
    }
    return all.sample > 0 ? sqrt(all.error / all.sample) : 0;
}

static weft_code try_kind(const trial *t, weft_components_kind kind, double *error_of, weft_error *error)
{
    weft_components *components = NULL;
    weft_component_maps maps = {0};
    WEFT_TRY(weft_component_model_create(&t->split->fitted, t->components, kind, 1, 1, 1, &components, error));
    weft_code code = weft_component_maps_create(components, &maps, error);
    if (code == WEFT_OK) {
        weft_component_model_factors(&maps, &t->split->fitted, t->factor);
        code = find_coefficients(t, error);
    }
    *error_of = code == WEFT_OK ? error_of_held(t, &maps) : 0;
    weft_component_maps_free(&maps);
    weft_components_free(components);
    return code;
}

static weft_code try_all(trial *t, double error_of[WEFT_COMPONENTS_KINDS], weft_error *error)
{
    size_t factors = (size_t)t->components->count * t->part->length;
    t->factor = aligned_alloc(ALIGNMENT, factors * sizeof *t->factor);
    t->coefficient = calloc((size_t)t->part->texel_count * (size_t)t->components->count, sizeof *t->coefficient);
    t->sum = malloc((size_t)t->split->held_count * sizeof *t->sum);
    weft_code code = t->factor && t->coefficient && t->sum
                         ? WEFT_OK
                         : weft_fail_memory(error, "factors of components", factors * sizeof *t->factor);
    for (int kind = 0; kind < WEFT_COMPONENTS_KINDS && code == WEFT_OK; kind++)
        code = try_kind(t, (weft_components_kind)kind, &error_of[kind], error);
    free(t->factor);
    free(t->coefficient);
    free(t->sum);
    return code;
}

weft_code weft_component_model_choose(const weft_component_images *images, const weft_training *training,
                                      int component_count, weft_components_kind *kind,
                                      double error_of[WEFT_COMPONENTS_KINDS], weft_error *error)
{
    split s;
    weft_training part = {0};
    weft_factorisation components = {0};
    *kind = WEFT_COMPONENTS_OF_LIGHT;
    memset(error_of, 0, WEFT_COMPONENTS_KINDS * sizeof *error_of);
    weft_code code = split_create(images, &s, error);
    if (code == WEFT_OK && s.held_count > 0 && s.fitted.image_count > 0) {
        code = weft_training_subset(training, &s.fitted, s.fitted.image, &part, error);
        if (code == WEFT_OK)
            code = weft_factorisation_find(&part, component_count, &components, error);
        trial t = {.images = images, .whole = training, .part = &part, .components = &components, .split = &s};
        if (code == WEFT_OK)
            code = try_all(&t, error_of, error);
        for (int tried = 1; tried < WEFT_COMPONENTS_KINDS; tried++)
            *kind = error_of[tried] < error_of[*kind] ? (weft_components_kind)tried : *kind;
    }
    weft_factorisation_free(&components);
    weft_training_free(&part);
    split_free(&s);
    return code;
}
