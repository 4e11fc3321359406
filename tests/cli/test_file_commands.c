/* eval, info, verify and import as a user runs them. */
#include "base/picture/image.h"
#include "btf/material/material.h"
#include "tests/support/run_weft.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void write_material(const char *path)
{
    weft_material material;
    assert_int_equal(weft_material_create(2, 2, 0, 0, 0, 1, &material, NULL), WEFT_OK);
    material.texel_pitch_mm = 1;
    for (int level = 0; level < material.level_count; level++) {
        for (int i = 0; i < material.level[level].width * material.level[level].height * 4; i++)
            material.level[level].diffuse[i] = i % 4 < 3 ? weft_half_of_float(0.5f) : 0;
    }
    assert_int_equal(weft_material_write(path, &material, NULL), WEFT_OK);
    weft_material_free(&material);
}

static void eval_appends_the_brdf_to_every_row(void **state)
{
    (void)state;
    write_material("file.weft");
    write_text("file.csv", "lx,ly,lz,vx,vy,vz\n0,0,1,0,0,1\n0,0,-1,0,0,1\n");
    expect_weft("eval file.weft --at file.csv --quiet", 0,
                "lx,ly,lz,vx,vy,vz,r,g,b\n0,0,1,0,0,1,0.159154943,0.159154943,0.159154943\n");
    expect_weft("eval file.weft --at file.csv --quiet -o file-out.csv", 0, "");
    assert_int_equal(access("file-out.csv", R_OK), 0);
}

static void eval_names_what_is_wrong(void **state)
{
    (void)state;
    write_material("file.weft");
    write_text("file.csv", "lx,ly,lz\n0,0,1\n");
    expect_weft("eval file.weft --at file.csv", 1, "file.csv' has no column 'vx'");
    expect_weft("eval file.weft --at none.csv", 1, "none.csv");
    expect_weft("eval none.weft --at file.csv", 1, "none.weft");
    expect_weft("eval file.weft", 2, "--at");
    expect_weft("eval --help", 0, "Example: weft eval");
}

static void an_input_is_never_the_output(void **state)
{
    (void)state;
    write_material("file.weft");
    write_text("file.csv", "lx,ly,lz,vx,vy,vz\n0,0,1,0,0,1\n");
    expect_weft("eval file.weft --at file.csv -o ./file.csv", 2, "would overwrite");
    expect_weft("eval file.weft --at file.csv -o file.weft", 2, "would overwrite");
    expect_weft("compress file.weft -o file.weft", 2, "would overwrite");
    expect_weft("capture --sample file.csv --truth file.csv -o file-session", 2, "would overwrite");
    expect_weft("verify file.weft", 0, "sound");
}

/* What the reference vectors give for this cloth and pair of directions (tests/data/reference/microcylinder_cloth.csv),
 * where threads weigh as printed. */
static void eval_info_and_verify_take_microcylinder_cloth(void **state)
{
    (void)state;
    const char *pair = "-0.892303704,-0.0608657588,0.447313602,0.0702826786,0.945829084,0.316966385";
    const char *cloth = WEFT_ASSETS "/microcylinder/plain_matte.mc";
    char text[512], arguments[512], expected[512];
    snprintf(text, sizeof text, "lx,ly,lz,vx,vy,vz\n%s\n", pair);
    write_text("file.csv", text);
    snprintf(arguments, sizeof arguments, "eval %s --at file.csv --as-printed --quiet", cloth);
    snprintf(expected, sizeof expected, "lx,ly,lz,vx,vy,vz,r,g,b\n%s,0.0152147184,0.0590503405,0.0736622146\n", pair);
    expect_weft(arguments, 0, expected);
    snprintf(arguments, sizeof arguments, "info %s", cloth);
    expect_weft(arguments, 0, "kind: microcylinder cloth");
    expect_weft(arguments, 0, "tangents: 4 x 4");
    snprintf(arguments, sizeof arguments, "verify %s", cloth);
    expect_weft(arguments, 0, "sound");
}

static void bad_microcylinder_cloth_is_named_with_line_and_column(void **state)
{
    (void)state;
    write_text("file.csv", "lx,ly,lz,vx,vy,vz\n0,0,1,0,0,1\n");
    write_text("file.mc", "microcylinder {\n  name = \"no thread\",\n  sigmb = 17\n}\n");
    expect_weft("verify file.mc", 1, "weft verify: file.mc:3:3: unknown key 'sigmb'");
    expect_weft("info file.mc", 1, "weft info: file.mc:3:3: unknown key 'sigmb'");
    expect_weft("eval file.mc --at file.csv", 1, "weft eval: file.mc:3:3: unknown key 'sigmb'");
    write_text("file.mc", "");
    expect_weft("verify file.mc", 1, "weft verify: file.mc:1:1: ");
    unlink("file.mc");
}

static void info_and_verify_speak_of_the_file(void **state)
{
    (void)state;
    write_material("file.weft");
    expect_weft("info file.weft", 0, "texels: 2 x 2");
    expect_weft("verify file.weft", 0, "sound");
    expect_weft("info file.weft --json", 0, "\"event\":\"info\"");
    expect_weft("info", 2, "needs a file");
}

static void verify_refuses_a_material_cut_anywhere(void **state)
{
    (void)state;
    write_material("file.weft");
    struct stat status;
    assert_int_equal(stat("file.weft", &status), 0);
    for (long cut = 0; cut < status.st_size; cut += 1 + status.st_size / 16) {
        write_material("file.weft");
        assert_int_equal(truncate("file.weft", cut), 0);
        expect_weft("verify file.weft", 1, "weft verify: ");
    }
}

static void import_leaves_nothing_when_a_photograph_is_bad(void **state)
{
    (void)state;
    mkdir("file-photographs", 0777);
    write_text("file-photographs/tl000_pl000_tv000_pv000.png", "not an image");
    expect_weft("import file-photographs -o file-out.btf.h5", 1, "tl000_pl000_tv000_pv000.png");
    assert_int_not_equal(access("file-out.btf.h5", F_OK), 0);
    weft_image image;
    assert_int_equal(weft_image_create(2, 2, &image, NULL), WEFT_OK);
    assert_int_equal(weft_image_write("file-photographs/tl000_pl000_tv000_pv000.png", &image, NULL, NULL), WEFT_OK);
    weft_image_free(&image);
    expect_weft("import file-photographs -o file-out.btf.h5", 0, "2 x 2 texels, 1 images from 1 views");
    expect_weft("import file-photographs -o file-out.btf.h5 --size x", 2, "--size");
    expect_weft("import file-photographs", 2, "-o");
    expect_weft("verify file-out.btf.h5", 0, "valid_samples: 4");
    unlink("file-out.btf.h5");
}

int test_file_commands(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eval_appends_the_brdf_to_every_row),
        cmocka_unit_test(eval_names_what_is_wrong),
        cmocka_unit_test(an_input_is_never_the_output),
        cmocka_unit_test(eval_info_and_verify_take_microcylinder_cloth),
        cmocka_unit_test(bad_microcylinder_cloth_is_named_with_line_and_column),
        cmocka_unit_test(info_and_verify_speak_of_the_file),
        cmocka_unit_test(verify_refuses_a_material_cut_anywhere),
        cmocka_unit_test(import_leaves_nothing_when_a_photograph_is_bad),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
