/* Photographs whose numbers are not sRGB: by what their files say, and by what the user says. */
#include "base/atomic_file.h"
#include "base/picture/colour.h"
#include "folder.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/icc_profile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char jpeg_name[] = "tl000_pl000_tv000_pv000.jpg", exr_name[] = "tl000_pl000_tv000_pv000.exr";

/* Published: to linear sRGB from Display P3, and from CIE XYZ (IEC 61966-2-1). */
static const double of_p3[3][3] = {{1.22494, -0.22494, 0}, {-0.04206, 1.04206, 0}, {-0.01964, -0.07864, 1.09827}};
static const double of_xyz[3][3] = {{3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};

/* ---- Files ---- */

typedef struct file {
    uint8_t bytes[8192];
    size_t size;
    char path[128];
} file;

static file read_file(const test_folder *folder, const char *name)
{
    file f = {.size = 0};
    snprintf(f.path, sizeof f.path, "%s/%s", folder->path, name);
    FILE *stream = fopen(f.path, "rb");
    assert_non_null(stream);
    f.size = fread(f.bytes, 1, sizeof f.bytes, stream);
    fclose(stream);
    assert_true(f.size > 0 && f.size < sizeof f.bytes);
    return f;
}

static void insert(file *f, size_t at, const void *bytes, size_t count)
{
    assert_true(f->size + count <= sizeof f->bytes);
    memmove(f->bytes + at + count, f->bytes + at, f->size - at);
    memcpy(f->bytes + at, bytes, count);
    f->size += count;
}

static void write_file(const file *f)
{
    assert_int_equal(weft_write_file(f->path, f->bytes, f->size, NULL), WEFT_OK);
}

/* ICC.1:2010, B.4: an APP2 segment after the first marker. */
static void put_profile(const test_folder *folder, const icc_profile *profile)
{
    file f = read_file(folder, jpeg_name);
    size_t length = 2 + 14 + profile->size;
    uint8_t head[18] = {0xff, 0xe2, (uint8_t)(length >> 8), (uint8_t)length};
    memcpy(head + 4, "ICC_PROFILE\0\1\1", 14);
    insert(&f, 2, profile->bytes, profile->size);
    insert(&f, 2, head, sizeof head);
    write_file(&f);
}

/* Where the list of attributes of an EXR file ends, behind its last byte. */
static size_t end_of_header(const file *f)
{
    size_t at = 8;
    while (f->bytes[at]) {
        at += strlen((const char *)f->bytes + at) + 1;
        at += strlen((const char *)f->bytes + at) + 1;
        int32_t size;
        memcpy(&size, f->bytes + at, 4);
        at += 4 + (size_t)size;
        assert_true(at < f->size);
    }
    return at + 1;
}

/* The picture is one block, whose place in the file stands behind the attributes. */
static void put_chromaticities(const test_folder *folder, const float xy[8])
{
    file f = read_file(folder, exr_name);
    uint8_t attribute[66] = "chromaticities\0chromaticities";
    const int32_t size = 32;
    memcpy(attribute + 30, &size, 4);
    memcpy(attribute + 34, xy, 32);
    insert(&f, 8, attribute, sizeof attribute);
    size_t table = end_of_header(&f);
    int64_t offset;
    memcpy(&offset, f.bytes + table, 8);
    offset += (int64_t)sizeof attribute;
    memcpy(f.bytes + table, &offset, 8);
    write_file(&f);
}

static void put_flat(const test_folder *folder, const char *name, const float rgb[3])
{
    weft_image image;
    assert_int_equal(weft_image_create(8, 8, &image, NULL), WEFT_OK);
    for (int i = 0; i < 3 * 64; i++)
        image.pixels[i] = rgb[i % 3];
    const weft_camera_notes notes = {"M", "N", "2026:01:01 00:00:00", 1, 1, 8, 100, 50, 50};
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder->path, name);
    if (strstr(name, ".jpg"))
        assert_int_equal(weft_snapshot_write(path, &image, &notes, NULL), WEFT_OK);
    else
        folder_put_image(folder, name, &image);
    weft_image_free(&image);
}

/* ---- What came of it ---- */

typedef struct outcome {
    double rgb[3], outside;
    char notes[2048];
} outcome;

static outcome import_with(const test_folder *folder, weft_import_options options)
{
    outcome o = {.notes = ""};
    weft_import_report report;
    weft_error error = {0};
    if (weft_import(folder->path, folder->dataset, &options, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    for (int i = 0; i < report.notes.count; i++) {
        size_t length = strlen(o.notes);
        snprintf(o.notes + length, sizeof o.notes - length, "%s\n", report.notes.line[i]);
    }
    o.outside = report.outside_fraction;
    weft_import_report_free(&report);
    imported import = folder_open(folder);
    for (int c = 0; c < 3; c++)
        o.rgb[c] = (double)imported_sample(&import, 4, 4, 0, c);
    imported_close(&import);
    return o;
}

static outcome import_as(const test_folder *folder, weft_import_colours colours)
{
    weft_import_options options = weft_import_defaults();
    options.colours = colours;
    return import_with(folder, options);
}

static void assert_turned(const double matrix[3][3], const double from[3], const double to[3])
{
    for (int c = 0; c < 3; c++) {
        double expected = matrix[c][0] * from[0] + matrix[c][1] * from[1] + matrix[c][2] * from[2];
        assert_float_equal(to[c], expected, 0.002);
    }
}

static void assert_note(const outcome *o, const char *words)
{
    if (!strstr(o->notes, words))
        fail_msg("'%s' does not say '%s'", o->notes, words);
}

static const float red_cloth[3] = {0.8f, 0.35f, 0.2f};

/* ---- Tests ---- */

static void a_profile_of_a_phone_is_taken_out(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    put_flat(&folder, jpeg_name, red_cloth);
    outcome plain = import_as(&folder, WEFT_IMPORT_AS_SAID);
    assert_null(strstr(plain.notes, "colours"));
    icc_profile profile = icc_profile_make(4, "Display P3", "RGB ", icc_display_p3, &icc_srgb_curve);
    put_profile(&folder, &profile);
    outcome turned = import_as(&folder, WEFT_IMPORT_AS_SAID);
    assert_turned(of_p3, plain.rgb, turned.rgb);
    assert_true(turned.rgb[0] > plain.rgb[0] + 0.05);
    assert_note(&turned, "colours of 'tl000_pl000_tv000_pv000.jpg': its ICC profile says 'Display P3'; turned into "
                         "sRGB (1 of 1 photographs)");
    outcome told = import_as(&folder, WEFT_IMPORT_SRGB);
    assert_memory_equal(told.rgb, plain.rgb, sizeof plain.rgb);
    assert_null(strstr(told.notes, "Display P3"));
    folder_remove(&folder);
}

static void colours_can_be_named_where_files_say_nothing(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    put_flat(&folder, jpeg_name, red_cloth);
    outcome plain = import_as(&folder, WEFT_IMPORT_AS_SAID), turned = import_as(&folder, WEFT_IMPORT_DISPLAY_P3);
    assert_turned(of_p3, plain.rgb, turned.rgb);
    outcome power = import_as(&folder, WEFT_IMPORT_GAMMA_22);
    for (int c = 0; c < 3; c++)
        assert_float_equal(power.rgb[c], pow((double)weft_srgb_of_linear((float)plain.rgb[c]), 2.2), 0.001);
    outcome adobe = import_as(&folder, WEFT_IMPORT_ADOBE_RGB);
    assert_true(adobe.rgb[0] > plain.rgb[0] + 0.1);
    folder_remove(&folder);
}

static void a_linear_profile_has_no_curve(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    put_flat(&folder, jpeg_name, red_cloth);
    weft_import_options options = weft_import_defaults();
    options.linear = true;
    outcome linear = import_with(&folder, options);
    icc_curve gamma = icc_gamma(1);
    icc_profile profile = icc_profile_make(2, "linear sRGB", "RGB ", icc_srgb, &gamma);
    put_profile(&folder, &profile);
    outcome said = import_as(&folder, WEFT_IMPORT_AS_SAID);
    assert_memory_equal(said.rgb, linear.rgb, sizeof linear.rgb);
    folder_remove(&folder);
}

static void a_profile_that_is_not_read_is_named(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    put_flat(&folder, jpeg_name, red_cloth);
    outcome plain = import_as(&folder, WEFT_IMPORT_AS_SAID);
    icc_curve gamma = icc_gamma(1.8);
    icc_profile profile = icc_profile_make(2, "scanner", "RGB ", NULL, &gamma);
    put_profile(&folder, &profile);
    outcome said = import_as(&folder, WEFT_IMPORT_AS_SAID);
    assert_memory_equal(said.rgb, plain.rgb, sizeof plain.rgb);
    assert_note(&said, "its ICC profile 'scanner' does not consist of curves and primaries; taken as sRGB");
    folder_remove(&folder);
}

static void chromaticities_are_honoured(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    const float xyz[3] = {0.3f, 0.28f, 0.25f};
    const double from[3] = {0.3, 0.28, 0.25};
    put_flat(&folder, exr_name, xyz);
    put_chromaticities(&folder, (const float[8]){1, 0, 0, 1, 0, 0, 1 / 3.0f, 1 / 3.0f});
    outcome turned = import_as(&folder, WEFT_IMPORT_AS_SAID);
    assert_turned(of_xyz, from, turned.rgb);
    assert_note(&turned, "its chromaticities say CIE XYZ; turned into sRGB");
    assert_null(strstr(turned.notes, "UTIA"));
    assert_float_equal(turned.outside, 0, 0);
    folder_remove(&folder);
}

/* A green that sRGB has not: what is kept of it is negative red. */
static void xyz_is_turned_and_what_is_outside_srgb_is_kept_and_counted(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    const float xyz[3] = {0.1f, 0.3f, 0.05f};
    const double from[3] = {0.1, 0.3, 0.05};
    put_flat(&folder, exr_name, xyz);
    outcome turned = import_as(&folder, WEFT_IMPORT_XYZ);
    assert_turned(of_xyz, from, turned.rgb);
    assert_true(turned.rgb[0] < -0.1);
    assert_float_equal(turned.outside, 1, 0);
    assert_null(strstr(turned.notes, "UTIA"));
    folder_remove(&folder);
}

static void exr_files_that_may_be_xyz_are_asked_about(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    put_flat(&folder, exr_name, red_cloth);
    outcome said = import_as(&folder, WEFT_IMPORT_AS_SAID);
    assert_float_equal(said.rgb[0], red_cloth[0], 0.001);
    assert_note(&said, "if they are XYZ, pass --colours xyz");
    outcome told = import_as(&folder, WEFT_IMPORT_SRGB);
    assert_memory_equal(told.rgb, said.rgb, sizeof said.rgb);
    assert_null(strstr(told.notes, "XYZ"));
    folder_remove(&folder);
}

static void white_can_be_another_value_than_1(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    put_flat(&folder, exr_name, (const float[3]){40, 30, 20});
    outcome said = import_as(&folder, WEFT_IMPORT_SRGB);
    assert_float_equal(said.rgb[1], 30, 0.02);
    assert_note(&said, "the mean sample is 30");
    weft_import_options options = weft_import_defaults();
    options.colours = WEFT_IMPORT_SRGB;
    options.white = 100;
    outcome told = import_with(&folder, options);
    for (int c = 0; c < 3; c++)
        assert_float_equal(told.rgb[c], 0.4 - 0.1 * c, 0.001);
    assert_null(strstr(told.notes, "in the mean"));
    folder_remove(&folder);
}

/* One pixel of grey, 128, and its gAMA chunk: 1. */
static const uint8_t grey_png[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
                                   0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
                                   0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00, 0x00, 0x00, 0x04, 0x67, 0x41, 0x4d, 0x41, 0x00,
                                   0x01, 0x86, 0xa0, 0x31, 0xe8, 0x96, 0x5f, 0x00, 0x00, 0x00, 0x0a, 0x49, 0x44, 0x41,
                                   0x54, 0x78, 0x9c, 0x63, 0x68, 0x00, 0x00, 0x00, 0x82, 0x00, 0x81, 0x77, 0xcd, 0x72,
                                   0xb6, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static void put_grey(const test_folder *folder)
{
    char path[128];
    snprintf(path, sizeof path, "%s/tl000_pl000_tv000_pv000.png", folder->path);
    assert_int_equal(weft_write_file(path, grey_png, sizeof grey_png, NULL), WEFT_OK);
}

static outcome import_pixel(const test_folder *folder, weft_import_colours colours)
{
    outcome o = {.notes = ""};
    weft_import_options options = weft_import_defaults();
    options.colours = colours;
    assert_int_equal(folder_import(folder, &options, NULL), WEFT_OK);
    imported import = folder_open(folder);
    for (int c = 0; c < 3; c++)
        o.rgb[c] = (double)imported_sample(&import, 0, 0, 0, c);
    imported_close(&import);
    return o;
}

static void a_gamma_of_png_is_honoured_and_grey_is_grey_in_all_primaries(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    put_grey(&folder);
    for (int i = 0; i < 3; i++) {
        assert_float_equal(import_pixel(&folder, WEFT_IMPORT_AS_SAID).rgb[i], 128 / 255.0, 0.001);
        assert_float_equal(import_pixel(&folder, WEFT_IMPORT_XYZ).rgb[i], 128 / 255.0, 0.001);
        assert_float_equal(import_pixel(&folder, WEFT_IMPORT_SRGB).rgb[i], 0.2158, 0.001);
    }
    folder_remove(&folder);
}

/* Two pictures of one pixel: 200, 100, 50, and 1, 2, 3. */
static const uint8_t two_in_a_tiff[] = {
    0x49, 0x49, 0x2a, 0x00, 0x08, 0x00, 0x00, 0x00, 0x09, 0x00, 0x00, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01,
    0x00, 0x00, 0x00, 0x01, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x02, 0x01, 0x03, 0x00,
    0x03, 0x00, 0x00, 0x00, 0x7a, 0x00, 0x00, 0x00, 0x03, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00,
    0x00, 0x06, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x11, 0x01, 0x04, 0x00, 0x01, 0x00,
    0x00, 0x00, 0x80, 0x00, 0x00, 0x00, 0x15, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x16,
    0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x17, 0x01, 0x04, 0x00, 0x01, 0x00, 0x00, 0x00,
    0x03, 0x00, 0x00, 0x00, 0x84, 0x00, 0x00, 0x00, 0x08, 0x00, 0x08, 0x00, 0x08, 0x00, 0xc8, 0x64, 0x32, 0x00, 0x09,
    0x00, 0x00, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x01, 0x03, 0x00, 0x01, 0x00,
    0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x02, 0x01, 0x03, 0x00, 0x03, 0x00, 0x00, 0x00, 0xf6, 0x00, 0x00, 0x00, 0x03,
    0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x06, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00,
    0x02, 0x00, 0x00, 0x00, 0x11, 0x01, 0x04, 0x00, 0x01, 0x00, 0x00, 0x00, 0xfc, 0x00, 0x00, 0x00, 0x15, 0x01, 0x03,
    0x00, 0x01, 0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x16, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00,
    0x00, 0x00, 0x17, 0x01, 0x04, 0x00, 0x01, 0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x08,
    0x00, 0x08, 0x00, 0x08, 0x00, 0x01, 0x02, 0x03};

static void a_second_picture_is_told(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    char path[128];
    snprintf(path, sizeof path, "%s/tl000_pl000_tv000_pv000.tif", folder.path);
    assert_int_equal(weft_write_file(path, two_in_a_tiff, sizeof two_in_a_tiff, NULL), WEFT_OK);
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    assert_int_equal(weft_import(folder.path, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
    const char *told = report.notes.line[report.notes.count - 1];
    assert_string_equal(told, "'tl000_pl000_tv000_pv000.tif' holds more than one picture: the first is taken (1 of 1 "
                              "photographs)");
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    assert_float_equal(imported_sample(&import, 0, 0, 0, 0), weft_linear_of_srgb(200 / 255.0f), 0.001);
    imported_close(&import);
    folder_remove(&folder);
}

static void sixteen_bits_may_be_linear(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    weft_image image;
    const weft_camera_notes notes = {"M", "N", "2026:01:01 00:00:00", 1, 1, 8, 100, 50, 50};
    char path[128];
    assert_int_equal(weft_image_create(8, 8, &image, NULL), WEFT_OK);
    snprintf(path, sizeof path, "%s/tl000_pl000_tv000_pv000.tif", folder.path);
    assert_int_equal(weft_snapshot_write(path, &image, &notes, NULL), WEFT_OK);
    weft_image_free(&image);
    outcome said = import_as(&folder, WEFT_IMPORT_AS_SAID), told = import_as(&folder, WEFT_IMPORT_SRGB);
    assert_note(
        &said,
        "it has 16 bits and does not state its tone curve; if its values are linear, pass --linear; taken as sRGB");
    assert_null(strstr(told.notes, "--linear"));
    weft_import_options options = weft_import_defaults();
    options.linear = true;
    told = import_with(&folder, options);
    assert_null(strstr(told.notes, "--linear"));
    folder_remove(&folder);
}

int test_import_colours(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_profile_of_a_phone_is_taken_out),
        cmocka_unit_test(colours_can_be_named_where_files_say_nothing),
        cmocka_unit_test(a_linear_profile_has_no_curve),
        cmocka_unit_test(a_profile_that_is_not_read_is_named),
        cmocka_unit_test(chromaticities_are_honoured),
        cmocka_unit_test(xyz_is_turned_and_what_is_outside_srgb_is_kept_and_counted),
        cmocka_unit_test(white_can_be_another_value_than_1),
        cmocka_unit_test(exr_files_that_may_be_xyz_are_asked_about),
        cmocka_unit_test(a_second_picture_is_told),
        cmocka_unit_test(sixteen_bits_may_be_linear),
        cmocka_unit_test(a_gamma_of_png_is_honoured_and_grey_is_grey_in_all_primaries),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
