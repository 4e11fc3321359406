/* Exposure times as cameras name them; against what eight real cameras offer. */
#include "capture/camera/camera.h"
#include "tests/support/cmocka_all.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void words_of_cameras_are_seconds(void **state)
{
    (void)state;
    static const struct {
        const char *choice;
        double seconds;
    } known[] = {{"1/60", 1 / 60.0},
                 {"1/8000", 1 / 8000.0},
                 {"0.5", 0.5},
                 {"1.3", 1.3},
                 {"30", 30},
                 {"0,0400s", 0.04},
                 {"2.5000s", 2.5},
                 {"2\"", 2},
                 {"10/25", 0.4},
                 {"bulb", 0},
                 {"Bulb", 0},
                 {"Auto", 0},
                 {"", 0},
                 {"1/0", 0},
                 {"1/", 0},
                 {"x 200", 0},
                 {"1/60 flash", 0},
                 {"-5", 0},
                 {"Unknown value 00f8", 0}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_float_equal(weft_shutter_seconds(known[i].choice), known[i].seconds, 1e-12);
}

/* All choices that begin with a digit are times, and a camera offers them in order. */
static int check_camera(const char *path)
{
    FILE *file = fopen(path, "r");
    char line[512];
    int count = 0, rises = 0, falls = 0;
    double before = 0;
    bool inside = false;
    if (!file)
        return 0;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\r\n")] = 0;
        if (line[0] == '/') {
            inside = strstr(line, "/shutterspeed") && !strstr(line, "flash");
            before = 0;
        }
        char choice[256];
        if (!inside || sscanf(line, "Choice: %*d %255[^\n]", choice) != 1)
            continue;
        double seconds = weft_shutter_seconds(choice);
        bool minutes = strchr(choice, 'm') != NULL; /* of bulb exposures */
        if (isdigit((unsigned char)choice[0]) && !minutes && !(seconds > 0))
            fail_msg("%s: '%s' is no time", path, choice);
        if (!isdigit((unsigned char)choice[0]))
            assert_float_equal(seconds, 0, 0);
        if (seconds > 0 && before > 0) {
            rises += seconds > before;
            falls += seconds < before;
        }
        before = seconds;
        count += seconds > 0;
    }
    fclose(file);
    assert_true(rises == 0 || falls == 0 || fmin(rises, falls) <= 2);
    return count;
}

static void choices_of_real_cameras_are_times(void **state)
{
    (void)state;
    static const char *const cameras[] = {"canon-eos-r", "canon-eos5dmark3",    "canon-powershot-sx70hs",
                                          "fuji-xt4",    "nikon-d7000",         "nikon-d750",
                                          "nikon-z6",    "olympus-e-m1-mark-ii"};
    int count = 0;
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        char path[512];
        snprintf(path, sizeof path, WEFT_SHARED "/real/camera-usb/libgphoto2-cameras/%s.txt", cameras[i]);
        count += check_camera(path);
    }
    if (count == 0) {
        print_message("no " WEFT_SHARED "/real/camera-usb: skipped\n");
        skip();
    }
    print_message("%d times\n", count);
    assert_true(count > 300);
}

int test_shutter_choice(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_of_cameras_are_seconds),
        cmocka_unit_test(choices_of_real_cameras_are_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
