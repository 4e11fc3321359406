/* `weft capture --check`, and a night after it, on a rig of a laboratory: a stage on USB through the real libhidapi,
 * whose contact releases a camera that drops its files into a folder. The stage is fake (tests/capture/fake_stage.h).
 * The camera stands where its gears truly stand, and sees what the virtual rig sees from there. Runs under
 * umockdev-wrapper. */
#include "btf/session/lens.h"
#include "capture/laboratory/laboratory.h"
#include "capture/preflight/preflight.h"
#include "capture/virtual/virtual_rig.h"
#include "tests/capture/fake_controller.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/run_weft.h"
#include "tests/support/scratch_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>

enum { SIZE = 160, BLACK = 1000, FULL_SCALE = 65535 };

static const double exposure_s = 1.0 / 64;

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "40,0,0,0\n20,90,0,0\n30,90,60,120\n";

static const char rig_conf[] =
    "name = \"bench\"\nopening_mm = 32\n"
    "stage {\n backend = usb\n usb_serial = \"ST-0001\"\n retries = 8\n replug_s = 20\n poll_s = 0.001\n}\n"
    "axis \"camera arm\" {\n moves = camera\n angle = theta\n channel = 0\n low_deg = -2\n high_deg = 90\n"
    " settle_s = 0\n backlash_deg = 0.4\n}\n"
    "axis \"camera ring\" {\n moves = camera\n angle = phi\n channel = 1\n low_deg = -2\n high_deg = 361\n"
    " settle_s = 0\n backlash_deg = 0.4\n}\n"
    "axis \"light arm\" {\n moves = light\n angle = theta\n channel = 2\n low_deg = -2\n high_deg = 90\n"
    " settle_s = 0\n backlash_deg = 0.4\n}\n"
    "axis \"light ring\" {\n moves = light\n angle = phi\n channel = 3\n low_deg = -2\n high_deg = 361\n"
    " settle_s = 0\n backlash_deg = 0.4\n}\n"
    "light {\n backend = stage\n distance_mm = 650\n}\n"
    "camera {\n backend = folder\n device = \"incoming\"\n pattern = \"*.tif\"\n trigger = stage\n"
    " lens = \"lens.json\"\n distance_mm = 500\n black_level = 1000\n shortest_exposure_s = 0.015625\n"
    " longest_exposure_s = 0.015625\n}\n";

/* ---- The disk ---- */

static bool disk_is_full;

int __real_statvfs(const char *path, struct statvfs *disk);
int __wrap_statvfs(const char *path, struct statvfs *disk);

int __wrap_statvfs(const char *path, struct statvfs *disk)
{
    int result = __real_statvfs(path, disk);
    if (disk_is_full)
        disk->f_bavail = 1;
    return result;
}

/* ---- The camera ---- */

typedef enum fault { NOTHING, DAYLIGHT, SHAKING, SLIPPED } fault;

typedef struct studio {
    fake_controller fake;
    weft_virtual_rig rig;
    fault fault;
    pthread_t photographer;
    bool ending; /* guarded by the mutex of the stage */
    int taken;
} studio;

/* What differs from the lamp's light: a window; a table that somebody leans on; a ring that slipped on its gear. */
static void disturb(const studio *s, uint16_t *samples)
{
    for (int i = SIZE * SIZE * 3 - 1; i >= 3; i--) {
        if (s->fault == DAYLIGHT && samples[i] < FULL_SCALE - 600)
            samples[i] = (uint16_t)(samples[i] + 600);
        if (s->fault == SHAKING && s->taken % 2)
            samples[i] = (uint16_t)((samples[i] + samples[i - 3]) / 2);
    }
}

static void store(const studio *s, const uint16_t *samples)
{
    weft_image image;
    char path[32];
    const weft_camera_notes notes = {.make = "M",
                                     .model = "N",
                                     .date = "2026:01:01 00:00:00",
                                     .orientation = 1,
                                     .exposure_s = exposure_s,
                                     .f_number = 8,
                                     .iso = 100,
                                     .focal_length_mm = 100};
    if (weft_image_create(SIZE, SIZE, &image, NULL) != WEFT_OK)
        abort();
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        image.pixels[i] = (float)samples[i] / FULL_SCALE;
    snprintf(path, sizeof path, "incoming/%04d.tif", s->taken);
    if (weft_snapshot_write("shot.tif", &image, &notes, NULL) != WEFT_OK || rename("shot.tif", path) != 0)
        abort();
    weft_image_free(&image);
}

static weft_angles angles_of(const double *gear)
{
    return (weft_angles){weft_rad_of_deg(gear[0] + fake_backlash_deg), weft_rad_of_deg(gear[1] + fake_backlash_deg)};
}

static void photograph(studio *s, const double *gear, bool lit)
{
    static uint16_t samples[SIZE * SIZE * 3];
    weft_rig *rig = &s->rig.rig;
    weft_angles view = angles_of(gear), light = angles_of(gear + 2);
    bool moved;
    double read_back_s;
    view.phi_rad += s->fault == SLIPPED ? weft_rad_of_deg(20) : 0;
    if (rig->stage.move(rig->stage.device, view, light, &moved, NULL) != WEFT_OK ||
        rig->light.power(rig->light.device, lit, NULL) != WEFT_OK ||
        rig->camera.expose(rig->camera.device, (uint64_t)s->taken, exposure_s, samples, &read_back_s, NULL) != WEFT_OK)
        abort();
    disturb(s, samples);
    store(s, samples);
}

/* A photograph for each closing of the contact. */
static void *watch(void *argument)
{
    studio *s = argument;
    fake_stage *stage = &s->fake.stage;
    for (bool ending = false; !ending;) {
        double gear[FAKE_AXES];
        pthread_mutex_lock(&stage->mutex);
        memcpy(gear, stage->gear, sizeof gear);
        bool lit = stage->lamp >= 0, released = stage->pulses > s->taken;
        ending = s->ending;
        pthread_mutex_unlock(&stage->mutex);
        if (released) {
            s->taken++;
            photograph(s, gear, lit);
        }
        nanosleep(&(struct timespec){0, 1000000}, NULL);
    }
    return NULL;
}

/* ---- The rig ---- */

/* The arms of the virtual rig do not err: those of the stage do. */
static weft_virtual_request request_of(void)
{
    weft_virtual_request request = {
        .sample = WEFT_ASSETS "/weaves/wool_gabardine.wv", .seed = 2, .settings = weft_virtual_settings_default()};
    weft_virtual_settings *settings = &request.settings;
    settings->rig.width_px = settings->rig.height_px = SIZE;
    settings->rig.focal_length_px = 740;
    settings->rig.bits = 16;
    settings->rig.black_level = BLACK;
    settings->samples_per_pixel = 4;
    settings->viewpoint_rotation_deg = settings->viewpoint_translation_mm = settings->light_rotation_deg = 0;
    return request;
}

static void write_rig(void)
{
    const weft_virtual_request request = request_of();
    const weft_lens lens = {.camera = weft_rig_settings_camera(&request.settings.rig)};
    assert_int_equal(weft_lens_write("lens.json", &lens, "none", NULL, 0, NULL), WEFT_OK);
    scratch_store("rig.conf", rig_conf, sizeof rig_conf - 1);
    scratch_store("plan.csv", plan, sizeof plan - 1);
}

static void open_studio(studio *s, UMockdevTestbed *testbed, fault injected)
{
    const weft_virtual_request request = request_of();
    weft_error error = {0};
    *s = (studio){.fault = injected};
    write_rig();
    expect_ok(weft_virtual_rig_open(&request, &s->rig, &error), &error);
    expect_ok(s->rig.rig.stage.home(s->rig.rig.stage.device, 0, &error), &error);
    fake_controller_start(&s->fake, testbed);
    assert_int_equal(pthread_create(&s->photographer, NULL, watch, s), 0);
}

static void close_studio(studio *s)
{
    pthread_mutex_lock(&s->fake.stage.mutex);
    s->ending = true;
    pthread_mutex_unlock(&s->fake.stage.mutex);
    pthread_join(s->photographer, NULL);
    fake_controller_end(&s->fake);
    weft_virtual_rig_close(&s->rig);
}

/* ---- Checks ---- */

static weft_preflight check(UMockdevTestbed *testbed, fault injected)
{
    static studio s;
    const weft_capture_request capture = {.folder = "night", .plan = "plan.csv"};
    const weft_laboratory_request request = {.rig_file = "rig.conf", .sample = "scarf"};
    weft_laboratory *laboratory;
    weft_preflight result;
    weft_error error = {0};
    open_studio(&s, testbed, injected);
    expect_ok(weft_laboratory_open(&request, &laboratory, &error), &error);
    expect_ok(weft_laboratory_connect(laboratory, &error), &error);
    weft_rig *rig = weft_laboratory_rig(laboratory);
    expect_ok(weft_preflight_run(&capture, rig, NULL, &result, &error), &error);
    weft_laboratory_close(laboratory);
    close_studio(&s);
    return result;
}

/* All pass but `failing`, and what else its cause may spoil; a shutter that is set by hand shows nothing of linearity.
 */
static void expect_only(weft_preflight *result, int failing, unsigned also)
{
    for (int kind = 0; kind < WEFT_CHECK_KINDS; kind++) {
        const weft_preflight_check *c = &result->check[kind];
        print_message("%s %g\n", weft_preflight_limits_of[kind].name, c->value);
        assert_true(c->done == (kind != WEFT_CHECK_LINEARITY) || also >> kind & 1);
        if (kind == failing)
            assert_true(c->done && !c->passed);
        else if (c->done && !(also >> kind & 1))
            assert_true(c->passed);
    }
    assert_true(weft_preflight_passed(result) == (failing < 0));
    weft_preflight_free(result);
}

static void a_sound_laboratory_passes(void **state)
{
    weft_preflight result = check(*state, NOTHING);
    assert_int_equal(result.pose_count, 2);
    expect_only(&result, -1, 0);
}

static void each_fault_is_found(void **state)
{
    weft_preflight result = check(*state, DAYLIGHT);
    expect_only(&result, WEFT_CHECK_STRAY, 0);
    result = check(*state, SHAKING);
    expect_only(&result, WEFT_CHECK_VIBRATION, 0);
    result = check(*state, SLIPPED);
    expect_only(&result, WEFT_CHECK_PLACE, 0);
}

static void a_disk_without_room_is_found(void **state)
{
    disk_is_full = true;
    weft_preflight result = check(*state, NOTHING);
    disk_is_full = false;
    assert_true(result.disk_needed > result.check[WEFT_CHECK_DISK].value);
    expect_only(&result, WEFT_CHECK_DISK, 0);
}

/* ---- The command ---- */

/* `days` ago. */
static void age(const char *path, int days)
{
    const struct timespec then = {time(NULL) - 86400L * days, 0}, both[2] = {then, then};
    assert_int_equal(utimensat(AT_FDCWD, path, both, 0), 0);
}

static void the_command_names_an_old_lens_and_then_takes_the_night(void **state)
{
    static studio s;
    open_studio(&s, *state, NOTHING);
    age("lens.json", 91);
    expect_weft("capture --rig rig.conf --sample scarf --plan plan.csv --check -o night", 1,
                "FAIL calibration     91 days old (at most 90)");
    expect_weft("info night", 1, "night"); /* no session was begun */
    age("lens.json", 89);
    expect_weft("capture --rig rig.conf --sample scarf --plan plan.csv --check -o night", 0,
                "pass calibration     89 days old");
    expect_weft("capture --rig rig.conf --sample scarf --plan plan.csv -o night", 0, "3 photographs");
    expect_weft("verify night", 0, "");
    expect_weft("register night -o night.btf.h5 --size 16x16", 0, "2 views");
    close_studio(&s);
}

/* ---- A testbed for each test ---- */

static int set_up(void **state)
{
    *state = umockdev_testbed_new();
    return 0;
}

static int tear_down(void **state)
{
    g_object_unref(*state);
    return 0;
}

static int enter(void **state)
{
    scratch_folder_enter(state);
    return mkdir("incoming", 0777);
}

#define WITH_TESTBED(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

int test_check_laboratory(void)
{
    const char *preloaded = getenv("LD_PRELOAD");
    if (!preloaded || !strstr(preloaded, "umockdev")) {
        puts("runs under umockdev-wrapper only");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        WITH_TESTBED(a_sound_laboratory_passes),
        WITH_TESTBED(each_fault_is_found),
        WITH_TESTBED(a_disk_without_room_is_found),
        WITH_TESTBED(the_command_names_an_old_lens_and_then_takes_the_night),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}
