/* Highlights on real balls under known lamps: a mirror ball (Seitz, University of Washington) and a glossy one
 * (DiLiGenT, Shi et al. 2016). Skipped without them. */
#include "base/picture/image.h"
#include "base/text/csv.h"
#include "registration/lamp/evidence.h"

#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char *const real = WEFT_SHARED "/real";

/* A ball of 20 mm, as an orthographic camera straight above shows it: one that is very far. */
typedef struct ball {
    weft_camera camera;
    weft_pose pose;
} ball;

static ball ball_of(int width, int height, double x, double y, double radius_px)
{
    const double far_mm = 1e5, focal = radius_px / 10 * (far_mm - 10);
    return (ball){.camera = {.width = width, .height = height, .fx = focal, .fy = focal, .cx = x, .cy = y},
                  .pose = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 0, far_mm}}};
}

/* Angle between the lamp that the highlight tells and the true one, degrees; NaN where none is found. */
static double error_deg(const ball *b, const char *path, bool linear, weft_vec3 truth)
{
    weft_tone_curve tone = linear ? weft_tone_linear() : weft_tone_srgb();
    weft_light_values values;
    weft_error error = {0};
    assert_int_equal(weft_light_values_read(path, b->camera.width, b->camera.height, &tone,
                                            (weft_file_range){250.0f / 255, 5.0f / 255}, &values, &error),
                     WEFT_OK);
    const double place[2] = {0, 0};
    weft_highlight seen = weft_ball_highlight(&b->camera, &b->pose, &values, weft_vec3_of(place[0], place[1], 0), 20);
    weft_light_values_free(&values);
    if (!seen.found)
        return NAN;
    weft_vec3 eye = weft_pose_camera_position(&b->pose), offset = weft_subtract(eye, weft_vec3_of(0, 0, 10));
    double half = weft_dot(offset, seen.ray), root = half * half - weft_dot(offset, offset) + 100;
    weft_vec3 normal = weft_scale(weft_add(offset, weft_scale(seen.ray, -half - sqrt(root))), 0.1);
    weft_vec3 light = weft_subtract(seen.ray, weft_scale(normal, 2 * weft_dot(seen.ray, normal)));
    return weft_deg_of_rad(acos(fmin(1, weft_dot(weft_unit(light), weft_unit(truth)))));
}

static void highlights_on_a_mirror_ball_tell_the_lamps(void **state)
{
    (void)state;
    enum { COUNT = 12 };
    char path[256];
    snprintf(path, sizeof path, "%s/lights-chrome-ball/lights.txt", real);
    FILE *lights = fopen(path, "r");
    int count;
    assert_true(lights && fscanf(lights, "%d", &count) == 1 && count == COUNT);
    ball b = ball_of(512, 340, 253.5, 191.0, 119.25);
    double sum = 0, most = 0;
    for (int i = 0; i < COUNT; i++) {
        double x, y, z;
        assert_int_equal(fscanf(lights, "%lf %lf %lf", &x, &y, &z), 3);
        snprintf(path, sizeof path, "%s/lights-chrome-ball/chrome.%d.png", real, i);
        double off = error_deg(&b, path, false, weft_vec3_of(x, -y, z)); /* the file's y points down */
        printf("chrome.%d: %.2f degrees\n", i, off);
        assert_true(isfinite(off));
        sum += off, most = fmax(most, off);
    }
    fclose(lights);
    printf("mirror ball: mean %.2f, largest %.2f degrees\n", sum / COUNT, most);
    assert_true(sum / COUNT < 4 && most < 9); /* the list is an estimate from these photographs itself */
}

static void highlights_on_a_glossy_ball_tell_the_lamps(void **state)
{
    (void)state;
    char path[256];
    snprintf(path, sizeof path, "%s/lights-diligent-ball/lights.csv", real);
    weft_csv table;
    assert_int_equal(weft_csv_read(path, true, &table, NULL), WEFT_OK);
    ball b = ball_of(152, 152, 75.86, 75.88, 70.9);
    double most = 0, sum = 0;
    int found = 0;
    for (int row = 0; row < table.row_count; row++) {
        double l[3];
        for (int i = 0; i < 3; i++)
            assert_int_equal(weft_csv_number(&table, row, 1 + i, &l[i], NULL), WEFT_OK);
        snprintf(path, sizeof path, "%s/lights-diligent-ball/%s", real, weft_csv_text(&table, row, 0));
        double off = error_deg(&b, path, true, weft_vec3_of(l[0], l[1], l[2]));
        if (isfinite(off))
            found++, sum += off, most = fmax(most, off);
    }
    printf("glossy ball: %d of %d found, mean %.2f, largest %.2f degrees\n", found, table.row_count, sum / found, most);
    assert_true(found > 0 && sum / found < 1.5);
    weft_csv_free(&table);
}

int test_real_lights(void)
{
    char path[256];
    snprintf(path, sizeof path, "%s/lights-chrome-ball", real);
    if (access(path, R_OK) != 0) {
        puts("skipped: the photographs of balls are not there");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(highlights_on_a_mirror_ball_tell_the_lamps),
        cmocka_unit_test(highlights_on_a_glossy_ball_tell_the_lamps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
