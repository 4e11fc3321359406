/* The virtual rig with a sample that has depth. */
#include "capture/virtual/ground_truth.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>
#include <string.h>

static weft_virtual_settings exact_settings(void)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.rig.width_px = settings.rig.height_px = 312;
    settings.rig.opening_mm = 7.2;
    settings.rig.focal_length_px = 6400;
    settings.rig.bits = 16;
    settings.full_well_electrons = 1e7;
    settings.sensitivity_electrons = 1e7;
    settings.read_noise_electrons = 0;
    settings.light_power_drift = 0;
    settings.rig.vignetting_r2 = settings.rig.vignetting_r4 = 0;
    settings.mounting_rotation_deg = settings.mounting_translation_mm = 0;
    settings.viewpoint_rotation_deg = settings.viewpoint_translation_mm = settings.light_rotation_deg = 0;
    return settings;
}

static weft_angles degrees(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

/* Mean raw green of the pixels whose centres see the rectangle of the plate. */
static double mean_over(const weft_virtual_world *world, const weft_pose *pose, const uint16_t *samples,
                        weft_rectangle where)
{
    enum { PLACES = 184 };
    weft_homography homography = weft_homography_of_pose(&world->camera, pose);
    double sum = 0;
    for (int i = 0; i < PLACES * PLACES; i++) {
        double x_mm = where.x0 + (i % PLACES + 0.5) / PLACES * (where.x1 - where.x0);
        double y_mm = where.y0 + (i / PLACES + 0.5) / PLACES * (where.y1 - where.y0);
        weft_pixel at = weft_camera_distort(&world->camera, weft_homography_apply(&homography, x_mm, y_mm));
        size_t pixel = (size_t)lround(at.y) * (size_t)world->camera.width + (size_t)lround(at.x);
        sum += samples[3 * pixel + 1] - world->settings.rig.black_level;
    }
    return sum / (PLACES * PLACES);
}

static double true_mean(const weft_virtual_sample *sample, weft_vec3 light, weft_vec3 camera)
{
    enum { TEXELS = 37 };
    double sum = 0;
    for (int i = 0; i < TEXELS * TEXELS; i++)
        sum += weft_truth_reflectance(sample, TEXELS, i % TEXELS, i / TEXELS, light, camera).g;
    return sum / (TEXELS * TEXELS);
}

/* A white patch reflects its reflectance times the cosine; the cloth what the truth says. 2 x 3 tiles stand for all. */
static void the_photograph_of_the_cloth_is_as_bright_as_the_truth_says(void **state)
{
    (void)state;
    static const double cases[3][4] = {{0, 0, 40, 30}, {55, 90, 20, 200}, {70, 10, 60, 120}};
    weft_virtual_request request = {WEFT_ASSETS "/stitches/plain_knit.stitch", 5, exact_settings()};
    weft_virtual_rig virtual;
    assert_int_equal(weft_virtual_rig_open(&request, &virtual, NULL), WEFT_OK);
    const weft_virtual_world *world = &virtual.world;
    weft_rig *rig = &virtual.rig;
    weft_target target = weft_target_for_opening(rig->settings.opening_mm);
    double read_back_s;
    bool moved;
    uint16_t *samples = malloc(3 * (size_t)world->camera.width * (size_t)world->camera.height * sizeof *samples);
    assert_non_null(samples);
    assert_int_equal(rig->stage.home(rig->stage.device, 0, NULL), WEFT_OK);
    for (int i = 0; i < 3; i++) {
        weft_angles view = degrees(cases[i][0], cases[i][1]), light = degrees(cases[i][2], cases[i][3]);
        rig->stage.move(rig->stage.device, view, light, &moved, NULL);
        rig->light.power(rig->light.device, true, NULL);
        assert_int_equal(rig->camera.expose(rig->camera.device, 1, 0.005, samples, &read_back_s, NULL), WEFT_OK);
        weft_pose pose = weft_virtual_world_pose(world, view, i);
        weft_vec3 true_light = weft_virtual_world_light(world, light, i);
        weft_rectangle tiles = {-1.8, -2.16, 1.8, 2.16}, patch = weft_target_reference(&target, 0);
        weft_rectangle inner = {0.7 * patch.x0 + 0.3 * patch.x1, 0.7 * patch.y0 + 0.3 * patch.y1,
                                0.3 * patch.x0 + 0.7 * patch.x1, 0.3 * patch.y0 + 0.7 * patch.y1};
        double white = mean_over(world, &pose, samples, inner) / target.white_reflectance;
        double cosine = weft_unit(true_light).z;
        double found = mean_over(world, &pose, samples, tiles) / white * cosine;
        double expected = true_mean(&virtual.sample, true_light, weft_pose_camera_position(&pose));
        print_message("view %g: photograph %.4f, truth %.4f\n", cases[i][0], found, expected);
        assert_float_equal(found / expected, 1, 0.02);
    }
    weft_virtual_rig_close(&virtual);
    free(samples);
}

static void tiles_of_a_stitch_cannot_be_chosen(void **state)
{
    (void)state;
    weft_virtual_settings settings = exact_settings();
    weft_virtual_sample refused;
    char warning[WEFT_MESSAGE_SIZE];
    weft_error error = {0};
    settings.tiles_x = 3;
    assert_int_equal(
        weft_virtual_sample_read(WEFT_ASSETS "/stitches/satin.stitch", &settings, 1, &refused, warning, &error),
        WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "tiles_x and tiles_y must be 0"));
}

int test_depth(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_photograph_of_the_cloth_is_as_bright_as_the_truth_says),
        cmocka_unit_test(tiles_of_a_stitch_cannot_be_chosen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
