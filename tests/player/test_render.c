/* `weft render` from end to end, as a user runs it. With --make FOLDER: writes the files it works on and leaves. */
#include "stage.h"

#include "base/atomic_file.h"
#include "base/picture/colour.h"
#include "tests/support/suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void make_files(const char *folder)
{
    char path[512];
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_make_folder(folder, &error), &error);
    stage_material(24, 24, 2, 81, 0, &material);
    snprintf(path, sizeof path, "%s/cloth.weft", folder);
    expect_ok(weft_material_write(path, &material, &error), &error);
    weft_material_free(&material);
    snprintf(path, sizeof path, "%s/cloth.btf.h5", folder);
    stage_dataset(path, 12, 19, 19, WEFT_REFLECTANCE_COSINE, true);
}

static int enter_folder(void **state)
{
    (void)state;
    make_files("render");
    return chdir("render");
}

/* Exit code of a shell command; $WEFT is the program. Its stderr goes to the file "said". */
static int run(const char *command)
{
    char line[2048];
    snprintf(line, sizeof line, "%s 2>said", command);
    setenv("WEFT", WEFT_PROGRAM, 1);
    setenv("WEAVES", WEFT_ASSETS "/weaves", 1);
    int status = system(line);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void expect_said(const char *part)
{
    char *text;
    size_t size;
    weft_error error = {0};
    expect_ok(weft_read_file("said", 1 << 20, &text, &size, &error), &error);
    if (!strstr(text, part))
        fail_msg("expected '%s' in: %s", part, text);
    free(text);
}

static weft_image read_picture(const char *path, int width, int height)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_image_read(path, &image, NULL, &error), &error);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    return image;
}

/* Variance of the luminance in the middle of a picture: a drawn cloth has some, a background has none. */
static double contrast(const weft_image *image, int left, int right)
{
    double sum = 0, squares = 0;
    long count = 0;
    for (int y = image->height / 3; y < image->height * 2 / 3; y++) {
        for (int x = left; x < right; x++) {
            double value = (double)image->pixels[3 * (y * image->width + x) + 1];
            sum += value;
            squares += value * value;
            count++;
        }
    }
    return squares / (double)count - sum / (double)count * (sum / (double)count);
}

static void three_panes_show_three_different_pictures(void **state)
{
    (void)state;
    assert_int_equal(run("$WEFT render cloth.weft --raw cloth.btf.h5 --weave $WEAVES/cotton_denim.wv --mode split "
                         "--environment none --size 240x100 --samples 1 --quiet -o split.png"),
                     0);
    weft_image image = read_picture("split.png", 240, 100);
    for (int pane = 0; pane < 3; pane++)
        assert_true(contrast(&image, 80 * pane + 25, 80 * pane + 55) > 1e-3);
    double difference = 0;
    for (int y = 0; y < 100; y++) {
        for (int x = 0; x < 80; x++) {
            const float *row = image.pixels + 720 * y;
            difference += (row[3 * x] != row[3 * (x + 80)]) + (row[3 * (x + 80)] != row[3 * (x + 160)]);
        }
    }
    assert_true(difference > 1000);
    weft_image_free(&image);
}

static void exr_holds_the_linear_values_of_the_png(void **state)
{
    (void)state;
    assert_int_equal(run("$WEFT render cloth.weft --mesh plane --camera=-90,90,3 --light 0,0 --exposure 0.5 "
                         "--size 64x64 --samples 2 --quiet -o plane.exr"),
                     0);
    assert_int_equal(run("$WEFT render cloth.weft --mesh plane --camera=-90,90,3 --light 0,0 --exposure 0.5 "
                         "--size 64x64 --samples 2 --quiet -o plane.png"),
                     0);
    weft_image linear = read_picture("plane.exr", 64, 64), coded = read_picture("plane.png", 64, 64);
    for (int i = 0; i < 3 * 64 * 64; i++) {
        double expected = fmin((double)weft_srgb_of_linear(linear.pixels[i]), 1);
        assert_float_equal((double)coded.pixels[i], expected, 0.006);
    }
    weft_image_free(&linear);
    weft_image_free(&coded);
}

static void a_difference_has_its_scale_in_png_but_not_among_the_numbers_of_exr(void **state)
{
    (void)state;
    const char *const type[] = {"exr", "png"};
    for (int is_png = 0; is_png < 2; is_png++) {
        char command[512], with[16], without[16];
        snprintf(with, sizeof with, "with.%s", type[is_png]);
        snprintf(without, sizeof without, "without.%s", type[is_png]);
        snprintf(
            command, sizeof command,
            "for f in '-o %s' '--no-labels -o %s'; do $WEFT render cloth.weft --raw cloth.btf.h5 "
            "--environment none --mesh plane --layout difference --size 400x200 --samples 1 --quiet $f || exit 9; done",
            with, without);
        assert_int_equal(run(command), 0);
        weft_image a = read_picture(with, 400, 200), b = read_picture(without, 400, 200);
        int differing = 0;
        for (int i = 0; i < 3 * 400 * 200; i++)
            differing += a.pixels[i] != b.pixels[i];
        assert_true(is_png ? differing > 1000 : differing == 0);
        weft_image_free(&a);
        weft_image_free(&b);
    }
}

/* A scene with most of its options away from their defaults. */
#define MANY_OPTIONS                                                                                                   \
    "--raw cloth.btf.h5 --weave $WEAVES/cotton_denim.wv --mode compressed,analytic --layout wipe --divider 0.4 "       \
    "--light 31.7,12.9,0.8 --light 60,100,0.1,0.2,0.3 --shadows --exposure 1.3 --tone soft --camera=-33.3,21,2.9 "     \
    "--lobes-on 1 --tables view --level nearest --mesh plane --mesh-size 123 --size 90x60 --samples 1 --quiet"

static void a_picture_can_be_drawn_again_bit_for_bit(void **state)
{
    (void)state;
    assert_int_equal(run("$WEFT render cloth.weft " MANY_OPTIONS " -o shot.png"), 0);
    assert_int_equal(run("$WEFT render --settings shot.png -o again.png --quiet && cmp shot.png again.png"), 0);
    assert_int_equal(run("$WEFT render --settings shot.png -o shot.exr --quiet"), 0);
    assert_int_equal(run("$WEFT render --settings shot.exr -o again.exr --quiet && cmp shot.exr again.exr"), 0);
    assert_int_equal(run("$WEFT render --exposure 1.2 --settings shot.png -o again.png --quiet"), 0);
    assert_int_equal(run("cmp -s shot.png again.png"), 1);
    assert_int_equal(run("$WEFT render cloth.weft " MANY_OPTIONS " --exposure 1.2 -o other.png"), 0);
    assert_int_equal(run("cmp other.png again.png"), 0);
}

static void a_folder_moved_as_a_whole_still_draws_its_pictures(void **state)
{
    (void)state;
    assert_int_equal(run("mkdir -p box/shots && cp cloth.weft box && "
                         "$WEFT render box/cloth.weft --environment none --mesh plane --size 40x30 --samples 1 --quiet "
                         "-o box/shots/a.png"),
                     0);
    assert_int_equal(run("rm -rf moved && mkdir moved && mv box moved/crate && cd moved/crate/shots && "
                         "$WEFT render --settings a.png --quiet -o b.png && cmp a.png b.png"),
                     0);
    assert_int_equal(run("mv moved/crate/cloth.weft moved; $WEFT render --settings moved/crate/shots/a.png -o c.png"),
                     WEFT_BAD_INPUT);
    expect_said("moved/crate/shots/a.png' shows the material 'moved/crate/shots/../cloth.weft'");
    assert_int_equal(run("$WEFT render moved/cloth.weft --settings moved/crate/shots/a.png -o c.png --quiet"), 0);
}

static void a_picture_without_good_settings_is_refused(void **state)
{
    (void)state;
    assert_int_equal(run("$WEFT render cloth.weft --mesh plane --environment none --exposure 1 --size 40x30 --samples "
                         "1 --quiet -o shot.png"),
                     0);
    assert_int_equal(run("$WEFT render --settings cloth.weft -o c.png"), WEFT_BAD_INPUT);
    assert_int_equal(run("head -c 60 shot.png > cut.png; $WEFT render --settings cut.png -o c.png"), WEFT_BAD_INPUT);
    expect_said("cut.png");
    assert_int_equal(run("sed 's/\"exposure\": 1/\"exposure\": X/' shot.png > bad.png; "
                         "$WEFT render --settings bad.png -o c.png"),
                     WEFT_BAD_INPUT);
    expect_said("bad.png");
    assert_int_equal(run("echo '{\"version\": 1, \"lamp\": 3}' > bad.json; $WEFT render --settings bad.json -o c.png"),
                     WEFT_BAD_INPUT);
    expect_said("the settings in 'bad.json': 'lamp' is not known");
    assert_int_not_equal(access("c.png.tmp", F_OK), 0);
}

static void a_cloth_twice_as_large_repeats_twice_as_often(void **state)
{
    (void)state;
    assert_int_equal(
        run("$WEFT render cloth.weft --environment none --size 40x30 --samples 1 --mesh-size 240 --quiet -o real.png"),
        0);
    /* 24 texels of 0.5 mm: 12 mm */
    assert_int_equal(
        run("$WEFT render cloth.weft --environment none --size 40x30 --samples 1 --repeat 20 --quiet -o given.png"), 0);
    weft_image real = read_picture("real.png", 40, 30), given = read_picture("given.png", 40, 30);
    assert_memory_equal(real.pixels, given.pixels, sizeof(float) * 3 * 40 * 30);
    weft_image_free(&real);
    weft_image_free(&given);
}

/* Settings and pixels: lit all round before a backdrop, unless a bare light is asked for. */
static void a_picture_begins_in_a_studio(void **state)
{
    (void)state;
    assert_int_equal(
        run("$WEFT render cloth.weft --mesh plane --size 40x30 --samples 1 -q -o begun.png && "
            "$WEFT render cloth.weft --mesh plane --environment studio --size 40x30 --samples 1 -q -o studio.png && "
            "cmp begun.png studio.png && "
            "tr -d '\\n ' < begun.png | grep -aq '\"environment\":\"studio\".*\"ground\":true'"),
        0);
    assert_int_equal(run("$WEFT render --settings begun.png -q -o again.png && cmp begun.png again.png"), 0);
    assert_int_equal(
        run("$WEFT render cloth.weft --environment none --exposure 1 --size 40x30 --samples 1 -q -o bare.png && "
            "$WEFT render cloth.weft --light 45,-110 --exposure 1 --size 40x30 --samples 1 -q -o light.png && "
            "cmp bare.png light.png && "
            "tr -d '\\n ' < bare.png | grep -aq '\"environment\":null.*\"ground\":false'"),
        0);
    assert_int_equal(
        run("$WEFT render cloth.weft --environment sky --shadows=off --ground=off --size 40x30 --samples 1 "
            "-q -o sky.png && "
            "tr -d '\\n ' < sky.png | grep -aq '\"shadows\":false.*\"ground\":false.*\"lit\":true'"),
        0);
}

static void a_path_gives_a_picture_for_every_frame(void **state)
{
    (void)state;
    assert_int_equal(run("printf 'time_s,azimuth_deg,light_phi_deg\\n0,-70,-110\\n0.5,20,0\\n1,20,30\\n' > path.csv; "
                         "$WEFT render cloth.weft --path path.csv --camera=-70,28,3.6 --light 45,0 --fps 4 --size "
                         "40x30 --samples 1 --exposure "
                         "1 -q -o turn%02d.png"),
                     0);
    assert_int_equal(
        run("ls turn*.png | tr '\\n' ' ' | grep -qx 'turn00.png turn01.png turn02.png turn03.png turn04.png '"), 0);
    assert_int_equal(run("$WEFT render cloth.weft --size 40x30 --samples 1 --camera=20,28,3.6 --light 45,0 --exposure "
                         "1 -q -o k.png; "
                         "$WEFT render --settings turn01.png -q -o g.png && cmp turn01.png g.png"),
                     0);
    weft_image frame = read_picture("turn02.png", 40, 30), key = read_picture("k.png", 40, 30);
    assert_memory_equal(frame.pixels, key.pixels, sizeof(float) * 3 * 40 * 30);
    weft_image_free(&frame);
    weft_image_free(&key);
    assert_int_equal(run("cmp -s turn00.png turn01.png"), 1);
    assert_int_equal(run("$WEFT render cloth.weft --path path.csv -o f.png"), WEFT_BAD_USAGE);
    expect_said("%04d");
    assert_int_equal(run("$WEFT render cloth.weft --path path.csv -o f%s%d.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --path none.csv -o f%d.png"), WEFT_BAD_INPUT);
    expect_said("none.csv");
}

static void a_sequence_on_a_full_disk_stops_with_whole_pictures(void **state)
{
    (void)state;
    assert_int_equal(run("printf 'time_s,distance\\n0,60\\n1,2\\n' > near.csv; rm -rf full; mkdir full; "
                         "(ulimit -f 20; $WEFT render cloth.weft --environment none --mesh sphere --path near.csv "
                         "--fps 3 --size 200x200 "
                         "--samples 1 -q "
                         "-o full/f%d.exr)"),
                     WEFT_SYSTEM);
    expect_said("full/f");
    assert_int_equal(run("ls -A full | grep -v '^f[0-9].exr$'"), 1);
    assert_int_equal(
        run("for f in full/*; do $WEFT render --settings $f -q -o full/again.exr && cmp $f full/again.exr || exit 9; "
            "done"),
        0);
}

static void the_reference_of_an_environment_tells_its_error(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_image sky;
    expect_ok(weft_image_create(32, 16, &sky, &error), &error);
    for (int i = 0; i < 3 * 32 * 16; i++)
        sky.pixels[i] = i % 96 < 9 ? 8 : 0.2f;
    expect_ok(weft_image_write("sky.exr", &sky, NULL, &error), &error);
    weft_image_free(&sky);
    assert_int_equal(run("$WEFT render cloth.weft --mesh sphere --environment sky.exr --environment-reference "
                         "--size 32x24 --samples 1 -o sky.png | grep -Eq 'relative RMSE [0-9.]+ %'"),
                     0);
    assert_int_equal(run("$WEFT render cloth.weft --mesh sphere --environment sky.exr --size 32x24 --samples 1 -q "
                         "-o few.png; cmp -s few.png sky.png"),
                     1);
    assert_int_equal(run("$WEFT render cloth.weft --mesh sphere --settings sky.png -q -o again.png; "
                         "cmp sky.png again.png"),
                     0);
    assert_int_equal(run("$WEFT render cloth.weft --environment cloth.weft -o a.png"), WEFT_BAD_INPUT);
    assert_int_equal(run("$WEFT render cloth.weft --environment few.png -o a.png"), WEFT_BAD_INPUT);
    expect_said("few.png': an environment map");
}

static void wrong_usage_is_exit_code_2(void **state)
{
    (void)state;
    assert_int_equal(run("$WEFT render -o a.png"), WEFT_BAD_USAGE);
    expect_said("needs a material");
    assert_int_equal(run("$WEFT render cloth.weft"), WEFT_BAD_USAGE);
    expect_said("-o");
    assert_int_equal(run("$WEFT render cloth.weft --mode raw -o a.png"), WEFT_BAD_USAGE);
    expect_said("--raw NAME.btf.h5");
    assert_int_equal(run("$WEFT render cloth.weft --size 10 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --size 99999x10 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --light nan,0 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --camera 0,91,3 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --samples 65 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --level=-1 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --repeat 0 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --light 1,2,3,4 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --light 1,2,-3 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --light none -o a.png"), WEFT_BAD_USAGE);
    expect_said("--environment");
    assert_int_equal(run("$WEFT render cloth.weft --lobes-on 4 -o a.png"), WEFT_BAD_USAGE);
    assert_int_equal(run("$WEFT render cloth.weft --layout difference -o a.png"), WEFT_BAD_USAGE);
    expect_said("needs two");
    assert_int_equal(run("$WEFT render cloth.weft cloth.weft -o a.png"), WEFT_BAD_USAGE);
    assert_int_not_equal(access("a.png", F_OK), 0);
}

static void options_that_would_do_nothing_are_refused(void **state)
{
    (void)state;
    static const char *const idle[][2] = {
        {"cloth.weft --raw-format bc6h", "--raw-format needs --raw"},
        {"cloth.weft --tiles 2,2", "--tiles needs --weave"},
        {"cloth.weft --noise 3", "--noise needs --weave"},
        {"--weave $WEAVES/cotton_denim.wv --lobes-on 1", "--lobes-on needs NAME.weft"},
        {"--weave $WEAVES/cotton_denim.wv --tables view", "--tables needs NAME.weft"},
        {"cloth.weft --environment-turn 30", "needs --environment"},
        {"cloth.weft --environment-strength 2", "needs --environment"},
        {"cloth.weft --environment-reference", "needs --environment"},
        {"cloth.weft --divider 0.3", "--divider needs --layout wipe"},
        {"cloth.weft --environment sky.exr --light none --shadows", "--shadows needs a --light"},
        {"cloth.weft --fps 12", "--fps needs --path"},
    };
    char arguments[256];
    for (size_t i = 0; i < sizeof idle / sizeof *idle; i++) {
        snprintf(arguments, sizeof arguments, "$WEFT render %s -o a.png", idle[i][0]);
        assert_int_equal(run(arguments), WEFT_BAD_USAGE);
        expect_said(idle[i][1]);
    }
    assert_int_equal(run("$WEFT render cloth.weft --tone soft -o a.exr"), WEFT_BAD_USAGE);
    expect_said("--tone needs -o OUT.png");
    assert_int_not_equal(access("a.png", F_OK), 0);
}

static void bad_files_are_exit_code_1_and_leave_no_picture(void **state)
{
    (void)state;
    assert_int_equal(run("$WEFT render none.weft -o a.png"), WEFT_BAD_INPUT);
    expect_said("none.weft");
    assert_int_equal(run("head -c 5000 cloth.weft > cut.weft; $WEFT render cut.weft -o a.png"), WEFT_BAD_INPUT);
    expect_said("cut.weft");
    assert_int_equal(run("$WEFT render cloth.weft --raw cloth.weft -o a.png"), WEFT_BAD_INPUT);
    assert_int_equal(run("$WEFT render cloth.weft --mesh none.obj -o a.png"), WEFT_BAD_INPUT);
    expect_said("none.obj");
    assert_int_equal(run("printf 'v 1 1 1\\nvt 0 0\\nf 1/1 1/1 1/1\\n' > dot.obj; "
                         "$WEFT render cloth.weft --mesh dot.obj -o a.png"),
                     WEFT_BAD_INPUT);
    expect_said("cannot be looked at");
    assert_int_not_equal(access("a.png", F_OK), 0);
}

static void a_failing_system_is_exit_code_3_and_leaves_no_picture(void **state)
{
    (void)state;
    assert_int_equal(run("$WEFT render cloth.weft --size 16x16 -o nowhere/a.png"), WEFT_SYSTEM);
    assert_int_equal(
        run("(ulimit -f 1; $WEFT render cloth.weft --environment none --size 200x200 --samples 1 -o a.exr)"),
        WEFT_SYSTEM);
    assert_int_equal(run("__EGL_VENDOR_LIBRARY_DIRS=/nonexistent $WEFT render cloth.weft -o a.png"), WEFT_SYSTEM);
    expect_said("without a display");
    assert_int_equal(run("DISPLAY= WAYLAND_DISPLAY= $WEFT play cloth.weft"), WEFT_SYSTEM);
    expect_said("cannot open a display");
    assert_int_equal(run("ls | grep -q '^a\\.\\|\\.a\\.\\|tmp'"), 1);
}

int test_render(void)
{
    if (suite_argument) {
        make_files(suite_argument);
        return 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_panes_show_three_different_pictures),
        cmocka_unit_test(exr_holds_the_linear_values_of_the_png),
        cmocka_unit_test(a_difference_has_its_scale_in_png_but_not_among_the_numbers_of_exr),
        cmocka_unit_test(a_picture_can_be_drawn_again_bit_for_bit),
        cmocka_unit_test(a_folder_moved_as_a_whole_still_draws_its_pictures),
        cmocka_unit_test(a_picture_without_good_settings_is_refused),
        cmocka_unit_test(a_cloth_twice_as_large_repeats_twice_as_often),
        cmocka_unit_test(a_picture_begins_in_a_studio),
        cmocka_unit_test(a_path_gives_a_picture_for_every_frame),
        cmocka_unit_test(a_sequence_on_a_full_disk_stops_with_whole_pictures),
        cmocka_unit_test(the_reference_of_an_environment_tells_its_error),
        cmocka_unit_test(wrong_usage_is_exit_code_2),
        cmocka_unit_test(options_that_would_do_nothing_are_refused),
        cmocka_unit_test(bad_files_are_exit_code_1_and_leave_no_picture),
        cmocka_unit_test(a_failing_system_is_exit_code_3_and_leaves_no_picture),
    };
    return cmocka_run_group_tests(tests, enter_folder, NULL);
}
