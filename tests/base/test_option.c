/* Options read from text: each kind, and what it refuses. */
#include "base/text/option.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct values {
    bool flag, on;
    int whole, noise, size[2], choice;
    uint64_t seed;
    double number, angle, pair[2];
    const char *text;
    char *name;
} values;

static const char *const words[] = {"one", "two", "three", NULL};

enum { FLAG, ON, WHOLE, NOISE, SIZE, CHOICE, SEED, NUMBER, ANGLE, PAIR, TEXT, NAME };

static const weft_option options[] = {
    [FLAG] = {.name = "flag", .kind = WEFT_OPTION_FLAG, .offset = offsetof(values, flag)},
    [ON] = {.name = "on", .kind = WEFT_OPTION_SWITCH, .offset = offsetof(values, on)},
    [WHOLE] = {.name = "whole", .kind = WEFT_OPTION_WHOLE, .offset = offsetof(values, whole), .low = 2, .high = 9},
    [NOISE] = {.name = "noise", .kind = WEFT_OPTION_NOISE, .offset = offsetof(values, noise)},
    [SIZE] = {.name = "size", .kind = WEFT_OPTION_SIZE, .offset = offsetof(values, size), .high = 64},
    [CHOICE] = {.name = "choice", .kind = WEFT_OPTION_CHOICE, .offset = offsetof(values, choice), .words = words},
    [SEED] = {.name = "seed", .kind = WEFT_OPTION_SEED, .offset = offsetof(values, seed)},
    [NUMBER] = {.name = "number",
                .kind = WEFT_OPTION_NUMBER,
                .offset = offsetof(values, number),
                .low = -1,
                .high = 50,
                .divisor = 100},
    [ANGLE] = {.name = "angle", .kind = WEFT_OPTION_ANGLE, .offset = offsetof(values, angle), .low = -90, .high = 90},
    [PAIR] = {.name = "pair", .kind = WEFT_OPTION_PAIR, .offset = offsetof(values, pair), .high = 10},
    [TEXT] = {.name = "text", .kind = WEFT_OPTION_TEXT, .offset = offsetof(values, text)},
    [NAME] = {.name = "name", .kind = WEFT_OPTION_NAME, .offset = offsetof(values, name)},
};

static void set(values *v, int option, const char *text)
{
    weft_error error = {0};
    if (weft_option_set(&options[option], text, v, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}

static void every_kind_is_read(void **state)
{
    (void)state;
    static const char text[] = "text";
    values v = {0};
    set(&v, FLAG, NULL);
    set(&v, ON, NULL);
    assert_true(v.flag && v.on);
    set(&v, ON, "off");
    assert_false(v.on);
    set(&v, WHOLE, "9");
    set(&v, NOISE, "2147483647");
    assert_true(v.whole == 9 && v.noise == INT32_MAX);
    set(&v, NOISE, "off");
    set(&v, SIZE, "64x1");
    set(&v, CHOICE, "three");
    assert_true(v.noise == 0 && v.size[0] == 64 && v.size[1] == 1 && v.choice == 2);
    set(&v, SEED, "9223372036854775807");
    set(&v, NUMBER, "12.5");
    set(&v, ANGLE, "-90");
    assert_true(v.seed == INT64_MAX && v.number == 0.125 && v.angle == -M_PI / 2);
    set(&v, PAIR, "0.5,10");
    set(&v, TEXT, text);
    set(&v, NAME, text);
    set(&v, NAME, text); /* frees the copy before it */
    assert_true(v.pair[0] == 0.5 && v.pair[1] == 10 && v.text == text && v.name != text);
    assert_string_equal(v.name, text);
    free(v.name);
}

static void refuse(int option, const char *text, const char *message)
{
    values v = {0}, before = {0};
    weft_error error = {0};
    assert_int_equal(weft_option_set(&options[option], text, &v, &error), WEFT_BAD_USAGE);
    assert_string_equal(error.message, message);
    assert_memory_equal(&v, &before, sizeof v);
}

static void faults_are_named(void **state)
{
    (void)state;
    refuse(ON, "yes", "--on is on or off, not 'yes'");
    refuse(WHOLE, "1", "--whole needs a whole number from 2 to 9, not '1'");
    refuse(WHOLE, " 3", "--whole needs a whole number from 2 to 9, not ' 3'");
    refuse(WHOLE, "3.5", "--whole needs a whole number from 2 to 9, not '3.5'");
    refuse(NOISE, "0", "--noise needs a whole number from 1 to 2147483647, not '0'");
    refuse(SIZE, "64", "--size needs WxH up to 64x64, not '64'");
    refuse(SIZE, "1x65", "--size needs WxH up to 64x64, not '1x65'");
    refuse(SIZE, "0x4", "--size needs WxH up to 64x64, not '0x4'");
    refuse(CHOICE, "four", "--choice is one of one, two, three, not 'four'");
    refuse(SEED, "9223372036854775808",
           "--seed needs a whole number from 0 to 9223372036854775807, not '9223372036854775808'");
    refuse(NUMBER, "nan", "--number needs a number from -1 to 50, not 'nan'");
    refuse(NUMBER, "50.1", "--number needs a number from -1 to 50, not '50.1'");
    refuse(NUMBER, "5%", "--number needs a number from -1 to 50, not '5%'");
    refuse(ANGLE, "91", "--angle needs a number from -90 to 90, not '91'");
    refuse(PAIR, "1", "--pair needs 2 numbers with commas, not '1'");
    refuse(PAIR, "1,0", "--pair needs two numbers above 0, up to 10, not '1,0'");
    refuse(PAIR, "11,1", "--pair needs two numbers above 0, up to 10, not '11,1'");
}

int test_option(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_is_read),
        cmocka_unit_test(faults_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
