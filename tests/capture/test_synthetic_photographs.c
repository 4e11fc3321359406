#include "btf/dataset/dataset.h"
#include "capture/synthetic/synthetic.h"
#include "registration/pose/opencv_bridge.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <jansson.h>
#include <libexif/exif-data.h>
#include <limits.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { COUNT = 3 };

static weft_synthetic_request small_request(const char *folder)
{
    weft_synthetic_request request = weft_synthetic_request_default();
    request.folder = folder;
    request.content = "checker";
    request.width = 360;
    request.photograph_count = COUNT;
    request.window = 0;
    request.truth_size = 16;
    return request;
}

static void take(const weft_synthetic_request *request)
{
    char warning[WEFT_MESSAGE_SIZE];
    weft_error error = {0};
    expect_ok(weft_synthetic_run(request, NULL, warning, &error), &error);
}

static bool project(const weft_synthetic_shot *shot, double x, double y, double pixel[2])
{
    const double(*r)[3] = shot->pose.rotation;
    weft_vec3 t = shot->pose.translation;
    return weft_synthetic_lens_project(
        &shot->lens,
        weft_vec3_of(r[0][0] * x + r[0][1] * y + t.x, r[1][0] * x + r[1][1] * y + t.y, r[2][0] * x + r[2][1] * y + t.z),
        pixel);
}

static void path_of(const weft_synthetic_request *request, const weft_synthetic_shot *shot, char path[PATH_MAX])
{
    snprintf(path, PATH_MAX, "%s/%.31s", request->folder, shot->name);
}

/* ---- Geometry ---- */

/* The detector draws all four corners of a black marker inward alike: their mean does not know. */
static void expect_marker(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                          const weft_marker *marker)
{
    weft_target target = weft_target_printed(request->opening_mm);
    weft_rectangle r = weft_target_marker(&target, marker->id);
    double off[2] = {0, 0};
    for (int i = 0; i < 4; i++) {
        double expected[2];
        assert_true(project(shot, i == 1 || i == 2 ? r.x1 : r.x0, i < 2 ? r.y1 : r.y0, expected));
        off[0] += (marker->corner[i][0] - expected[0]) / 4;
        off[1] += (marker->corner[i][1] - expected[1]) / 4;
    }
    assert_true(hypot(off[0], off[1]) < 0.1);
}

/* Another eye finds the markers where the truth has them. */
static void markers_lie_where_the_truth_says(void **state)
{
    (void)state;
    weft_synthetic_request request = small_request("markers");
    weft_synthetic_shot shot[COUNT];
    weft_error error = {0};
    request.set = WEFT_SYNTHETIC_TRIPOD;
    request.width = 1500;
    request.format = WEFT_SYNTHETIC_TIFF;
    request.photograph_count = 1;
    request.no_balls = true; /* whose shadow may lie on a marker */
    request.truth_size = 0;
    take(&request);
    weft_synthetic_plan(&request, shot);
    char path[PATH_MAX];
    weft_image image;
    path_of(&request, &shot[0], path);
    expect_ok(weft_image_read(path, &image, NULL, &error), &error);
    size_t pixels = (size_t)image.width * (size_t)image.height;
    uint8_t *grey = malloc(pixels);
    assert_non_null(grey);
    for (size_t i = 0; i < pixels; i++)
        grey[i] = (uint8_t)lroundf(255 * image.pixels[3 * i + 1]);
    weft_marker marker[WEFT_MARKERS_LIMIT];
    int count = 0;
    expect_ok(
        weft_opencv_find_markers(NULL, grey, image.width, image.height, marker, WEFT_MARKERS_LIMIT, &count, &error),
        &error);
    assert_int_equal(count, WEFT_SHEET_MARKER_COUNT);
    for (int i = 0; i < count; i++)
        expect_marker(&request, &shot[0], &marker[i]);
    free(grey);
    weft_image_free(&image);
}

/* ---- Light ---- */

/* Mean of a square of pixels of a channel about a place. */
static double mean_about(const weft_image *image, const double at[2], int channel)
{
    double sum = 0;
    for (int dy = -3; dy <= 3; dy++) {
        for (int dx = -3; dx <= 3; dx++) {
            size_t x = (size_t)(lround(at[0]) + dx), y = (size_t)(lround(at[1]) + dy);
            sum += (double)image->pixels[3 * (y * (size_t)image->width + x) + (size_t)channel];
        }
    }
    return sum / 49;
}

/* Where the true reflectance is 0.5, the file holds 0.5 of what a white sheet would give there: the patches of the
 * checker in linear photographs against the dataset of the truth. */
static void photographs_show_the_true_reflectance(void **state)
{
    (void)state;
    weft_synthetic_request request = small_request("linear");
    weft_synthetic_shot shot[COUNT];
    weft_error error = {0};
    weft_dataset *truth;
    weft_half samples[16 * 16 * COUNT * 3];
    uint8_t mask[16 * 16 * COUNT];
    int compared = 0;
    request.format = WEFT_SYNTHETIC_TIFF;
    request.set = WEFT_SYNTHETIC_TRIPOD;
    request.width = 900;
    request.no_balls = request.no_pin = true;
    take(&request);
    weft_synthetic_plan(&request, shot);
    expect_ok(weft_dataset_open("linear.truth.btf.h5", &truth, &error), &error);
    assert_int_equal(weft_dataset_get_layout(truth)->distance, WEFT_NEAR);
    expect_ok(weft_dataset_read_block(truth, 0, 0, 16, 16, samples, mask, &error), &error);
    for (int i = 0; i < COUNT; i++) {
        char path[PATH_MAX];
        weft_image image;
        path_of(&request, &shot[i], path);
        expect_ok(weft_image_read(path, &image, NULL, &error), &error);
        for (int texel = 0; texel < 16 * 16; texel++) {
            int x = texel % 16, y = texel / 16;
            if (x % 4 == 0 || x % 4 == 3 || y % 4 == 0 || y % 4 == 3)
                continue;
            double x_mm = ((x + 0.5) / 16 - 0.5) * request.opening_mm,
                   y_mm = (0.5 - (y + 0.5) / 16) * request.opening_mm;
            weft_vec3 d = weft_subtract(shot[i].lamp.at, weft_vec3_of(x_mm, y_mm, 0));
            double pixel[2], lux = shot[i].lamp.intensity_cd / (weft_dot(d, d) * 1e-6);
            assert_true(project(&shot[i], x_mm, y_mm, pixel));
            for (int channel = 0; channel < 3; channel++) {
                const double *colour = &shot[i].lamp.colour.r;
                double white = lux / WEFT_PI * colour[channel] * shot[i].exposure.gain *
                               shot[i].exposure.white_balance[channel] *
                               weft_synthetic_lens_vignetting(&shot[i].lens, pixel[0], pixel[1]);
                double expected = (double)weft_float_of_half(samples[(texel * COUNT + i) * 3 + channel]) * white;
                if (expected > 0.9)
                    continue;
                assert_float_equal(mean_about(&image, pixel, channel) / expected, 1, 0.03);
                compared++;
            }
        }
        weft_image_free(&image);
    }
    assert_true(compared > COUNT * 64 * 3 / 2);
    weft_dataset_close(truth);
}

/* Two photographs of a grey wall differ by shot and read noise, and by nothing else. */
static void noise_is_that_of_electrons(void **state)
{
    (void)state;
    enum { PIXELS = 200000 };
    float *wall = malloc(PIXELS * sizeof *wall), *first = malloc(PIXELS * sizeof *first),
          *second = malloc(PIXELS * sizeof *second);
    assert_true(wall && first && second);
    for (int iso = 100; iso <= 6400; iso *= 8) {
        weft_synthetic_exposure exposure = {.iso = iso, .gain = 1e-3, .white_balance = {1, 1, 1}};
        double mean = 0, squares = 0, full_well = 60000.0 * 100 / iso;
        for (int i = 0; i < PIXELS; i++)
            wall[i] = 400;
        assert_int_equal(weft_synthetic_sense(&exposure, wall, PIXELS, 1, first, NULL), WEFT_OK);
        assert_int_equal(weft_synthetic_sense(&exposure, wall, PIXELS, 2, second, NULL), WEFT_OK);
        for (int i = 0; i < PIXELS; i++) {
            double difference = (double)first[i] - (double)second[i];
            mean += (double)first[i] / PIXELS;
            squares += difference * difference / (2 * PIXELS);
        }
        double step = 1.0 / 15871, variance = (0.4 * full_well + 16) / (full_well * full_well) + step * step / 12;
        assert_float_equal(mean, 0.4, 2e-4);
        assert_float_equal(squares / variance, 1, 0.03);
    }
    free(wall);
    free(first);
    free(second);
}

/* ---- Files ---- */

static void expect_same_files(const char *a, const char *b)
{
    size_t size_a, size_b;
    unsigned char *bytes_a = scratch_load(a, &size_a), *bytes_b = scratch_load(b, &size_b);
    assert_int_equal(size_a, size_b);
    assert_memory_equal(bytes_a, bytes_b, size_a);
    free(bytes_a);
    free(bytes_b);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    static const char *const folder[2] = {"one", "three"};
    weft_synthetic_shot shot[COUNT];
    int threads = omp_get_max_threads();
    for (int run = 0; run < 2; run++) {
        weft_synthetic_request request = small_request(folder[run]);
        request.rubbish_count = 1; /* shaken */
        request.hand_shadows = 1;
        omp_set_num_threads(run == 0 ? 1 : 3);
        take(&request);
        weft_synthetic_plan(&request, shot);
    }
    omp_set_num_threads(threads);
    for (int i = 0; i < COUNT; i++) {
        char a[PATH_MAX], b[PATH_MAX];
        snprintf(a, sizeof a, "one/%.31s", shot[i].name);
        snprintf(b, sizeof b, "three/%.31s", shot[i].name);
        expect_same_files(a, b);
    }
    expect_same_files("one.truth.json", "three.truth.json");
    weft_synthetic_request other = small_request("other");
    other.seed = 2;
    weft_synthetic_shot otherwise[COUNT];
    weft_synthetic_plan(&other, otherwise);
    assert_true(otherwise[0].pose.translation.z != shot[0].pose.translation.z);
}

static double exif_number(ExifData *data, ExifIfd ifd, ExifTag tag)
{
    ExifEntry *entry = exif_content_get_entry(data->ifd[ifd], tag);
    assert_non_null(entry);
    ExifByteOrder order = exif_data_get_byte_order(data);
    if (entry->format == EXIF_FORMAT_SHORT)
        return exif_get_short(entry->data, order);
    assert_int_equal(entry->format, EXIF_FORMAT_RATIONAL);
    ExifRational value = exif_get_rational(entry->data, order);
    assert_int_not_equal(value.denominator, 0);
    return (double)value.numerator / value.denominator;
}

/* libexif shares nothing with the library that wrote the file. */
static void exif_says_what_the_camera_did(void **state)
{
    (void)state;
    weft_synthetic_request request = small_request("noted");
    weft_synthetic_shot shot[COUNT];
    bool turned = false;
    request.truth_size = 0;
    request.seed = 3; /* its first three stand upright and lie */
    take(&request);
    weft_synthetic_plan(&request, shot);
    for (int i = 0; i < COUNT; i++) {
        char path[PATH_MAX], date[32];
        path_of(&request, &shot[i], path);
        ExifData *data = exif_data_new_from_file(path);
        assert_non_null(data);
        turned |= shot[i].orientation != 1;
        assert_int_equal((int)exif_number(data, EXIF_IFD_0, EXIF_TAG_ORIENTATION), shot[i].orientation);
        assert_float_equal(exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_TIME) / shot[i].exposure.seconds, 1,
                           0.005);
        assert_float_equal(exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FNUMBER), 11, 1e-6);
        assert_float_equal(exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS), shot[i].exposure.iso, 0.5);
        assert_float_equal(exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH), 35, 1e-6);
        assert_float_equal(exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM), 54, 1e-6);
        ExifEntry *entry = exif_content_get_entry(data->ifd[EXIF_IFD_EXIF], EXIF_TAG_DATE_TIME_ORIGINAL);
        assert_string_equal(exif_entry_get_value(entry, date, sizeof date), shot[i].date);
        exif_data_unref(data);
    }
    assert_true(turned);
}

/* A power of two is one over a whole number exactly. */
static void exif_holds_every_exposure(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_image image;
    expect_ok(weft_image_create(16, 16, &image, &error), &error);
    for (int power = -11; power <= 1; power++) {
        weft_camera_notes notes = {"a", "b", "2026:03:14 14:00:00", 1, ldexp(1, power), 8, 200, 35, 53};
        expect_ok(weft_snapshot_write("exposed.jpg", &image, &notes, &error), &error);
        ExifData *data = exif_data_new_from_file("exposed.jpg");
        assert_non_null(data);
        assert_float_equal(exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_TIME) / ldexp(1, power), 1, 0.005);
        exif_data_unref(data);
    }
    weft_image_free(&image);
}

/* The truth in the file is that of the plan, and rubbish is named. */
static void the_truth_is_written_down(void **state)
{
    (void)state;
    weft_synthetic_request request = small_request("rubbish/");
    weft_synthetic_shot shot[7];
    request.width = 300;
    request.photograph_count = 7;
    request.rubbish_count = 6;
    request.truth_size = 4;
    take(&request);
    weft_synthetic_plan(&request, shot);
    json_t *root = json_load_file("rubbish.truth.json", 0, NULL), *list = json_object_get(root, "photographs");
    assert_int_equal(json_array_size(list), 7);
    int seen[WEFT_SYNTHETIC_FAULT_COUNT] = {0};
    for (size_t i = 0; i < 7; i++) {
        json_t *one = json_array_get(list, i), *at = json_object_get(json_object_get(one, "lamp"), "at_mm");
        assert_string_equal(json_string_value(json_object_get(one, "name")), shot[i].name);
        assert_string_equal(json_string_value(json_object_get(one, "fault")), weft_synthetic_fault_name(shot[i].fault));
        assert_float_equal(json_real_value(json_array_get(at, 2)), shot[i].lamp.at.z, 1e-6);
        seen[shot[i].fault]++;
    }
    for (int fault = 0; fault < WEFT_SYNTHETIC_FAULT_COUNT; fault++)
        assert_int_equal(seen[fault], 1);
    json_decref(root);
    weft_error error = {0};
    weft_dataset *truth;
    uint8_t mask[16 * 7];
    expect_ok(weft_dataset_open("rubbish.truth.btf.h5", &truth, &error), &error);
    expect_ok(weft_dataset_read_block(truth, 0, 0, 4, 4, NULL, mask, &error), &error);
    for (int i = 0; i < 7; i++)
        assert_int_equal(mask[i] == 0, shot[i].fault == WEFT_SYNTHETIC_GOOD);
    weft_dataset_close(truth);
}

/* A tripod stands still, and its notes point at the lamp. */
static void a_tripod_stands(void **state)
{
    (void)state;
    weft_synthetic_request request = small_request("stand");
    weft_synthetic_shot shot[COUNT];
    request.set = WEFT_SYNTHETIC_TRIPOD;
    request.width = 300;
    request.truth_size = 0;
    take(&request);
    weft_synthetic_plan(&request, shot);
    FILE *notes = fopen("stand.lp", "r");
    int count;
    assert_true(notes && fscanf(notes, "%d", &count) == 1 && count == COUNT);
    for (int i = 0; i < COUNT; i++) {
        char name[WEFT_SYNTHETIC_NAME_SIZE];
        weft_vec3 light;
        assert_memory_equal(&shot[i].pose, &shot[0].pose, sizeof shot[0].pose);
        assert_float_equal(shot[i].lens.focus_mm, shot[0].lens.focus_mm, 0);
        assert_int_equal(fscanf(notes, "%31s %lf %lf %lf", name, &light.x, &light.y, &light.z), 4);
        assert_string_equal(name, shot[i].name);
        /* Right and up of the picture as it is shown: the camera stands upright, the left of the file is its top. */
        weft_vec3 lamp = weft_unit(shot[i].lamp.at), eye = weft_unit(weft_pose_camera_position(&shot[i].pose));
        double middle[2], aside[2];
        weft_vec3 shift = weft_scale(weft_subtract(lamp, weft_scale(eye, weft_dot(lamp, eye))), 5);
        assert_true(project(&shot[i], 0, 0, middle) && project(&shot[i], shift.x, shift.y, aside));
        double right = middle[1] - aside[1], up = middle[0] - aside[0], length = hypot(right, up);
        double level = hypot(light.x, light.y);
        assert_int_equal(shot[i].orientation, 6);
        assert_float_equal(light.z, weft_dot(lamp, eye), 0.02);
        assert_float_equal(light.x, level * right / length, 0.02);
        assert_float_equal(light.y, level * up / length, 0.02);
    }
    fclose(notes);
}

static void a_folder_in_use_is_left_alone(void **state)
{
    (void)state;
    weft_synthetic_request request = small_request("used");
    char warning[WEFT_MESSAGE_SIZE];
    weft_error error = {0};
    assert_int_equal(mkdir("used", 0777), 0);
    scratch_store("used/letter.txt", "dear", 4);
    assert_int_equal(weft_synthetic_run(&request, NULL, warning, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "not empty"));
    assert_int_not_equal(access("used.truth.json", F_OK), 0);
}

int test_synthetic_photographs(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(markers_lie_where_the_truth_says), cmocka_unit_test(photographs_show_the_true_reflectance),
        cmocka_unit_test(noise_is_that_of_electrons),       cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(exif_says_what_the_camera_did),    cmocka_unit_test(exif_holds_every_exposure),
        cmocka_unit_test(the_truth_is_written_down),        cmocka_unit_test(a_tripod_stands),
        cmocka_unit_test(a_folder_in_use_is_left_alone),
    };
    return cmocka_run_group_tests_name("synthetic photographs", tests, scratch_folder_enter, scratch_folder_leave);
}
