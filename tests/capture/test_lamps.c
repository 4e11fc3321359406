/* Lamps on USB through the real libhidapi: relay boards, and who switches a lamp off when the program is gone. Runs
 * under umockdev-wrapper. */
#include "capture/motion/controller.h"
#include "capture/motion/lamps.h"
#include "tests/capture/fake_controller.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- Relay boards ---- */

typedef struct fake_relay {
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    unsigned closed;
    int switched_on;
    int ignores; /* changes that it will not carry out */
} fake_relay;

static void set_relays(fake_relay *relay, const unsigned char *bytes)
{
    unsigned bit = bytes[2] >= 1 && bytes[2] <= 8 ? 1u << (bytes[2] - 1) : 0;
    relay->switched_on += bytes[1] == 0xff;
    relay->closed = bytes[1] == 0xff   ? relay->closed | bit
                    : bytes[1] == 0xfd ? relay->closed & ~bit
                    : bytes[1] == 0xfc ? 0
                                       : relay->closed;
}

static void set_feature(void *context, const unsigned char *bytes, size_t size)
{
    fake_relay *relay = context;
    if (size < 3 || relay->ignores-- > 0)
        return;
    pthread_mutex_lock(&relay->mutex);
    set_relays(relay, bytes);
    pthread_cond_broadcast(&relay->changed);
    pthread_mutex_unlock(&relay->mutex);
}

static void wait_until_open(fake_relay *relay)
{
    pthread_mutex_lock(&relay->mutex);
    while (relay->closed != 0)
        pthread_cond_wait(&relay->changed, &relay->mutex);
    pthread_mutex_unlock(&relay->mutex);
}

static void get_feature(void *context, unsigned char *bytes, size_t size)
{
    const unsigned char state[9] = {0, 'A', 'B', 'C', 'D', 'E', 0, 0, (unsigned char)((fake_relay *)context)->closed};
    memcpy(bytes, state, size < sizeof state ? size : sizeof state);
}

static fake_hid_kind kind_of_relay(fake_relay *fake)
{
    static const unsigned char descriptor[] = {0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                                               0x00, 0x75, 0x08, 0x95, 0x08, 0x09, 0x00, 0xb2, 0x02, 0x01, 0xc0};
    return (fake_hid_kind){.vendor = 0x16c0,
                           .product = 0x05df,
                           .maker = "www.dcttech.com",
                           .name = "USBRelay8",
                           .serial = "",
                           .descriptor = descriptor,
                           .descriptor_size = sizeof descriptor,
                           .context = fake,
                           .set_feature = set_feature,
                           .get_feature = get_feature};
}

static const weft_relay_settings relay_settings = {.address = {0x16c0, 0x05df, ""}, .replug_s = 5, .retries = 2};

static void a_relay_board_switches_one_lamp_at_a_time_and_is_found_again(void **state)
{
    fake_relay fake = {.mutex = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};
    const fake_hid_kind kind = kind_of_relay(&fake);
    fake_hid *hid = fake_hid_plug(*state, 3, &kind);
    weft_relay *relay;
    weft_error error = {0};
    assert_int_equal(weft_relay_create(&relay_settings, &relay, NULL), WEFT_OK);
    weft_lamp_switch lamps = weft_relay_lamps(relay);
    assert_int_equal(lamps.set(lamps.device, 2, 1, NULL), WEFT_OK);
    assert_int_equal(fake.closed, 4);
    assert_int_equal(lamps.set(lamps.device, 7, 0.1, NULL), WEFT_OK);
    assert_int_equal(fake.closed, 128);
    fake.ignores = 2; /* read back, found wanting, sent again */
    assert_int_equal(lamps.set(lamps.device, 0, 1, NULL), WEFT_OK);
    assert_int_equal(fake.closed, 1);
    assert_int_equal(lamps.set(lamps.device, 8, 1, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "no relay 9"));
    fake_hid_unplug(hid);
    fake_hid_free(hid);
    hid = fake_hid_plug(*state, 4, &kind);
    assert_int_equal(lamps.set(lamps.device, -1, 0, NULL), WEFT_OK);
    assert_int_equal(fake.closed, 0);
    fake.ignores = 100;
    assert_int_equal(lamps.set(lamps.device, 1, 1, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "relay 2 does not switch on"));
    fake.ignores = 0;
    assert_int_equal(lamps.set(lamps.device, 1, 1, NULL), WEFT_OK);
    weft_relay_free(relay);
    assert_int_equal(fake.closed, 0);
    fake_hid_unplug(hid);
    fake_hid_free(hid);
}

/* ---- Programs that are killed ---- */

/* Lights lamp 1 in a process that then gets `killer`, as its whole group does when somebody types Ctrl-C twice; 0: it
 * ends as it should. Returns whether it ended so. */
static bool light_and_die(weft_lamp_switch lamps, int killer)
{
    pid_t child = fork();
    if (child == 0) {
        weft_lamp_guard *guard;
        setpgid(0, 0);
        lamps.abandon(lamps.device);
        if (weft_lamp_guard_create(lamps, &guard, NULL) != WEFT_OK)
            _exit(1);
        lamps = weft_lamp_guard_lamps(guard);
        if (lamps.set(lamps.device, -1, 0, NULL) != WEFT_OK || lamps.set(lamps.device, 1, 1, NULL) != WEFT_OK)
            _exit(1);
        if (killer)
            kill(0, killer);
        weft_lamp_guard_free(guard);
        _exit(waitpid(-1, NULL, WNOHANG) == -1 ? 0 : 2); /* nobody is left behind */
    }
    int status;
    assert_true(child > 0 && waitpid(child, &status, 0) == child);
    return killer ? WIFSIGNALED(status) && WTERMSIG(status) == killer : WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static const int killers[] = {SIGINT, SIGTERM, SIGHUP, SIGKILL};
enum { KILLERS = sizeof killers / sizeof *killers };

static void a_relay_that_nobody_holds_opens(void **state)
{
    fake_relay fake = {.mutex = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};
    const fake_hid_kind kind = kind_of_relay(&fake);
    fake_hid *hid = fake_hid_plug(*state, 3, &kind);
    weft_relay *relay;
    assert_int_equal(weft_relay_create(&relay_settings, &relay, NULL), WEFT_OK);
    assert_true(light_and_die(weft_relay_lamps(relay), 0));
    assert_int_equal(fake.closed, 2); /* a guard that is sent away switches nothing */
    for (int i = 0; i < KILLERS; i++) {
        fake.closed = 0;
        fake.switched_on = 0;
        assert_true(light_and_die(weft_relay_lamps(relay), killers[i]));
        assert_int_equal(fake.switched_on, 1);
        wait_until_open(&fake);
    }
    weft_relay_free(relay);
    fake_hid_unplug(hid);
    fake_hid_free(hid);
}

static void a_lamp_of_the_stage_that_nobody_holds_goes_off(void **state)
{
    fake_controller fake;
    const weft_axes axes = {.count = 0};
    const weft_controller_settings settings = {
        .address = {0x1209, 0xb7f1, "ST-0001"}, .timeout_s = 0.06, .retries = 100};
    weft_controller *controller;
    fake_controller_start(&fake, *state);
    assert_int_equal(weft_controller_create(&settings, &axes, &controller, NULL), WEFT_OK);
    assert_true(light_and_die(weft_controller_lamps(controller), 0));
    assert_int_not_equal(fake.stage.level, 0);
    for (int i = 0; i < KILLERS; i++) {
        assert_true(light_and_die(weft_controller_lamps(controller), killers[i]));
        fake_stage_wait_until_dark(&fake.stage);
    }
    weft_controller_free(controller);
    fake_controller_end(&fake);
}

/* A testbed for each test. */
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

int test_lamps(void)
{
    const char *preloaded = getenv("LD_PRELOAD");
    if (!preloaded || !strstr(preloaded, "umockdev")) {
        puts("runs under umockdev-wrapper only");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_relay_board_switches_one_lamp_at_a_time_and_is_found_again, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(a_relay_that_nobody_holds_opens, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_lamp_of_the_stage_that_nobody_holds_goes_off, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
