/* How components are coded and carried between images: decided by images that were held out. */
#include "compress/components/model.h"

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
    MOST_TEXELS = 128,
    MOST_COMPONENTS = 16,
    MOST_COMPARED = 600, /* images held out */
    LINEAR = 0,          /* exponents by number: that of linear light, and ... */
    USUAL = 2            /* ... the one that forms are tried with, and that few images have */
};

static const float exponent_of[WEFT_COMPONENT_EXPONENTS] = {1, 1.5f, 2, 2.4f, 3};

/* What the coding for a screen may leave of linear light, as a multiple of the least. */
static const double most_of_linear = 1.05;

/* What a larger exponent must leave at most of the error of a smaller one: levels of coded values are nearer to means the
 * smaller it is. */
static const double worth_an_exponent = 0.98;

/* Powers of l . h and l_z. */
static const struct {
    weft_components_kind kind;
    float incidence_power, cosine_power;
} form[WEFT_COMPONENT_FORMS] = {{WEFT_COMPONENTS_KRIGED_OVER_LIGHT, 0, 0},
                                {WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR, 1, 0},
                                {WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR, 2, -1}};

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
        view_count = pick(images->view, images->view_count, EVERY, views);
    if (first_lights >= LEAST_LIGHTS)
        light_count = pick(images->light, first_lights, images->view_count < FEW_VIEWS ? EVERY_OF_FEW : EVERY, lights);
    for (int view = 0; view < images->view_count; view++)
        add_view(images, view, is_near(images->view[view], views, view_count, 1e-3), lights, light_count, s);
    s->fitted.length = (3 * (size_t)s->fitted.image_count + 15) / 16 * 16;
    return WEFT_OK;
}

/* ---- One exponent and form ---- */

typedef struct squares {
    double error, sample, screen_error, screen_sample;
} squares;

typedef struct trial {
    const weft_component_images *images;
    const weft_training *whole, *part; /* linear, and coded */
    float exponent;
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

/* Relative RMSE of the images that were held out. Images are added in their order, however many threads there are. */
static weft_component_errors errors_of_held(const trial *t, const weft_component_maps *maps)
{
    squares all = {0};
    int count = t->split->held_count < MOST_COMPARED ? t->split->held_count : MOST_COMPARED;
#pragma omp parallel for schedule(dynamic, 8)
    for (int i = 0; i < count; i++)
        t->sum[i] = squares_of(t, maps, (int)((long)i * t->split->held_count / count));
    for (int i = 0; i < count; i++) {
        all.error += t->sum[i].error;
        all.sample += t->sum[i].sample;
        all.screen_error += t->sum[i].screen_error;
        all.screen_sample += t->sum[i].screen_sample;
    }
    return all.sample > 0
               ? (weft_component_errors){sqrt(all.error / all.sample), sqrt(all.screen_error / all.screen_sample)}
               : (weft_component_errors){0};
}

static float least_incidence(const weft_component_images *images)
{
    weft_real least = 1;
    for (int view = 0; view < images->view_count; view++)
        for (uint32_t i = images->first[view]; i < images->first[view + 1]; i++)
            least = fmin(least, weft_dot(images->light[i], weft_half_vector(images->light[i], images->view[view])));
    return (float)fmin(fmax(least, (weft_real)WEFT_LEAST_INCIDENCE), (weft_real)1);
}

static void set_form(const weft_component_images *images, float exponent, int number, weft_component_plan *plan)
{
    *plan = (weft_component_plan){.kind = form[number].kind,
                                  .exponent = exponent,
                                  .incidence_power = form[number].incidence_power,
                                  .cosine_power = form[number].cosine_power,
                                  .least_incidence = least_incidence(images)};
}

static weft_code try_form(const trial *t, int number, weft_component_errors *errors, weft_error *error)
{
    weft_components *components = NULL;
    weft_component_maps maps = {0};
    weft_component_plan plan;
    set_form(&t->split->fitted, t->exponent, number, &plan);
    WEFT_TRY(weft_component_model_choose_lengths(&t->split->fitted, t->components, &plan, error));
    WEFT_TRY(weft_component_model_create(&t->split->fitted, t->components, &plan, 1, 1, 1, &components, error));
    weft_code code = weft_component_maps_create(components, &maps, error);
    if (code == WEFT_OK) {
        weft_component_model_factors(&maps, &t->split->fitted, t->factor);
        code = find_coefficients(t, error);
    }
    if (code == WEFT_OK)
        *errors = errors_of_held(t, &maps);
    weft_component_maps_free(&maps);
    weft_components_free(components);
    return code;
}

/* Forms first .. last - 1. */
static weft_code try_forms(trial *t, int first, int last, weft_component_errors *errors, weft_error *error)
{
    size_t factors = (size_t)t->components->count * t->part->length;
    t->factor = aligned_alloc(ALIGNMENT, factors * sizeof *t->factor);
    t->coefficient = calloc((size_t)t->part->texel_count * (size_t)t->components->count, sizeof *t->coefficient);
    t->sum = malloc((size_t)t->split->held_count * sizeof *t->sum);
    weft_code code = t->factor && t->coefficient && t->sum
                         ? WEFT_OK
                         : weft_fail_memory(error, "factors of components", factors * sizeof *t->factor);
    for (int number = first; number < last && code == WEFT_OK; number++)
        code = try_form(t, number, &errors[number - first], error);
    free(t->factor);
    free(t->coefficient);
    free(t->sum);
    return code;
}

/* ---- All of them ---- */

/* `some` is linear. */
static weft_code try_exponent(const weft_component_images *images, const weft_training *some, const split *s,
                              int component_count, float exponent, int first, int last, weft_component_errors *errors,
                              weft_error *error)
{
    weft_training part = {0};
    weft_factorisation components = {0};
    weft_code code = weft_training_subset(some, &s->fitted, s->fitted.image, &part, error);
    if (code == WEFT_OK) {
        weft_training_code(&part, &s->fitted, exponent);
        code = weft_factorisation_find(&part, component_count, &components, error);
    }
    trial t = {
        .images = images, .whole = some, .part = &part, .exponent = exponent, .components = &components, .split = s};
    if (code == WEFT_OK)
        code = try_forms(&t, first, last, errors, error);
    weft_factorisation_free(&components);
    weft_training_free(&part);
    return code;
}

static int best_form(const weft_component_trial *tried, bool for_screen)
{
    int best = 0;
    for (int number = 1; number < WEFT_COMPONENT_FORMS; number++) {
        const weft_component_errors *own = &tried->of_form[number], *least = &tried->of_form[best];
        if (own->linear > 0 && (for_screen ? own->screen < least->screen : own->linear < least->linear))
            best = number;
    }
    return best;
}

static double measure_of(const weft_component_errors *errors, bool for_screen)
{
    return for_screen ? errors->screen : errors->linear;
}

static int best_exponent(const weft_component_trial *tried, bool for_screen)
{
    int best = for_screen ? USUAL : LINEAR;
    double least = INFINITY, linear = INFINITY;
    for (int i = 0; i < WEFT_COMPONENT_EXPONENTS; i++)
        if (tried->of_exponent[i].linear > 0)
            linear = fmin(linear, tried->of_exponent[i].linear);
    for (int i = 0; i < WEFT_COMPONENT_EXPONENTS; i++) {
        const weft_component_errors *own = &tried->of_exponent[i];
        if (own->linear > 0 && own->linear <= most_of_linear * linear &&
            measure_of(own, for_screen) < worth_an_exponent * least) {
            least = measure_of(own, for_screen);
            best = i;
        }
    }
    return best;
}

/* What all trials share. */
typedef struct trials {
    const weft_component_images *images;
    const weft_training *some; /* linear */
    const split *split;
    int component_count, form;
    bool for_screen;
    weft_component_trial *tried;
} trials;

static weft_code try_number(const trials *t, int number, weft_error *error)
{
    return try_exponent(t->images, t->some, t->split, t->component_count, exponent_of[number], t->form, t->form + 1,
                        &t->tried->of_exponent[number], error);
}

/* That of linear light; from the usual one on, as long as the next is better; and what lies between these two, unless
 * it would be too small. */
static weft_code try_exponents(const trials *t, weft_error *error)
{
    const weft_component_errors *of = t->tried->of_exponent;
    bool is_better = true;
    WEFT_TRY(try_number(t, LINEAR, error));
    for (int i = USUAL + 1; i < WEFT_COMPONENT_EXPONENTS && is_better; i++) {
        WEFT_TRY(try_number(t, i, error));
        is_better = measure_of(&of[i], t->for_screen) < worth_an_exponent * measure_of(&of[i - 1], t->for_screen);
    }
    bool may_be_smaller = best_exponent(t->tried, t->for_screen) <= USUAL;
    for (int i = LINEAR + 1; i < USUAL && may_be_smaller; i++)
        WEFT_TRY(try_number(t, i, error));
    return WEFT_OK;
}

/* Few views are carried over the light: they do not tell how a highlight moves with the view. */
static weft_code try_all(trials *t, weft_error *error)
{
    weft_component_trial *tried = t->tried;
    int forms = t->images->view_count < FEW_VIEWS ? 1 : WEFT_COMPONENT_FORMS;
    WEFT_TRY(try_exponent(t->images, t->some, t->split, t->component_count, exponent_of[USUAL], 0, forms,
                          tried->of_form, error));
    t->form = best_form(tried, t->for_screen);
    tried->image_count = t->split->held_count;
    tried->of_exponent[USUAL] = tried->of_form[t->form];
    return try_exponents(t, error);
}

float weft_component_exponent(int number)
{
    return exponent_of[number];
}

weft_code weft_component_model_choose(const weft_component_images *images, const weft_training *training,
                                      int component_count, bool for_screen, weft_component_plan *plan,
                                      weft_component_trial *tried, weft_error *error)
{
    split s;
    weft_training some = {0};
    *tried = (weft_component_trial){0};
    weft_code code = split_create(images, &s, error);
    if (code == WEFT_OK)
        code = weft_training_thin(training, MOST_TEXELS, &some, error);
    if (code == WEFT_OK && s.held_count > 0 && s.fitted.image_count > 0)
        code =
            try_all(&(trials){.images = images,
                              .some = &some,
                              .split = &s,
                              .component_count = component_count < MOST_COMPONENTS ? component_count : MOST_COMPONENTS,
                              .for_screen = for_screen,
                              .tried = tried},
                    error);
    set_form(images, exponent_of[best_exponent(tried, for_screen)], best_form(tried, for_screen), plan);
    weft_training_free(&some);
    split_free(&s);
    return code;
}
