/* Files of cameras and programs that are not ours: each is read right, or named. */
#include "base/picture/colour_claim.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char *const files = WEFT_SHARED "/real/files/";

typedef struct outcome {
    const char *name;
    const char *refused; /* NULL: it is read */
    int width, height;   /* as it is shown */
    bool is_partial;
    const char *colours;
} outcome;

static const outcome outcomes[] = {
    {"raw/DNG.dng", "cannot hold", 0, 0, false, NULL},
    {"raw/Nikon.nef", "cannot hold", 0, 0, false, NULL},
    {"raw/CanonRaw.cr2", "cannot hold", 0, 0, false, NULL},
    {"raw/Issue 247-1.nef", NULL, 2000, 3008, false, ""},
    {"jpeg/corrupted.jpg", "not whole", 0, 0, false, NULL},
    {"exr/t01.exr", NULL, 400, 300, false, ""},
    {"exr/t05.exr", NULL, 340, 260, false, ""},
    {"exr/t08.exr", NULL, 501, 401, true, ""},
    {"exr/t09.exr", "holds no pixel", 0, 0, false, NULL},
    {"heic/iphone_13_pro_max.HEIC", NULL, 3024, 4032, false, "its ICC profile says 'Display P3'"},
};

static void every_file_is_read_or_named(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof outcomes / sizeof outcomes[0]; i++) {
        const outcome *o = &outcomes[i];
        char path[4096];
        weft_image image;
        weft_image_kind kind;
        weft_exif exif;
        weft_colour_claim claim;
        weft_error error = {0};
        snprintf(path, sizeof path, "%s%s", files, o->name);
        weft_code code = weft_colour_claim_read(path, &image, &kind, &exif, &claim, &error);
        if (o->refused) {
            assert_int_equal(code, WEFT_DAMAGED);
            if (!strstr(error.message, o->refused))
                fail_msg("'%s' does not say '%s'", error.message, o->refused);
            continue;
        }
        if (code != WEFT_OK)
            fail_msg("%s", error.message);
        assert_true(exif.width == image.width && exif.height == image.height);
        assert_int_equal(weft_image_turn(&image, exif.orientation, NULL), WEFT_OK);
        assert_true(image.width == o->width && image.height == o->height);
        assert_int_equal(image.is_partial, o->is_partial);
        assert_string_equal(claim.words, o->colours);
        weft_image_free(&image);
    }
}

int test_real_files(void)
{
    if (access(files, R_OK) != 0) {
        printf("skipped: no files in %s\n", files);
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_file_is_read_or_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
