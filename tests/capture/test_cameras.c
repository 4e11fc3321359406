/* Cameras of a laboratory: a folder into which another program drops its photographs, and OpenCV's VideoCapture. */
#include "capture/camera/camera.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WIDTH = 40, HEIGHT = 30, BIN = 2, VALUES = WIDTH * HEIGHT * 3 };

/* A picture twice as large, each of whose blocks has values about a mean that says where it is. */
static double mean_at(int x, int y, int channel)
{
    return (0.4 + 0.01 * x + 0.004 * y) * (channel + 1) / 3;
}

static void write_picture(const char *path, int width, int height, double exposure_s)
{
    weft_image image;
    assert_int_equal(weft_image_create(width, height, &image, NULL), WEFT_OK);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            double offset = (x % 2 ? 0.05 : -0.05) * (y % 2 ? 1 : 0.5);
            for (int k = 0; k < 3; k++)
                image.pixels[3 * (y * width + x) + k] = (float)(mean_at(x / BIN, y / BIN, k) + offset);
        }
    }
    const weft_camera_notes notes = {.make = "M",
                                     .model = "N",
                                     .date = "2026:01:01 00:00:00",
                                     .orientation = 1,
                                     .exposure_s = exposure_s,
                                     .f_number = 8,
                                     .iso = 100,
                                     .focal_length_mm = 100};
    assert_int_equal(weft_snapshot_write(path, &image, &notes, NULL), WEFT_OK);
    weft_image_free(&image);
}

static void assert_values(const uint16_t *samples, double tolerance)
{
    for (int i = 0; i < VALUES; i++) {
        double wanted = mean_at(i / 3 % WIDTH, i / 3 / WIDTH, i % 3);
        assert_float_equal(samples[i] / 65535.0, wanted, tolerance);
    }
}

/* ---- A folder ---- */

/* Step `step` of what the other program does once the shutter is released; returns whether there are more. */
typedef bool program_step(int step);

/* The other program, and the time: it goes on by a step whenever the camera waits, and the clock then says that all of
 * the wait is over. */
typedef struct other_program {
    program_step *work;
    int step; /* -1: it has done all, or was not asked yet */
    int releases;
    double exposure_s, now_s;
} other_program;

static double now_of_program(void *context)
{
    return ((other_program *)context)->now_s;
}

static bool wait_for_program(void *context, int descriptor, double seconds)
{
    other_program *program = context;
    struct pollfd ready = {descriptor, POLLIN, 0};
    program->now_s += seconds;
    if (program->step >= 0)
        program->step = program->work(program->step) ? program->step + 1 : -1;
    return poll(&ready, 1, 0) > 0;
}

static weft_code release(void *context, double exposure_s, weft_error *error)
{
    other_program *program = context;
    (void)error;
    program->releases++;
    program->exposure_s = exposure_s;
    program->step = 0;
    return WEFT_OK;
}

static weft_code take(program_step *work, double fixed_s, double timeout_s, uint16_t *samples, double *read_back_s,
                      char *original, weft_error *error)
{
    other_program program = {.work = work, .step = -1};
    const weft_clock clock = {&program, now_of_program, wait_for_program};
    const weft_camera_settings settings = {
        .device = "incoming",
        .pattern = "*.tif",
        .timeout_s = timeout_s,
        .format = {.bin = BIN, .width = WIDTH, .height = HEIGHT, .exposure_s = fixed_s},
        .shutter = {&program, release},
        .clock = &clock};
    weft_rig_camera rig;
    assert_int_equal(weft_folder_camera_open(&settings, &rig, NULL), WEFT_OK);
    /* Came before the release: none of this exposure's. */
    write_picture("before.tif", WIDTH * BIN, HEIGHT * BIN, 7);
    assert_int_equal(rename("before.tif", "incoming/before.tif"), 0);
    weft_code code = rig.expose(rig.device, 0, 0.25, samples, read_back_s, error);
    assert_int_equal(program.releases, 1);
    assert_float_equal(program.exposure_s, 0.25, 0);
    if (original)
        snprintf(original, 64, "%s", rig.original(rig.device));
    rig.close(rig.device);
    return code;
}

static bool drop_whole(int step)
{
    (void)step;
    write_picture("incoming/IMG_1.TIF", WIDTH * BIN, HEIGHT * BIN, 0.125);
    return false;
}

static void the_next_file_is_the_frame_and_says_its_exposure(void **state)
{
    (void)state;
    uint16_t samples[VALUES];
    double read_back_s;
    char original[64];
    weft_error error = {0};
    if (take(drop_whole, 0, 10, samples, &read_back_s, original, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_values(samples, 1e-4);
    assert_float_equal(read_back_s, 0.125, 1e-6);
    assert_string_equal(original, "incoming/IMG_1.TIF");
    assert_int_equal(access(original, F_OK), 0);
}

/* In pieces, closed in between, with other files about: as programs do over a slow cable. */
static bool drop_in_pieces(int step)
{
    enum { PIECES = 4 };
    size_t size;
    if (step == 0) {
        write_picture("whole.tif", WIDTH * BIN, HEIGHT * BIN, 0.125);
        scratch_store("incoming/IMG_2.xmp", "metadata", 8);
        scratch_store("incoming/.hidden.tif", "x", 1);
    }
    unsigned char *bytes = scratch_load("whole.tif", &size);
    size_t from = size * (size_t)step / PIECES, to = size * (size_t)(step + 1) / PIECES;
    FILE *file = fopen("incoming/IMG_2.tif", step == 0 ? "wb" : "ab");
    assert_non_null(file);
    fwrite(bytes + from, 1, to - from, file);
    fclose(file);
    free(bytes);
    return step + 1 < PIECES;
}

static void a_file_is_waited_for_until_it_is_whole(void **state)
{
    (void)state;
    uint16_t samples[VALUES];
    double read_back_s;
    char original[64];
    weft_error error = {0};
    if (take(drop_in_pieces, 0, 20, samples, &read_back_s, original, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_values(samples, 1e-4);
    assert_string_equal(original, "incoming/IMG_2.tif");
}

/* The camera writes both kinds, and the second one half a second after the next release. */
static bool drop_the_second_kind_late(int step)
{
    static int shot;
    static const char *const file[] = {"IMG_9999.tif", "IMG_9999.jpg", "IMG_0001.tif", "IMG_0001.jpg", "IMG_0001.tif"};
    char path[64];
    (void)step;
    snprintf(path, sizeof path, "incoming/%s", file[shot]);
    shot++;
    write_picture(path, WIDTH * BIN, HEIGHT * BIN, 0.125 * shot);
    return shot == 2 || shot == 4;
}

static void raw_and_jpeg_are_one_shot_and_names_may_roll_over(void **state)
{
    (void)state;
    other_program program = {.work = drop_the_second_kind_late, .step = -1};
    const weft_clock clock = {&program, now_of_program, wait_for_program};
    const weft_camera_settings settings = {.device = "incoming",
                                           .pattern = "IMG*",
                                           .timeout_s = 10,
                                           .format = {.bin = BIN, .width = WIDTH, .height = HEIGHT},
                                           .shutter = {&program, release},
                                           .clock = &clock};
    static const struct {
        const char *name;
        double exposure_s;
    } wanted[] = {{"incoming/IMG_9999.tif", 0.125}, {"incoming/IMG_0001.tif", 0.375}, {"incoming/IMG_0001.tif", 0.625}};
    weft_rig_camera rig;
    assert_int_equal(weft_folder_camera_open(&settings, &rig, NULL), WEFT_OK);
    for (int i = 0; i < 3; i++) {
        uint16_t samples[VALUES];
        double read_back_s;
        weft_error error = {0};
        if (rig.expose(rig.device, 0, 0.25, samples, &read_back_s, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_string_equal(rig.original(rig.device), wanted[i].name);
        assert_float_equal(read_back_s, wanted[i].exposure_s, 1e-6);
    }
    rig.close(rig.device);
}

static bool move_in(int step)
{
    (void)step;
    write_picture("elsewhere.tif", WIDTH * BIN, HEIGHT * BIN, 0);
    rename("elsewhere.tif", "incoming/IMG_3.tif");
    return false;
}

static bool drop_nothing(int step)
{
    (void)step;
    return false;
}

static bool drop_half(int step)
{
    (void)step;
    size_t size;
    write_picture("whole.tif", WIDTH * BIN, HEIGHT * BIN, 0.125);
    unsigned char *bytes = scratch_load("whole.tif", &size);
    scratch_store("incoming/half.tif", bytes, size / 2);
    free(bytes);
    return false;
}

static bool drop_other_size(int step)
{
    (void)step;
    write_picture("incoming/other.tif", WIDTH, HEIGHT, 0.125);
    return false;
}

static void what_cannot_be_a_frame_is_named_when_the_time_is_up(void **state)
{
    (void)state;
    uint16_t samples[VALUES];
    double read_back_s;
    weft_error error = {0};
    assert_int_equal(take(drop_nothing, 0, 0.3, samples, &read_back_s, NULL, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "no photograph '*.tif' came into 'incoming' within 0.3 s"));
    assert_int_equal(take(drop_half, 0, 0.5, samples, &read_back_s, NULL, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "half.tif"));
    assert_int_equal(take(drop_other_size, 0, 0.5, samples, &read_back_s, NULL, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "40 x 30 pixels, not 2 times 40 x 30"));
    /* No exposure in the file: only one that was set by hand will do. */
    assert_int_equal(take(move_in, 0, 0.5, samples, &read_back_s, NULL, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "does not say how long it was exposed"));
    assert_int_equal(take(move_in, 0.5, 10, samples, &read_back_s, NULL, &error), WEFT_OK);
    assert_float_equal(read_back_s, 0.5, 0);
}

static void a_folder_that_is_not_there_is_named(void **state)
{
    (void)state;
    const weft_camera_settings settings = {.device = "nowhere", .pattern = "*"};
    weft_rig_camera rig;
    weft_error error = {0};
    assert_int_equal(weft_folder_camera_open(&settings, &rig, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "'nowhere'"));
}

/* Whoever presses Ctrl-C wants no shutter to be heard any more, however often a photograph is tried. */
static void nothing_is_released_after_a_stop(void **state)
{
    (void)state;
    const volatile sig_atomic_t stop = 1;
    other_program program = {.work = drop_whole};
    const weft_camera_settings settings = {.device = "incoming",
                                           .pattern = "*.tif",
                                           .timeout_s = 10,
                                           .format = {.bin = BIN, .width = WIDTH, .height = HEIGHT},
                                           .shutter = {&program, release},
                                           .stop = &stop};
    uint16_t samples[VALUES];
    double read_back_s;
    weft_rig_camera rig;
    weft_error error = {0};
    assert_int_equal(weft_folder_camera_open(&settings, &rig, NULL), WEFT_OK);
    assert_int_equal(rig.expose(rig.device, 0, 0.25, samples, &read_back_s, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "stopped"));
    assert_int_equal(program.releases, 0);
    rig.close(rig.device);
}

/* ---- A video ---- */

static void frames_of_a_series_come_in_order_until_it_ends(void **state)
{
    (void)state;
    enum { FRAMES = 3 };
    for (int i = 0; i < FRAMES; i++) {
        char path[32];
        weft_image image;
        snprintf(path, sizeof path, "frame_%02d.png", i);
        assert_int_equal(weft_image_create(WIDTH, HEIGHT, &image, NULL), WEFT_OK);
        for (int k = 0; k < VALUES; k++)
            image.pixels[k] = (float)(40 * (i + 1) + 30 * (k % 3)) / 255;
        assert_int_equal(weft_image_write(path, &image, NULL, NULL), WEFT_OK);
        weft_image_free(&image);
    }
    for (int srgb = 0; srgb < 2; srgb++) {
        const weft_camera_settings settings = {
            .device = "frame_%02d.png",
            .format = {.bin = 1, .width = WIDTH, .height = HEIGHT, .srgb = srgb, .exposure_s = 0.02}};
        weft_rig_camera rig;
        weft_error error = {0};
        if (weft_video_camera_open(&settings, &rig, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        for (int i = 0; i < FRAMES; i++) {
            uint16_t samples[VALUES];
            double read_back_s;
            if (rig.expose(rig.device, 0, 0.02, samples, &read_back_s, &error) != WEFT_OK)
                fail_msg("%s", error.message);
            assert_float_equal(read_back_s, 0.02, 0);
            for (int k = 0; k < VALUES; k++) {
                double encoded = (40 * (i + 1) + 30 * (k % 3)) / 255.0;
                double linear = encoded > 0.04045 ? pow((encoded + 0.055) / 1.055, 2.4) : encoded / 12.92;
                assert_float_equal(samples[k] / 65535.0, srgb ? linear : encoded, 1e-4);
            }
        }
        uint16_t samples[VALUES];
        double read_back_s;
        assert_int_equal(rig.expose(rig.device, 0, 0.02, samples, &read_back_s, &error), WEFT_SYSTEM);
        assert_non_null(strstr(error.message, "delivers no frame"));
        rig.close(rig.device);
    }
}

static void a_camera_that_is_not_there_is_named(void **state)
{
    (void)state;
    static const char *const devices[] = {"97", "no-such.avi"};
    for (int i = 0; i < 2; i++) {
        const weft_camera_settings settings = {.device = devices[i]};
        weft_rig_camera rig;
        weft_error error = {0};
        assert_int_equal(weft_video_camera_open(&settings, &rig, &error), WEFT_SYSTEM);
        assert_non_null(strstr(error.message, devices[i]));
    }
}

static int enter(void **state)
{
    scratch_folder_enter(state);
    return mkdir("incoming", 0777);
}

int test_cameras(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_next_file_is_the_frame_and_says_its_exposure),
        cmocka_unit_test(a_file_is_waited_for_until_it_is_whole),
        cmocka_unit_test(what_cannot_be_a_frame_is_named_when_the_time_is_up),
        cmocka_unit_test(raw_and_jpeg_are_one_shot_and_names_may_roll_over),
        cmocka_unit_test(a_folder_that_is_not_there_is_named),
        cmocka_unit_test(nothing_is_released_after_a_stop),
        cmocka_unit_test(frames_of_a_series_come_in_order_until_it_ends),
        cmocka_unit_test(a_camera_that_is_not_there_is_named),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}
