#include "compress/components/components_fit.h"

#include "btf/material/component_rounding.h"
#include "compress/components/completion.h"
#include "compress/components/model.h"
#include "compress/components/projection.h"

#include <math.h>
#include <stdlib.h>

/* What rounding may add to the mean square of what the components leave. */
static const double rounding_share = 0.01;

enum { ALIGNMENT = 64, MOST_COMPARED = 2000000, LEAST_LIGHTS = 12, LEAST_VIEWS = 4 };

/* What one fit hands from step to step. */
typedef struct fitting {
    weft_dataset *dataset;
    const weft_components_options *options;
    const weft_progress *progress;
    weft_component_images images;
    weft_training training;
    weft_completion completion; /* where images are scattered */
    weft_factorisation factorisation;
    weft_components *components;
    weft_component_maps maps;
    float *factor; /* [layer][length] */
    weft_projection projection;
} fitting;

static void free_all(fitting *work)
{
    free(work->factor);
    weft_projection_free(&work->projection);
    weft_factorisation_free(&work->factorisation);
    weft_completion_free(&work->completion);
    weft_component_maps_free(&work->maps);
    weft_training_free(&work->training);
    weft_component_images_free(&work->images);
    weft_components_free(work->components);
}

/* ---- Learning ---- */

static weft_code learn_from_grid(fitting *work, weft_components_report *report, weft_error *error)
{
    int count = work->options->component_count;
    WEFT_TRY(weft_component_model_choose(&work->images, &work->training, count, work->options->for_screen,
                                         &report->plan, &report->trial, error));
    if (!work->options->held_out)
        WEFT_TRY(weft_component_model_try_outermost(&work->images, &work->training, count, &report->plan,
                                                    &report->trial, error));
    weft_progress_report(work->progress, "learning components", 1, 2);
    weft_training_code(&work->training, &work->images, report->plan.exponent);
    WEFT_TRY(weft_factorisation_find(&work->training, count, &work->factorisation, error));
    return weft_component_model_choose_lengths(&work->images, &work->factorisation, &report->plan, error);
}

static weft_code learn_from_scattered(fitting *work, weft_components_report *report, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    weft_completion *completion = &work->completion;
    weft_training_drop_clipped(&work->training);
    WEFT_TRY(weft_completion_make(layout, &work->images, &work->training, &work->options->budget,
                                  weft_dataset_path(work->dataset), work->progress, completion, error));
    report->scattered = true;
    report->left_out_count = completion->left_out_count;
    report->left_out_error = completion->left_out_error;
    report->covariance = completion->covariance;
    report->mean = completion->mean;
    report->mean_error[0] = completion->mean_error[0];
    report->mean_error[1] = completion->mean_error[1];
    weft_progress_report(work->progress, "learning components", 1, 2);
    WEFT_TRY(
        weft_factorisation_find(&completion->training, work->options->component_count, &work->factorisation, error));
    work->factorisation.noise += completion->noise;
    return weft_component_model_choose_scattered(layout, &work->images, &work->training, &completion->images,
                                                 &work->factorisation, &report->plan, report->scattered_error, error);
}

static weft_code learn(fitting *work, weft_material *material, weft_components_report *report, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    bool scattered = weft_images_are_scattered(layout);
    weft_progress_report(work->progress, "learning components", 0, 2);
    WEFT_TRY(weft_component_images_create(layout, work->options->held_out, &work->images, error));
    /* Samples of the texels that are learned from, those again that are not held out, these filled, and products. */
    WEFT_TRY(weft_memory_budget_require(&work->options->budget,
                                        (uint64_t)WEFT_TRAINING_TEXELS *
                                            (12 * work->images.length + 12 * (uint64_t)WEFT_TRAINING_TEXELS),
                                        weft_dataset_path(work->dataset), "its components", error));
    WEFT_TRY(weft_training_read(work->dataset, &work->images, &work->training, error));
    WEFT_TRY(scattered ? learn_from_scattered(work, report, error) : learn_from_grid(work, report, error));
    report->training_texels = work->training.texel_count;
    WEFT_TRY(weft_component_model_create(scattered ? &work->completion.images : &work->images, &work->factorisation,
                                         &report->plan, layout->width, layout->height, material->level_count,
                                         &work->components, error));
    weft_progress_report(work->progress, "learning components", 2, 2);
    return WEFT_OK;
}

/* ---- Projecting ---- */

/* Far images have the same factors for all texels. */
static weft_code find_factors(fitting *work, weft_error *error)
{
    size_t bytes = (size_t)work->options->component_count * work->images.length * sizeof *work->factor;
    work->factor = aligned_alloc(ALIGNMENT, bytes);
    if (!work->factor)
        return weft_fail_memory(error, "factors of components", bytes);
    weft_component_model_factors(&work->maps, &work->images, work->factor);
    return WEFT_OK;
}

/* The prior of components that were learned at other directions serves samples, too. */
static weft_code make_projector(fitting *work, weft_projector *projector, weft_error *error)
{
    weft_factorisation prior = work->factorisation;
    prior.length = work->images.length;
    WEFT_TRY(find_factors(work, error));
    return weft_projector_create(&prior, work->factor, work->images.image_count, projector, error);
}

/* Values and coefficients of each layer are rounded to steps that change a sample alike: an error that spreads evenly
 * over a step has a twelfth of its square. Steps are powers of the root of 2, so that the last digits of the noise
 * decide none. */
static double rounding_step(const weft_factorisation *factorisation, int component_count)
{
    double square = 12 * rounding_share * factorisation->noise / (2 * component_count);
    return square > 0 ? exp2(floor(log2(square)) / 2) : 0;
}

static weft_code project(fitting *work, weft_components_report *report, weft_error *error)
{
    weft_projector projector = {0};
    bool is_near = weft_dataset_get_layout(work->dataset)->distance == WEFT_NEAR;
    const weft_projection_job job = {&work->options->budget, work->options->checkpoint, &work->options->log,
                                     work->progress};
    WEFT_TRY(weft_component_maps_create(work->components, &work->maps, error));
    weft_code code = is_near ? WEFT_OK : make_projector(work, &projector, error);
    if (code == WEFT_OK)
        code = weft_projection_make(work->dataset, &work->images, is_near ? NULL : &projector, &work->factorisation,
                                    &work->maps, &job, &work->projection, error);
    weft_projector_free(&projector);
    weft_component_maps_free(&work->maps);
    report->masked = work->projection.masked;
    report->empty_texels = work->projection.empty;
    if (code == WEFT_OK && work->options->finer)
        code = weft_component_model_double(&work->components, error);
    if (code == WEFT_OK)
        code = weft_components_fill_levels(&work->projection, &work->images, work->factor, work->components, error);
    if (code == WEFT_OK && !work->options->finer)
        report->rounding_step = rounding_step(&work->factorisation, work->components->component_count);
    if (report->rounding_step > 0)
        weft_components_round(report->rounding_step, work->components);
    return code;
}

/* ---- Measuring ---- */

/* What the finished components say of one image of a training texel that has it. */
static size_t compare(const fitting *work, const float *factor, weft_vec3 light, size_t texel, int image,
                      weft_compared *pair)
{
    const weft_training *training = &work->training;
    const float *sample = training->vector + texel * training->length + 3 * (size_t)image;
    float scale = 1 / work->images.weight[image];
    if (training->known[texel * training->image_count + (size_t)image] != WEFT_SAMPLE_VALID)
        return 0;
    weft_rgb value = weft_components_texel(work->components, work->components->component_count, factor, 0,
                                           training->place[texel].x, training->place[texel].y, light.z);
    float exponent = work->components->exponent;
    pair[0] = (weft_compared){weft_decoded(exponent, scale * sample[0]), (float)value.r};
    pair[1] = (weft_compared){weft_decoded(exponent, scale * sample[1]), (float)value.g};
    pair[2] = (weft_compared){weft_decoded(exponent, scale * sample[2]), (float)value.b};
    return 3;
}

static size_t compare_image(const fitting *work, const weft_component_maps *maps, int view, int image,
                            weft_compared *pair)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    const weft_training *training = &work->training;
    bool is_near = layout->distance == WEFT_NEAR;
    weft_vec3 light = work->images.light[image], to_view = work->images.view[view];
    int number = work->images.image[image];
    float factor[3 * WEFT_COMPONENTS_MAX];
    size_t count = 0;
    weft_component_factors(maps, light, to_view, factor);
    for (size_t texel = 0; texel < (size_t)training->texel_count; texel++) {
        if (is_near) {
            const weft_training_place *place = &training->place[texel];
            light = weft_dataset_light_direction(layout, number, place->x, place->y);
            to_view = weft_dataset_view_direction(layout, layout->view_of_image[number], place->x, place->y);
            weft_component_factors(maps, light, to_view, factor);
        }
        count += compare(work, factor, light, texel, image, pair + count);
    }
    return count;
}

/* All images, or an even choice where that would be too many samples. */
static weft_code measure(const fitting *work, weft_components_report *report, weft_error *error)
{
    const weft_component_images *images = &work->images;
    size_t per_image = 3 * (size_t)work->training.texel_count, all = per_image * (size_t)images->image_count;
    int step = (int)(all / MOST_COMPARED + 1);
    size_t count = 0, room = per_image * ((size_t)images->image_count / (size_t)step + 1);
    weft_component_maps maps;
    weft_compared *pair = malloc(room * sizeof *pair);
    if (!pair)
        return weft_fail_memory(error, "measured samples", room * sizeof *pair);
    weft_code code = weft_component_maps_create(work->components, &maps, error);
    for (int view = 0; view < images->view_count && code == WEFT_OK; view++)
        for (int i = (int)images->first[view]; i < (int)images->first[view + 1]; i++) {
            if (i % step == 0)
                count += compare_image(work, &maps, view, i, pair + count);
        }
    if (code == WEFT_OK) {
        code = weft_error_summary_of(pair, count, &report->fitted, error);
        weft_component_maps_free(&maps);
    }
    free(pair);
    return code;
}

/* ---- The whole ---- */

static weft_code fit(fitting *work, weft_material *material, weft_components_report *report, weft_error *error)
{
    WEFT_TRY(learn(work, material, report, error));
    WEFT_TRY(project(work, report, error));
    return measure(work, report, error);
}

bool weft_images_are_scattered(const weft_dataset_layout *layout)
{
    int images = 0, views = 0, most = 0;
    for (int view = 0; view < layout->view_count; view++) {
        int before = images;
        for (int image = 0; image < layout->image_count; image++)
            images += layout->view_of_image[image] == view;
        views += images > before;
        most = images - before > most ? images - before : most;
    }
    return layout->distance == WEFT_NEAR || (views > 1 && views < LEAST_VIEWS) || images < LEAST_LIGHTS * views ||
           views > WEFT_KRIGED_MAX_VIEWS || most > WEFT_KRIGED_MAX_LIGHTS;
}

weft_code weft_components_fit(weft_dataset *dataset, const weft_components_options *options,
                              const weft_progress *progress, weft_material *material, weft_components_report *report,
                              weft_error *error)
{
    fitting work = {.dataset = dataset, .options = options, .progress = progress};
    *report = (weft_components_report){0};
    weft_code code = fit(&work, material, report, error);
    if (code == WEFT_OK) {
        material->components = work.components;
        work.components = NULL;
    }
    free_all(&work);
    return code;
}
