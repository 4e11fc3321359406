#include "capture/capture.h"
#include "registration/registration.h"

#include "btf/dataset.h"
#include "registration/statistics.h"
#include "tests/btf/cmocka_all.h"
#include "tests/btf/scratch_folder.h"

#include <hdf5.h>
#include <math.h>
#include <stdlib.h>

/* A session of the virtual rig, registered without its truth, then held against it. */

enum { SHOTS = 18, STAYS = 6, TEXELS = 64, TRUTH_IMAGES = 6, VALUES = TEXELS * TEXELS * 3 };

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "10,0,0,0\n45,120,0,0\n75,240,0,0\n"
                           "10,0,30,90\n45,120,30,90\n75,240,30,90\n"
                           "10,0,45,200\n45,120,45,200\n75,240,45,200\n"
                           "10,0,60,300\n45,120,60,300\n75,240,60,300\n"
                           "10,0,75,20\n45,120,75,20\n75,240,75,20\n"
                           "10,0,75,150\n45,120,75,150\n75,240,75,150\n";

static weft_session session;
static weft_registration registration;
static weft_camera true_camera;
static double rotation[STAYS][3][3], translation[STAYS][3], light[SHOTS][3];
static int image_shot[TRUTH_IMAGES];
static float reflectance[TRUTH_IMAGES][TEXELS][TEXELS][3];

static bool load(hid_t file, const char *name, hid_t type, size_t count, void *values)
{
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
    bool good = H5Sget_simple_extent_npoints(space) == (hssize_t)count &&
                H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    H5Sclose(space);
    H5Dclose(set);
    return good;
}

static bool load_number(hid_t file, const char *name, double *value)
{
    hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
    bool good = H5Aread(attribute, H5T_NATIVE_DOUBLE, value) >= 0;
    H5Aclose(attribute);
    return good;
}

static bool load_truth(void)
{
    hid_t file = H5Fopen("session.truth.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
    true_camera = session.camera;
    bool good = file >= 0 && load(file, "rotation", H5T_NATIVE_DOUBLE, STAYS * 9, rotation) &&
                load(file, "translation_mm", H5T_NATIVE_DOUBLE, STAYS * 3, translation) &&
                load(file, "light_mm", H5T_NATIVE_DOUBLE, SHOTS * 3, light) &&
                load(file, "image_shot", H5T_NATIVE_INT, TRUTH_IMAGES, image_shot) &&
                load(file, "reflectance", H5T_NATIVE_FLOAT, (size_t)TRUTH_IMAGES * VALUES, reflectance) &&
                load_number(file, "fx", &true_camera.fx) && load_number(file, "fy", &true_camera.fy) &&
                load_number(file, "cx", &true_camera.cx) && load_number(file, "cy", &true_camera.cy) &&
                load_number(file, "k1", &true_camera.k1) && load_number(file, "k2", &true_camera.k2);
    H5Fclose(file);
    return good;
}

static int take_and_register(void **state)
{
    if (scratch_folder_enter(state) != 0)
        return -1;
    scratch_store("plan.csv", plan, sizeof plan - 1);
    weft_capture_request request = {.folder = "session",
                                    .plan = "plan.csv",
                                    .sample = WEFT_ASSETS "/weaves/cotton_denim.wv",
                                    .settings = weft_rig_settings_default(),
                                    .seed = 5,
                                    .truth_size = TEXELS,
                                    .truth_images = TRUTH_IMAGES};
    weft_capture_summary summary;
    weft_error error = {0};
    if (weft_capture_run(&request, NULL, NULL, &summary, &error) != WEFT_OK ||
        weft_session_open("session", &session, &error) != WEFT_OK || !load_truth()) {
        print_error("%s\n", error.message);
        return -1;
    }
    weft_registration_settings settings = weft_registration_defaults(&session);
    return weft_register_session(&session, "made.btf.h5", &settings, NULL, &registration, &error) == WEFT_OK ? 0 : -1;
}

static int leave(void **state)
{
    weft_registration_free(&registration);
    weft_session_free(&session);
    return scratch_folder_leave(state);
}

/* RMS over the opening, in texels, of where the registration puts the points that truly lie at a place. */
static double error_texels(int stay)
{
    enum { grid = 9 };
    const double opening = session.target.opening_mm;
    int true_stay = registration.survey.stay[stay].stay;
    weft_pose pose = {.translation = {translation[true_stay][0], translation[true_stay][1], translation[true_stay][2]}};
    memcpy(pose.rotation, rotation[true_stay], sizeof pose.rotation);
    weft_homography truth = weft_homography_of_pose(&true_camera, &pose);
    weft_homography inverse = weft_homography_inverse(&registration.pose[stay].homography);
    double sum = 0;
    for (int i = 0; i < grid * grid; i++) {
        double x = opening * (i % grid / (grid - 1.0) - 0.5), y = opening * (i / grid / (grid - 1.0) - 0.5);
        weft_pixel seen = weft_camera_distort(&true_camera, weft_homography_apply(&truth, x, y));
        seen = weft_camera_undistort(&session.camera, seen);
        weft_pixel back = weft_homography_apply(&inverse, seen.x, seen.y);
        sum += (back.x - x) * (back.x - x) + (back.y - y) * (back.y - y);
    }
    return sqrt(sum / (grid * grid)) / opening * TEXELS;
}

static void poses_agree_with_the_truth_within_half_the_floors(void **state)
{
    (void)state;
    double error[STAYS];
    assert_int_equal(registration.survey.stay_count, STAYS);
    for (int stay = 0; stay < STAYS; stay++) {
        error[stay] = error_texels(stay);
        assert_int_equal(registration.pose[stay].source, WEFT_POSE_DRAWING);
        print_message("view %.0f degrees: %.4f texels\n",
                      weft_deg_of_rad(registration.survey.view[registration.survey.stay[stay].view].theta_rad),
                      error[stay]);
    }
    assert_true(weft_quantile(error, STAYS, 0.5) < 0.025);
    assert_true(weft_quantile(error, STAYS, 1) < 0.075);
}

/* Relative errors of a shot's unsaturated samples; the truth holds the cosine at each texel, the dataset that of the
 * far direction. Returns their number. */
static int relative_errors(int image, const weft_half *samples, const uint8_t *mask, double *error)
{
    int shot = image_shot[image], count = 0;
    weft_vec3 far = weft_direction_of_angles(session.shot[shot].light_driven);
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        double x = ((i % TEXELS + 0.5) / TEXELS - 0.5) * session.target.opening_mm;
        double y = (0.5 - (i / TEXELS + 0.5) / TEXELS) * session.target.opening_mm;
        weft_vec3 near = weft_unit((weft_vec3){light[shot][0] - x, light[shot][1] - y, light[shot][2]});
        if (mask[(size_t)i * SHOTS + (size_t)shot])
            continue;
        for (int c = 0; c < 3; c++) {
            double truth = (double)reflectance[image][i / TEXELS][i % TEXELS][c] * far.z / near.z;
            double found = (double)weft_float_of_half(samples[((size_t)i * SHOTS + (size_t)shot) * 3 + (size_t)c]);
            if (truth > 0)
                error[count++] = fabs(found / truth - 1);
        }
    }
    return count;
}

static void reflectance_agrees_with_the_truth_within_the_floor(void **state)
{
    (void)state;
    weft_half *samples = malloc(sizeof *samples * SHOTS * VALUES);
    uint8_t *mask = malloc((size_t)SHOTS * TEXELS * TEXELS);
    double *error = malloc(sizeof *error * VALUES), *up_to_45 = malloc(sizeof *up_to_45 * TRUTH_IMAGES * VALUES);
    int count_45 = 0;
    weft_dataset *dataset;
    assert_true(samples && mask && error && up_to_45);
    assert_int_equal(weft_dataset_open("made.btf.h5", &dataset, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, TEXELS, TEXELS, samples, mask, NULL), WEFT_OK);
    for (int image = 0; image < TRUTH_IMAGES; image++) {
        int count = relative_errors(image, samples, mask, error);
        double tilt = weft_deg_of_rad(session.shot[image_shot[image]].view.theta_rad);
        for (int i = 0; i < count && tilt < 45.1; i++)
            up_to_45[count_45++] = error[i];
        print_message("view %.0f degrees: median relative error %.2f %%\n", tilt,
                      100 * weft_quantile(error, count, 0.5));
    }
    assert_true(count_45 > 0);
    assert_true(weft_quantile(up_to_45, count_45, 0.5) < 0.03);
    weft_dataset_close(dataset);
    free(samples);
    free(mask);
    free(error);
    free(up_to_45);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_agree_with_the_truth_within_half_the_floors),
        cmocka_unit_test(reflectance_agrees_with_the_truth_within_the_floor),
    };
    return cmocka_run_group_tests(tests, take_and_register, leave);
}
