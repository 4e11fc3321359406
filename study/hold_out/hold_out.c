#include "study/hold_out/hold_out.h"

#include "study/error/predictor.h"
#include "study/hold_out/excerpt.h"
#include "study/hold_out/interpolation.h"

#include <malloc.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Layers learn from 512 texels, which are to be there. */
enum { SIDE = 12, LAYERS_SIDE = 24, BLOCK_SIDE = 64 };

/* Of the excerpt, at most. */
static const long most_samples = 1L << 22;

/* ---- One split ---- */

/* Samples channel by channel beside what a model says of them; a slot is empty where `group` is 0. */
typedef struct comparison {
    size_t count;
    weft_compared *value; /* [count] */
    uint8_t *group;       /* [count] flags of study/hold_out/split.h */
} comparison;

/* One split at work. It looks at the images that are held out and, to tell what being fitted is worth, at those that
 * the next split holds out: as many of the same rings, but fitted here. */
typedef struct trial {
    const weft_excerpt *excerpt;
    int *image;     /* [held_count + fitted_count] the images that are held out, then the others */
    uint8_t *flags; /* of those: why each is held out, here or in the next split */
    int held_count, fitted_count;
    weft_predictor *predictor;
    weft_interpolation *interpolation;
    comparison material, photographs; /* of what is held out */
    comparison fitted;
} trial;

static void put(comparison *compared, size_t slot, uint8_t flags, const weft_half *half, weft_rgb prediction)
{
    const double said[3] = {(double)prediction.r, (double)prediction.g, (double)prediction.b};
    for (size_t c = 0; c < 3 && !isnan(said[c]); c++) {
        compared->value[slot + c] =
            (weft_compared){.sample = weft_float_of_half(half[c]), .prediction = (float)said[c]};
        compared->group[slot + c] = flags;
    }
}

/* The samples of a texel into its own slots. */
static void compare_samples(trial *t, int x, int y, const weft_rgb *material, const weft_rgb *photographs)
{
    const weft_dataset_layout *layout = &t->excerpt->layout;
    size_t texel = (size_t)y * (size_t)layout->width + (size_t)x, held = (size_t)t->held_count;
    for (size_t i = 0; i < held + (size_t)t->fitted_count; i++) {
        size_t at = texel * (size_t)layout->image_count + (size_t)t->image[i];
        const weft_half *half = t->excerpt->samples + 3 * at;
        weft_vec3 light = weft_dataset_light_direction(layout, t->image[i], x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[t->image[i]], x, y);
        if (t->excerpt->mask[at] || !(light.z > 0 && view.z > 0))
            continue;
        if (i >= held) {
            put(&t->fitted, 3 * (texel * (size_t)t->fitted_count + i - held), t->flags[i], half, material[i]);
            continue;
        }
        put(&t->material, 3 * (texel * held + i), t->flags[i], half, material[i]);
        put(&t->photographs, 3 * (texel * held + i), t->flags[i], half, photographs[i]);
    }
}

static weft_code compare_texel(trial *t, int x, int y, weft_error *error)
{
    int images = t->held_count + t->fitted_count;
    weft_rgb *prediction = malloc(2 * (size_t)images * sizeof *prediction);
    if (!prediction)
        return weft_fail_memory(error, "predictions", 2 * (size_t)images * sizeof *prediction);
    weft_rgb *photographs = prediction + images;
    weft_predictor_predict(t->predictor, x, y, t->image, images, prediction);
    weft_code code = weft_interpolation_predict(t->interpolation, x, y, photographs, error);
    if (code == WEFT_OK)
        compare_samples(t, x, y, prediction, photographs);
    free(prediction);
    return code;
}

static weft_code compare_texels(trial *t, weft_error *error)
{
    const weft_dataset_layout *layout = &t->excerpt->layout;
    weft_code code = WEFT_OK;
#pragma omp parallel for schedule(dynamic, 1)
    for (int texel = 0; texel < layout->width * layout->height; texel++) {
        weft_error own = {0};
        weft_code own_code = compare_texel(t, texel % layout->width, texel / layout->width, &own);
#pragma omp critical
        if (own_code != WEFT_OK) {
            code = own_code;
            if (error)
                *error = own;
        }
    }
    return code;
}

static weft_code allocate_comparison(const weft_excerpt *excerpt, int image_count, comparison *compared,
                                     weft_error *error)
{
    size_t count = 3 * (size_t)excerpt->layout.width * (size_t)excerpt->layout.height * (size_t)image_count;
    *compared = (comparison){count, calloc(count + 1, sizeof *compared->value), calloc(count + 1, 1)};
    return compared->value && compared->group
               ? WEFT_OK
               : weft_fail_memory(error, "samples", count * (sizeof *compared->value + 1));
}

static void free_comparison(comparison *compared)
{
    free(compared->value);
    free(compared->group);
}

static void list_images(const uint8_t *held, const uint8_t *next, int image_count, trial *t)
{
    for (int i = 0; i < image_count; i++) {
        if (!held[i])
            continue;
        t->flags[t->held_count] = held[i];
        t->image[t->held_count++] = i;
    }
    for (int i = 0; i < image_count; i++) {
        if (held[i] || !next[i])
            continue;
        t->flags[t->held_count + t->fitted_count] = next[i];
        t->image[t->held_count + t->fitted_count++] = i;
    }
}

static weft_code allocate_trial(const weft_excerpt *excerpt, const uint8_t *held, const uint8_t *next, trial *t,
                                weft_error *error)
{
    size_t images = (size_t)excerpt->layout.image_count;
    *t = (trial){.excerpt = excerpt, .image = calloc(images, sizeof *t->image), .flags = calloc(images, 1)};
    if (!t->image || !t->flags)
        return weft_fail_memory(error, "images", images * (sizeof *t->image + 1));
    list_images(held, next, excerpt->layout.image_count, t);
    WEFT_TRY(allocate_comparison(excerpt, t->held_count, &t->material, error));
    WEFT_TRY(allocate_comparison(excerpt, t->held_count, &t->photographs, error));
    return allocate_comparison(excerpt, t->fitted_count, &t->fitted, error);
}

static void free_trial(trial *t)
{
    weft_predictor_free(t->predictor);
    weft_interpolation_free(t->interpolation);
    free(t->image);
    free(t->flags);
    free_comparison(&t->material);
    free_comparison(&t->photographs);
    free_comparison(&t->fitted);
}

/* ---- Errors ---- */

static void drop_empty_slots(comparison *compared)
{
    size_t kept = 0;
    for (size_t i = 0; i < compared->count; i++) {
        if (!compared->group[i])
            continue;
        compared->value[kept] = compared->value[i];
        compared->group[kept++] = compared->group[i];
    }
    compared->count = kept;
}

static weft_code summarise_group(const comparison *compared, int flags, weft_error_summary *result, weft_error *error)
{
    return weft_error_summary_of_group(compared->value, compared->group, compared->count, flags, result, error);
}

static weft_code summarise(comparison *compared, weft_hold_out_error *result, weft_error *error)
{
    drop_empty_slots(compared);
    WEFT_TRY(weft_error_summary_of(compared->value, compared->count, &result->all, error));
    WEFT_TRY(summarise_group(compared, WEFT_HELD_VIEW, &result->view, error));
    WEFT_TRY(summarise_group(compared, WEFT_HELD_LIGHT, &result->light, error));
    return summarise_group(compared, WEFT_HELD_VIEW | WEFT_HELD_LIGHT, &result->both, error);
}

/* Takes one more summary into a mean over `*taken` of them; one without values does not count. */
static void take_into_mean(const weft_error_summary *one, int *taken, weft_error_summary *mean)
{
    if (one->count == 0)
        return;
    double share = 1.0 / ++*taken;
    mean->median_relative += share * (one->median_relative - mean->median_relative);
    mean->percentile80_relative += share * (one->percentile80_relative - mean->percentile80_relative);
    mean->rmse += share * (one->rmse - mean->rmse);
    mean->relative_rmse += share * (one->relative_rmse - mean->relative_rmse);
    mean->psnr_db =
        isinf(one->psnr_db) || isinf(mean->psnr_db) ? INFINITY : mean->psnr_db + share * (one->psnr_db - mean->psnr_db);
    mean->count += one->count;
}

/* How many splits are in each mean. */
typedef struct means_taken {
    int all, view, light, both;
} means_taken;

static void take_errors(const weft_hold_out_error *one, means_taken *taken, weft_hold_out_error *mean)
{
    take_into_mean(&one->all, &taken->all, &mean->all);
    take_into_mean(&one->view, &taken->view, &mean->view);
    take_into_mean(&one->light, &taken->light, &mean->light);
    take_into_mean(&one->both, &taken->both, &mean->both);
}

/* ---- The fits ---- */

/* The whole measurement at work. */
typedef struct measuring {
    const weft_compress_options *given;
    weft_compress_options options; /* of the fits without some images */
    const char *scratch_path;
    weft_excerpt excerpt;
    weft_splits splits;
    weft_compress_model whole_model; /* that all images carry, and its lobes */
    int whole_lobes;
    means_taken material_taken, photographs_taken;
    int fitted_taken;
    int measured_count; /* of the splits: the first ones */
    weft_hold_out *result;
} measuring;

static weft_code fit_without(const measuring *work, const uint8_t *held, weft_material *material,
                             weft_compress_report *report, weft_error *error)
{
    weft_dataset *others;
    WEFT_TRY(weft_excerpt_write(&work->excerpt, held, work->scratch_path, &others, error));
    weft_code code = weft_compress(others, &work->options, NULL, material, report, error);
    weft_dataset_close(others);
    return code;
}

static weft_code predict(const weft_material *material, const uint8_t *held, trial *t, weft_error *error)
{
    WEFT_TRY(weft_predictor_of_material(&t->excerpt->layout, material, &t->predictor, error));
    WEFT_TRY(weft_interpolation_create(t->excerpt, held, t->image, t->held_count, &t->interpolation, error));
    return compare_texels(t, error);
}

static weft_code measure_trial(measuring *work, trial *t, weft_error *error)
{
    weft_hold_out_error material, photographs;
    weft_error_summary fitted;
    WEFT_TRY(summarise(&t->material, &material, error));
    WEFT_TRY(summarise(&t->photographs, &photographs, error));
    drop_empty_slots(&t->fitted);
    WEFT_TRY(weft_error_summary_of(t->fitted.value, t->fitted.count, &fitted, error));
    take_errors(&material, &work->material_taken, &work->result->material);
    take_errors(&photographs, &work->photographs_taken, &work->result->photographs);
    take_into_mean(&fitted, &work->fitted_taken, &work->result->fitted);
    return WEFT_OK;
}

static weft_code measure_split(measuring *work, int split, weft_error *error)
{
    const uint8_t *held = weft_splits_held(&work->splits, split);
    const uint8_t *next = weft_splits_held(&work->splits, (split + 1) % work->splits.count);
    weft_material material;
    weft_compress_report report;
    WEFT_TRY(fit_without(work, held, &material, &report, error));
    work->result->smaller_model |= report.model != work->whole_model || report.lobe_count != work->whole_lobes;
    trial t;
    weft_code code = allocate_trial(&work->excerpt, held, next, &t, error);
    if (code == WEFT_OK)
        code = predict(&material, held, &t, error);
    if (code == WEFT_OK)
        code = measure_trial(work, &t, error);
    free_trial(&t);
    weft_material_free(&material);
    return code;
}

/* ---- Preparation ---- */

static int fewest_kept(const weft_splits *splits)
{
    int fewest = splits->image_count;
    for (int s = 0; s < splits->count; s++) {
        const uint8_t *held = weft_splits_held(splits, s);
        int kept = 0;
        for (int i = 0; i < splits->image_count; i++)
            kept += held[i] == 0;
        fewest = kept < fewest ? kept : fewest;
    }
    return fewest;
}

static weft_code read_excerpt(weft_dataset *dataset, measuring *work, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_dataset_layout others = *layout;
    int lobes;
    others.image_count = fewest_kept(&work->splits);
    if (weft_compress_plan(&others, &work->options, &lobes) == WEFT_COMPRESS_SPARSE)
        return weft_excerpt_read(dataset, WEFT_EXCERPT_BLOCK, BLOCK_SIDE, &work->excerpt, error);
    weft_excerpt_kind kind = layout->distance == WEFT_NEAR ? WEFT_EXCERPT_REGULAR : WEFT_EXCERPT_SCATTERED;
    int side = work->options.layer_count > 0 ? LAYERS_SIDE : SIDE;
    while (side > 1 && (long)side * side * layout->image_count > most_samples)
        side--;
    return weft_excerpt_read(dataset, kind, side, &work->excerpt, error);
}

static void describe(const weft_dataset_layout *layout, measuring *work)
{
    const weft_splits *splits = &work->splits;
    long held = 0;
    for (size_t i = 0; i < (size_t)splits->count * (size_t)splits->image_count; i++)
        held += splits->held[i] != 0;
    *work->result = (weft_hold_out){.kind = splits->kind,
                                    .split_count = work->measured_count,
                                    .view_count = splits->view_count,
                                    .view_held_count = splits->view_held_count,
                                    .light_count = splits->light_count,
                                    .light_held_count = splits->light_held_count,
                                    .image_count = splits->image_count,
                                    .image_held_count = (int)lround((double)held / splits->count),
                                    .texel_count = (long)work->excerpt.layout.width * work->excerpt.layout.height,
                                    .dataset_texel_count = (long)layout->width * layout->height};
}

static weft_code measure_splits(weft_dataset *dataset, measuring *work, const weft_progress *progress,
                                weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    static const char step[] = "fitting without some images";
    WEFT_TRY(read_excerpt(dataset, work, error));
    WEFT_TRY(
        weft_compress_share_budget(layout, &work->excerpt.layout, work->given, &work->options.budget_bytes, error));
    describe(layout, work);
    work->whole_model = weft_compress_plan(layout, &work->options, &work->whole_lobes);
    for (int s = 0; s < work->measured_count; s++) {
        weft_progress_report(progress, step, s, work->measured_count);
        WEFT_TRY(measure_split(work, s, error));
    }
    weft_progress_report(progress, step, work->measured_count, work->measured_count);
    if (work->result->material.all.count == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "every sample that was held out is masked");
    return WEFT_OK;
}

weft_code weft_hold_out_measure(weft_dataset *dataset, const weft_compress_options *options, int split_count,
                                const char *scratch_path, const weft_progress *progress, weft_hold_out *result,
                                weft_error *error)
{
    measuring work = {.given = options, .options = *options, .scratch_path = scratch_path, .result = result};
    work.options.levels = false;
    work.options.held_out = NULL;
    work.options.checkpoint_path = NULL;
    /* The one after the last is that of the fitted images. */
    int most = split_count > 1 ? split_count : 2;
    weft_code code = weft_splits_create(weft_dataset_get_layout(dataset), 0, most, &work.splits, error);
    bool each = work.splits.kind == WEFT_SPLIT_EACH;
    work.measured_count = each || split_count > work.splits.count ? work.splits.count : split_count;
    if (code == WEFT_OK)
        code = measure_splits(dataset, &work, progress, error);
    weft_excerpt_free(&work.excerpt);
    weft_splits_free(&work.splits);
    /* What is free is given back to the system, so that the fit of the whole has room. */
    malloc_trim(0);
    return code;
}
