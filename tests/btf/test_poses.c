#include "btf/session/poses_file.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const weft_camera camera = {
    .width = 416, .height = 400, .fx = 1920, .fy = 1910, .cx = 207.5, .cy = 199, .k1 = -0.5, .k2 = 1};

static weft_poses_file example(void)
{
    weft_poses_file file = {.poses = weft_rig_poses_nominal(&camera, 500),
                            .home_rotation_rad = 1e-4,
                            .home_translation_mm = 0.02,
                            .scatter_rad = 0.001,
                            .scatter_mm = 0.1,
                            .point_px = 0.01,
                            .rms_px = 0.5,
                            .held_out_rms_px = 0.6};
    weft_joint *phi = &file.poses.joint[WEFT_CAMERA_PHI];
    phi->direction = weft_unit(weft_vec3_of(0.01, -0.02, -1));
    phi->point = weft_vec3_of(0.3, -0.4, 0.011);
    phi->scale = 0.002;
    phi->uneven[1] = 0.003;
    phi->wobble[2] = -0.001;
    file.error[WEFT_CAMERA_PHI] = (weft_joint_error){1e-4, 0.02, 1e-5, 2e-4, 3e-4};
    return file;
}

static void store(const weft_poses_file *file)
{
    const weft_lens_photograph shot[] = {{"a.tif", NULL}, {"b.tif", "it was moved"}};
    const char *const undetermined[] = {"sample phi does not turn"};
    weft_error error = {0};
    expect_ok(weft_poses_write("rig.poses.json", file, shot, 2, undetermined, 1, &error), &error);
}

static void poses_are_read_as_they_were_written(void **state)
{
    (void)state;
    const weft_turns turns = {{60, -130, 20}};
    weft_poses_file wrote = example(), read;
    weft_error error = {0};
    store(&wrote);
    expect_ok(weft_poses_read("rig.poses.json", &read, &error), &error);
    weft_pose a = weft_rig_poses_at(&wrote.poses, &turns), b = weft_rig_poses_at(&read.poses, &turns);
    assert_true(weft_length(weft_subtract(a.translation, b.translation)) < 1e-9);
    for (int i = 0; i < 9; i++)
        assert_true(fabs(a.rotation[i / 3][i % 3] - b.rotation[i / 3][i % 3]) < 1e-12);
    assert_true(read.poses.camera.fy == camera.fy && read.poses.camera.k2 == camera.k2);
    assert_true(fabs(read.error[WEFT_CAMERA_PHI].wobble_rad / 3e-4 - 1) < 1e-9);
    assert_true(fabs(read.scatter_rad / wrote.scatter_rad - 1) < 1e-9);
    assert_true(read.held_out_rms_px == wrote.held_out_rms_px && read.point_px == wrote.point_px);
}

static void assert_refused(const char *from, const char *to, const char *said)
{
    weft_poses_file file = example();
    weft_error error = {0};
    size_t size;
    store(&file);
    char *stored = (char *)scratch_load("rig.poses.json", &size), text[8192], changed[8192];
    snprintf(text, sizeof text, "%.*s", (int)size, stored);
    free(stored);
    const char *at = strstr(text, from);
    assert_non_null(at);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    scratch_store("bad.poses.json", changed, strlen(changed));
    assert_int_equal(weft_class_of(weft_poses_read("bad.poses.json", &file, &error)), WEFT_BAD_INPUT);
    if (!strstr(error.message, said) || !strstr(error.message, "bad.poses.json"))
        fail_msg("'%s' does not say '%s'", error.message, said);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    assert_refused("\"weft_poses\": 1", "\"weft_lens\": 1", "holds no poses of a rig");
    assert_refused("\"weft_poses\": 1", "\"weft_poses\": 2", "poses of version 2");
    assert_refused("\"fx\": 1920.0", "\"fx\": -1920.0", "'camera' does not describe a lens");
    assert_refused("\"home\"", "\"house\"", "'home' is no pose");
    assert_refused("\"joints\"", "\"axes\"", "is no list of 3 joints");
    assert_refused("\"camera phi\"", "\"camera theta\"", "the joint 'camera phi'");
    assert_refused("\"scale\": 0.002", "\"scale\": 1e9", "the joint 'camera phi'");
    assert_refused("\"rms_px\": 0.5", "\"rms_px\": \"small\"", "wrong type");
}

static void assert_not_written(const weft_poses_file *file, const char *said)
{
    weft_error error = {0};
    assert_int_equal(weft_poses_write("none.poses.json", file, NULL, 0, NULL, 0, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, said) || !strstr(error.message, "none.poses.json"))
        fail_msg("'%s' does not say '%s'", error.message, said);
}

static void what_is_no_number_is_named(void **state)
{
    (void)state;
    weft_poses_file file = example();
    file.held_out_rms_px = INFINITY;
    assert_not_written(&file, "'held_out_rms_px' is not a finite number");
    file = example();
    file.error[2].wobble_rad = NAN;
    assert_not_written(&file, "'joints' is not a finite");
    file = example();
    file.poses.home.translation.y = NAN;
    assert_not_written(&file, "'home' is not a finite");
    file = example();
    file.poses.camera.cy = NAN;
    assert_not_written(&file, "'camera' is not a finite");
}

/* A motion is its pose, whichever part of the quaternion is the largest. */
static void motions_come_back(void **state)
{
    (void)state;
    for (int i = 0; i < 64; i++) {
        double angle = i * WEFT_PI / 64 + 0.001;
        weft_vec3 axis = weft_unit(weft_vec3_of(cos(i * 2.1), sin(i * 3.3), cos(i * 0.7)));
        const weft_motion motion = {{axis.x * angle, axis.y * angle, axis.z * angle}, {1, -2, 3}};
        weft_pose pose = weft_pose_of_motion(&motion);
        weft_motion back = weft_motion_of_pose(&pose);
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(back.rotation[k] - motion.rotation[k]) < 1e-9);
            assert_true(back.translation[k] == motion.translation[k]);
        }
    }
    weft_motion none = {{0, 0, 0}, {0, 0, 0}};
    weft_pose pose = weft_pose_of_motion(&none);
    none = weft_motion_of_pose(&pose);
    assert_true(none.rotation[0] == 0 && pose.rotation[0][0] == 1);
}

int test_poses(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_are_read_as_they_were_written),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(what_is_no_number_is_named),
        cmocka_unit_test(motions_come_back),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
