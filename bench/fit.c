/* Time and error of the joint fit, of our alternation, and of an alternation with MINPACK where it is installed: the
 * same texels, one method after the other on each, one thread. Usage: bench_fit [texels] [lobes] */
#include "compress/fit.h"
#include "btf/processor.h"
#include "tests/support/synthetic_texel.h"

#ifdef WEFT_HAVE_MINPACK
#include "fit_minpack.h"
#endif

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { JOINT, ALTERNATION, MINPACK, METHODS };

typedef struct bench {
    weft_dataset_layout layout;
    weft_bundle bundle;
    weft_samples samples;
    weft_fit_workspace *workspace;
    float *sum, *count;
    double *table;
    int lobe_count;
} bench;

typedef struct result {
    double microseconds[METHODS], error[METHODS], passes;
    int failed[METHODS];
} result;

static double microseconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

/* Residual of one fit by one method, negative where it failed. */
static double run(bench *with, int method, int *passes)
{
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = with->lobe_count;
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_fit fit = {.residual = -1};
    if (method == JOINT) {
        weft_fit_cold(&with->bundle, &with->samples, 0, &options, with->workspace, &frame, &fit, with->table);
        *passes = fit.passes;
    } else if (method == ALTERNATION) {
        weft_fit_alternate(&with->bundle, &with->samples, 0, &options, 0.1, 20, &frame, &fit, with->table, NULL);
    }
#ifdef WEFT_HAVE_MINPACK
    if (method == MINPACK)
        fit.residual = minpack_alternate(&with->bundle, &with->samples, 0, with->lobe_count, 0.1);
#endif
    return fit.residual;
}

static void measure(bench *with, synthetic_kind kind, uint64_t seed, result *sums)
{
    synthetic_texel(&with->layout, kind, seed, 0.01, with->sum);
    weft_samples_gather(&with->bundle, with->layout.values, with->sum, with->count, 1, &with->samples);
    for (int method = 0; method < METHODS; method++) {
        int passes = 0;
        double began = microseconds_now();
        double residual = run(with, method, &passes);
        sums->microseconds[method] += microseconds_now() - began;
        sums->passes += passes;
        sums->failed[method] += residual < 0;
        sums->error[method] += residual < 0 ? 1 : sqrt(residual / with->samples.energy[0]);
    }
}

static void print_method(const char *name, const result *sums, int method, int count)
{
    if (sums->failed[method] == count)
        printf("  %-28s not installed or failed\n", name);
    else
        printf("  %-28s %9.0f us   relative RMSE %.4f   failed %d\n", name, sums->microseconds[method] / count,
               sums->error[method] / count, sums->failed[method]);
}

static weft_code create(bench *with, weft_error *error)
{
    WEFT_TRY(synthetic_layout(1, 1, &with->layout, error));
    WEFT_TRY(weft_bundle_create(&with->layout, NULL, &with->bundle, error));
    WEFT_TRY(weft_samples_create(&with->bundle, &with->samples, error));
    WEFT_TRY(weft_fit_workspace_create(&with->bundle, &with->workspace, error));
    size_t images = (size_t)with->layout.image_count;
    with->sum = calloc(3 * images, sizeof(float));
    with->count = calloc(images, sizeof(float));
    with->table = calloc((size_t)with->layout.view_count, sizeof(double));
    if (!with->sum || !with->count || !with->table)
        return weft_fail_memory(error, "samples", 16 * images);
    for (size_t i = 0; i < images; i++)
        with->count[i] = 1;
    return WEFT_OK;
}

int main(int argc, char **argv)
{
    static const char *const kind_name[SYNTHETIC_KINDS] = {"Lafortune x T", "two Ward lobes", "crossed yarns"};
    int count = argc > 1 ? atoi(argv[1]) : 12;
    bench with = {.lobe_count = argc > 2 ? atoi(argv[2]) : 2};
    weft_error error = {0};
    if (count < 1 || with.lobe_count < 1 || with.lobe_count > 3 || create(&with, &error) != WEFT_OK) {
        fprintf(stderr, "bench_fit: %s\n", error.message[0] ? error.message : "usage: bench_fit [texels] [lobes 1..3]");
        return 1;
    }
    unsigned state = weft_denormals_off();
    for (synthetic_kind kind = 0; kind < SYNTHETIC_KINDS; kind++) {
        result sums = {0};
        for (int i = 0; i < count; i++)
            measure(&with, kind, (uint64_t)(64 * i + i), &sums);
        printf("%s, %d texels, %d lobes + T, upright frame, from nothing, %.1f passes\n", kind_name[kind], count,
               with.lobe_count, sums.passes / count);
        print_method("joint", &sums, JOINT, count);
        print_method("alternation, double", &sums, ALTERNATION, count);
        print_method("alternation, MINPACK lmder", &sums, MINPACK, count);
    }
    weft_denormals_restore(state);
    free(with.sum);
    free(with.count);
    free(with.table);
    weft_fit_workspace_free(with.workspace);
    weft_samples_free(&with.samples);
    weft_bundle_free(&with.bundle);
    weft_dataset_layout_free(&with.layout);
    return 0;
}
