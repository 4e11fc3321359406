/* What a file is told to be, whatever its name. */
#include "btf/file_kind.h"

#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static void write_bytes(const char *path, const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void expect_kind(const char *path, weft_file_kind expected)
{
    weft_file_kind kind = WEFT_FILE_SESSION;
    weft_error error = {0};
    if (weft_file_kind_of(path, &kind, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(kind, expected);
}

static void expect_text(const char *text, weft_file_kind expected)
{
    write_bytes("file_kind.bin", text, strlen(text));
    expect_kind("file_kind.bin", expected);
}

static void first_bytes_tell_binary_files(void **state)
{
    (void)state;
    expect_text("\x89HDF\r\n\x1a\n....", WEFT_FILE_DATASET);
    expect_text("\x89WEFT\r\n\x1a....", WEFT_FILE_MATERIAL);
    expect_text("\x89PNG\r\n\x1a\n....", WEFT_FILE_PICTURE);
    expect_text("\x76\x2f\x31\x01....", WEFT_FILE_RADIANCE);
    expect_text("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", WEFT_FILE_RADIANCE);
}

static void the_first_word_tells_texts(void **state)
{
    (void)state;
    expect_text("/* a */ /* weave */\nstitch { }", WEFT_FILE_STITCH);
    expect_text("\n  weave{", WEFT_FILE_WEAVE);
    expect_text("microcylinder {", WEFT_FILE_MICROCYLINDER);
    expect_text("# made by hand\n# v\nv 0 0 0\n", WEFT_FILE_MESH);
    expect_text("mtllib a.mtl\n", WEFT_FILE_MESH);
    expect_kind(WEFT_ASSETS "/weaves/cotton_twill.wv", WEFT_FILE_WEAVE);
    expect_kind(WEFT_ASSETS "/microcylinder/crepe.mc", WEFT_FILE_MICROCYLINDER);
    expect_kind(WEFT_ASSETS "/stitches/plain_knit.stitch", WEFT_FILE_STITCH);
}

static void content_counts_more_than_the_name(void **state)
{
    (void)state;
    write_bytes("lies.weft", "weave {", 7);
    expect_kind("lies.weft", WEFT_FILE_WEAVE);
}

/* So that its reader says what is wrong in it. */
static void a_damaged_file_is_what_its_name_says(void **state)
{
    (void)state;
    write_bytes("cut.weft", "\x89WE", 3);
    expect_kind("cut.weft", WEFT_FILE_MATERIAL);
    write_bytes("empty.btf.h5", "", 0);
    expect_kind("empty.btf.h5", WEFT_FILE_DATASET);
    write_bytes("odd.wv", "/* never closed", 15);
    expect_kind("odd.wv", WEFT_FILE_WEAVE);
}

static void folders_are_sessions_and_the_rest_is_refused(void **state)
{
    (void)state;
    weft_file_kind kind;
    weft_error error = {0};
    mkdir("file_kind_folder", 0755);
    expect_kind("file_kind_folder", WEFT_FILE_SESSION);
    write_bytes("poem.txt", "weaver of words", 15);
    assert_int_equal(weft_file_kind_of("poem.txt", &kind, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "poem.txt"));
    assert_int_equal(weft_file_kind_of("there_is_none.weft", &kind, &error), WEFT_MISSING);
    assert_int_equal(weft_file_kind_of("/dev/null", &kind, &error), WEFT_BAD_INPUT);
}

static void a_file_of_bonn_is_told_what_to_do_with(void **state)
{
    (void)state;
    weft_file_kind kind;
    weft_error error = {0};
    write_bytes("carpet.btf", "!DFMF08FCR....", 14);
    assert_true(weft_file_is_bonn("carpet.btf"));
    assert_int_equal(weft_file_kind_of("carpet.btf", &kind, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "weft import"));
    write_bytes("carpet.btf", "DFMF08FCR....", 13);
    assert_false(weft_file_is_bonn("carpet.btf"));
    assert_false(weft_file_is_bonn("there_is_none.btf"));
    assert_false(weft_file_is_bonn("."));
}

int test_file_kind(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_bytes_tell_binary_files),
        cmocka_unit_test(the_first_word_tells_texts),
        cmocka_unit_test(content_counts_more_than_the_name),
        cmocka_unit_test(a_damaged_file_is_what_its_name_says),
        cmocka_unit_test(folders_are_sessions_and_the_rest_is_refused),
        cmocka_unit_test(a_file_of_bonn_is_told_what_to_do_with),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
