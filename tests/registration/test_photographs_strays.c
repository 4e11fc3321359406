/* What is left out, or refused: markers that a pin or a shadow crosses, and mistakes. Corners are made here from a lens
 * that is known. */
#include "registration/photographs/lens.h"
#include "registration/photographs/steps.h"

#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PHOTOGRAPHS = 10, WIDTH = 1500, HEIGHT = 1000 };

static const double opening_mm = 40, scatter_px = 0.3;

static const weft_camera camera = {
    .width = WIDTH, .height = HEIGHT, .fx = 2200, .fy = 2200, .cx = 752, .cy = 497, .k1 = -0.2, .k2 = 0.2};

/* A place of the plate, above it, in the photograph. */
static weft_pixel seen_at(const weft_camera *lens, const weft_pose *pose, weft_vec3 place)
{
    const double at[3] = {place.x, place.y, place.z},
                 shift[3] = {pose->translation.x, pose->translation.y, pose->translation.z};
    double eye[3];
    for (int row = 0; row < 3; row++) {
        eye[row] = shift[row];
        for (int column = 0; column < 3; column++)
            eye[row] += pose->rotation[row][column] * at[column];
    }
    weft_pixel straight = {lens->cx + lens->fx * eye[0] / eye[2], lens->cy + lens->fy * eye[1] / eye[2]};
    return weft_camera_distort(lens, straight);
}

/* Where a place of a sheet comes to lie. */
typedef weft_vec3 (*shape)(double x, double y, double amount_mm);

/* It rises towards the left and the right, by `rise_mm` at 100 mm from the middle. */
static weft_vec3 folded_up(double x, double y, double rise_mm)
{
    return weft_vec3_of(x, y, rise_mm * x * x / (100 * 100));
}

/* Paper does not stretch: it lies on a cylinder about an axis along (0.8, 0.6), its corners lower by `bow_mm`. */
static weft_vec3 arched(double x, double y, double bow_mm)
{
    const double reach = 0.6 * 62 / 32 * opening_mm + 0.8 * 84 / 32 * opening_mm;
    double radius = reach * reach / (2 * bow_mm), along = 0.8 * x + 0.6 * y, across = 0.6 * x - 0.8 * y;
    double bent = radius * sin(across / radius), low = radius * (cos(across / radius) - 1);
    return weft_vec3_of(0.8 * along + 0.6 * bent, 0.6 * along - 0.8 * bent, low);
}

/* Damp paper: all of it is lower to the sides, as a wave with crest in the middle; steepest half-way. */
static weft_vec3 domed(double x, double y, double bow_mm)
{
    double away = hypot(x, y) / (hypot(62, 84) / 32 * opening_mm);
    return weft_vec3_of(x, y, -bow_mm * (1 - cos(0.75 * 3.14159265 * away)) / (1 - cos(0.75 * 3.14159265)));
}

static weft_photographs_photograph photograph_of(const weft_camera *lens, int number, shape sheet, double amount_mm)
{
    weft_target target = weft_target_printed(opening_mm);
    weft_photographs_photograph p = {0};
    weft_angles view = {weft_rad_of_deg(6.5 * number), weft_rad_of_deg(77.0 * number)};
    p.pose = weft_pose_of_view(view, 430);
    p.marker_count = WEFT_SHEET_MARKER_COUNT;
    for (int id = 0; id < WEFT_SHEET_MARKER_COUNT; id++) {
        weft_rectangle r = weft_target_marker(&target, id);
        const double outline[4][2] = {{r.x0, r.y1}, {r.x1, r.y1}, {r.x1, r.y0}, {r.x0, r.y0}};
        for (int corner = 0; corner < 4; corner++) {
            int i = p.corner_count++;
            double x = outline[corner][0], y = outline[corner][1];
            weft_pixel seen = seen_at(lens, &p.pose, sheet(x, y, amount_mm));
            p.plate[i][0] = x, p.plate[i][1] = y;
            p.seen[i][0] = seen.x + scatter_px * sin(12.9 * i + 7.1 * number);
            p.seen[i][1] = seen.y + scatter_px * sin(4.7 * i + 3.3 * number + 1);
        }
    }
    return p;
}

static void photograph_all(weft_photographs_photograph photograph[PHOTOGRAPHS])
{
    for (int i = 0; i < PHOTOGRAPHS; i++)
        photograph[i] = photograph_of(&camera, i, folded_up, 0);
}

/* Two corners of a marker are found beside an edge that is none of it. */
static void cross(weft_photographs_photograph *photograph, int marker, double by_px)
{
    photograph->seen[4 * marker + 1][0] += by_px;
    photograph->seen[4 * marker + 2][0] += 0.6 * by_px;
}

static void estimate(weft_photographs_photograph photograph[PHOTOGRAPHS], weft_lens_estimate *lens)
{
    weft_error error = {0};
    if (weft_lens_estimate_from(photograph, PHOTOGRAPHS, WIDTH, HEIGHT, NULL, lens, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    print_message("focal length %.2f, %.3f pixels off\n", lens->camera.fx, lens->rms_px);
}

static double view_error_deg(const weft_photographs_photograph *found, int number)
{
    weft_photographs_photograph truth = photograph_of(&camera, number, folded_up, 0);
    weft_vec3 a = weft_unit(weft_pose_camera_position(&found->pose)),
              b = weft_unit(weft_pose_camera_position(&truth.pose));
    return weft_deg_of_rad(acos(fmin(1, weft_dot(a, b))));
}

static void a_crossed_marker_costs_no_photograph(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[PHOTOGRAPHS];
    weft_lens_estimate lens;
    photograph_all(photograph);
    cross(&photograph[2], 1, 9);
    cross(&photograph[5], 0, -12);
    cross(&photograph[5], 9, 7);
    cross(&photograph[5], 12, 14);
    estimate(photograph, &lens);
    for (int i = 0; i < PHOTOGRAPHS; i++) {
        assert_string_equal(photograph[i].remark, "");
        print_message("photograph %d: %d corners, %.3f degrees\n", i, photograph[i].corner_count,
                      view_error_deg(&photograph[i], i));
        assert_true(view_error_deg(&photograph[i], i) < 0.08);
    }
    assert_int_equal(photograph[2].corner_count, WEFT_PLATE_CORNERS - 2);
    assert_int_equal(photograph[5].corner_count, WEFT_PLATE_CORNERS - 6);
    assert_near(lens.camera.fx, camera.fx, 3);
    assert_true(lens.rms_px < 1.1 * scatter_px);
}

/* Good corners are not dropped for the bend of the lens. */
static void no_corner_is_lost_without_reason(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[PHOTOGRAPHS];
    weft_lens_estimate lens;
    photograph_all(photograph);
    estimate(photograph, &lens);
    for (int i = 0; i < PHOTOGRAPHS; i++)
        assert_int_equal(photograph[i].corner_count, WEFT_PLATE_CORNERS);
}

/* Of these a part of the corners lies on one plane, or all do but under another lens. */
static void a_bent_sheet_and_another_zoom_are_left_out(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[PHOTOGRAPHS];
    weft_lens_estimate lens;
    weft_camera zoomed = camera;
    zoomed.fx = zoomed.fy = 1800;
    photograph_all(photograph);
    photograph[4] = photograph_of(&camera, 4, folded_up, 5);
    photograph[7] = photograph_of(&zoomed, 7, folded_up, 0);
    estimate(photograph, &lens);
    for (int i = 0; i < PHOTOGRAPHS; i++) {
        bool wrong = i == 4 || i == 7;
        print_message("photograph %d: %s\n", i, photograph[i].remark);
        assert_true(wrong == (photograph[i].remark[0] != 0));
    }
    assert_near(lens.camera.fx, camera.fx, 3);
}

/* A sheet is not cut down round by round until what is left of it is flat. */
static void most_corners_of_a_gently_bent_sheet_stay_or_none_count(void **state)
{
    (void)state;
    for (double bend_mm = 0.5; bend_mm < 5; bend_mm += 0.5) {
        weft_photographs_photograph photograph[PHOTOGRAPHS];
        weft_lens_estimate lens;
        photograph_all(photograph);
        photograph[4] = photograph_of(&camera, 4, folded_up, bend_mm);
        estimate(photograph, &lens);
        print_message("bent by %.1f mm: %d of %d corners; %s\n", bend_mm, photograph[4].corner_count,
                      WEFT_PLATE_CORNERS, photograph[4].remark);
        assert_true(photograph[4].remark[0] || 4 * photograph[4].corner_count >= 3 * WEFT_PLATE_CORNERS);
    }
}

/* A sheet that all photographs show bent is part of what is estimated; the lens is as good as with a flat one. */
static void a_bowed_sheet_is_found_with_the_lens(void **state)
{
    (void)state;
    static const struct bow {
        const char *name;
        shape sheet;
        double mm;
    } bows[] = {{"arched", arched, 0.5},
                {"arched", arched, 1},
                {"arched", arched, -3},
                {"domed", domed, 1},
                {"domed", domed, -1}};
    weft_target target = weft_target_printed(opening_mm);
    for (size_t k = 0; k < sizeof bows / sizeof *bows; k++) {
        weft_photographs_photograph photograph[PHOTOGRAPHS];
        weft_lens_estimate lens;
        for (int i = 0; i < PHOTOGRAPHS; i++)
            photograph[i] = photograph_of(&camera, i, bows[k].sheet, bows[k].mm);
        cross(&photograph[3], 2, 9);
        estimate(photograph, &lens);
        double bow_mm = weft_lens_bow_mm(&lens.bend, &target), middle = lens.bend.xx + lens.bend.yy;
        print_message("%s by %.1f mm: found %.2f, focal length %.2f %% off +- %.1f\n", bows[k].name, bows[k].mm, bow_mm,
                      100 * (lens.camera.fx / camera.fx - 1), lens.errors.focal_px);
        assert_near(bow_mm / fabs(bows[k].mm), 1, 0.25);
        assert_true(middle * bows[k].mm < 0);
        assert_near(lens.camera.fx / camera.fx, 1, 0.002);
        assert_near(lens.camera.fx, camera.fx, 2 * lens.errors.focal_px);
        for (int i = 0; i < PHOTOGRAPHS; i++) {
            assert_string_equal(photograph[i].remark, "");
            assert_true(view_error_deg(&photograph[i], i) < 0.12);
            assert_int_equal(photograph[i].corner_count, WEFT_PLATE_CORNERS - 2 * (i == 3));
        }
    }
}

static void a_bow_is_found_under_a_lens_that_is_known(void **state)
{
    (void)state;
    weft_target target = weft_target_printed(opening_mm);
    weft_photographs_photograph photograph[PHOTOGRAPHS];
    weft_lens_estimate lens;
    weft_error error = {0};
    for (int i = 0; i < PHOTOGRAPHS; i++)
        photograph[i] = photograph_of(&camera, i, arched, 1);
    expect_ok(weft_lens_estimate_from(photograph, PHOTOGRAPHS, WIDTH, HEIGHT, &camera, &lens, &error), &error);
    assert_near(weft_lens_bow_mm(&lens.bend, &target), 1, 0.1);
    assert_true(lens.camera.fx == camera.fx && lens.distinct_views >= 4);
    assert_true(lens.errors.focal_px == 0 && lens.bend_error_mm > 0);
    for (int i = 0; i < PHOTOGRAPHS; i++)
        assert_true(photograph[i].corner_rms_px < 2 * scatter_px);
}

/* What scatters, and what the lens has beyond k1 and k2, makes no bow. */
static void a_flat_sheet_is_called_flat(void **state)
{
    (void)state;
    for (int other = 0; other < 3; other++) {
        weft_photographs_photograph photograph[PHOTOGRAPHS];
        weft_lens_estimate lens;
        weft_camera strange = camera;
        strange.k3 = other == 1 ? 0.4 : 0;
        strange.p1 = other == 2 ? 0.001 : 0;
        for (int i = 0; i < PHOTOGRAPHS; i++)
            photograph[i] = photograph_of(&strange, i, folded_up, 0);
        cross(&photograph[5], 0, -12);
        estimate(photograph, &lens);
        assert_true(lens.bend.xx == 0 && lens.bend.xy == 0 && lens.bend.yy == 0);
    }
}

/* Half of the photographs, or some, are of a lens that is shorter by a tenth or more. No file says so. */
static void photographs_of_two_lenses_are_parted(void **state)
{
    (void)state;
    for (int others = 3; others <= PHOTOGRAPHS / 2; others++) {
        for (int shorter = 0; shorter < 3; shorter++) {
            weft_photographs_photograph photograph[PHOTOGRAPHS];
            weft_lens_estimate lens;
            weft_camera second = camera;
            second.fx = second.fy = (double[]){1100, 1600, 1980}[shorter];
            second.k1 = 0.05;
            for (int i = 0; i < PHOTOGRAPHS; i++)
                photograph[i] = photograph_of(i % 2 && i / 2 < others ? &second : &camera, i, folded_up, 0);
            estimate(photograph, &lens);
            int kept[2] = {0, 0};
            for (int i = 0; i < PHOTOGRAPHS; i++) {
                bool is_second = i % 2 && i / 2 < others, is_used = photograph[i].remark[0] == 0;
                kept[is_second] += is_used;
                assert_true(is_used || strstr(photograph[i].remark, "another lens"));
            }
            print_message("%d of %.0f pixels: kept %d and %d\n", others, second.fx, kept[0], kept[1]);
            assert_int_equal(fmin(kept[0], kept[1]), 0);
            assert_int_equal(kept[0] + kept[1], kept[0] ? PHOTOGRAPHS - others : others);
            assert_near(lens.camera.fx, kept[0] ? camera.fx : second.fx, 6);
        }
    }
}

/* From a tripod neither the axis nor the focal length can be measured. What is stated holds for a lens whose axis
 * passes the middle by 14 pixels, and whose focal length is 2 % longer than the camera wrote. */
static void a_tripod_states_what_an_assumed_lens_costs(void **state)
{
    (void)state;
    for (int number = 0; number < 8; number += 2) {
        weft_photographs_photograph photograph[PHOTOGRAPHS];
        weft_lens_estimate lens;
        weft_camera skewed = camera;
        double assumed;
        skewed.fx = skewed.fy = 2244, skewed.cx = 759.5, skewed.cy = 489.5;
        for (int i = 0; i < PHOTOGRAPHS; i++) {
            photograph[i] = photograph_of(&skewed, number, folded_up, 0);
            photograph[i].exif.focal_length_35mm = 2200 * 43.2666 / hypot(WIDTH, HEIGHT);
        }
        estimate(photograph, &lens);
        assert_int_equal(lens.knowledge, WEFT_LENS_FOCAL_ONLY);
        expect_ok(weft_lens_assumed_error(&lens, &photograph[0], &assumed, NULL), &(weft_error){0});
        double off = view_error_deg(&photograph[0], number);
        print_message("from %.1f degrees: %.2f degrees off, %.2f stated\n", 6.5 * number, off, assumed);
        assert_true(off < 2 * assumed && assumed < 2 && assumed > 0.02);
    }
}

/* ---- Mistakes of people, named for what they are ---- */

enum { COUNT = 8, PICTURE = 64 };

/* Eight photographs from the side, whose lamps lie elsewhere; all have one size, one lens and one power. */
static void make_set(weft_photographs_photograph photograph[COUNT], weft_photograph_set *set)
{
    static char names[COUNT][2];
    memset(photograph, 0, COUNT * sizeof *photograph);
    for (int i = 0; i < COUNT; i++) {
        weft_photographs_photograph *p = &photograph[i];
        names[i][0] = (char)('a' + i);
        p->name = names[i];
        p->exif = (weft_exif){.width = 600, .height = 400, .bits = 8, .f_number = 8, .iso = 100, .exposure_s = 0.01};
        p->exif.focal_length_35mm = 35;
        p->pose = weft_pose_of_view((weft_angles){0.2 + 0.05 * i, 2.4 * i}, 500);
        p->lamp.position_mm = weft_scale(weft_direction_of_angles((weft_angles){0.6, 1.7 * i}), 400 + 50 * (i % 3));
        double squared = weft_dot(p->lamp.position_mm, p->lamp.position_mm);
        p->lamp.level[0] = p->lamp.level[1] = p->lamp.level[2] = 1e5 / squared;
    }
    *set = (weft_photograph_set){.count = COUNT, .photograph = photograph};
}

/* A refusal that holds `words`, and with --force a note; both NULL: neither. */
static void expect_refusal(weft_code (*check)(const char *, const weft_photographs_settings *, weft_photograph_set *,
                                              weft_error *),
                           weft_photograph_set *set, const char *words)
{
    weft_photographs_settings settings = weft_photographs_defaults();
    weft_error error = {0};
    weft_code code = check("felt", &settings, set, &error);
    if (!words) {
        expect_ok(code, &error);
        assert_int_equal(set->notes.count, 0);
        return;
    }
    assert_int_equal(weft_class_of(code), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, words));
    settings.force = true;
    expect_ok(check("felt", &settings, set, &error), &error);
    assert_int_equal(set->notes.count, 1);
    assert_non_null(strstr(set->notes.line[0], words));
    weft_lines_free(&set->notes);
}

static weft_code check_sizes(const char *folder, const weft_photographs_settings *settings, weft_photograph_set *set,
                             weft_error *error)
{
    return weft_photographs_check_sizes(folder, settings, weft_photographs_common_size(set), set, error);
}

static void a_folder_of_two_sizes_is_refused(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[COUNT];
    weft_photograph_set set;
    make_set(photograph, &set);
    photograph[7].exif.width = 300;
    expect_refusal(check_sizes, &set, NULL);
    photograph[3].exif.width = 300;
    expect_refusal(check_sizes, &set, "2 of 8 photographs have another size than 600 x 400 pixels, such as 'd'");
}

static void another_lens_is_left_out(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[COUNT];
    weft_photograph_set set;
    make_set(photograph, &set);
    photograph[1].exif.focal_length_35mm = 50;
    photograph[2].exif.focal_length_35mm = 35.5; /* rounded otherwise */
    photograph[3].exif.focal_length_35mm = 0;    /* nothing is written */
    weft_photographs_leave_out_other_lenses(&set);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(weft_photographs_used(&photograph[i]), i != 1);
    assert_non_null(strstr(photograph[1].remark, "another lens or zoom: 50 mm, most with 35 mm"));
}

static void a_lamp_that_was_off_is_left_out(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[COUNT];
    weft_photograph_set set;
    make_set(photograph, &set);
    photograph[4].lamp.level[1] /= 20;
    photograph[5].lamp.level[1] /= 3;
    weft_photographs_leave_out_unlit(&set);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(weft_photographs_used(&photograph[i]), i != 4);
    assert_non_null(strstr(photograph[4].remark, "5.0 % of that of the others"));
}

static void a_flash_that_is_not_told_is_refused(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[COUNT];
    weft_photograph_set set;
    make_set(photograph, &set);
    expect_refusal(weft_photographs_check_flash, &set, NULL);
    for (int i = 0; i < COUNT; i++)
        photograph[i].lamp.position_mm =
            weft_add(weft_pose_camera_position(&photograph[i].pose), weft_vec3_of(30, -30, 10));
    expect_refusal(weft_photographs_check_flash, &set, "beside the camera in 8 of 8 photographs");
    photograph[0].lamp.position_mm = photograph[1].lamp.position_mm = weft_vec3_of(400, 0, 300);
    expect_refusal(weft_photographs_check_flash, &set, NULL);
}

/* Spots that repeat nowhere, moved by `shift` pixels, in light of some strength. */
static void draw_sample(weft_image *image, int shift, double strength)
{
    weft_error error = {0};
    expect_ok(weft_image_create(PICTURE, PICTURE, image, &error), &error);
    for (int i = 0; i < PICTURE * PICTURE; i++) {
        double x = i % PICTURE - shift, y = (double)(i / PICTURE), value = 0.5;
        for (int spot = 0; spot < 20; spot++) {
            double dx = x - fmod(37.7 * spot, PICTURE), dy = y - fmod(23.3 * spot + 5, PICTURE);
            value += 0.3 * (spot % 2 ? 1 : -1) * exp(-(dx * dx + dy * dy) / 12);
        }
        for (int c = 0; c < 3; c++)
            image->pixels[3 * i + c] = (float)(strength * value);
    }
}

static void a_sample_that_moved_is_refused(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[COUNT];
    weft_photograph_set set;
    make_set(photograph, &set);
    for (int i = 0; i < COUNT; i++)
        draw_sample(&photograph[i].rectified, 0, 0.5 + 0.1 * (i % 4));
    expect_refusal(weft_photographs_check_still, &set, NULL);
    for (int i = 4; i < COUNT; i++) {
        weft_image_free(&photograph[i].rectified);
        draw_sample(&photograph[i].rectified, 4, 0.7);
    }
    expect_refusal(weft_photographs_check_still, &set,
                   "moved under the sheet: in 4 of 8 photographs, such as 'e', it lies 3.1 mm");
    for (int i = 0; i < COUNT; i++)
        weft_image_free(&photograph[i].rectified);
}

int test_photographs_strays(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crossed_marker_costs_no_photograph),
        cmocka_unit_test(no_corner_is_lost_without_reason),
        cmocka_unit_test(a_bent_sheet_and_another_zoom_are_left_out),
        cmocka_unit_test(most_corners_of_a_gently_bent_sheet_stay_or_none_count),
        cmocka_unit_test(a_bowed_sheet_is_found_with_the_lens),
        cmocka_unit_test(a_bow_is_found_under_a_lens_that_is_known),
        cmocka_unit_test(a_flat_sheet_is_called_flat),
        cmocka_unit_test(photographs_of_two_lenses_are_parted),
        cmocka_unit_test(a_tripod_states_what_an_assumed_lens_costs),
        cmocka_unit_test(a_folder_of_two_sizes_is_refused),
        cmocka_unit_test(another_lens_is_left_out),
        cmocka_unit_test(a_lamp_that_was_off_is_left_out),
        cmocka_unit_test(a_flash_that_is_not_told_is_refused),
        cmocka_unit_test(a_sample_that_moved_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
