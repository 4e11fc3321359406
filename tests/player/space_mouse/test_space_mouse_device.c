/* A SpaceMouse through the real libhidapi: reports, a pulled cable, a forbidden node. Runs under umockdev-wrapper. */
#include "player/window/space_mouse.h"
#include "tests/support/fake_hid.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* Multi-axis controller: reports 1 and 2 of three 16-bit axes each, report 3 of two buttons. */
static const unsigned char descriptor[] = {
    0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0xa1, 0x00, 0x85, 0x01, 0x16, 0xa2, 0xfe, 0x26, 0x5e, 0x01, 0x09, 0x30, 0x09,
    0x31, 0x09, 0x32, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xc0, 0xa1, 0x00, 0x85, 0x02, 0x09, 0x33, 0x09, 0x34, 0x09,
    0x35, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xc0, 0xa1, 0x02, 0x85, 0x03, 0x05, 0x09, 0x19, 0x01, 0x29, 0x02, 0x75,
    0x01, 0x95, 0x02, 0x15, 0x00, 0x25, 0x01, 0x81, 0x02, 0x75, 0x0e, 0x95, 0x01, 0x81, 0x03, 0xc0, 0xc0};

static const fake_hid_kind space_mouse = {.vendor = 0x256f,
                                          .product = 0xc635,
                                          .maker = "3Dconnexion",
                                          .name = "SpaceMouse Compact",
                                          .serial = "",
                                          .descriptor = descriptor,
                                          .descriptor_size = sizeof descriptor};

static const unsigned char push_right[] = {1, 0x5e, 0x01, 0, 0, 0, 0}, push_both_buttons[] = {3, 3, 0};

static weft_space_mouse *new_mouse(void)
{
    weft_space_mouse *mouse = NULL;
    weft_error error;
    assert_int_equal(weft_space_mouse_create(&mouse, &error), WEFT_OK);
    return mouse;
}

static void reports_arrive_in_order(void **state)
{
    fake_hid *hid = fake_hid_plug(*state, 1, &space_mouse);
    weft_space_mouse *mouse = new_mouse();
    weft_space_motion motion;
    assert_int_equal(weft_space_mouse_poll(mouse, 0, &motion), WEFT_SPACE_MOUSE_DEVICE);
    assert_string_equal(weft_space_mouse_message(mouse), "SpaceMouse Compact");
    assert_float_equal(motion.translation[0], 0, 0);
    fake_hid_push(hid, push_right, sizeof push_right);
    fake_hid_push(hid, push_both_buttons, sizeof push_both_buttons);
    assert_int_equal(weft_space_mouse_poll(mouse, 0.1, &motion), WEFT_SPACE_MOUSE_DEVICE);
    assert_float_equal(motion.translation[0], 1, 0);
    assert_int_equal(motion.buttons, 3);
    fake_hid_push(hid, (const unsigned char[7]){1}, 7);
    weft_space_mouse_poll(mouse, 0.2, &motion);
    assert_float_equal(motion.translation[0], 0, 0);
    weft_space_mouse_free(mouse);
    fake_hid_unplug(hid);
    fake_hid_free(hid);
}

static void a_pulled_cable_leaves_the_cap_at_rest_and_another_is_found(void **state)
{
    fake_hid *hid = fake_hid_plug(*state, 2, &space_mouse);
    weft_space_mouse *mouse = new_mouse();
    weft_space_motion motion;
    assert_int_equal(weft_space_mouse_poll(mouse, 0, &motion), WEFT_SPACE_MOUSE_DEVICE);
    fake_hid_push(hid, push_right, sizeof push_right);
    weft_space_mouse_poll(mouse, 0.1, &motion);
    assert_float_equal(motion.translation[0], 1, 0);
    fake_hid_unplug(hid);
    assert_int_equal(weft_space_mouse_poll(mouse, 0.2, &motion), WEFT_SPACE_MOUSE_ABSENT);
    assert_float_equal(motion.translation[0], 0, 0);
    assert_int_equal(weft_space_mouse_poll(mouse, 2.5, &motion), WEFT_SPACE_MOUSE_ABSENT);
    fake_hid *again = fake_hid_plug(*state, 3, &space_mouse);
    assert_int_equal(weft_space_mouse_poll(mouse, 5, &motion), WEFT_SPACE_MOUSE_DEVICE);
    fake_hid_push(again, push_right, sizeof push_right);
    weft_space_mouse_poll(mouse, 5.1, &motion);
    assert_float_equal(motion.translation[0], 1, 0);
    weft_space_mouse_free(mouse);
    fake_hid_unplug(again);
    fake_hid_free(again);
    fake_hid_free(hid);
}

/* For every user of the machine: its folders, and the sockets through which it serves. */
static void open_testbed(UMockdevTestbed *testbed)
{
    gchar *root = umockdev_testbed_get_root_dir(testbed);
    gchar *command = g_strdup_printf("chmod -R a+rwX '%s/ioctl' && chmod a+rx '%s'", root, root);
    assert_int_equal(system(command), 0);
    g_free(command);
    g_free(root);
}

/* An ordinary user, without the rule. */
static void a_forbidden_device_is_named_with_the_rule_that_mends_it(void **state)
{
    if (geteuid() != 0)
        skip();
    fake_hid *hid = fake_hid_plug_forbidden(*state, 4, &space_mouse);
    weft_space_mouse *mouse = new_mouse();
    weft_space_motion motion;
    open_testbed(*state);
    assert_int_equal(seteuid(65534), 0);
    weft_space_mouse_state found = weft_space_mouse_poll(mouse, 0, &motion);
    assert_int_equal(seteuid(0), 0);
    assert_int_equal(found, WEFT_SPACE_MOUSE_FORBIDDEN);
    const char *message = weft_space_mouse_message(mouse);
    assert_non_null(strstr(message, "/dev/hidraw4"));
    /* The file that is to be copied is there. */
    char rule[512];
    assert_int_equal(sscanf(message, "%*[^:]: sudo cp %511s /etc/udev/rules.d/", rule), 1);
    assert_int_equal(access(rule, R_OK), 0);
    weft_space_mouse_free(mouse);
    fake_hid_unplug(hid);
    fake_hid_free(hid);
}

int test_space_mouse_device(void)
{
    const char *preloaded = getenv("LD_PRELOAD");
    if (!preloaded || !strstr(preloaded, "umockdev")) {
        puts("runs under umockdev-wrapper only");
        return 77;
    }
    UMockdevTestbed *testbed = umockdev_testbed_new();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(reports_arrive_in_order, testbed),
        cmocka_unit_test_prestate(a_pulled_cable_leaves_the_cap_at_rest_and_another_is_found, testbed),
        cmocka_unit_test_prestate(a_forbidden_device_is_named_with_the_rule_that_mends_it, testbed),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    g_object_unref(testbed);
    return failed;
}
