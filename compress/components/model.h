/* The shared half of components: components at the images of a dataset, and what their maps make of them. */
#ifndef WEFT_COMPRESS_COMPONENTS_MODEL_H
#define WEFT_COMPRESS_COMPONENTS_MODEL_H

#include "compress/components/factorisation.h"
#include "reflectance/components/components.h"

/* How components are coded, and carried between the images (btf/material/components.h). */
typedef struct weft_component_plan {
    weft_components_kind kind;
    float exponent, incidence_power, cosine_power, least_incidence;
    float view_length, view_nugget, trend;
    float length[WEFT_COMPONENTS_MAX], nugget[WEFT_COMPONENTS_MAX];
} weft_component_plan;

/* Components of which only kind, exponent and powers are set, for weft_components_divisor. Pure. */
weft_components weft_component_plan_powers(const weft_component_plan *plan);

/* Components without coefficients, for a material of width x height texels: a coefficient of 1 stands for a whole
 * component. The caller frees. Errors: WEFT_SYSTEM. */
weft_code weft_component_model_create(const weft_component_images *images, const weft_factorisation *factorisation,
                                      const weft_component_plan *plan, int width, int height, int level_count,
                                      weft_components **result, weft_error *error);

/* Puts components without coefficients, which are freed, into the place of themselves twice over, one half behind the
 * other. Errors: WEFT_BAD_USAGE for more than WEFT_COMPONENTS_MAX, WEFT_SYSTEM. */
weft_code weft_component_model_double(weft_components **components, weft_error *error);

/* What the maps give at the images themselves, times their weights: factor [layer][images->length], aligned to 64
 * bytes. */
void weft_component_model_factors(const weft_component_maps *maps, const weft_component_images *images, float *factor);

/* The same by the calling thread alone. */
void weft_component_model_factors_alone(const weft_component_maps *maps, const weft_component_images *images,
                                        float *factor);

/* The forms of maps that are tried: over the light, and over the half vector with two pairs of powers. */
enum { WEFT_COMPONENT_FORMS = 3, WEFT_COMPONENT_EXPONENTS = 5 };

/* Relative RMSE of images held out: of linear light, and of what a screen shows. */
typedef struct weft_component_errors {
    double linear, screen;
} weft_component_errors;

/* What decided a plan. */
typedef struct weft_component_trial {
    int image_count;                                             /* that were held out; 0: too few to hold any out */
    weft_component_errors of_form[WEFT_COMPONENT_FORMS];         /* with an exponent of 2; 0: not tried */
    weft_component_errors of_exponent[WEFT_COMPONENT_EXPONENTS]; /* with the best form; 0: not tried */
    double outermost_deg;                  /* the outermost views and lights are so far from the normal; 0: not tried */
    weft_component_errors of_outermost[3]; /* of their images: the view, the light, or both are such; 0: none */
} weft_component_trial;

/* The exponents: 1, 1.5, 2, 2.4 and 3. Pure. */
float weft_component_exponent(int number);

/* The number of the exponent of the least error: for the screen the least there, among those that leave of linear light
 * at most a twentieth more than the best, else the least of linear light. A larger exponent must leave 2 % less than a
 * smaller one. That of 2, or of 1, where nothing was tried. Pure. */
int weft_component_best_exponent(const weft_component_trial *trial, bool for_screen);

/* Which plan predicts images best that it has not seen: a tenth of the views and of the lights are held out, and forms
 * and exponents are fitted to the rest of some texels: exponents of 1 and 2, from 2 up as long as the next one is
 * better, and 1.5 unless a larger one is chosen. `training` is linear and as it is read. Lengths are not chosen yet.
 * Errors: WEFT_SYSTEM. */
weft_code weft_component_model_choose(const weft_component_images *images, const weft_training *training,
                                      int component_count, bool for_screen, weft_component_plan *plan,
                                      weft_component_trial *trial, weft_error *error);

/* What a plan says of the outermost views and lights when only what lies inside them is fitted: how wrong a material
 * may be beyond the directions of its images. Errors: WEFT_SYSTEM. */
weft_code weft_component_model_try_outermost(const weft_component_images *images, const weft_training *training,
                                             int component_count, const weft_component_plan *plan,
                                             weft_component_trial *trial, weft_error *error);

/* Lengths, nuggets and trend of a plan, by leaving values of the components out. Errors: WEFT_SYSTEM. */
weft_code weft_component_model_choose_lengths(const weft_component_images *images,
                                              const weft_factorisation *factorisation, weft_component_plan *plan,
                                              weft_error *error);

/* Which kind of maps says more of the images themselves, where the components belong to other directions `places`
 * (compress/components/completion.h): the first two kinds are fitted to the training texels. `layout` is that of the
 * dataset. Errors: WEFT_SYSTEM. */
weft_code weft_component_model_choose_scattered(const weft_dataset_layout *layout, const weft_component_images *images,
                                                const weft_training *training, const weft_component_images *places,
                                                const weft_factorisation *factorisation, weft_component_plan *plan,
                                                double error_of[2], weft_error *error);

#endif
