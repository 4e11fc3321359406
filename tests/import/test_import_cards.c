/* Nine real flash photographs of a card. Skipped without them. */
#include "folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static const char *const cards = WEFT_SHARED "/real/cards-blue";
enum { WIDTH = 64 };

static void nine_flash_photographs_become_plausible_reflectance(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    weft_import_options options = weft_import_defaults();
    options.width = WIDTH;
    weft_import_report report;
    assert_int_equal(weft_import(cards, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
    assert_int_equal(report.image_count, 9);
    assert_true(report.saturated_fraction > 0 && report.saturated_fraction < 0.2);
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    assert_float_equal(import.layout->texel_pitch_mm, 68.48 / WIDTH, 1e-6);
    double sum = 0;
    long valid = 0;
    for (int i = 0; i < WIDTH * WIDTH * 9; i++) {
        if (import.mask[i])
            continue;
        float green = weft_float_of_half(import.samples[3 * i + 1]);
        assert_true(green >= 0 && green < 1.2f);
        sum += (double)green;
        valid++;
    }
    assert_in_range(valid, WIDTH * WIDTH * 7, WIDTH * WIDTH * 9);
    assert_true(sum / (double)valid > 0.02 && sum / (double)valid < 0.8);
    imported_close(&import);
    folder_remove(&folder);
}

int test_import_cards(void)
{
    if (access(cards, R_OK) != 0) {
        printf("skipped: no photographs in %s\n", cards);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(nine_flash_photographs_become_plausible_reflectance)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
