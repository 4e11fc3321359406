/* Each check finds the fault that it is for, and no other check is troubled; a good rig passes all. The faults lie
 * between the virtual rig and the check, behind the rig's interface, as those of devices do. */
#include "capture/preflight/preflight.h"
#include "capture/virtual/virtual_rig.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE = 160, FULL_SCALE = 4095, BLACK = 64 };

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "60,0,0,0\n30,0,0,0\n60,90,60,0\n30,90,60,0\n30,90,30,90\n";

typedef enum fault { NOTHING, DEFOCUS, STRAY, SHAKING, WHITE_CLIPPED, COVERED, NOISE, CURVED, WARM, GLOWING } fault;

/* The virtual rig, with something wrong with what its camera delivers. */
typedef struct faulty {
    weft_virtual_rig *rig;
    weft_rig_camera camera; /* the sound one */
    weft_rig_light light;
    weft_rig_stage stage;
    fault fault;
    bool lit, grazing;
    int exposures;
} faulty;

static weft_code power(void *device, bool on, weft_error *error)
{
    faulty *f = device;
    f->lit = on;
    return f->light.power(f->light.device, on, error);
}

static weft_code move(void *device, weft_angles view, weft_angles light, bool *moved, weft_error *error)
{
    faulty *f = device;
    f->grazing = view.theta_rad > 1;
    return f->stage.move(f->stage.device, view, light, moved, error);
}

static weft_code home(void *device, int first_viewpoint, weft_error *error)
{
    faulty *f = device;
    return f->stage.home(f->stage.device, first_viewpoint, error);
}

static uint16_t clip(double value)
{
    return (uint16_t)fmin(fmax(value, 0), FULL_SCALE);
}

/* Mean of squares of 7 x 7 pixels. */
static void blur(uint16_t *samples)
{
    enum { REACH = 3 };
    static uint16_t sharp[SIZE * SIZE * 3];
    memcpy(sharp, samples, sizeof sharp);
    for (int i = 0; i < SIZE * SIZE; i++) {
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            int count = 0;
            for (int y = i / SIZE - REACH; y <= i / SIZE + REACH; y++) {
                for (int x = i % SIZE - REACH; x <= i % SIZE + REACH; x++) {
                    if (x >= 0 && y >= 0 && x < SIZE && y < SIZE) {
                        sum += sharp[3 * (y * SIZE + x) + c];
                        count++;
                    }
                }
            }
            samples[3 * i + c] = clip(sum / count);
        }
    }
}

/* Every other photograph is half a pixel to the side. */
static void shake(uint16_t *samples)
{
    for (int i = SIZE * SIZE - 1; i > 0; i--) {
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (uint16_t)((samples[3 * i + c] + samples[3 * i - 3 + c]) / 2);
    }
}

static void change(uint16_t *samples, double factor, double lift)
{
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        samples[i] = clip(BLACK + lift + (samples[i] - BLACK) * factor);
}

static void be_noisy(uint16_t *samples)
{
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        samples[i] = clip(samples[i] * (0.9 + 0.2 * rand() / RAND_MAX));
}

/* A tone curve, as in cameras that give no raw values. */
static void curve(uint16_t *samples)
{
    for (int i = 0; i < SIZE * SIZE * 3; i++) {
        double light = fmax(samples[i] - BLACK, 0) / (FULL_SCALE - BLACK);
        samples[i] = clip(BLACK + (FULL_SCALE - BLACK) * pow(light, 0.85));
    }
}

/* Dark current: of every pixel, or of one in so many. */
static void be_warm(uint16_t *samples, double lift, int apart)
{
    for (int i = 0; i < SIZE * SIZE; i += apart) {
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = clip(samples[3 * i + c] + lift);
    }
}

/* A cloth over the three quarters of the picture at the right. */
static void cover(uint16_t *samples)
{
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (i % SIZE > SIZE / 4) {
            for (int c = 0; c < 3; c++)
                samples[3 * i + c] = 700;
        }
    }
}

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    faulty *f = device;
    WEFT_TRY(f->camera.expose(f->camera.device, frame, exposure_s, samples, read_back_s, error));
    f->exposures++;
    if (f->fault == DEFOCUS)
        blur(samples);
    else if (f->fault == STRAY && f->grazing) /* from a window that only the lowest view sees */
        change(samples, 1, 40);
    else if (f->fault == SHAKING && f->exposures % 2)
        shake(samples);
    else if (f->fault == WHITE_CLIPPED && f->lit)
        change(samples, 20, 0);
    else if (f->fault == COVERED)
        cover(samples);
    else if (f->fault == NOISE && f->lit)
        be_noisy(samples);
    else if (f->fault == CURVED)
        curve(samples);
    else if (f->fault == WARM)
        be_warm(samples, 150 * exposure_s, 1);
    else if (f->fault == GLOWING)
        be_warm(samples, 50 * exposure_s, 100);
    return WEFT_OK;
}

static weft_virtual_request request_of(void)
{
    weft_virtual_request request = {
        .sample = WEFT_ASSETS "/weaves/wool_gabardine.wv", .seed = 2, .settings = weft_virtual_settings_default()};
    request.settings.rig.width_px = request.settings.rig.height_px = SIZE;
    request.settings.rig.focal_length_px = 740;
    request.settings.samples_per_pixel = 4;
    return request;
}

static weft_preflight check(fault injected)
{
    const weft_virtual_request request = request_of();
    const weft_capture_request capture = {.folder = "session", .plan = "plan.csv"};
    weft_virtual_rig rig;
    weft_preflight result;
    weft_error error = {0};
    scratch_store("plan.csv", plan, sizeof plan - 1);
    expect_ok(weft_virtual_rig_open(&request, &rig, &error), &error);
    faulty f = {
        .rig = &rig, .camera = rig.rig.camera, .light = rig.rig.light, .stage = rig.rig.stage, .fault = injected};
    weft_rig wrapped = rig.rig;
    wrapped.lens_path = "plan.csv";
    wrapped.camera = (weft_rig_camera){.device = &f, .expose = expose};
    wrapped.stage = (weft_rig_stage){.device = &f, .home = home, .move = move};
    wrapped.light = (weft_rig_light){&f, power};
    /* So a white patch clips that cannot be exposed for. */
    wrapped.settings.shortest_exposure_s = injected == WHITE_CLIPPED ? 1.0 / 60 : wrapped.settings.shortest_exposure_s;
    expect_ok(weft_preflight_run(&capture, &wrapped, NULL, &result, &error), &error);
    for (int kind = 0; kind < WEFT_CHECK_KINDS; kind++)
        print_message("%d %s %s %g\n", (int)injected, weft_preflight_limits_of[kind].name,
                      !result.check[kind].done    ? "-"
                      : result.check[kind].passed ? "pass"
                                                  : "FAIL",
                      result.check[kind].value);
    weft_virtual_rig_close(&rig);
    return result;
}

static void a_good_rig_passes_everything_and_leaves_nothing_behind(void **state)
{
    (void)state;
    weft_preflight result = check(NOTHING);
    for (int kind = 0; kind < WEFT_CHECK_KINDS; kind++) {
        assert_true(result.check[kind].done);
        assert_true(result.check[kind].passed);
    }
    assert_true(weft_preflight_passed(&result));
    /* The frontal view, and the lowest of the plan. */
    assert_int_equal(result.pose_count, 2);
    assert_int_equal(scratch_folder_entries(), 1); /* the plan */
    weft_preflight_free(&result);
}

/* Each fault, what must find it, and what else may. */
static void each_check_finds_its_fault(void **state)
{
    (void)state;
    static const struct {
        fault fault;
        weft_preflight_kind found_by;
        unsigned also;
    } cases[] = {
        {DEFOCUS, WEFT_CHECK_FOCUS, 1u << WEFT_CHECK_FOCUS_GRAZING | 1u << WEFT_CHECK_TARGET},
        {STRAY, WEFT_CHECK_STRAY, 1u << WEFT_CHECK_LINEARITY}, /* as much in a short exposure as in a long one */
        {SHAKING, WEFT_CHECK_VIBRATION, 0},
        {WHITE_CLIPPED, WEFT_CHECK_WHITE_CLIPPED, ~0u},
        {COVERED, WEFT_CHECK_TARGET, ~0u},
        {NOISE, WEFT_CHECK_NOISE, 0},
        {CURVED, WEFT_CHECK_LINEARITY, 0},
        {WARM, WEFT_CHECK_DARK, 0},
        {GLOWING, WEFT_CHECK_HOT, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        weft_preflight result = check(cases[i].fault);
        assert_false(weft_preflight_passed(&result));
        for (int kind = 0; kind < WEFT_CHECK_KINDS; kind++) {
            const weft_preflight_check *c = &result.check[kind];
            if (kind == (int)cases[i].found_by)
                assert_true(c->done && !c->passed);
            else if (!(cases[i].also >> kind & 1))
                assert_true(c->done && c->passed);
        }
        weft_preflight_free(&result);
    }
}

int test_preflight(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_good_rig_passes_everything_and_leaves_nothing_behind),
        cmocka_unit_test(each_check_finds_its_fault),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
