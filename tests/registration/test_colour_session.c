/* Two cameras under two lamps photograph a chart, and a sample in the plate: registered, they meet in one colour space.
 */
#include "base/atomic_file.h"
#include "btf/dataset/dataset.h"
#include "btf/session/camera_list.h"
#include "plate.h"
#include "registration/colour/difference.h"
#include "tests/support/chart_picture.h"
#include "tests/support/expect_ok.h"
#include "tests/support/run_weft.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIZE = 208, SQUARE = 420, TEXELS = 8, FIELDS = 4, MOST_IMAGES = 2, BLACK = 64, FULL = 4095 };

static const double camera_mm = 600, light_mm = 650;
static const weft_angles light = {0.5, 1}, view[2] = {{0, 0}, {0.4, 2.5}}; /* of each camera */

/* CIE Lab under D50 of the four fields of the sample: a yellow green, a wine red, a blue, a grey. */
static const double field_lab[FIELDS][3] = {{65, -28, 45}, {38, 48, 8}, {45, 0, -40}, {60, 0, 0}};

/* ---- A session with one photograph ---- */

static weft_session describe(const char *folder, const weft_camera *camera, int number)
{
    weft_session s = {.folder = strdup(folder), .rig = strdup("test"), .sample = strdup("four fields")};
    s.rig_settings = strdup("{}");
    s.camera = *camera;
    s.camera_distance_mm = camera_mm;
    s.light_distance_mm = light_mm;
    s.bits = 12;
    s.black_level = BLACK;
    s.target = weft_target_for_opening(32);
    s.shot_count = 1;
    s.shot = calloc(1, sizeof *s.shot);
    s.record = calloc(1, sizeof *s.record);
    s.shot[0] = (weft_shot){light, view[number], light};
    return s;
}

static void store(weft_session *s, const uint16_t *raw)
{
    char path[512], parent[512];
    weft_error error = {0};
    const weft_shot_record record = {.taken = true, .exposure_s = 0.5, .bytes = 1, .crc32 = 1};
    expect_ok(weft_make_folder(s->folder, &error), &error);
    expect_ok(weft_session_create(s, &error), &error);
    weft_session_photograph_path(s, 0, path, sizeof path);
    snprintf(parent, sizeof parent, "%s", path);
    *strrchr(parent, '/') = 0;
    expect_ok(weft_make_folder(parent, &error), &error);
    expect_ok(weft_photograph_write(path, s->camera.width, s->camera.height, s->bits, raw, &error), &error);
    expect_ok(weft_session_append(s, 0, &record, &error), &error);
    weft_session_free(s);
}

/* ---- The chart ---- */

/* Seen by a lens that loses much light, as its calibration says: 1 - 0.5 rho^2 at the share rho of half the diagonal.
 */
static void photograph_chart(int camera, const char *folder)
{
    chart_picture picture = chart_picture_usual();
    const double corner[4][2] = {{30, 30}, {330, 38}, {335, 235}, {28, 240}};
    picture.width = picture.height = SQUARE;
    memcpy(picture.corner, corner, sizeof corner);
    picture.camera = &spectral_cameras[camera];
    picture.lamp = &spectral_lamps[camera];
    picture.vignetting = 0.5;
    weft_camera lens = {.width = SQUARE, .height = SQUARE, .fx = 2 * SQUARE, .fy = 2 * SQUARE};
    lens.cx = lens.cy = SQUARE / 2.0;
    lens.vignetting[0] = -0.5 * 2 * 4;
    weft_session s = describe(folder, &lens, camera);
    weft_image image = chart_picture_render(&picture);
    uint16_t *raw = malloc(sizeof *raw * SQUARE * SQUARE * 3);
    assert_non_null(raw);
    for (int i = 0; i < SQUARE * SQUARE * 3; i++)
        raw[i] = (uint16_t)weft_clamp(BLACK + (FULL - BLACK) * (double)image.pixels[i] + 0.5, 0, FULL);
    weft_image_free(&image);
    store(&s, raw);
    free(raw);
}

/* ---- The sample ---- */

static double shown[FIELDS]; /* of each field, in the channel that is being rendered, white being 1 */

static int field_at(double x_mm, double y_mm)
{
    return (x_mm > 0) + 2 * (y_mm < 0);
}

static double sample(double x_mm, double y_mm)
{
    return shown[field_at(x_mm, y_mm)];
}

/* Of all fields as a camera shows them under its lamp; and of white. */
static void see_fields(int camera, double field[FIELDS][3], double white[3])
{
    spectral_white(&spectral_cameras[camera], &spectral_lamps[camera], white);
    for (int i = 0; i < FIELDS; i++) {
        spectral_reflectance reflectance = spectral_of_lab_d50(field_lab[i]);
        spectral_see(&spectral_cameras[camera], &spectral_lamps[camera], &reflectance, field[i]);
        for (int c = 0; c < 3; c++)
            field[i][c] /= white[c];
    }
}

/* The light of the lamp at a pixel, and the white of the camera, of which the brightest channel is 1. */
static double lamp_at(const weft_session *s, const weft_homography *inverse, int at)
{
    weft_pixel pixel = weft_camera_undistort(&s->camera, (weft_pixel){at % SIZE, at / SIZE});
    weft_pixel plate = weft_homography_apply(inverse, pixel.x, pixel.y);
    weft_vec3 from = weft_scale(weft_direction_of_angles(light), light_mm);
    weft_vec3 beam = weft_subtract(from, (weft_vec3){plate.x, plate.y, 0});
    double r = weft_length(beam);
    return beam.z / r * light_mm * light_mm / (r * r);
}

/* Into a session that knows nothing of colours, and one that holds `colour`, where that is wanted. */
static void photograph_sample(int camera, const char *plain, const char *coloured, const weft_colour *colour)
{
    const weft_camera lens = plate_camera(SIZE, camera_mm);
    weft_session s = describe(plain, &lens, camera);
    weft_pose pose = plate_jittered_pose(view[camera], camera_mm, 21);
    weft_homography homography = weft_homography_of_pose(&s.camera, &pose);
    weft_homography inverse = weft_homography_inverse(&homography);
    double field[FIELDS][3], white[3];
    uint16_t *raw = malloc(sizeof *raw * SIZE * SIZE * 3);
    assert_non_null(raw);
    see_fields(camera, field, white);
    double brightest = fmax(white[0], fmax(white[1], white[2]));
    for (int c = 0; c < 3; c++) {
        const plate_scene scene = {s.target, 0, 0.002, 4, 0, sample};
        for (int i = 0; i < FIELDS; i++)
            shown[i] = field[i][c];
        float *even = plate_photograph(&scene, &s.camera, &pose, 1 + (unsigned)c);
        for (int i = 0; i < SIZE * SIZE; i++) {
            double value = 3600 * white[c] / brightest * (double)even[i] * lamp_at(&s, &inverse, i);
            raw[3 * i + c] = (uint16_t)weft_clamp(BLACK + value + 0.5, 0, FULL);
        }
        free(even);
    }
    store(&s, raw);
    if (coloured) {
        weft_session other = describe(coloured, &lens, camera);
        other.colour = *colour;
        store(&other, raw);
    }
    free(raw);
}

/* ---- What comes of it ---- */

/* Means of the middles of the fields, reflectance, of an image of a dataset of `images`. */
static void read_fields(const char *path, int images, int image, double field[FIELDS][3])
{
    weft_half samples[TEXELS * TEXELS * MOST_IMAGES][3];
    uint8_t mask[TEXELS * TEXELS * MOST_IMAGES];
    weft_dataset *dataset;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    assert_int_equal(weft_dataset_get_layout(dataset)->image_count, images);
    expect_ok(weft_dataset_read_block(dataset, 0, 0, TEXELS, TEXELS, &samples[0][0], mask, &error), &error);
    weft_dataset_close(dataset);
    memset(field, 0, FIELDS * sizeof *field);
    for (int i = 0; i < FIELDS * 4; i++) {
        int x = 1 + i % 2 + 4 * (i / 4 % 2), y = 1 + i / 2 % 2 + 4 * (i / 8);
        int at = (y * TEXELS + x) * images + image;
        assert_int_equal(mask[at], 0);
        for (int c = 0; c < 3; c++)
            field[i / 4][c] += (double)weft_float_of_half(samples[at][c]) / cos(light.theta_rad) / 4;
    }
}

static double difference(const double srgb[3], const double other[3])
{
    double lab[3], lab_other[3];
    weft_lab_of_linear_srgb(srgb, lab);
    weft_lab_of_linear_srgb(other, lab_other);
    return weft_ciede2000(lab, lab_other);
}

/* Mean distances: of the two cameras from one another, and of the worse of them from what is true. */
static void compare(double found[2][FIELDS][3], double *apart, double *wrong)
{
    double off[2] = {0, 0};
    *apart = 0;
    for (int i = 0; i < FIELDS; i++) {
        double truth[3];
        weft_linear_srgb_of_lab_d50(field_lab[i], truth);
        *apart += difference(found[0][i], found[1][i]) / FIELDS;
        for (int camera = 0; camera < 2; camera++)
            off[camera] += difference(found[camera][i], truth) / FIELDS;
    }
    *wrong = fmax(off[0], off[1]);
    /* Grey stays grey, as light as it is. */
    for (int camera = 0; camera < 2; camera++) {
        double grey[3];
        weft_linear_srgb_of_lab_d50(field_lab[3], grey);
        print_message("grey over what it is: %.3f %.3f %.3f\n", found[camera][3][0] / grey[0],
                      found[camera][3][1] / grey[1], found[camera][3][2] / grey[2]);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(found[camera][3][c] / grey[c] - 1) < 0.03);
    }
}

static void compare_days(const char *const path[2], double *apart, double *wrong)
{
    double found[2][FIELDS][3];
    for (int camera = 0; camera < 2; camera++)
        read_fields(path[camera], 1, 0, found[camera]);
    compare(found, apart, wrong);
}

/* One is given its colour at registration, in the place of that of its session; the other has it in the session. */
static void two_cameras_meet_in_one_colour_space(void **state)
{
    (void)state;
    weft_colour colour;
    weft_error error = {0};
    double before[2], after[2];
    for (int camera = 0; camera < 2; camera++)
        photograph_chart(camera, camera ? "chart1" : "chart0");
    expect_weft("colour chart0 -o colour0.json", 0, "from 24 of 24 patches");
    expect_weft("colour chart1/ -o colour1.json", 0, "from 24 of 24 patches");
    expect_ok(weft_colour_read("colour1.json", &colour, &error), &error);
    photograph_sample(0, "day0", "day0.coloured", &colour);
    photograph_sample(1, "day1", "day1.coloured", &colour);
    expect_weft("register day0 -o raw0.btf.h5 --size 8x8", 0, "1 of 1 photographs");
    expect_weft("register day1 -o raw1.btf.h5 --size 8x8", 0, "1 of 1 photographs");
    expect_weft("register day0.coloured -o srgb0.btf.h5 --size 8x8 --colour colour0.json --report report", 0,
                "colours: linear sRGB");
    expect_weft("register day1.coloured -o srgb1.btf.h5 --size 8x8", 0, "colours: linear sRGB");
    compare_days((const char *const[]){"raw0.btf.h5", "raw1.btf.h5"}, &before[0], &before[1]);
    compare_days((const char *const[]){"srgb0.btf.h5", "srgb1.btf.h5"}, &after[0], &after[1]);
    print_message("apart %.2f, were %.2f; off %.2f, were %.2f\n", after[0], before[0], after[1], before[1]);
    assert_true(after[0] < 0.4 * before[0] && after[0] < 3);
    assert_true(after[1] < 0.4 * before[1] && after[1] < 3);
}

static void list_cameras(const char *folder)
{
    const weft_camera_list list = {2, {"left", "right"}};
    weft_error error = {0};
    expect_ok(weft_make_folder(folder, &error), &error);
    expect_ok(weft_camera_list_write(folder, &list, &error), &error);
}

/* Two cameras of one session, of two models, each with a colour of its own: that of the test before. */
static void cameras_of_one_session_meet_in_one_colour_space(void **state)
{
    (void)state;
    weft_error error = {0};
    double found[2][FIELDS][3], apart, wrong;
    list_cameras("charts");
    rename("chart0", "charts/left");
    rename("chart1", "charts/right");
    expect_ok(weft_make_folder("colours", &error), &error);
    expect_weft("colour charts -o no.json", 1, "name one of them, such as 'charts/left'");
    link("colour0.json", "colours/left.json");
    link("colour1.json", "colours/right.json");
    list_cameras("night");
    photograph_sample(0, "night/left", NULL, NULL);
    photograph_sample(1, "night/right", NULL, NULL);
    expect_weft("register night -o no.btf.h5 --size 8x8", 1, "do not see the same colours");
    expect_weft("register night -o no.btf.h5 --size 8x8 --colour colours/left.json", 1, "do not see the same colours");
    expect_weft("register night/left -o no.btf.h5 --size 8x8 --colour colours", 1,
                "there is one camera, so name its file");
    expect_weft("register night -o no.btf.h5 --size 8x8 --colour charts", 1, "charts/left.json");
    assert_true(access("no.json", F_OK) != 0 && access("no.btf.h5", F_OK) != 0);
    expect_weft("register night -o after.btf.h5 --size 8x8 --colour colours", 0, "colours: linear sRGB");
    for (int camera = 0; camera < 2; camera++)
        read_fields("after.btf.h5", 2, camera, found[camera]);
    compare(found, &apart, &wrong);
    print_message("in one session: apart %.2f, off %.2f\n", apart, wrong);
    assert_true(apart < 3 && wrong < 3);
}

static void a_bad_colour_leaves_nothing_behind(void **state)
{
    (void)state;
    scratch_store("bad.json", "{\"weft_colour\": 1}", 18);
    expect_weft("register day0 -o no.btf.h5 --size 8x8 --colour bad.json", 1, "'bad.json' lacks a field of its colour");
    expect_weft("photographs day0 -o no.btf.h5 --colour bad.json", 1, "'bad.json' lacks a field of its colour");
    expect_weft("capture --sample " WEFT_ASSETS "/weaves/cotton_twill.wv -o taken --colour bad.json", 1,
                "'bad.json' lacks a field of its colour");
    assert_true(access("no.btf.h5", F_OK) != 0 && access("taken", F_OK) != 0);
}

/* Capture keeps the colour, goes on without being told it again, and does not take another one for it. */
static void capture_keeps_a_colour(void **state)
{
    (void)state;
#define CAPTURE "capture --sample " WEFT_ASSETS "/weaves/cotton_twill.wv --plan plan.csv -o taken --truth-size 4 "
    static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n20,0,0,0\n";
    weft_session session;
    weft_colour colour;
    weft_error error = {0};
    scratch_store("plan.csv", plan, sizeof plan - 1);
    expect_weft(CAPTURE "--colour colour0.json", 0, "1 photographs");
    expect_ok(weft_session_open("taken", &session, &error), &error);
    expect_ok(weft_colour_read("colour0.json", &colour, &error), &error);
    assert_int_equal(session.colour.terms, colour.terms);
    assert_true(fabs(session.colour.matrix[0][1] - colour.matrix[0][1]) < 1e-10);
    weft_session_free(&session);
    expect_weft(CAPTURE, 0, "1 photographs were there already");
    expect_weft(CAPTURE "--colour colour1.json", 1, "was begun with another colour");
}

int test_colour_session(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_cameras_meet_in_one_colour_space),
        cmocka_unit_test(cameras_of_one_session_meet_in_one_colour_space),
        cmocka_unit_test(a_bad_colour_leaves_nothing_behind),
        cmocka_unit_test(capture_keeps_a_colour),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
