/* What single photographs tell of the lamp: the shadow of the pin, the highlight on a ball, a row of a list. Shadows
 * and highlights are drawn here by tracing rays, texel by texel, which the room under test does not do. */
#include "registration/lamp/evidence.h"
#include "registration/lamp/listed.h"

#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double opening_mm = 40, pin_mm = 30, head_mm = 1.5;

/* ---- The shadow of the pin ---- */

static double distance_of_segments(weft_vec3 a, weft_vec3 b, weft_vec3 c, weft_vec3 d)
{
    enum { STEPS = 24 };
    double least = INFINITY;
    for (int i = 0; i <= STEPS; i++) {
        weft_vec3 p = weft_add(a, weft_scale(weft_subtract(b, a), i / (double)STEPS)), along = weft_subtract(d, c);
        double t = weft_dot(weft_subtract(p, c), along) / weft_dot(along, along);
        weft_vec3 q = weft_add(c, weft_scale(along, fmin(fmax(t, 0), 1)));
        least = fmin(least, weft_length(weft_subtract(p, q)));
    }
    return least;
}

/* Part of a round lamp, that faces the pin, that a place of the sheet sees. */
static double lamp_seen(weft_vec3 place, weft_vec3 lamp, double radius, weft_vec3 foot)
{
    enum { PLACES = 24 };
    weft_vec3 neck = weft_add(foot, weft_vec3_of(0, 0, pin_mm - head_mm));
    weft_vec3 toward = weft_unit(lamp), side = weft_unit(weft_cross(toward, weft_vec3_of(0.3, -0.7, 0.2)));
    weft_vec3 other = weft_cross(toward, side);
    weft_vec3 middle = weft_add(place, weft_scale(weft_subtract(lamp, place), 1.2 * pin_mm / lamp.z));
    int seen = 0;
    if (distance_of_segments(foot, neck, place, middle) > 4)
        return 1;
    for (int i = 0; i < PLACES; i++) {
        double r = radius * sqrt((i + 0.5) / PLACES), turn = 2.399963 * i;
        weft_vec3 at = weft_add(lamp, weft_add(weft_scale(side, r * cos(turn)), weft_scale(other, r * sin(turn))));
        /* As far up as the pin reaches. */
        weft_vec3 high = weft_add(place, weft_scale(weft_subtract(at, place), 1.2 * pin_mm / at.z));
        double to_head = distance_of_segments(neck, weft_add(neck, weft_vec3_of(0, 0, 1e-6)), place, high);
        seen += to_head > head_mm && distance_of_segments(foot, neck, place, high) > 0.4;
    }
    return seen / (double)PLACES;
}

/* A patch as a photograph would give it: paper and ink, the fall of light, a word printed beside the pin. */
static float *draw_patch(const weft_pin_area *area, const weft_target *target, weft_vec3 lamp, double radius, bool pin)
{
    float *patch = malloc((size_t)area->columns * (size_t)area->rows * sizeof *patch);
    weft_vec3 foot = weft_vec3_of(area->foot[0], area->foot[1], 0);
    assert_non_null(patch);
    for (int i = 0; i < area->columns * area->rows; i++) {
        weft_vec3 at = weft_vec3_of(area->x0 + area->step_mm * (i % area->columns),
                                    area->y0 + area->step_mm * (i / area->columns), 0);
        weft_vec3 to = weft_subtract(lamp, at);
        double light = lamp.z / pow(weft_length(to), 3) * pow(weft_length(lamp), 2);
        bool word = fabs(at.x - foot.x + 4) < 0.3 && fabs(at.y - foot.y + 6) < 5;
        double reflectance = word ? 0.5 : weft_target_sheet_reflectance(target, at.x, at.y);
        double noise = 0.01 * sin(12.9 * i + 3.1 * lamp.x) * sin(7.7 * i);
        patch[i] = (float)(reflectance * light * ((pin ? lamp_seen(at, lamp, radius, foot) : 1) + noise + 0.02));
    }
    return patch;
}

enum { LAMPS = 7 };
static const double lamp_mm[LAMPS][3] = {{300, 500, 500}, {200, 420, 600},  {250, 100, 600}, {-40, 350, 700},
                                         {500, 60, 620},  {-700, 200, 330}, {600, 250, 380}};

static void find_all(bool pin, weft_pin_area *area, weft_pin_shadow shadow[LAMPS])
{
    weft_target target = weft_target_printed(opening_mm);
    *area = weft_pin_area_of(&target, pin_mm);
    float *patch[LAMPS];
    weft_vec3 eye[LAMPS];
    for (int i = 0; i < LAMPS; i++) {
        patch[i] = draw_patch(area, &target, weft_vec3_of(lamp_mm[i][0], lamp_mm[i][1], lamp_mm[i][2]), 8, pin);
        eye[i] = weft_vec3_of(-300, -200, 600);
    }
    assert_int_equal(weft_pin_find(area, &target, eye, patch, LAMPS, shadow, NULL), WEFT_OK);
    for (int i = 0; i < LAMPS; i++)
        free(patch[i]);
}

static void the_shadow_of_a_pin_ends_where_the_ray_through_its_head_does(void **state)
{
    (void)state;
    weft_pin_area area;
    weft_pin_shadow shadow[LAMPS];
    find_all(true, &area, shadow);
    int ended = 0, left = 0;
    for (int i = 0; i < LAMPS; i++) {
        const double *l = lamp_mm[i], height = pin_mm - head_mm;
        double x = area.foot[0] + (area.foot[0] - l[0]) * height / (l[2] - height);
        double y = area.foot[1] + (area.foot[1] - l[1]) * height / (l[2] - height);
        double ux = x - area.foot[0], uy = y - area.foot[1], length = hypot(ux, uy);
        double dx = shadow[i].place[0] - x, dy = shadow[i].place[1] - y;
        double along = (dx * ux + dy * uy) / length, across = (dy * ux - dx * uy) / length;
        printf("lamp %d: found %d, %.2f mm along (%.2f), %.2f across (%.2f), length %.1f\n", i, shadow[i].found, along,
               shadow[i].along_mm, across, shadow[i].across_mm, length);
        assert_true(shadow[i].found);
        assert_true(fabs(across) < 0.25 && fabs(across) < 3 * shadow[i].across_mm);
        assert_true(shadow[i].across_mm < 0.5);
        if (isinf(shadow[i].along_mm)) {
            left++;
            continue;
        }
        ended++;
        assert_true(fabs(along) < 0.4 && fabs(along) < 3 * shadow[i].along_mm);
    }
    assert_int_equal(left, 1); /* the sixth: it falls to the right, off the sheet */
    assert_true(ended == LAMPS - 1 && isinf(shadow[5].along_mm));
}

static void where_no_pin_stands_no_shadow_is_found(void **state)
{
    (void)state;
    weft_pin_area area;
    weft_pin_shadow shadow[LAMPS];
    find_all(false, &area, shadow);
    for (int i = 0; i < LAMPS; i++)
        assert_false(shadow[i].found);
}

/* ---- The highlight on a ball ---- */

/* A photograph of a ball on white paper that is clipped, as a camera from above takes it. */
static weft_light_values draw_ball(const weft_camera *camera, const weft_pose *pose, const double place[2],
                                   double diameter, weft_vec3 lamp)
{
    weft_light_values values = {camera->width, camera->height, NULL, NULL, 0};
    values.grey = malloc((size_t)camera->width * (size_t)camera->height * sizeof *values.grey);
    assert_non_null(values.grey);
    weft_vec3 eye = weft_pose_camera_position(pose), centre = weft_vec3_of(place[0], place[1], diameter / 2);
    for (int i = 0; i < camera->width * camera->height; i++) {
        double a = (i % camera->width - camera->cx) / camera->fx, b = (i / camera->width - camera->cy) / camera->fy;
        const double(*r)[3] = pose->rotation;
        weft_vec3 ray = weft_unit(weft_vec3_of(r[0][0] * a + r[1][0] * b + r[2][0], r[0][1] * a + r[1][1] * b + r[2][1],
                                               r[0][2] * a + r[1][2] * b + r[2][2]));
        weft_vec3 offset = weft_subtract(eye, centre);
        double half = weft_dot(offset, ray), root = half * half - weft_dot(offset, offset) + diameter * diameter / 4;
        values.grey[i] = NAN; /* clipped paper */
        if (root <= 0)
            continue;
        weft_vec3 at = weft_add(eye, weft_scale(ray, -half - sqrt(root)));
        weft_vec3 normal = weft_scale(weft_subtract(at, centre), 2 / diameter);
        weft_vec3 mirrored = weft_subtract(ray, weft_scale(normal, 2 * weft_dot(ray, normal)));
        if (mirrored.z > 0)
            values.grey[i] = weft_dot(mirrored, weft_unit(weft_subtract(lamp, at))) > cos(0.12) ? NAN : 0.01f;
    }
    return values;
}

/* A single clipped pixel where the ball is dark, above the highlight in the file: the other ball's highlight, mirrored.
 */
static void add_speck(const weft_camera *camera, weft_light_values *values)
{
    int skipped = 0;
    for (int i = 0; i < camera->width * camera->height; i++) {
        if (values->grey[i] < 1 && ++skipped == 60) {
            values->grey[i] = NAN;
            return;
        }
    }
}

static void a_highlight_beside_clipped_paper_is_the_lamps(void **state)
{
    (void)state;
    weft_camera camera = {.width = 400, .height = 300, .fx = 900, .fy = 900, .cx = 199.5, .cy = 149.5};
    weft_pose pose = weft_pose_of_view((weft_angles){0.05, 1}, 400);
    const double place[2] = {8, -5}, diameter = 20;
    for (int i = 0; i < 4; i++) {
        double theta = weft_rad_of_deg(20 + 17 * i), phi = 1.3 * i;
        weft_vec3 lamp = weft_scale(weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)), 700);
        weft_light_values values = draw_ball(&camera, &pose, place, diameter, lamp);
        if (i < 2) /* farther from the highlight than that is wide */
            add_speck(&camera, &values);
        weft_highlight seen =
            weft_ball_highlight(&camera, &pose, &values, weft_vec3_of(place[0], place[1], 0), diameter);
        free(values.grey);
        assert_true(seen.found);
        weft_vec3 eye = weft_pose_camera_position(&pose), centre = weft_vec3_of(place[0], place[1], 10);
        weft_vec3 offset = weft_subtract(eye, centre);
        double half = weft_dot(offset, seen.ray), root = half * half - weft_dot(offset, offset) + 100;
        weft_vec3 at = weft_add(eye, weft_scale(seen.ray, -half - sqrt(root)));
        weft_vec3 normal = weft_scale(weft_subtract(at, centre), 0.1);
        weft_vec3 mirrored = weft_subtract(seen.ray, weft_scale(normal, 2 * weft_dot(seen.ray, normal)));
        double angle = acos(fmin(1, weft_dot(mirrored, weft_unit(weft_subtract(lamp, at)))));
        printf("lamp %.0f degrees from the normal: %.2f off, %.2f stated\n", weft_deg_of_rad(theta),
               weft_deg_of_rad(angle), weft_deg_of_rad(seen.deviation_rad));
        assert_true(angle < 2 * seen.deviation_rad && seen.deviation_rad < weft_rad_of_deg(2));
    }
}

static void a_highlight_near_the_rim_is_known_less_well(void **state)
{
    (void)state;
    weft_camera camera = {.width = 400, .height = 300, .fx = 900, .fy = 900, .cx = 199.5, .cy = 149.5};
    weft_pose pose = weft_pose_of_view((weft_angles){1.1, 0}, 400);
    const double place[2] = {0, 0};
    double deviation[2];
    for (int i = 0; i < 2; i++) {
        weft_vec3 lamp = i ? weft_vec3_of(-600, 0, 250) : weft_vec3_of(500, 0, 400);
        weft_light_values values = draw_ball(&camera, &pose, place, 20, lamp);
        weft_highlight seen = weft_ball_highlight(&camera, &pose, &values, weft_vec3_of(place[0], place[1], 0), 20);
        free(values.grey);
        assert_true(seen.found);
        deviation[i] = seen.deviation_rad;
    }
    assert_true(deviation[1] > 1.5 * deviation[0]);
}

/* ---- Lists ---- */

/* A camera that looks straight down, its x along the plate's x, stands as Exif orientation says. */
static weft_photographs_photograph photograph_from_above(char *name, int orientation)
{
    weft_photographs_photograph p = {.name = name, .exif = {.orientation = orientation}};
    p.pose = (weft_pose){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 0, 500}};
    return p;
}

static weft_light_list list_of(weft_listed_light *row, int count, bool of_pictures)
{
    return (weft_light_list){.path = "rows.lp", .of_pictures = of_pictures, .count = count, .row = row};
}

static void an_lp_file_counts_in_the_picture_as_it_is_shown(void **state)
{
    (void)state;
    char name[] = "a.jpg";
    weft_listed_light row = {.file = name, .has_light = true, .light = {0.6, 0.48, 0.64}};
    weft_light_list list = list_of(&row, 1, true);
    /* Exif 2.3: with 6 the left column is the top, so up is -x of the file, and the right is up in it; with 8 contrary.
     */
    static const struct {
        int orientation;
        double x, y;
    } expected[] = {{1, 0.6, 0.48}, {3, -0.6, -0.48}, {6, -0.48, 0.6}, {8, 0.48, -0.6}};
    for (size_t i = 0; i < 4; i++) {
        weft_photographs_photograph p = photograph_from_above(name, expected[i].orientation);
        weft_listed_lamp lamp = weft_listed_lamp_of(&list, &p);
        assert_true(lamp.found);
        assert_near(lamp.light.x, expected[i].x, 1e-12);
        assert_near(lamp.light.y, expected[i].y, 1e-12);
        assert_near(lamp.light.z, 0.64, 1e-12);
        assert_near(lamp.deviation_rad, WEFT_PI / 180, 1e-12);
    }
    list.of_pictures = false;
    weft_photographs_photograph p = photograph_from_above(name, 6);
    assert_near(weft_listed_lamp_of(&list, &p).light.x, 0.6, 1e-12);
}

enum { ROWS = 6 };

/* Photographs whose lamps lie as the rows say, seen from around. */
static void make_rows(weft_listed_light row[ROWS], weft_photographs_photograph p[ROWS])
{
    static char name[ROWS][8];
    for (int i = 0; i < ROWS; i++) {
        snprintf(name[i], sizeof name[i], "%d.jpg", i);
        weft_vec3 light = weft_unit(weft_vec3_of(cos(1.1 * i), sin(1.1 * i), 0.5 + 0.2 * i));
        row[i] = (weft_listed_light){.file = name[i], .line = 2 + i, .has_light = true, .light = light};
        p[i] = photograph_from_above(name[i], 1);
        p[i].lamp.position_mm = weft_scale(light, 600);
        p[i].lamp.uncertainty_deg = 0.5;
    }
}

static void expect_notes(const weft_light_list *list, const weft_photographs_photograph *p, int count,
                         const char *first)
{
    weft_lines notes = {0};
    assert_int_equal(weft_listed_compare(list, p, ROWS, &notes, NULL), WEFT_OK);
    if (notes.count != count || (count > 0 && !strstr(notes.line[0], first)))
        fail_msg("%d lines, the first '%s'", notes.count, notes.count ? notes.line[0] : "");
    weft_lines_free(&notes);
}

static void rows_that_contradict_the_photographs_are_named(void **state)
{
    (void)state;
    weft_listed_light row[ROWS];
    weft_photographs_photograph p[ROWS];
    make_rows(row, p);
    weft_light_list list = list_of(row, ROWS, true);
    expect_notes(&list, p, 0, "");
    row[3].light = weft_unit(weft_add(row[3].light, weft_vec3_of(0.07, 0, 0)));
    expect_notes(&list, p, 1, "'3.jpg': its lamp is");
    row[3].uncertainty_deg = 3;
    expect_notes(&list, p, 0, "");
    make_rows(row, p);
    for (int i = 0; i < ROWS; i++)
        row[i].light.y = -row[i].light.y;
    expect_notes(&list, p, 1, "if their y points down");
    make_rows(row, p);
    list.count = ROWS - 1;
    expect_notes(&list, p, 1, "1 photographs are not in 'rows.lp', such as '5.jpg'");
}

static void steps_of_a_turntable_count_from_anywhere(void **state)
{
    (void)state;
    weft_listed_light row[ROWS];
    weft_photographs_photograph p[ROWS];
    make_rows(row, p);
    weft_light_list list = list_of(row, ROWS, false);
    for (int i = 0; i < ROWS; i++) {
        double theta = weft_rad_of_deg(15 + 8 * i), phi = weft_rad_of_deg(50 * i);
        p[i].pose = weft_pose_of_view((weft_angles){theta, phi + 1.234}, 500);
        row[i] = (weft_listed_light){.file = p[i].name, .line = 2 + i, .has_view = true};
        row[i].view = weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
    }
    expect_notes(&list, p, 0, "");
    p[4].pose = weft_pose_of_view((weft_angles){weft_rad_of_deg(47), weft_rad_of_deg(200 + 5) + 1.234}, 500);
    expect_notes(&list, p, 1, "'4.jpg': its view is");
}

static void a_list_of_something_else_is_refused(void **state)
{
    (void)state;
    weft_listed_light row[ROWS];
    weft_photographs_photograph p[ROWS];
    make_rows(row, p);
    weft_light_list list = list_of(row, ROWS, true);
    weft_error error = {0};
    assert_int_equal(weft_listed_check(&list, p, ROWS, &error), WEFT_OK);
    list.positions = true;
    row[2].light = weft_vec3_of(0, 0, 3);
    assert_int_equal(weft_listed_check(&list, p, ROWS, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "rows.lp:2: a lamp of length 1"));
    char other[] = "z.jpg";
    list.positions = false, list.count = 1;
    row[0].file = other;
    assert_int_equal(weft_listed_check(&list, p, ROWS, &error), WEFT_BAD_INPUT);
    assert_non_null(
        strstr(error.message, "'rows.lp' lists none of the photographs; it names 'z.jpg', the folder holds '0.jpg'"));
}

int test_photographs_evidence(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_shadow_of_a_pin_ends_where_the_ray_through_its_head_does),
        cmocka_unit_test(where_no_pin_stands_no_shadow_is_found),
        cmocka_unit_test(a_highlight_beside_clipped_paper_is_the_lamps),
        cmocka_unit_test(a_highlight_near_the_rim_is_known_less_well),
        cmocka_unit_test(an_lp_file_counts_in_the_picture_as_it_is_shown),
        cmocka_unit_test(rows_that_contradict_the_photographs_are_named),
        cmocka_unit_test(steps_of_a_turntable_count_from_anywhere),
        cmocka_unit_test(a_list_of_something_else_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
