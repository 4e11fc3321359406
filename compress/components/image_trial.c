#include "compress/components/image_trial.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    ALIGNMENT = 64,
    EVERY = 10,
    EVERY_OF_FEW = 5, /* where a tenth would be a few images */
    FEW_VIEWS = 4,
    LEAST_VIEWS = 20,
    LEAST_LIGHTS = 20,
    MOST_REFERENCES = 64,
    MOST_COMPARED = 600 /* images held out */
};

/* What a screen shows of a value. */
static const float screen_exponent = 2.4f;

/* Between these there are measured directions on all sides: what is held out is interpolated, not extrapolated. Lights
 * this near to one that is held out are held out, too, so that jitter between views gives nothing away. */
static const double least_theta_deg = 10, most_theta_deg = 62, same_light_deg = 5;

static bool is_inside(weft_vec3 direction)
{
    double cosine = (double)direction.z;
    return cosine < cos(least_theta_deg * WEFT_PI / 180) && cosine > cos(most_theta_deg * WEFT_PI / 180);
}

/* Every `every` of the directions that lie inside. */
static int pick(const weft_vec3 *direction, int count, int every, weft_vec3 *picked)
{
    int inside = 0, found = 0;
    for (int i = 0; i < count && found < MOST_REFERENCES; i++) {
        if (is_inside(direction[i]) && inside++ % every == every / 2)
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

void weft_image_split_free(weft_image_split *s)
{
    weft_component_images_free(&s->fitted);
    free(s->held);
    free(s->held_view);
    free(s->held_kind);
    *s = (weft_image_split){0};
}

static weft_code split_allocate(const weft_component_images *images, weft_image_split *s, weft_error *error)
{
    size_t count = (size_t)images->image_count;
    *s = (weft_image_split){.held = malloc(count * sizeof *s->held),
                            .held_view = malloc(count * sizeof *s->held_view),
                            .held_kind = malloc(count)};
    WEFT_TRY(weft_component_images_allocate(images->image_count, images->view_count, &s->fitted, error));
    return s->held && s->held_view && s->held_kind
               ? WEFT_OK
               : weft_fail_memory(error, "images of components", count * sizeof *s->held_view);
}

static void hold_out(const weft_component_images *images, int view, int image, weft_held_kind kind, weft_image_split *s)
{
    s->held_view[s->held_count] = images->view[view];
    s->held_kind[s->held_count] = (uint8_t)kind;
    s->held[s->held_count++] = image;
}

/* A view is done: it is among those that are fitted where an image of it is. */
static void end_view(const weft_component_images *images, int view, weft_image_split *s)
{
    weft_component_images *fitted = &s->fitted;
    if (fitted->image_count == (int)fitted->first[fitted->view_count])
        return;
    fitted->view[fitted->view_count] = images->view[view];
    fitted->first[++fitted->view_count] = (uint32_t)fitted->image_count;
}

static void end_split(weft_image_split *s)
{
    s->fitted.length = (3 * (size_t)s->fitted.image_count + 15) / 16 * 16;
}

weft_code weft_image_split_inside(const weft_component_images *images, weft_image_split *s, weft_error *error)
{
    weft_vec3 views[MOST_REFERENCES], lights[MOST_REFERENCES];
    int view_count = 0, light_count = 0, first_lights = (int)images->first[1];
    WEFT_TRY(split_allocate(images, s, error));
    if (images->view_count >= LEAST_VIEWS)
        view_count = pick(images->view, images->view_count, EVERY, views);
    if (first_lights >= LEAST_LIGHTS)
        light_count = pick(images->light, first_lights, images->view_count < FEW_VIEWS ? EVERY_OF_FEW : EVERY, lights);
    for (int view = 0; view < images->view_count; view++) {
        bool held_view = is_near(images->view[view], views, view_count, 1e-3);
        for (int i = (int)images->first[view]; i < (int)images->first[view + 1]; i++) {
            if (held_view || is_near(images->light[i], lights, light_count, same_light_deg))
                hold_out(images, view, i, WEFT_HELD_INSIDE, s);
            else
                weft_component_images_add(&s->fitted, images, i, i);
        }
        end_view(images, view, s);
    }
    end_split(s);
    return WEFT_OK;
}

/* ---- The outermost ---- */

/* Directions within this angle of a ring belong to it. */
static const double ring_deg = 1;

static int by_height(const void *a, const void *b)
{
    weft_real first = *(const weft_real *)a, second = *(const weft_real *)b;
    return (first > second) - (first < second);
}

/* The cosine below which the outermost of so many directions lie; -1 where less than `least` would be left. */
static weft_code outermost_below(const weft_vec3 *direction, int count, int least, weft_real *below, weft_error *error)
{
    weft_real *height = malloc((size_t)count * sizeof *height);
    if (!height)
        return weft_fail_memory(error, "heights of directions", (size_t)count * sizeof *height);
    for (int i = 0; i < count; i++)
        height[i] = direction[i].z;
    qsort(height, (size_t)count, sizeof *height, by_height);
    double tenth = acos(fmin((double)height[count / EVERY], 1));
    *below = (weft_real)cos(tenth - ring_deg * WEFT_PI / 180);
    int outside = 0;
    while (outside < count && height[outside] < *below)
        outside++;
    *below = count - outside < least ? -1 : *below;
    free(height);
    return WEFT_OK;
}

static void split_below(const weft_component_images *images, weft_real view_below, weft_real light_below,
                        weft_image_split *s)
{
    for (int view = 0; view < images->view_count; view++) {
        bool far_view = images->view[view].z < view_below;
        for (int i = (int)images->first[view]; i < (int)images->first[view + 1]; i++) {
            bool far_light = images->light[i].z < light_below;
            if (far_view || far_light)
                hold_out(images, view, i,
                         !far_light  ? WEFT_HELD_FAR_VIEW
                         : !far_view ? WEFT_HELD_FAR_LIGHT
                                     : WEFT_HELD_FAR_BOTH,
                         s);
            else
                weft_component_images_add(&s->fitted, images, i, i);
        }
        end_view(images, view, s);
    }
    end_split(s);
}

weft_code weft_image_split_outermost(const weft_component_images *images, double *from_deg, weft_image_split *s,
                                     weft_error *error)
{
    weft_real view_below = -1, light_below = -1;
    WEFT_TRY(split_allocate(images, s, error));
    WEFT_TRY(outermost_below(images->view, images->view_count, LEAST_VIEWS, &view_below, error));
    WEFT_TRY(outermost_below(images->light, (int)images->first[1], LEAST_LIGHTS, &light_below, error));
    *from_deg = acos((double)fmax(view_below, light_below)) * 180 / WEFT_PI;
    split_below(images, view_below, light_below, s);
    return WEFT_OK;
}

/* ---- One exponent ---- */

typedef struct squares {
    double error, sample, screen_error, screen_sample;
} squares;

typedef struct trial {
    const weft_component_images *images;
    const weft_training *whole, *part; /* linear, and coded */
    float exponent;
    const weft_factorisation *components;
    const weft_image_split *split;
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
        const uint8_t *known = t->part->known + (size_t)i * t->part->image_count;
        weft_error own = {0};
        weft_code code =
            weft_projector_solve(&projector, &vector, &known, 1, t->coefficient + (size_t)i * (size_t)count, &own);
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

static void add_squares(float value, float sample, double weight, squares *sum)
{
    double difference = (double)value - (double)sample;
    double truth = (double)weft_coded(screen_exponent, sample);
    double shown = (double)weft_coded(screen_exponent, value) - truth;
    sum->error += weight * difference * difference;
    sum->sample += weight * (double)sample * (double)sample;
    sum->screen_error += weight * shown * shown;
    sum->screen_sample += weight * truth * truth;
}

/* Sums over the texels for one image that was held out. */
static squares squares_of(const trial *t, const weft_component_maps *maps, int held)
{
    int image = t->split->held[held], count = t->components->count;
    float factor[3 * WEFT_COMPONENTS_MAX] = {0}, weight = t->images->weight[image];
    squares sum = {0};
    weft_component_factors(maps, t->images->light[image], t->split->held_view[held], factor);
    for (int texel = 0; texel < t->part->texel_count; texel++) {
        const float *own = t->coefficient + (size_t)texel * (size_t)count;
        const float *sample = t->whole->vector + (size_t)texel * t->whole->length + 3 * (size_t)image;
        if (t->whole->known[(size_t)texel * t->whole->image_count + (size_t)image] != WEFT_SAMPLE_VALID)
            continue;
        for (int c = 0; c < 3; c++) {
            float value = 0;
            for (int k = 0; k < count; k++)
                value += own[k] * factor[3 * k + c];
            value = weft_decoded(t->exponent, value);
            add_squares(value > 0 ? value : 0, sample[c] / weight, (double)(weight * weight), &sum);
        }
    }
    return sum;
}

/* Relative RMSE of the images that were held out, by kind. Images are added in their order, however many threads there
 * are. */
static void measure_held(const trial *t, const weft_component_maps *maps, weft_component_errors errors[WEFT_HELD_KINDS])
{
    squares all[WEFT_HELD_KINDS] = {0};
    int count = t->split->held_count < MOST_COMPARED ? t->split->held_count : MOST_COMPARED;
#pragma omp parallel for schedule(dynamic, 8)
    for (int i = 0; i < count; i++)
        t->sum[i] = squares_of(t, maps, (int)((long)i * t->split->held_count / count));
    for (int i = 0; i < count; i++) {
        squares *of = &all[t->split->held_kind[(long)i * t->split->held_count / count]];
        of->error += t->sum[i].error;
        of->sample += t->sum[i].sample;
        of->screen_error += t->sum[i].screen_error;
        of->screen_sample += t->sum[i].screen_sample;
    }
    for (int kind = 0; kind < WEFT_HELD_KINDS; kind++)
        errors[kind] = all[kind].sample > 0
                           ? (weft_component_errors){sqrt(all[kind].error / all[kind].sample),
                                                     sqrt(all[kind].screen_error / all[kind].screen_sample)}
                           : (weft_component_errors){0};
}

float weft_least_incidence_of(const weft_component_images *images)
{
    weft_real least = 1;
    for (int view = 0; view < images->view_count; view++)
        for (uint32_t i = images->first[view]; i < images->first[view + 1]; i++)
            least = fmin(least, weft_dot(images->light[i], weft_half_vector(images->light[i], images->view[view])));
    return (float)fmin(fmax(least, (weft_real)WEFT_LEAST_INCIDENCE), (weft_real)1);
}

static weft_code try_plan(const trial *t, weft_component_plan *plan, weft_component_errors errors[WEFT_HELD_KINDS],
                          weft_error *error)
{
    weft_components *components = NULL;
    weft_component_maps maps = {0};
    plan->least_incidence = weft_least_incidence_of(&t->split->fitted);
    WEFT_TRY(weft_component_model_choose_lengths(&t->split->fitted, t->components, plan, error));
    WEFT_TRY(weft_component_model_create(&t->split->fitted, t->components, plan, 1, 1, 1, &components, error));
    weft_code code = weft_component_maps_create(components, &maps, error);
    if (code == WEFT_OK) {
        weft_component_model_factors(&maps, &t->split->fitted, t->factor);
        code = find_coefficients(t, error);
    }
    if (code == WEFT_OK)
        measure_held(t, &maps, errors);
    weft_component_maps_free(&maps);
    weft_components_free(components);
    return code;
}

static weft_code try_plans(trial *t, weft_component_plan *plan, int count,
                           weft_component_errors (*errors)[WEFT_HELD_KINDS], weft_error *error)
{
    size_t factors = (size_t)t->components->count * t->part->length;
    t->factor = aligned_alloc(ALIGNMENT, factors * sizeof *t->factor);
    t->coefficient = calloc((size_t)t->part->texel_count * (size_t)t->components->count, sizeof *t->coefficient);
    t->sum = malloc((size_t)t->split->held_count * sizeof *t->sum);
    weft_code code = t->factor && t->coefficient && t->sum
                         ? WEFT_OK
                         : weft_fail_memory(error, "factors of components", factors * sizeof *t->factor);
    for (int i = 0; i < count && code == WEFT_OK; i++)
        code = try_plan(t, &plan[i], errors[i], error);
    free(t->factor);
    free(t->coefficient);
    free(t->sum);
    return code;
}

weft_code weft_image_trial_run(const weft_image_trial *of, weft_component_plan *plan, int count,
                               weft_component_errors (*errors)[WEFT_HELD_KINDS], weft_error *error)
{
    weft_training part = {0};
    weft_factorisation components = {0};
    const weft_component_images *fitted = &of->split->fitted;
    weft_code code = weft_training_subset(of->training, fitted, fitted->image, &part, error);
    if (code == WEFT_OK) {
        weft_training_code(&part, fitted, plan->exponent);
        code = weft_factorisation_find(&part, of->component_count, &components, error);
    }
    trial t = {.images = of->images,
               .whole = of->training,
               .part = &part,
               .exponent = plan->exponent,
               .components = &components,
               .split = of->split};
    if (code == WEFT_OK)
        code = try_plans(&t, plan, count, errors, error);
    weft_factorisation_free(&components);
    weft_training_free(&part);
    return code;
}
