/* A night of a contrast of 10^4 through the whole chain: brackets as the histogram asks for them, registration, the
 * truth. The cloth is a chequer of 16 matt fields of three channels, from white to a ten-thousandth of it. Compared are
 * the texels within the fields: what is measured is the radiometry, not the edges. The rig and its truth share the
 * model of the cloth; registration knows neither. */
#include "base/numeric/statistics.h"
#include "btf/dataset/dataset.h"
#include "registration/registration.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/ground_truth.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/virtual_session.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHOTS = 4, SIZE = 208, TEXELS = 32, FIELDS = 4, BRACKETS = 4, VALUES = SHOTS * TEXELS * TEXELS * 3 };

static const double contrast = 1e4;

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "20,90,0,0\n60,270,0,0\n15,90,40,250\n55,80,40,250\n";

/* ---- The cloth ---- */

/* Albedo of a field in a channel: the 48 levels are even in the logarithm, and lie about at random. */
static double albedo(int field, int channel)
{
    enum { LEVELS = 3 * FIELDS * FIELDS };
    int level = (field * 3 + channel) * 29 % LEVELS;
    return 0.9 * pow(contrast, -level / (LEVELS - 1.0));
}

static void write_cloth(void)
{
    FILE *file = fopen("cloth.wv", "w");
    assert_non_null(file);
    fprintf(file, "weave { name = \"fields\", tileWidth = %d, tileHeight = %d, alpha = 0.01, beta = 4, ss = 0.5,\n",
            FIELDS, FIELDS);
    fputs("hWidth = 0.5, warpArea = 1, weftArea = 1,\npattern {", file);
    for (int i = 0; i < FIELDS * FIELDS; i++)
        fprintf(file, "%s %d", i ? "," : "", i + 1);
    fputs(" }", file);
    for (int i = 0; i < FIELDS * FIELDS; i++)
        fprintf(
            file,
            ",\nyarn { type = warp, psi = 0, umax = 20, kappa = 0, width = 1, length = 1, centerU = %g, centerV = %g,\n"
            "kd = {%.9g, %.9g, %.9g}, ks = {0, 0, 0} }",
            (i % FIELDS + 0.5) / FIELDS, 1 - (i / FIELDS + 0.5) / FIELDS, albedo(i, 0), albedo(i, 1), albedo(i, 2));
    fputs(" }\n", file);
    assert_int_equal(fclose(file), 0);
}

/* ---- The night ---- */

static weft_capture_summary photograph(const char *folder, int brackets)
{
    virtual_session request = {.rig = {"cloth.wv", 11, weft_virtual_settings_default()}};
    weft_virtual_settings *settings = &request.rig.settings;
    weft_capture_summary summary;
    weft_error error = {0};
    request.capture = (weft_capture_request){.folder = folder, .plan = "plan.csv", .brackets = brackets};
    request.truth = (weft_truth_request){"truth.h5", TEXELS, SHOTS};
    settings->rig.width_px = settings->rig.height_px = SIZE;
    settings->rig.focal_length_px = 960;
    settings->tiles_x = settings->tiles_y = 1;
    settings->cloth_noise = 0;
    expect_ok(virtual_session_take(&request, NULL, NULL, &summary, &error), &error);
    return summary;
}

static void register_night(const char *folder)
{
    weft_registration registration;
    weft_session session;
    weft_error error = {0};
    expect_ok(weft_session_open(folder, &session, &error), &error);
    weft_registration_settings settings = weft_registration_defaults(&session);
    settings.width = settings.height = TEXELS;
    expect_ok(weft_register_session(&session, "night.btf.h5", &settings, NULL, &registration, &error), &error);
    weft_registration_free(&registration);
    weft_session_free(&session);
}

/* ---- Against the truth ---- */

/* The edges of the fields are put out of the truth, a texel to either side. */
static void leave_edges_out(truth *real)
{
    const int field = TEXELS / FIELDS;
    for (int i = 0; i < VALUES / 3; i++) {
        int x = i % TEXELS % field, y = i / TEXELS % TEXELS % field;
        if (x == 0 || y == 0 || x == field - 1 || y == field - 1)
            memset(real->reflectance[i], 0, sizeof real->reflectance[i]);
    }
}

typedef struct figures {
    double median, high; /* relative errors of the samples that are not masked: half, and 99 of 100, are below */
    double share;        /* of the samples within fields that are not masked */
    double contrast;     /* of the true reflectances of these */
} figures;

static double contrast_of(const truth *real)
{
    double least = INFINITY, most = 0;
    for (int i = 0; i < VALUES; i++) {
        double value = (double)real->reflectance[i / 3][i % 3];
        most = fmax(most, value);
        least = value > 0 ? fmin(least, value) : least;
    }
    return most / least;
}

static figures compare(void)
{
    truth real;
    truth_errors errors;
    weft_dataset *dataset;
    weft_error error = {0};
    static double all[VALUES];
    int count = 0, inside = 0;
    expect_ok(truth_read("truth.h5", &real, &error), &error);
    expect_ok(weft_dataset_open("night.btf.h5", &dataset, &error), &error);
    leave_edges_out(&real);
    for (int i = 0; i < VALUES; i++)
        inside += real.reflectance[i / 3][i % 3] > 0;
    expect_ok(truth_compare_above(&real, dataset, 0, &errors, &error), &error);
    weft_dataset_close(dataset);
    for (int i = 0; i < real.image_count; i++) {
        memcpy(all + count, errors.error + (size_t)i * (size_t)errors.capacity, (size_t)errors.count[i] * sizeof *all);
        count += errors.count[i];
    }
    figures f = {weft_quantile(all, count, 0.5), weft_quantile(all, count, 0.99), (double)count / inside,
                 contrast_of(&real)};
    truth_errors_free(&errors);
    truth_free(&real);
    return f;
}

static figures measure(const char *folder, int brackets)
{
    weft_capture_summary summary = photograph(folder, brackets);
    register_night(folder);
    figures f = compare();
    print_message(
        "contrast %.3g, %d shots, %d photographs more: median %.2f %%, 99th percentile %.2f %%, %.1f %% masked\n",
        f.contrast, summary.taken, summary.bracketed, 100 * f.median, 100 * f.high, 100 * (1 - f.share));
    return f;
}

static void a_night_of_high_contrast_is_met_with_brackets(void **state)
{
    (void)state;
    write_cloth();
    scratch_store("plan.csv", plan, sizeof plan - 1);
    figures without = measure("without", 0), with = measure("with", BRACKETS);
    assert_true(with.contrast >= contrast);
    assert_true(with.median < 0.01);
    assert_true(with.high < 0.05);
    assert_true(with.share > 0.95);
    assert_true(without.high > 4 * with.high);
}

int test_contrast(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_night_of_high_contrast_is_met_with_brackets)};
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
