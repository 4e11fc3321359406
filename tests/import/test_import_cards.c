/* Nine real flash photographs of a card, and one of a towel, by phones. Skipped without them. */
#include "folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static const char *const cards = WEFT_SHARED "/real/cards-blue", *const towel = WEFT_SHARED "/real/phone-towel";
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

/* Linear green in the middle of a photograph of a grey card. */
static double middle_of(const char *path)
{
    enum { REACH = 20 };
    weft_image image;
    double sum = 0;
    assert_int_equal(weft_image_read(path, &image, NULL, NULL), WEFT_OK);
    for (int y = -REACH; y < REACH; y++)
        for (int x = -REACH; x < REACH; x++)
            sum += (double)image.pixels[3 * ((image.height / 2 + y) * (long)image.width + image.width / 2 + x) + 1];
    weft_image_free(&image);
    return pow((sum / (4.0 * REACH * REACH) + 0.055) / 1.055, 2.4);
}

/* A green towel under the flash of a phone, 18.5 cm away. A card of 18 % grey at 20 cm tells the power of the flash. */
static void a_towel_under_a_flash_becomes_a_green_material(void **state)
{
    (void)state;
    if (access(towel, R_OK) != 0)
        skip();
    test_folder folder = folder_make();
    weft_image image;
    char path[512], power[64];
    snprintf(path, sizeof path, "%s/greycard_low.jpg", towel);
    double watts = middle_of(path) * 3.14159265 * 20 * 20 / 0.18;
    snprintf(power, sizeof power, "%.1f,%.1f,%.1f\n", watts, watts, watts);
    snprintf(path, sizeof path, "%s/towel/point.jpg", towel);
    assert_int_equal(weft_image_read(path, &image, NULL, NULL), WEFT_OK);
    folder_put_image(&folder, "00.png", &image);
    weft_image_free(&image);
    folder_put_text(&folder, "camera_pos.txt", "0,0,18.5\n");
    folder_put_text(&folder, "light_pos.txt", "0,1.2,18.5\n");
    folder_put_text(&folder, "light_power.txt", power);
    folder_put_text(&folder, "image_size.txt", "23.7\n");
    weft_import_options options = weft_import_defaults();
    options.width = 2 * WIDTH;
    weft_import_report report;
    assert_int_equal(weft_import(folder.path, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    double sum[3] = {0, 0, 0};
    long valid = 0, texels = (long)import.layout->width * import.layout->height;
    for (long i = 0; i < texels; i++) {
        if (import.mask[i])
            continue;
        for (int c = 0; c < 3; c++)
            sum[c] += (double)weft_float_of_half(import.samples[3 * i + c]);
        valid++;
    }
    print_message("towel: %.3f %.3f %.3f, %ld of %ld texels\n", sum[0] / (double)valid, sum[1] / (double)valid,
                  sum[2] / (double)valid, valid, texels);
    assert_true(valid > 0.98 * (double)texels);
    assert_true(sum[1] > 1.3 * sum[0] && sum[0] > 2 * sum[2]);
    assert_true(sum[1] > 0.2 * (double)valid && sum[1] < 1.0 * (double)valid);
    imported_close(&import);
    folder_remove(&folder);
}

int test_import_cards(void)
{
    if (access(cards, R_OK) != 0) {
        printf("skipped: no photographs in %s\n", cards);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(nine_flash_photographs_become_plausible_reflectance),
                                       cmocka_unit_test(a_towel_under_a_flash_becomes_a_green_material)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
