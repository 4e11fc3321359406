/* A flash that sits beside the lens and shines past the sheet. Its light is reckoned here on the plate, with the cosine
 * of the angle to the middle of its beam; the room under test knows squares of tangents in the frame of the camera. */
#include "registration/lamp/lamp.h"

#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { PHOTOGRAPHS = 10, COLUMNS = 15, PLACES = COLUMNS * COLUMNS };

static const double pitch_mm = 10, paper = 0.85, ink = 0.05, beam_power = 3;
static const weft_vec3 flash_in_camera = {35, -70, 10}, beam_in_camera = {0.06, 0.05, 0.997};

typedef struct scene {
    weft_target target;
    double place[PLACES][2];
    bool is_ink[PLACES];
    weft_paper_places places;
    weft_paper_sample sample[PHOTOGRAPHS][PLACES];
    weft_lamp_evidence evidence[PHOTOGRAPHS];
} scene;

static weft_vec3 out_of_camera(const weft_pose *pose, weft_vec3 v)
{
    const double(*r)[3] = pose->rotation;
    return weft_vec3_of(r[0][0] * v.x + r[1][0] * v.y + r[2][0] * v.z, r[0][1] * v.x + r[1][1] * v.y + r[2][1] * v.z,
                        r[0][2] * v.x + r[1][2] * v.y + r[2][2] * v.z);
}

static weft_vec3 flash_of(const weft_pose *pose)
{
    return weft_add(weft_pose_camera_position(pose), out_of_camera(pose, flash_in_camera));
}

/* Of a flash of unit intensity, at a place of the plate that faces it. */
static double strength(const weft_pose *pose, double x, double y)
{
    weft_vec3 to = weft_subtract(weft_vec3_of(x, y, 0), flash_of(pose));
    double cosine = weft_dot(weft_unit(to), weft_unit(out_of_camera(pose, beam_in_camera)));
    return pow(cosine, beam_power) / weft_dot(to, to);
}

static double value_at(const weft_pose *pose, double x, double y, double exposure)
{
    weft_vec3 flash = flash_of(pose), eye = weft_pose_camera_position(pose);
    double toward_flash = flash.z / weft_length(weft_subtract(flash, weft_vec3_of(x, y, 0)));
    weft_vec3 ray = weft_unit(weft_subtract(weft_vec3_of(x, y, 0), eye));
    double off_axis = weft_dot(ray, out_of_camera(pose, weft_vec3_of(0, 0, 1)));
    return exposure * strength(pose, x, y) * toward_flash * pow(off_axis, 4);
}

static void photograph(scene *s, int i)
{
    weft_angles view = {weft_rad_of_deg(5 + 55.0 * i / (PHOTOGRAPHS - 1)), 2.4 * i};
    weft_lamp_evidence *e = &s->evidence[i];
    *e = (weft_lamp_evidence){.pose = weft_pose_of_view(view, 380 + 25 * (i % 5)), .exposure = 1 + 0.5 * (i % 3)};
    e->paper = (weft_paper_samples){.count = PLACES, .sample = s->sample[i]};
    weft_vec3 eye = weft_pose_camera_position(&e->pose);
    for (int k = 0; k < PLACES; k++) {
        double x = s->place[k][0], y = s->place[k][1];
        weft_vec3 ray = weft_unit(weft_subtract(weft_vec3_of(x, y, 0), eye));
        double off_axis = weft_dot(ray, out_of_camera(&e->pose, weft_vec3_of(0, 0, 1)));
        double value = 8e4 * (s->is_ink[k] ? ink : paper) * value_at(&e->pose, x, y, e->exposure);
        s->sample[i][k] = (weft_paper_sample){.place = k, .radius_squared = (float)(1 / (off_axis * off_axis) - 1)};
        for (int c = 0; c < 3; c++)
            s->sample[i][k].light[c] = (float)value;
    }
}

static scene *photograph_all(void)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->target = weft_target_printed(40);
    for (int k = 0; k < PLACES; k++) {
        s->place[k][0] = pitch_mm * (k % COLUMNS - COLUMNS / 2);
        s->place[k][1] = pitch_mm * (k / COLUMNS - COLUMNS / 2);
        s->is_ink[k] = k % 4 == 3;
    }
    s->places = (weft_paper_places){PLACES, s->place, s->is_ink, 1};
    for (int i = 0; i < PHOTOGRAPHS; i++)
        photograph(s, i);
    return s;
}

static void a_flash_is_found_where_it_is_though_its_beam_points_elsewhere(void **state)
{
    (void)state;
    scene *s = photograph_all();
    weft_lamp_place place[PHOTOGRAPHS];
    weft_lamp_solution found = {.place = place};
    weft_lamp_problem problem = {.target = &s->target,
                                 .places = &s->places,
                                 .count = PHOTOGRAPHS,
                                 .evidence = s->evidence,
                                 .corner_radius_squared = 0.16,
                                 .flash = true};
    weft_error error = {0};
    weft_lamp_guess(&problem, &found);
    assert_int_equal(weft_lamp_solve(&problem, &found, &error), WEFT_OK);
    const double *at = found.flash.place_mm;
    printf("flash at %.1f %.1f %.1f mm\n", at[0], at[1], at[2]);
    assert_near(at[0], flash_in_camera.x, 6);
    assert_near(at[1], flash_in_camera.y, 6);
    assert_near(at[2], flash_in_camera.z, 12);
    assert_near(found.dark_error, 0, 0);
    for (int i = 0; i < PHOTOGRAPHS; i++) {
        const weft_pose *pose = &s->evidence[i].pose;
        double level = 8e4 * s->evidence[i].exposure * strength(pose, 0, 0);
        assert_near(place[i].level[1] / level, 1, 0.02);
        /* From rim to rim of the opening, beside the inverse square law. */
        double low = weft_flash_log_beam(&found.flash, pose, -20, -20);
        double high = weft_flash_log_beam(&found.flash, pose, 20, 20);
        weft_vec3 flash = flash_of(pose), a = weft_subtract(weft_vec3_of(-20, -20, 0), flash);
        weft_vec3 b = weft_subtract(weft_vec3_of(20, 20, 0), flash);
        double expected = log(strength(pose, 20, 20) * weft_dot(b, b)) - log(strength(pose, -20, -20) * weft_dot(a, a));
        assert_near(high - low, expected, 0.015);
    }
    free(s);
}

int test_photographs_flash(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flash_is_found_where_it_is_though_its_beam_points_elsewhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
