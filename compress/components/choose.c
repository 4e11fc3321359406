/* How components are coded and carried between images: decided by images that were held out. */
#include "compress/components/image_trial.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    FEW_VIEWS = 4,
    MOST_TEXELS = 128,
    MOST_COMPONENTS = 16,
    LINEAR = 0, /* exponents by number: that of linear light, and ... */
    USUAL = 2   /* ... the one that forms are tried with, and that few images have */
};

static const float exponent_of[WEFT_COMPONENT_EXPONENTS] = {1, 1.5f, 2, 2.4f, 3};

/* What the coding for a screen may leave of linear light, as a multiple of the least. */
static const double most_of_linear = 1.05;

/* What a larger exponent must leave at most of the error of a smaller one: levels of coded values are nearer to means
 * the smaller it is. */
static const double worth_an_exponent = 0.98;

/* Powers of l . h and l_z. */
static const struct {
    weft_components_kind kind;
    float incidence_power, cosine_power;
} form[WEFT_COMPONENT_FORMS] = {{WEFT_COMPONENTS_KRIGED_OVER_LIGHT, 0, 0},
                                {WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR, 1, 0},
                                {WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR, 2, -1}};

static int at_most(int count, int most)
{
    return count < most ? count : most;
}

static weft_component_plan plan_of(const weft_component_images *images, float exponent, int number)
{
    return (weft_component_plan){.kind = form[number].kind,
                                 .exponent = exponent,
                                 .incidence_power = form[number].incidence_power,
                                 .cosine_power = form[number].cosine_power,
                                 .least_incidence = weft_least_incidence_of(images)};
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

int weft_component_best_exponent(const weft_component_trial *tried, bool for_screen)
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
typedef struct search {
    weft_image_trial of;
    int form;
    bool for_screen;
    weft_component_trial *tried;
} search;

static weft_code try_forms(search *s, int forms, weft_error *error)
{
    weft_component_plan plan[WEFT_COMPONENT_FORMS];
    weft_component_errors errors[WEFT_COMPONENT_FORMS][WEFT_HELD_KINDS];
    for (int number = 0; number < forms; number++)
        plan[number] = plan_of(s->of.images, exponent_of[USUAL], number);
    WEFT_TRY(weft_image_trial_run(&s->of, plan, forms, errors, error));
    for (int number = 0; number < forms; number++)
        s->tried->of_form[number] = errors[number][WEFT_HELD_INSIDE];
    s->form = best_form(s->tried, s->for_screen);
    s->tried->of_exponent[USUAL] = s->tried->of_form[s->form];
    return WEFT_OK;
}

static weft_code try_exponent(const search *s, int number, weft_error *error)
{
    weft_component_plan plan = plan_of(s->of.images, exponent_of[number], s->form);
    weft_component_errors errors[1][WEFT_HELD_KINDS];
    WEFT_TRY(weft_image_trial_run(&s->of, &plan, 1, errors, error));
    s->tried->of_exponent[number] = errors[0][WEFT_HELD_INSIDE];
    return WEFT_OK;
}

/* That of linear light; from the usual one on, as long as the next is better; and what lies between these two, unless
 * it would be too small. */
static weft_code try_exponents(const search *s, weft_error *error)
{
    const weft_component_errors *of = s->tried->of_exponent;
    bool is_better = true;
    WEFT_TRY(try_exponent(s, LINEAR, error));
    for (int i = USUAL + 1; i < WEFT_COMPONENT_EXPONENTS && is_better; i++) {
        WEFT_TRY(try_exponent(s, i, error));
        is_better = measure_of(&of[i], s->for_screen) < worth_an_exponent * measure_of(&of[i - 1], s->for_screen);
    }
    bool may_be_smaller = weft_component_best_exponent(s->tried, s->for_screen) <= USUAL;
    for (int i = LINEAR + 1; i < USUAL && may_be_smaller; i++)
        WEFT_TRY(try_exponent(s, i, error));
    return WEFT_OK;
}

/* Few views are carried over the light: they do not tell how a highlight moves with the view. */
static weft_code try_inside(search *s, weft_error *error)
{
    weft_image_split split;
    weft_code code = weft_image_split_inside(s->of.images, &split, error);
    s->of.split = &split;
    if (code == WEFT_OK && split.held_count > 0 && split.fitted.image_count > 0) {
        s->tried->image_count = split.held_count;
        code = try_forms(s, s->of.images->view_count < FEW_VIEWS ? 1 : WEFT_COMPONENT_FORMS, error);
        if (code == WEFT_OK)
            code = try_exponents(s, error);
    }
    weft_image_split_free(&split);
    s->of.split = NULL;
    return code;
}

float weft_component_exponent(int number)
{
    return exponent_of[number];
}

weft_code weft_component_model_choose(const weft_component_images *images, const weft_training *training,
                                      int component_count, bool for_screen, weft_component_plan *plan,
                                      weft_component_trial *tried, weft_error *error)
{
    weft_training some;
    *tried = (weft_component_trial){0};
    WEFT_TRY(weft_training_thin(training, MOST_TEXELS, &some, error));
    search s = {
        .of = {.images = images, .training = &some, .component_count = at_most(component_count, MOST_COMPONENTS)},
        .for_screen = for_screen,
        .tried = tried};
    weft_code code = try_inside(&s, error);
    *plan = plan_of(images, exponent_of[weft_component_best_exponent(tried, for_screen)], best_form(tried, for_screen));
    weft_training_free(&some);
    return code;
}

weft_code weft_component_model_try_outermost(const weft_component_images *images, const weft_training *training,
                                             int component_count, const weft_component_plan *plan,
                                             weft_component_trial *tried, weft_error *error)
{
    weft_training some;
    weft_image_split split = {0};
    weft_component_plan own = *plan;
    weft_component_errors errors[1][WEFT_HELD_KINDS];
    WEFT_TRY(weft_training_thin(training, MOST_TEXELS, &some, error));
    double from_deg;
    weft_code code = weft_image_split_outermost(images, &from_deg, &split, error);
    const weft_image_trial trial = {images, &some, &split, at_most(component_count, MOST_COMPONENTS)};
    if (code == WEFT_OK && split.held_count > 0) {
        code = weft_image_trial_run(&trial, &own, 1, errors, error);
        for (int kind = WEFT_HELD_FAR_VIEW; kind < WEFT_HELD_KINDS && code == WEFT_OK; kind++)
            tried->of_outermost[kind - WEFT_HELD_FAR_VIEW] = errors[0][kind];
        tried->outermost_deg = from_deg;
    }
    weft_image_split_free(&split);
    weft_training_free(&some);
    return code;
}
