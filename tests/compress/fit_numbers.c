/* Fits a few synthetic texels and prints the relative RMSE of each, so that two builds for different processors can be
 * compared. Plain C without libraries: it is also cross-compiled. Exit code 1, saying why, where a fit contradicts the
 * samples or denormal floats are handled wrongly; 77 where this processor lacks the
 * instruction set of WEFT_ISA. */
#include "base/processor.h"
#include "btf/direction/direction.h"
#include "compress/fit/fit.h"
#include "tests/support/alternation.h"
#include "tests/support/synthetic_texel.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TEXELS = 4 };

typedef struct texel {
    weft_dataset_layout layout;
    weft_bundle bundle;
    weft_samples samples;
    weft_fit_workspace *workspace;
    float *sum, *count;
    double table[WEFT_UBO81_COUNT];
} texel;

static weft_code create(texel *one, weft_error *error)
{
    WEFT_TRY(synthetic_layout(1, 1, &one->layout, error));
    WEFT_TRY(weft_bundle_create(&one->layout, NULL, &one->bundle, error));
    WEFT_TRY(weft_samples_create(&one->bundle, &one->samples, error));
    WEFT_TRY(weft_fit_workspace_create(&one->bundle, &one->workspace, error));
    size_t images = (size_t)one->layout.image_count;
    one->sum = calloc(3 * images, sizeof *one->sum);
    one->count = calloc(images, sizeof *one->count);
    if (!one->sum || !one->count)
        return weft_fail_memory(error, "samples", 4 * images * sizeof(float));
    for (size_t image = 0; image < images; image++)
        one->count[image] = 1;
    return WEFT_OK;
}

static void destroy(texel *one)
{
    free(one->sum);
    free(one->count);
    weft_fit_workspace_free(one->workspace);
    weft_samples_free(&one->samples);
    weft_bundle_free(&one->bundle);
    weft_dataset_layout_free(&one->layout);
}

/* Prints the RMSE found by the sum over the samples in double, which the sums of the kernel must agree with. */
static weft_code fit_one(texel *one, synthetic_kind kind, int lobes, bool table, bool turn, weft_error *error)
{
    static const char *const name[SYNTHETIC_KINDS] = {"lafortune", "ward", "yarn"};
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = lobes;
    options.table = table;
    options.fit_frame = turn;
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_fit fit;
    weft_fit_cold(&one->bundle, &one->samples, 0, &options, one->workspace, &frame, &fit, one->table);
    double exact = weft_fit_residual(&one->bundle, &one->samples, 0, &fit, one->table);
    if (!(fabs(fit.residual / exact - 1) < 1e-3))
        return weft_fail(error, WEFT_BAD_INPUT, "%s, %d lobes: residual %g, by the samples in double %g", name[kind],
                         lobes, fit.residual, exact);
    printf("%-10s %d lobes%s%s  %.7f\n", name[kind], lobes, table ? " T" : "", turn ? " frame" : "",
           sqrt(exact / one->samples.energy[0]));
    return WEFT_OK;
}

static weft_code fit_all(texel *one, weft_error *error)
{
    for (int i = 0; i < TEXELS * SYNTHETIC_KINDS; i++) {
        synthetic_kind kind = (synthetic_kind)(i % SYNTHETIC_KINDS);
        synthetic_texel(&one->layout, kind, 64 * (uint64_t)i, 0.01, one->sum);
        weft_samples_gather(&one->bundle, one->layout.values, one->sum, one->count, 1, &one->samples);
        for (int lobes = 0; lobes <= 2; lobes++) {
            WEFT_TRY(fit_one(one, kind, lobes, false, false, error));
            WEFT_TRY(fit_one(one, kind, lobes, true, false, error));
        }
        WEFT_TRY(fit_one(one, kind, 1, true, true, error));
    }
    return WEFT_OK;
}

static float half_of_smallest_normal(void)
{
    volatile float smallest = FLT_MIN, half = 0.5f;
    return smallest * half;
}

static weft_code check_denormals(weft_error *error)
{
    unsigned state = weft_denormals_off();
    float inside = half_of_smallest_normal();
    weft_denormals_restore(state);
    if (inside != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "denormals are not taken for 0");
    if (half_of_smallest_normal() == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "denormals are still taken for 0 after the restoration");
    return WEFT_OK;
}

int main(void)
{
    texel one = {0};
    weft_error error = {0};
    if (weft_processor_check(&error) != WEFT_OK) {
        fprintf(stderr, "skipped: %s\n", error.message);
        return 77;
    }
    weft_code code = check_denormals(&error);
    if (code == WEFT_OK)
        code = create(&one, &error);
    if (code == WEFT_OK)
        code = fit_all(&one, &error);
    destroy(&one);
    if (code != WEFT_OK)
        fprintf(stderr, "%s\n", error.message);
    return code != WEFT_OK;
}
