#include "base/numeric/statistics.h"
#include "btf/dataset/dataset.h"
#include "btf/session/camera_list.h"
#include "capture/capture.h"
#include "capture/virtual/ground_truth.h"
#include "registration/registration.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/ground_truth.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The same views by one camera, and by two that share them, each with errors of its own; held against the truth of
 * each. */

enum { SHOTS = 10, VIEWPOINTS = 5, TEXELS = 32, VALUES = TEXELS * TEXELS * 3 };

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "10,0,0,0\n45,130,0,0\n"
                           "10,0,30,90\n45,130,30,90\n"
                           "10,0,30,270\n45,130,30,270\n"
                           "10,0,60,20\n45,130,60,20\n"
                           "10,0,60,200\n45,130,60,200\n";

typedef struct outcome {
    int count;
    weft_session *sessions;
    weft_registration registration[2];
    double warp[VIEWPOINTS], *error; /* of positions, in texels; relative, of samples */
    int viewpoints, errors;
} outcome;

static outcome one, two;

static void sound(weft_code code, const weft_error *error)
{
    if (code != WEFT_OK)
        fail_msg("%s", error->message);
}

static void photograph(const char *folder, int cameras)
{
    weft_virtual_request request = {WEFT_ASSETS "/weaves/cotton_denim.wv", 5, weft_virtual_settings_default()};
    const weft_capture_request capture_request = {.folder = folder, .plan = "plan.csv"};
    weft_virtual_rig rig[2];
    weft_capture capture;
    weft_error error = {0};
    int count;
    request.settings.cameras = cameras;
    sound(weft_virtual_rigs_open(&request, rig, &count, &error), &error);
    sound(weft_capture_begin(&capture_request, &rig[0].rig, NULL, &capture, &error), &error);
    sound(weft_capture_take(&capture, NULL, NULL, &error), &error);
    for (int i = 0; i < count; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s.%d.truth.h5", folder, i);
        const weft_truth_request wanted = {path, TEXELS, SHOTS};
        sound(weft_truth_write(&wanted, &capture.held[i].session, &rig[i], NULL, &error), &error);
    }
    weft_capture_end(&capture);
    for (int i = 0; i < count; i++)
        weft_virtual_rig_close(&rig[i]);
}

/* Shots of a camera, as images of the dataset. */
static void number_as_in_the_dataset(truth *t, int first_image)
{
    double(*light_mm)[3] = calloc(SHOTS, sizeof *light_mm);
    assert_non_null(light_mm);
    memcpy(light_mm[first_image], t->light_mm, (size_t)t->shot_count * sizeof *light_mm);
    free(t->light_mm);
    t->light_mm = light_mm;
    t->shot_count = SHOTS;
    for (int i = 0; i < t->image_count; i++)
        t->image_shot[i] += first_image;
}

/* Adds what one camera erred by; its images begin at `first_image` of the dataset. */
static void compare(const char *folder, int camera, int first_image, weft_dataset *dataset, outcome *o)
{
    truth real;
    truth_errors errors;
    char path[64];
    weft_error error = {0};
    const weft_registration *r = &o->registration[camera];
    snprintf(path, sizeof path, "%s.%d.truth.h5", folder, camera);
    sound(truth_read(path, &real, &error), &error);
    for (int i = 0; i < r->survey.viewpoint_count; i++) {
        assert_int_equal(r->pose[i].source, WEFT_POSE_DRAWING);
        o->warp[o->viewpoints++] = truth_warp_error_texels(
            &real, &o->sessions[camera].camera, r->survey.viewpoint[i].viewpoint, &r->pose[i].homography, TEXELS);
    }
    number_as_in_the_dataset(&real, first_image);
    sound(truth_compare_reflectance(&real, dataset, &errors, &error), &error);
    for (int i = 0; i < real.image_count; i++) {
        memcpy(o->error + o->errors, errors.error + (size_t)i * (size_t)errors.capacity,
               (size_t)errors.count[i] * sizeof *o->error);
        o->errors += errors.count[i];
    }
    truth_errors_free(&errors);
    truth_free(&real);
}

static void register_and_compare(const char *folder, outcome *o)
{
    weft_registration_settings settings[2];
    weft_dataset *dataset;
    weft_error error = {0};
    char path[64];
    snprintf(path, sizeof path, "%s.btf.h5", folder);
    o->error = malloc(sizeof *o->error * SHOTS * VALUES);
    assert_non_null(o->error);
    sound(weft_camera_sessions_open(folder, &o->sessions, &o->count, &error), &error);
    for (int i = 0; i < o->count; i++) {
        settings[i] = weft_registration_defaults(&o->sessions[i]);
        settings[i].width = settings[i].height = TEXELS;
    }
    sound(weft_register_cameras(o->sessions, o->count, path, settings, NULL, o->registration, &error), &error);
    sound(weft_dataset_open(path, &dataset, &error), &error);
    assert_int_equal(weft_dataset_get_layout(dataset)->image_count, SHOTS);
    assert_int_equal(weft_dataset_get_layout(dataset)->view_count, VIEWPOINTS);
    for (int i = 0, image = 0; i < o->count; i++) {
        compare(folder, i, image, dataset, o);
        image += o->sessions[i].shot_count;
    }
    weft_dataset_close(dataset);
    assert_int_equal(o->viewpoints, VIEWPOINTS);
}

static int take_and_register(void **state)
{
    if (scratch_folder_enter(state) != 0)
        return -1;
    scratch_store("plan.csv", plan, sizeof plan - 1);
    photograph("one", 1);
    photograph("two", 2);
    register_and_compare("one", &one);
    register_and_compare("two", &two);
    return 0;
}

static void let_go(outcome *o)
{
    for (int i = 0; i < o->count; i++)
        weft_registration_free(&o->registration[i]);
    weft_camera_sessions_free(o->sessions, o->count);
    free(o->error);
}

static int leave(void **state)
{
    let_go(&one);
    let_go(&two);
    return scratch_folder_leave(state);
}

static void two_cameras_err_as_one_does(void **state)
{
    (void)state;
    assert_int_equal(one.count, 1);
    assert_int_equal(two.count, 2);
    double warp_one = weft_quantile(one.warp, VIEWPOINTS, 1), warp_two = weft_quantile(two.warp, VIEWPOINTS, 1);
    double of_one = weft_quantile(one.error, one.errors, 0.5), of_two = weft_quantile(two.error, two.errors, 0.5);
    double high_one = weft_quantile(one.error, one.errors, 0.95), high_two = weft_quantile(two.error, two.errors, 0.95);
    print_message("one: %.4f texels in the worst view, samples %.2f %% median, %.2f %% at the 95th percentile\n",
                  warp_one, 100 * of_one, 100 * high_one);
    print_message("two: %.4f texels in the worst view, samples %.2f %% median, %.2f %% at the 95th percentile\n",
                  warp_two, 100 * of_two, 100 * high_two);
    assert_true(warp_two < 0.02);
    assert_true(of_two < 1.1 * of_one);
    assert_true(high_two < 1.1 * high_one);
}

/* Their lenses differ: each is seen by its own. */
static void each_camera_has_errors_of_its_own(void **state)
{
    (void)state;
    truth first, second;
    assert_int_equal(truth_read("two.0.truth.h5", &first, NULL), WEFT_OK);
    assert_int_equal(truth_read("two.1.truth.h5", &second, NULL), WEFT_OK);
    assert_true(first.camera.cx != second.camera.cx);
    assert_memory_equal(first.light_mm[0], second.light_mm[0], sizeof first.light_mm[0]);
    truth_free(&first);
    truth_free(&second);
}

static void cameras_of_unknown_colours_are_refused(void **state)
{
    (void)state;
    weft_session pair[2] = {{.folder = "left"}, {.folder = "right"}};
    weft_error error = {0};
    char model[] = "A", same[] = "A", other[] = "B";
    assert_int_equal(weft_camera_sessions_agree(pair, 1, NULL), WEFT_OK);
    assert_int_equal(weft_camera_sessions_agree(pair, 2, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "'left' and 'right'"));
    pair[0].camera_model = model;
    pair[1].camera_model = same;
    assert_int_equal(weft_camera_sessions_agree(pair, 2, NULL), WEFT_OK);
    pair[1].camera_model = other;
    assert_int_equal(weft_camera_sessions_agree(pair, 2, NULL), WEFT_BAD_INPUT);
    pair[0].colour.terms = pair[1].colour.terms = WEFT_COLOUR_LINEAR_TERMS;
    assert_int_equal(weft_camera_sessions_agree(pair, 2, NULL), WEFT_OK);
    pair[1].camera_model = same;
    pair[1].colour.terms = 0;
    assert_int_equal(weft_camera_sessions_agree(pair, 2, NULL), WEFT_BAD_INPUT);
    /* And registration asks. */
    weft_registration_settings settings[2] = {one.registration[0].settings, one.registration[0].settings};
    weft_registration registration[2];
    assert_int_equal(weft_register_cameras(pair, 2, "no.btf.h5", settings, NULL, registration, NULL), WEFT_BAD_INPUT);
}

int test_several_cameras(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_cameras_err_as_one_does),
        cmocka_unit_test(each_camera_has_errors_of_its_own),
        cmocka_unit_test(cameras_of_unknown_colours_are_refused),
    };
    return cmocka_run_group_tests(tests, take_and_register, leave);
}
