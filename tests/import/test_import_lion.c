/* Real photographs of a carved lion's head under 240 lamps of a dome. Skipped without them. */
#include "folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static const char *const lion = WEFT_SHARED "/real/lights-rti-lion";

/* Mean over a band of the picture: rows [y0, y1), columns [x0, x1). */
static double band_mean(const imported *import, int image, int x0, int x1, int y0, int y1)
{
    double sum = 0;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++)
            sum += (double)imported_sample(import, x, y, image, 1);
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

/* Lamps on the right brighten the right, those at the top the top: the axes of the .lp file are as documented. */
static void the_relief_is_bright_toward_the_lamp(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    assert_int_equal(weft_import(lion, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
    assert_int_equal(report.image_count, 240);
    assert_int_equal(report.view_count, 1);
    assert_int_equal(report.missing_count, 0);
    assert_int_equal(report.width, 64);
    assert_int_equal(report.height, 43);
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    double toward[4] = {0}, away[4] = {0};
    for (int i = 0; i < 240; i++) {
        weft_vec3 light = import.layout->light[i];
        assert_float_equal(weft_length(light), 1, 1e-5);
        double *right = light.x > 0.6 ? &toward[0] : light.x < -0.6 ? &away[0] : NULL;
        double *top = light.y > 0.6 ? &toward[1] : light.y < -0.6 ? &away[1] : NULL;
        if (right)
            right[2] += 1, *right += band_mean(&import, i, 52, 64, 0, 43) / band_mean(&import, i, 0, 12, 0, 43);
        if (top)
            top[2] += 1, *top += band_mean(&import, i, 0, 64, 0, 8) / band_mean(&import, i, 0, 64, 35, 43);
    }
    for (int axis = 0; axis < 2; axis++) {
        assert_true(toward[axis + 2] > 10 && away[axis + 2] > 10);
        assert_true(toward[axis] / toward[axis + 2] > 1.5 * away[axis] / away[axis + 2]);
    }
    imported_close(&import);
    folder_remove(&folder);
}

int test_import_lion(void)
{
    if (access(lion, R_OK) != 0) {
        printf("skipped: no photographs in %s\n", lion);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_relief_is_bright_toward_the_lamp)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
