/* The representation of Daubert et al. 2001 as they stored and fitted it (all floats, the average frame of the
 * geometry, alternation until T changes by less than 0.1) against the material that Weft makes of the same dataset:
 * error and size (docs/notes/benchmarks.md). */
#include "base/clock.h"
#include "base/processor.h"
#include "compress/compress.h"
#include "compress/fit/fit.h"
#include "compress/run/frames_and_opacity.h"
#include "compress/run/group_sums.h"
#include "compress/texel/texel.h"
#include "tests/support/alternation.h"

#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PAPER_THRESHOLD 0.1
enum { PAPER_ROUNDS = 50 };

typedef struct arguments {
    const char *dataset;
    int lobe_count;
} arguments;

/* The sums of samples of all texels of a level. */
typedef struct level_groups {
    int width, height;
    float *group; /* [height][width][4 image_count] */
} level_groups;

static double processor_seconds(void)
{
    return weft_clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
}

static weft_code read_groups(weft_dataset *dataset, level_groups *groups, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t images = (size_t)layout->image_count, texels = (size_t)layout->width * (size_t)layout->height;
    *groups = (level_groups){layout->width, layout->height, calloc(4 * images * texels, sizeof(float))};
    weft_half *samples = malloc(3 * images * sizeof *samples);
    uint8_t *mask = malloc(images);
    weft_code code = groups->group && samples && mask
                         ? WEFT_OK
                         : weft_fail_memory(error, "sums of samples", 4 * images * texels * sizeof(float));
    for (size_t i = 0; code == WEFT_OK && i < texels; i++) {
        code = weft_dataset_read_block(dataset, (int)(i % (size_t)layout->width), (int)(i / (size_t)layout->width), 1,
                                       1, samples, mask, error);
        if (code == WEFT_OK)
            weft_group_of_texel(samples, mask, NULL, images, groups->group + 4 * images * i);
    }
    free(samples);
    free(mask);
    return code;
}

/* The level above, in place of the one below. */
static weft_code halve_groups(level_groups *groups, size_t images, weft_error *error)
{
    level_groups above = {(groups->width + 1) / 2, (groups->height + 1) / 2, NULL};
    size_t floats = 4 * images * (size_t)above.width * (size_t)above.height;
    above.group = calloc(floats, sizeof *above.group);
    if (!above.group)
        return weft_fail_memory(error, "sums of samples", floats * sizeof(float));
    for (int y = 0; y < groups->height; y++) {
        for (int x = 0; x < groups->width; x++) {
            size_t from = (size_t)y * (size_t)groups->width + (size_t)x;
            size_t to = (size_t)(y / 2) * (size_t)above.width + (size_t)(x / 2);
            weft_group_add(groups->group + 4 * images * from, images, above.group + 4 * images * to);
        }
    }
    free(groups->group);
    *groups = above;
    return WEFT_OK;
}

static weft_code fit_texel(const weft_bundle *bundle, const weft_samples *samples, int lobe_count,
                           const weft_frame *frame, double *table, weft_error_sums *result, weft_error *error)
{
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = lobe_count;
    double scale = samples->scale * samples->scale;
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        weft_fit fit;
        WEFT_TRY(weft_fit_alternate(bundle, samples, channel, &options, PAPER_THRESHOLD, PAPER_ROUNDS, frame, &fit,
                                    table, error));
        result->square += scale * samples->energy[channel];
        result->square_error += scale * weft_fit_residual(bundle, samples, channel, &fit, table);
    }
    return WEFT_OK;
}

/* The tangent is that of the paper: perpendicular to the normal and to what is perpendicular to normal and x. */
static weft_code fit_level(const weft_dataset_layout *layout, const weft_bundle *bundle, const level_groups *groups,
                           int level, int lobe_count, const weft_material_level *frames, weft_error_sums *result,
                           weft_error *error)
{
    size_t images = (size_t)layout->image_count;
    double *table = calloc((size_t)layout->view_count, sizeof *table);
    weft_samples samples;
    weft_code code = weft_samples_create(bundle, &samples, error);
    if (code == WEFT_OK && !table)
        code = weft_fail_memory(error, "view table", (size_t)layout->view_count * sizeof *table);
    for (int i = 0; code == WEFT_OK && i < groups->width * groups->height; i++) {
        const float *group = groups->group + 4 * images * (size_t)i;
        int extent[4], size = weft_texel_group(layout, level, i % groups->width, i / groups->width, extent);
        weft_samples_gather(bundle, layout->values, group, group + 3 * images, size, &samples);
        weft_frame frame = weft_frame_of_normal(weft_frame_decode(frames->frame + 3 * (size_t)i).normal, 0);
        code = fit_texel(bundle, &samples, lobe_count, &frame, table, result, error);
    }
    weft_samples_free(&samples);
    free(table);
    return code;
}

static void print_level(int level, const level_groups *groups, const weft_error_sums *paper,
                        const weft_error_summary *ours, double seconds)
{
    double relative = weft_error_sums_relative_rmse(paper);
    printf("%5d  %4d x %-4d  %8.4f  %8.4f  %8.3f  %10.2f\n", level, groups->width, groups->height, relative,
           ours->relative_rmse, relative > 0 ? ours->relative_rmse / relative : 1, seconds);
}

/* lobes: Cx, Cy, Cz, N; rho; frame: normal and tangent; T with alpha. */
static double paper_bytes(const weft_material *material)
{
    double texels = 0, floats = 3.0 * (4 * material->lobe_count + 1) + 6 + 4.0 * material->view_count;
    for (int k = 0; k < material->level_count; k++)
        texels += (double)material->level[k].width * material->level[k].height;
    return sizeof(float) * floats * texels;
}

static weft_code compare_levels(weft_dataset *dataset, const arguments *given, const weft_material *ours,
                                weft_material *frames, const weft_bundle *bundle, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    level_groups groups = {0};
    WEFT_TRY(weft_given_frames_store(dataset, frames, error));
    weft_code code = read_groups(dataset, &groups, error);
    printf("level       texels  paper      Weft      Weft/paper  paper's s\n");
    for (int k = 0; code == WEFT_OK && k < ours->level_count; k++) {
        weft_error_sums paper = {0};
        double began = processor_seconds();
        if (k > 0)
            code = halve_groups(&groups, (size_t)layout->image_count, error);
        if (code == WEFT_OK)
            code = fit_level(layout, bundle, &groups, k, given->lobe_count, &frames->level[k], &paper, error);
        if (code == WEFT_OK)
            print_level(k, &groups, &paper, &ours->level[k].error, processor_seconds() - began);
    }
    free(groups.group);
    return code;
}

static weft_code compare(weft_dataset *dataset, const arguments *given, weft_error *error)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_material ours, frames = {0};
    weft_bundle bundle = {0};
    uint64_t bytes = 0;
    options.lobe_count = given->lobe_count;
    double began = processor_seconds();
    WEFT_TRY(weft_compress(dataset, &options, NULL, &ours, NULL, error));
    double seconds = processor_seconds() - began;
    weft_code code = weft_material_size(&ours, &bytes, error);
    if (code == WEFT_OK)
        code = weft_material_create(ours.level[0].width, ours.level[0].height, 0, 0, 0, true, &frames, error);
    if (code == WEFT_OK)
        code = weft_bundle_create(weft_dataset_get_layout(dataset), NULL, &bundle, error);
    if (code == WEFT_OK)
        code = compare_levels(dataset, given, &ours, &frames, &bundle, error);
    if (code == WEFT_OK)
        printf("size: %.3f MB as floats, %.3f MB as Weft writes it, fitted in %.2f s of processor time\n",
               1e-6 * paper_bytes(&ours), 1e-6 * (double)bytes, seconds);
    weft_bundle_free(&bundle);
    weft_material_free(&frames);
    weft_material_free(&ours);
    return code;
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    arguments *to = state->input;
    switch (key) {
    case 'l':
        to->lobe_count = atoi(text);
        if (to->lobe_count < 1 || to->lobe_count > WEFT_MATERIAL_MAX_LOBES)
            argp_error(state, "'%s': the number of lobes must be 1 to %d", text, WEFT_MATERIAL_MAX_LOBES);
        return 0;
    case ARGP_KEY_ARG:
        if (to->dataset)
            argp_error(state, "one dataset");
        to->dataset = text;
        return 0;
    case ARGP_KEY_END:
        if (!to->dataset)
            argp_error(state, "needs NAME.btf.h5");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

int main(int argc, char **argv)
{
    static const struct argp_option option[] = {{"lobes", 'l', "K", 0, "Lobes, 1 to 3 (default 2)", 0}, {0}};
    const struct argp parser = {
        .options = option,
        .parser = parse_option,
        .args_doc = "NAME.btf.h5",
        .doc = "Error and size of the representation of Daubert et al. 2001 and of Weft's, level by level.",
    };
    arguments given = {.lobe_count = 2};
    argp_parse(&parser, argc, argv, 0, NULL, &given);
    weft_dataset *dataset;
    weft_error error = {0};
    weft_code code = weft_processor_check(&error);
    if (code == WEFT_OK)
        code = weft_dataset_open(given.dataset, &dataset, &error);
    if (code == WEFT_OK) {
        code = compare(dataset, &given, &error);
        weft_dataset_close(dataset);
    }
    if (code != WEFT_OK)
        fprintf(stderr, "bench_paper: %s\n", error.message);
    return code == WEFT_OK ? 0 : 1;
}
