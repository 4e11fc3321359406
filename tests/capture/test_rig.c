#include "capture/virtual/random.h"
#include "capture/virtual/virtual_rig.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

/* A small rig without noise, whose raw values are proportional to radiance. */
typedef struct fixture {
    weft_virtual_rig virtual;
    weft_target target;
    uint16_t *samples;
} fixture;

static weft_virtual_settings quiet_settings(void)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.rig.width_px = settings.rig.height_px = 208;
    settings.rig.focal_length_px = 960;
    settings.rig.bits = 16;
    settings.full_well_electrons = 1e7;
    settings.sensitivity_electrons = 2e7;
    settings.read_noise_electrons = 0;
    settings.light_power_drift = 0;
    return settings;
}

static void open_rig(const weft_virtual_settings *settings, fixture *f)
{
    weft_virtual_request request = {WEFT_ASSETS "/weaves/polyester_lining.wv", 5, *settings};
    assert_int_equal(weft_virtual_rig_open(&request, &f->virtual, NULL), WEFT_OK);
    const weft_rig_stage *stage = &f->virtual.rig.stage;
    assert_int_equal(stage->home(stage->device, 0, NULL), WEFT_OK);
    f->target = weft_target_for_opening(settings->rig.opening_mm);
    f->samples = malloc((size_t)settings->rig.width_px * (size_t)settings->rig.height_px * 3 * sizeof *f->samples);
    assert_non_null(f->samples);
}

static void close_rig(fixture *f)
{
    weft_virtual_rig_close(&f->virtual);
    free(f->samples);
}

static weft_angles degrees(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

/* Drives and exposes; the light is on unless told otherwise. */
static bool photograph(fixture *f, weft_angles view, weft_angles light, double exposure_s, bool on)
{
    bool moved;
    double read_back_s;
    weft_rig *rig = &f->virtual.rig;
    assert_int_equal(rig->stage.move(rig->stage.device, view, light, &moved, NULL), WEFT_OK);
    assert_int_equal(rig->light.power(rig->light.device, on, NULL), WEFT_OK);
    assert_int_equal(rig->camera.expose(rig->camera.device, 1, exposure_s, f->samples, &read_back_s, NULL), WEFT_OK);
    assert_true(fabs(read_back_s - exposure_s) <= 0.5e-6);
    return moved;
}

static double raw(const fixture *f, int x, int y)
{
    return f->samples[3 * ((size_t)y * (size_t)f->virtual.world.settings.rig.width_px + (size_t)x)] -
           f->virtual.world.settings.rig.black_level;
}

/* Pixel of the true camera that sees a point of the plate. */
static weft_pixel project(const fixture *f, const weft_pose *pose, double x_mm, double y_mm)
{
    weft_homography homography = weft_homography_of_pose(&f->virtual.world.camera, pose);
    return weft_camera_distort(&f->virtual.world.camera, weft_homography_apply(&homography, x_mm, y_mm));
}

/* Mean raw value of a white patch over exposure, cosine, falloff and vignetting. */
static double normalised_white(const fixture *f, const weft_pose *pose, weft_vec3 light, int patch, double exposure_s)
{
    weft_rectangle r = weft_target_reference(&f->target, patch);
    double sum = 0;
    int count = 0;
    for (double v = 0.35; v < 0.7; v += 0.1) {
        for (double u = 0.35; u < 0.7; u += 0.1) {
            double x_mm = r.x0 + u * (r.x1 - r.x0), y_mm = r.y0 + v * (r.y1 - r.y0);
            weft_pixel at = project(f, pose, x_mm, y_mm);
            weft_vec3 to_light = weft_subtract(light, weft_vec3_of(x_mm, y_mm, 0));
            double distance = weft_length(to_light);
            double irradiance = to_light.z / (distance * distance * distance);
            double vignetting = weft_camera_vignetting(&f->virtual.world.camera, at);
            sum += raw(f, (int)lround(at.x), (int)lround(at.y)) / (exposure_s * irradiance * vignetting);
            count++;
        }
    }
    return sum / count;
}

static void white_patches_obey_exposure_cosine_falloff_and_vignetting(void **state)
{
    (void)state;
    weft_virtual_settings settings = quiet_settings();
    fixture f;
    open_rig(&settings, &f);
    const double cases[][5] = {{0, 0, 30, 0, 0.5}, {30, 90, 0, 0, 0.25}, {60, 200, 45, 10, 0.7}, {45, 300, 75, 120, 1}};
    double reference = 0;
    for (int i = 0; i < 4; i++) {
        weft_angles view = degrees(cases[i][0], cases[i][1]), light = degrees(cases[i][2], cases[i][3]);
        photograph(&f, view, light, cases[i][4], true);
        weft_pose pose = weft_virtual_world_pose(&f.virtual.world, view, i);
        weft_vec3 true_light = weft_virtual_world_light(&f.virtual.world, light, i);
        for (int patch = 0; patch < WEFT_TARGET_REFERENCE_COUNT; patch++) {
            double white = normalised_white(&f, &pose, true_light, patch, cases[i][4]);
            reference = reference > 0 ? reference : white;
            assert_true(fabs(white / reference - 1) < 0.01);
        }
    }
    close_rig(&f);
}

/* Printed reflectance of a pixel by 24 x 24 pinhole rays through the true camera. */
static double traced_print(const fixture *f, const weft_homography *to_plate, int x, int y)
{
    enum { RAYS = 24 };
    double sum = 0;
    for (int i = 0; i < RAYS * RAYS; i++) {
        weft_pixel pixel = {x - 0.5 + (i % RAYS + 0.5) / RAYS, y - 0.5 + (i / RAYS + 0.5) / RAYS};
        weft_pixel undistorted = weft_camera_undistort(&f->virtual.world.camera, pixel);
        weft_pixel plate = weft_homography_apply(to_plate, undistorted.x, undistorted.y);
        sum += weft_target_reflectance(&f->target, plate.x, plate.y);
    }
    return sum / (RAYS * RAYS);
}

static void edges_of_the_print_lie_where_the_true_camera_sees_them(void **state)
{
    (void)state;
    weft_virtual_settings settings = quiet_settings();
    settings.aperture_mm = 0;
    settings.samples_per_pixel = 64;
    fixture f;
    open_rig(&settings, &f);
    photograph(&f, degrees(45, 30), degrees(20, 200), 0.5, true);
    weft_pose pose = weft_virtual_world_pose(&f.virtual.world, degrees(45, 30), 0);
    weft_homography to_pixels = weft_homography_of_pose(&f.virtual.world.camera, &pose);
    weft_homography to_plate = weft_homography_inverse(&to_pixels);
    weft_rectangle marker = weft_target_marker(&f.target, 3);
    weft_pixel at = project(&f, &pose, (marker.x0 + marker.x1) / 2, (marker.y0 + marker.y1) / 2);
    /* Around one marker the irradiance is nearly even: fit one factor, then compare. */
    double cross = 0, squares = 0, error = 0;
    const int reach = 20;
    for (int pass = 0; pass < 2; pass++) {
        for (int y = (int)at.y - reach; y <= (int)at.y + reach; y++) {
            for (int x = (int)at.x - reach; x <= (int)at.x + reach; x++) {
                double expected = traced_print(&f, &to_plate, x, y), seen = raw(&f, x, y);
                if (pass == 0) {
                    cross += expected * seen;
                    squares += expected * expected;
                } else {
                    double difference = seen * squares / cross - expected;
                    error += difference * difference;
                }
            }
        }
    }
    /* A shift of 0.1 pixels alone would give more than 0.03. */
    assert_true(sqrt(error) / (2 * reach + 1) < 0.02);
    close_rig(&f);
}

/* How much a wide pupil changes a photograph, relative to its contrast. */
static double blur_of_wide_pupil(weft_angles view)
{
    weft_virtual_settings settings = quiet_settings();
    fixture sharp, wide;
    settings.samples_per_pixel = 32;
    settings.aperture_mm = 0;
    open_rig(&settings, &sharp);
    settings.aperture_mm = 12;
    open_rig(&settings, &wide);
    photograph(&sharp, view, degrees(30, 90), 0.3, true);
    photograph(&wide, view, degrees(30, 90), 0.3, true);
    double difference = 0, brightness = 0;
    for (int y = 0; y < 208; y++) {
        for (int x = 0; x < 208; x++) {
            difference += fabs(raw(&sharp, x, y) - raw(&wide, x, y));
            brightness += raw(&sharp, x, y);
        }
    }
    close_rig(&sharp);
    close_rig(&wide);
    return difference / brightness;
}

static void grazing_views_are_out_of_focus_and_frontal_ones_are_not(void **state)
{
    (void)state;
    assert_true(blur_of_wide_pupil(degrees(75, 20)) > 4 * blur_of_wide_pupil(degrees(0, 0)));
}

static void the_camera_in_the_way_of_the_light_darkens_the_photograph(void **state)
{
    (void)state;
    weft_virtual_settings settings = quiet_settings();
    fixture f;
    open_rig(&settings, &f);
    photograph(&f, degrees(45, 0), degrees(45, 0), 0.5, true);
    for (int i = 0; i < 208; i++)
        assert_true(raw(&f, i, i) == 0);
    photograph(&f, degrees(45, 0), degrees(41, 0), 0.5, true);
    assert_true(raw(&f, 104, 60) > 100);
    close_rig(&f);
}

static void without_light_only_the_read_noise_remains(void **state)
{
    (void)state;
    weft_virtual_settings settings = quiet_settings();
    settings.full_well_electrons = (1 << 16) - 1 - settings.rig.black_level; /* one electron a step */
    settings.read_noise_electrons = 10;
    fixture f;
    open_rig(&settings, &f);
    photograph(&f, degrees(0, 0), degrees(30, 0), 0.5, false);
    double sum = 0, squares = 0;
    for (int i = 0; i < 208 * 208; i++) {
        double value = raw(&f, i % 208, i / 208);
        sum += value;
        squares += value * value;
    }
    double mean = sum / (208 * 208), deviation = sqrt(squares / (208 * 208) - mean * mean);
    assert_true(fabs(mean) < 0.3);
    assert_true(fabs(deviation - 10) < 0.3);
    close_rig(&f);
}

static void a_viewpoint_lasts_until_the_camera_axes_move(void **state)
{
    (void)state;
    weft_virtual_settings settings = quiet_settings();
    fixture f;
    open_rig(&settings, &f);
    assert_true(photograph(&f, degrees(30, 0), degrees(30, 90), 0.5, true));
    double first = raw(&f, 60, 60);
    assert_false(photograph(&f, degrees(30, 0), degrees(60, 90), 0.5, true));
    assert_false(photograph(&f, degrees(30, 0), degrees(30, 90), 0.5, true));
    assert_true(raw(&f, 60, 60) == first);
    assert_true(photograph(&f, degrees(30, 60), degrees(30, 90), 0.5, true));
    assert_true(photograph(&f, degrees(30, 0), degrees(30, 90), 0.5, true));
    weft_pose pose = weft_virtual_world_pose(&f.virtual.world, degrees(30, 0), 0);
    weft_pose again = weft_virtual_world_pose(&f.virtual.world, degrees(30, 0), 2);
    double shift_mm = weft_length(weft_subtract(pose.translation, again.translation));
    assert_true(shift_mm > 0.001 && shift_mm < 2);
    close_rig(&f);
}

static void errors_of_a_viewpoint_have_the_size_that_the_settings_say(void **state)
{
    (void)state;
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.mounting_rotation_deg = settings.mounting_translation_mm = 0;
    weft_virtual_world world = weft_virtual_world_of_camera(&settings, 3, 0);
    weft_pose nominal = weft_pose_of_view(degrees(0, 0), settings.rig.camera_distance_mm);
    double squares = 0;
    const int viewpoints = 3000;
    for (int viewpoint = 0; viewpoint < viewpoints; viewpoint++) {
        weft_pose pose = weft_virtual_world_pose(&world, degrees(0, 0), viewpoint);
        weft_vec3 shift = weft_subtract(pose.translation, nominal.translation);
        squares += weft_dot(shift, shift) / 3;
    }
    assert_true(fabs(sqrt(squares / viewpoints) / settings.viewpoint_translation_mm - 1) < 0.05);
}

int test_rig(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_patches_obey_exposure_cosine_falloff_and_vignetting),
        cmocka_unit_test(edges_of_the_print_lie_where_the_true_camera_sees_them),
        cmocka_unit_test(grazing_views_are_out_of_focus_and_frontal_ones_are_not),
        cmocka_unit_test(the_camera_in_the_way_of_the_light_darkens_the_photograph),
        cmocka_unit_test(without_light_only_the_read_noise_remains),
        cmocka_unit_test(a_viewpoint_lasts_until_the_camera_axes_move),
        cmocka_unit_test(errors_of_a_viewpoint_have_the_size_that_the_settings_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
