#include "capture/laboratory/rig_file.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Line 1 is the name, line 3 begins the stage, line 6 the axis. */
static const char sound[] = "name = \"bench\"\n"
                            "opening_mm = 30\n"
                            "stage {\n"
                            "  backend = usb\n"
                            "}\n"
                            "axis \"arm\" {\n"
                            "  moves = camera\n"
                            "  angle = theta\n"
                            "  channel = 2\n"
                            "  low_deg = -5\n"
                            "  high_deg = 80\n"
                            "  backlash_deg = 0.25\n"
                            "}\n"
                            "light {\n"
                            "  backend = stage\n"
                            "  phi_deg = 90\n"
                            "  distance_mm = 600\n"
                            "}\n"
                            "camera {\n"
                            "  backend = folder\n"
                            "  lens = \"lens.json\"\n"
                            "  distance_mm = 500\n"
                            "}\n";

/* The sound file with one piece of it replaced. */
static weft_code read_changed(const char *from, const char *to, weft_rig_file *rig, weft_error *error)
{
    char text[2048];
    const char *at = strstr(sound, from);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - sound), sound, to, at + strlen(from));
    scratch_store("rig.conf", text, strlen(text));
    return weft_rig_file_read("rig.conf", rig, error);
}

static void assert_refused(const char *from, const char *to, const char *message)
{
    weft_rig_file rig;
    weft_error error = {0};
    assert_int_equal(read_changed(from, to, &rig, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, message))
        fail_msg("'%s' is not in '%s'", message, error.message);
}

static void what_is_written_is_what_is_read(void **state)
{
    (void)state;
    weft_rig_file rig;
    weft_error error = {0};
    assert_int_equal(read_changed("bench", "bench", &rig, &error), WEFT_OK);
    assert_string_equal(rig.name, "bench");
    assert_float_equal(rig.opening_mm, 30, 0);
    assert_int_equal(rig.stage.backend, WEFT_STAGE_USB);
    assert_float_equal(rig.stage.usb_vendor, 0x1209, 0);
    assert_int_equal(rig.axes.count, 1);
    const weft_axis *arm = &rig.axes.axis[0];
    assert_string_equal(arm->name, "arm");
    assert_int_equal(arm->moves, WEFT_BODY_CAMERA);
    assert_int_equal(arm->angle, WEFT_TURN_THETA);
    assert_int_equal(arm->channel, 2);
    assert_float_equal(arm->low_deg, -5, 0);
    assert_float_equal(arm->high_deg, 80, 0);
    assert_float_equal(arm->backlash_deg, 0.25, 0);
    assert_true(rig.axes.together);
    assert_float_equal(rig.axes.fixed_deg[WEFT_BODY_LIGHT][WEFT_TURN_PHI], 90, 0);
    assert_string_equal(rig.camera[0].lens, "lens.json");
    assert_int_equal(rig.camera[0].values, WEFT_VALUES_LINEAR);
}

static void mistakes_are_named_with_file_and_line(void **state)
{
    (void)state;
    assert_refused("opening_mm = 30", "opening_mm = 0", "rig.conf:2: 'opening_mm' must be a number from 1 to 1000");
    assert_refused("opening_mm = 30", "opening_mm = nan", "rig.conf:2:");
    assert_refused("opening_mm = 30", "opening_mn = 30", "rig.conf:2:");
    assert_refused("  backend = usb", "  backend = serial", "rig.conf:4: 'backend' must be one of: usb, none");
    assert_refused("  moves = camera", "  moves = lamp", "rig.conf:7: 'moves' must be one of: camera, light, sample");
    assert_refused("  channel = 2", "  channel = 1.5", "rig.conf:9: 'channel' must be a whole number from 0 to 7");
    assert_refused("  channel = 2", "  channel = two", "rig.conf:9:");
    assert_refused("  low_deg = -5\n", "", "rig.conf:12: section axis lacks 'low_deg'");
    assert_refused("  low_deg = -5", "  low_deg = 80", "rig.conf:13: axis 'arm': 'low_deg' must be below 'high_deg'");
    assert_refused("  lens = \"lens.json\"\n", "", "section camera lacks 'lens'");
    assert_refused("name = \"bench\"\n", "", "lacks 'name'");
    assert_refused("}\nlight {", "light {", "rig.conf:13:");
    assert_refused("camera {", "kamera {", "rig.conf:19:");
    assert_refused("\"arm\"", "\"an axis whose name is longer than there is room\"",
                   "rig.conf:13: the name of an axis");
}

static void parts_that_do_not_go_together_are_refused(void **state)
{
    (void)state;
    assert_refused("  backend = usb", "  backend = none", "nobody drives axis 'arm'");
    assert_refused("  lens = ", "  longest_exposure_s = 1e-5\n  lens = ", "the longest exposure");
    assert_refused("  backend = stage\n", "  backend = none\n  lamps = \"l.csv\"\n", "lamps that nobody switches");
}

static void a_rig_that_is_missing_or_no_text_is_refused(void **state)
{
    (void)state;
    weft_rig_file rig;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_rig_file_read("no-rig.conf", &rig, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "no-rig.conf"));
    scratch_store("rig.conf", "\0\1\2", 3);
    assert_int_equal(weft_rig_file_read("rig.conf", &rig, &error), WEFT_BAD_INPUT);
    scratch_store("rig.conf", "", 0);
    assert_int_equal(weft_rig_file_read("rig.conf", &rig, &error), WEFT_BAD_INPUT);
}

static void two_axes_of_one_angle_or_channel_are_refused(void **state)
{
    (void)state;
    const char *second = "}\naxis \"other\" {\n moves = light\n angle = theta\n channel = %d\n low_deg = 0\n"
                         " high_deg = 9\n}\nlight {";
    char text[512];
    snprintf(text, sizeof text, second, 2);
    assert_refused("}\nlight {", text, "both channel 2");
    snprintf(text, sizeof text, second, 3);
    char *light = strstr(text, "light");
    memcpy(light, "camera", 5);
    weft_rig_file rig;
    assert_int_equal(read_changed("}\nlight {", text, &rig, NULL), WEFT_BAD_INPUT);
    snprintf(text, sizeof text, second, 3);
    assert_int_equal(read_changed("}\nlight {", text, &rig, NULL), WEFT_OK);
    assert_int_equal(rig.axes.count, 2);
    assert_refused("}\nlight {", "}\naxis \"arm\" {\n moves = light\n}\nlight {", "rig.conf:14:");
    assert_refused("}\nlight {", "}\nstage {\n backend = usb\n}\nlight {", "a rig has 1 section 'stage'");
}

static void several_cameras_are_told_apart(void **state)
{
    (void)state;
    const char *first = "camera {\n", *second = "camera {\n  name = \"%s\"\n  backend = folder\n  device = \"%s\"\n"
                                                "  lens = \"other.json\"\n  theta_deg = 60\n  distance_mm = 400\n"
                                                "  trigger = %s\n}\ncamera {\n  name = \"left\"\n  trigger = stage\n";
    char text[512];
    weft_rig_file rig;
    snprintf(text, sizeof text, second, "right", "there", "hand");
    assert_int_equal(read_changed(first, text, &rig, NULL), WEFT_OK);
    assert_int_equal(rig.camera_count, 2);
    assert_string_equal(rig.camera[0].name, "right");
    assert_true(rig.camera[0].theta_deg == 60 && rig.camera[0].distance_mm == 400);
    assert_string_equal(rig.camera[1].name, "left");
    assert_true(rig.camera[1].theta_deg == 0 && rig.camera[1].distance_mm == 500);
    snprintf(text, sizeof text, second, "left", "there", "hand");
    assert_refused(first, text, "two cameras are called 'left'");
    snprintf(text, sizeof text, second, "../up", "there", "hand");
    assert_refused(first, text, "needs a name");
    snprintf(text, sizeof text, second, "", "there", "hand");
    assert_refused(first, text, "needs a name");
    snprintf(text, sizeof text, second, "right", "", "hand");
    assert_refused(first, text, "are the same device");
    snprintf(text, sizeof text, second, "right", "there", "stage");
    assert_refused(first, text, "hang on one shutter contact");
}

/* One camera may name its poses beside its section; of several each names its own in it. */
static void poses_are_of_a_camera(void **state)
{
    (void)state;
    const char *top = "poses = \"top.json\"\ncamera {\n", *own = "camera {\n  poses = \"own.json\"\n";
    char text[512];
    weft_rig_file rig;
    assert_int_equal(read_changed("camera {\n", top, &rig, NULL), WEFT_OK);
    assert_string_equal(rig.camera[0].poses, "top.json");
    assert_int_equal(read_changed("camera {\n", own, &rig, NULL), WEFT_OK);
    assert_string_equal(rig.camera[0].poses, "own.json");
    snprintf(text, sizeof text, "poses = \"top.json\"\n%s", own);
    assert_refused("camera {\n", text, "'poses' are named twice");
    static const char right[] = "camera {\n  name = \"right\"\n  backend = folder\n  device = \"there\"\n"
                                "  lens = \"other.json\"\n  distance_mm = 400\n  poses = \"right.json\"\n}\n"
                                "camera {\n  name = \"left\"\n";
    snprintf(text, sizeof text, "%s  poses = \"left.json\"\n", right);
    assert_int_equal(read_changed("camera {\n", text, &rig, NULL), WEFT_OK);
    assert_string_equal(rig.camera[0].poses, "right.json");
    assert_string_equal(rig.camera[1].poses, "left.json");
    snprintf(text, sizeof text, "poses = \"top.json\"\n%s", right);
    assert_refused("camera {\n", text, "'poses' are of one camera, the rig has 2");
}

static void every_shipped_rig_is_sound(void **state)
{
    (void)state;
    static const char *const shipped[] = {"goniometer", "arc", "dome", "cameras", "turntable", "photographs"};
    for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
        char path[512];
        weft_rig_file rig;
        weft_error error = {0};
        snprintf(path, sizeof path, WEFT_ASSETS "/rigs/%s.conf", shipped[i]);
        /* The path of this machine may be longer than rigs have room for. */
        assert_int_equal(symlink(path, "shipped.conf"), 0);
        if (weft_rig_file_read("shipped.conf", &rig, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_int_equal(unlink("shipped.conf"), 0);
    }
}

int test_rig_file(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_what_is_read),
        cmocka_unit_test(mistakes_are_named_with_file_and_line),
        cmocka_unit_test(parts_that_do_not_go_together_are_refused),
        cmocka_unit_test(a_rig_that_is_missing_or_no_text_is_refused),
        cmocka_unit_test(two_axes_of_one_angle_or_channel_are_refused),
        cmocka_unit_test(several_cameras_are_told_apart),
        cmocka_unit_test(poses_are_of_a_camera),
        cmocka_unit_test(every_shipped_rig_is_sound),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
