#include "capture/virtual/ground_truth.h"

#include "base/numeric/statistics.h"
#include "base/picture/image.h"
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <hdf5.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 8, IMAGES = 5, VIEWPOINTS = 5 };

static weft_session session;
static weft_virtual_rig rig;
static double rotation[VIEWPOINTS][3][3], translation[VIEWPOINTS][3], light[SMALL_SHOTS][3];
static int viewpoint[SMALL_SHOTS], image_shot[IMAGES];
static float reflectance[IMAGES][TEXELS][TEXELS][3];

static virtual_session make_request(void)
{
    virtual_session request = small_session_request();
    request.truth.size = TEXELS;
    request.truth.image_count = IMAGES;
    request.rig.settings.rig.bits = 16;
    request.rig.settings.full_well_electrons = 1e7;
    request.rig.settings.sensitivity_electrons = 8e8;
    request.rig.settings.samples_per_pixel = 32;
    request.rig.settings.light_power_drift = 0;
    return request;
}

static int load(hid_t file, const char *name, hid_t type, size_t count, void *values)
{
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    hid_t space = H5Dget_space(set);
    int good = H5Sget_simple_extent_npoints(space) == (hssize_t)count &&
               H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    H5Sclose(space);
    H5Dclose(set);
    return good;
}

static int load_truth(void)
{
    hid_t file = H5Fopen("session.truth.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
    int good = file >= 0 && load(file, "rotation", H5T_NATIVE_DOUBLE, VIEWPOINTS * 9, rotation) &&
               load(file, "translation_mm", H5T_NATIVE_DOUBLE, VIEWPOINTS * 3, translation) &&
               load(file, "light_mm", H5T_NATIVE_DOUBLE, SMALL_SHOTS * 3, light) &&
               load(file, "viewpoint", H5T_NATIVE_INT, SMALL_SHOTS, viewpoint) &&
               load(file, "image_shot", H5T_NATIVE_INT, IMAGES, image_shot) &&
               load(file, "reflectance", H5T_NATIVE_FLOAT, IMAGES * TEXELS * TEXELS * 3, reflectance);
    H5Fclose(file);
    return good;
}

static int take_session(void **state)
{
    if (scratch_folder_enter(state) != 0)
        return -1;
    virtual_session request = make_request();
    weft_capture_summary summary;
    return virtual_session_take(&request, NULL, NULL, &summary, NULL) == WEFT_OK &&
                   weft_session_open("session", &session, NULL) == WEFT_OK &&
                   weft_virtual_rig_open(&request.rig, &rig, NULL) == WEFT_OK && load_truth()
               ? 0
               : -1;
}

static int leave_session(void **state)
{
    weft_session_free(&session);
    weft_virtual_rig_close(&rig);
    return scratch_folder_leave(state);
}

static void poses_and_lights_are_those_of_the_virtual_rig(void **state)
{
    (void)state;
    for (int shot = 0; shot < SMALL_SHOTS; shot++) {
        assert_int_equal(viewpoint[shot], session.record[shot].viewpoint);
        weft_pose pose = weft_virtual_world_pose(&rig.world, session.shot[shot].view, viewpoint[shot]);
        assert_memory_equal(rotation[viewpoint[shot]], pose.rotation, sizeof pose.rotation);
        assert_true(translation[viewpoint[shot]][0] == pose.translation.x &&
                    translation[viewpoint[shot]][2] == pose.translation.z);
        weft_vec3 at = weft_virtual_world_light(&rig.world, session.shot[shot].light_driven, viewpoint[shot]);
        assert_true(light[shot][0] == at.x && light[shot][1] == at.y && light[shot][2] == at.z);
    }
}

/* Mean of pi BRDF cos over a texel by points x points samples. */
static weft_rgb integrate_texel(int shot, int x, int y, int points)
{
    double(*r)[3] = rotation[viewpoint[shot]];
    const double *t = translation[viewpoint[shot]];
    weft_rgb sum = {0, 0, 0};
    for (int i = 0; i < points * points; i++) {
        double u = (x + (i % points + 0.5) / points) / TEXELS, v = 1 - (y + (i / points + 0.5) / points) / TEXELS;
        double p[3] = {(u - 0.5) * 32, (v - 0.5) * 32, 0}, to_camera[3], to_light[3], camera_length = 0,
               light_length = 0;
        for (int axis = 0; axis < 3; axis++) {
            to_camera[axis] = -(r[0][axis] * t[0] + r[1][axis] * t[1] + r[2][axis] * t[2]) - p[axis];
            to_light[axis] = light[shot][axis] - p[axis];
            camera_length += to_camera[axis] * to_camera[axis];
            light_length += to_light[axis] * to_light[axis];
        }
        camera_length = sqrt(camera_length);
        light_length = sqrt(light_length);
        weft_weave_point point = weft_weave_locate(&rig.sample.flat.weave, u * rig.sample.flat.tiles_x,
                                                   v * rig.sample.flat.tiles_y, rig.sample.flat.noise_seed);
        weft_rgb brdf = weft_weave_brdf(
            &rig.sample.flat.weave, &point,
            weft_vec3_of(to_light[0] / light_length, to_light[1] / light_length, to_light[2] / light_length),
            weft_vec3_of(to_camera[0] / camera_length, to_camera[1] / camera_length, to_camera[2] / camera_length));
        double weight = WEFT_PI * to_light[2] / light_length / (points * points);
        sum = (weft_rgb){sum.r + weight * brdf.r, sum.g + weight * brdf.g, sum.b + weight * brdf.b};
    }
    return sum;
}

static void reflectance_equals_an_independent_evaluation(void **state)
{
    (void)state;
    for (int image = 0; image < IMAGES; image++) {
        for (int i = 0; i < TEXELS * TEXELS; i++) {
            weft_rgb expected = integrate_texel(image_shot[image], i % TEXELS, i / TEXELS, 8);
            const float *found = reflectance[image][i / TEXELS][i % TEXELS];
            assert_true(fabs(found[0] - expected.r) <= 1e-5 * expected.r);
            assert_true(fabs(found[1] - expected.g) <= 1e-5 * expected.g);
            assert_true(fabs(found[2] - expected.b) <= 1e-5 * expected.b);
        }
    }
}

static void reflectance_is_near_the_converged_mean_of_the_footprint(void **state)
{
    (void)state;
    for (int image = 0; image < IMAGES; image++) {
        double found = 0, converged = 0;
        for (int i = 0; i < TEXELS * TEXELS; i++) {
            converged += integrate_texel(image_shot[image], i % TEXELS, i / TEXELS, 40).r;
            found += reflectance[image][i / TEXELS][i % TEXELS][0];
        }
        assert_true(fabs(found / converged - 1) < 0.03);
    }
}

/* Mean over a texel of the photograph, turned into reflectance with the true camera, light and sensitivity. */
static double photographed_texel(const uint16_t *samples, int shot, int x, int y)
{
    enum { POINTS = 16 };
    weft_pose pose = weft_virtual_world_pose(&rig.world, session.shot[shot].view, viewpoint[shot]);
    weft_homography homography = weft_homography_of_pose(&rig.world.camera, &pose);
    const weft_virtual_settings *s = &rig.world.settings;
    double electrons_per_step = s->full_well_electrons / (65535 - s->rig.black_level), sum = 0;
    for (int i = 0; i < POINTS * POINTS; i++) {
        double x_mm = ((x + (i % POINTS + 0.5) / POINTS) / TEXELS - 0.5) * 32;
        double y_mm = (0.5 - (y + (i / POINTS + 0.5) / POINTS) / TEXELS) * 32;
        weft_pixel at = weft_camera_distort(&rig.world.camera, weft_homography_apply(&homography, x_mm, y_mm));
        double raw = samples[3 * (lround(at.y) * SMALL_SIZE + lround(at.x))] - s->rig.black_level;
        weft_vec3 to_light = {light[shot][0] - x_mm, light[shot][1] - y_mm, light[shot][2]};
        double falloff = pow(weft_length(to_light) / s->rig.light_distance_mm, 2);
        sum += WEFT_PI * falloff * raw * electrons_per_step /
               (s->sensitivity_electrons * session.record[shot].exposure_s *
                weft_camera_vignetting(&rig.world.camera, at));
    }
    return sum / (POINTS * POINTS);
}

static void photographs_show_the_reflectance_of_the_truth(void **state)
{
    (void)state;
    static uint16_t samples[SMALL_SIZE * SMALL_SIZE * 3];
    for (int image = 0; image < IMAGES; image++) {
        int shot = image_shot[image];
        if (session.shot[shot].view.theta_rad > weft_rad_of_deg(50))
            continue;
        char path[PATH_MAX];
        double error[(TEXELS - 2) * (TEXELS - 2)];
        int count = 0;
        weft_session_photograph_path(&session, shot, path, sizeof path);
        assert_int_equal(weft_photograph_read(path, SMALL_SIZE, SMALL_SIZE, 16, samples, NULL), WEFT_OK);
        for (int y = 1; y < TEXELS - 1; y++) {
            for (int x = 1; x < TEXELS - 1; x++)
                error[count++] = photographed_texel(samples, shot, x, y) / reflectance[image][y][x][0] - 1;
        }
        /* Texels are 3.5 pixels here, so the highlights of a neighbour bleed in; on the whole it must not. */
        assert_true(fabs(weft_quantile(error, count, 0.5)) < 0.05);
    }
}

static void the_choice_takes_every_view_once_with_all_lights_among_them(void **state)
{
    (void)state;
    static weft_shot shots[81 * 81];
    bool view_seen[81] = {false}, light_seen[81] = {false};
    int chosen[81];
    for (int i = 0; i < 81 * 81; i++)
        shots[i] = (weft_shot){weft_ubo81_angles(i % 81), weft_ubo81_angles(i / 81), {0, 0}};
    weft_session full = {.shot_count = 81 * 81, .shot = shots};
    assert_int_equal(weft_truth_choose(&full, 81, chosen), 81);
    for (int i = 0; i < 81; i++) {
        view_seen[chosen[i] / 81] = true;
        light_seen[chosen[i] % 81] = true;
    }
    for (int i = 0; i < 81; i++)
        assert_true(view_seen[i] && light_seen[i]);
    full.shot_count = 81;
    assert_int_equal(weft_truth_choose(&full, 81, chosen), 81);
    full.shot_count = 3;
    assert_int_equal(weft_truth_choose(&full, 81, chosen), 3);
}

int test_truth(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_and_lights_are_those_of_the_virtual_rig),
        cmocka_unit_test(reflectance_equals_an_independent_evaluation),
        cmocka_unit_test(reflectance_is_near_the_converged_mean_of_the_footprint),
        cmocka_unit_test(photographs_show_the_reflectance_of_the_truth),
        cmocka_unit_test(the_choice_takes_every_view_once_with_all_lights_among_them),
    };
    return cmocka_run_group_tests(tests, take_session, leave_session);
}
