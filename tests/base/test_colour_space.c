/* Colours of files against the matrices that others published. */
#include "base/picture/colour.h"
#include "base/picture/colour_claim.h"
#include "base/picture/colour_space.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/icc_profile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* To linear sRGB: of CIE XYZ (IEC 61966-2-1), of Adobe RGB (1998) and of Display P3 (all under D65), of ACES 2065-1
 * (whose white of 6000 K is adapted by Bradford's transform). */
static const double of_xyz[3][3] = {{3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
static const double of_adobe[3][3] = {{1.39836, -0.39836, 0}, {0, 1, 0}, {0, -0.04293, 1.04293}};
static const double of_p3[3][3] = {{1.22494, -0.22494, 0}, {-0.04206, 1.04206, 0}, {-0.01964, -0.07864, 1.09827}};
static const double of_aces[3][3] = {
    {2.52169, -1.13413, -0.38756}, {-0.27648, 1.37272, -0.09624}, {-0.01538, -0.15298, 1.16835}};

static void assert_matrix(const weft_colour_space *space, const double expected[3][3], double tolerance)
{
    for (int i = 0; i < 9; i++)
        assert_float_equal(space->matrix[i / 3][i % 3], expected[i / 3][i % 3], tolerance);
}

static void assert_white(const weft_colour_space *space)
{
    float white[3] = {1, 1, 1};
    weft_colour_space_to_srgb(space, white, 1);
    for (int c = 0; c < 3; c++)
        assert_float_equal(white[c], 1, 1e-6);
}

static void known_spaces_have_the_matrices_that_are_published(void **state)
{
    (void)state;
    weft_colour_space space;
    weft_colour_space_make(WEFT_COLOURS_XYZ, &space);
    assert_matrix(&space, of_xyz, 5e-4);
    weft_colour_space_make(WEFT_COLOURS_ADOBE_RGB, &space);
    assert_matrix(&space, of_adobe, 5e-4);
    assert_white(&space);
    assert_float_equal(weft_curve_decode(&space.curve[1], 0.5f), pow(0.5, 2.19921875), 1e-6);
    weft_colour_space_make(WEFT_COLOURS_DISPLAY_P3, &space);
    assert_matrix(&space, of_p3, 5e-4);
    assert_white(&space);
    assert_float_equal(weft_curve_decode(&space.curve[2], 0.5f), weft_linear_of_srgb(0.5f), 0);
    weft_colour_space_make(WEFT_COLOURS_GAMMA_22, &space);
    assert_true(weft_colour_space_has_srgb_primaries(&space));
    assert_float_equal(weft_curve_decode(&space.curve[0], 0.5f), pow(0.5, 2.2), 1e-6);
    assert_false(weft_colour_space_is_srgb(&space));
    weft_colour_space_make(WEFT_COLOURS_SRGB, &space);
    assert_true(weft_colour_space_is_srgb(&space));
}

static void chromaticities_are_adapted_to_their_white(void **state)
{
    (void)state;
    const double aces[8] = {0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767};
    const double xyz[8] = {1, 0, 0, 1, 0, 0, 1 / 3.0, 1 / 3.0}, rec709[8] = {.64, .33, .3, .6, .15, .06, .3127, .329};
    const double flat[8] = {.64, .33, .64, .33, .15, .06, .3127, .329}, nothing[8] = {0};
    weft_colour_space space;
    assert_true(weft_colour_space_of_primaries(aces, &space));
    assert_matrix(&space, of_aces, 3e-3);
    assert_white(&space);
    assert_true(weft_colour_space_of_primaries(xyz, &space));
    assert_matrix(&space, of_xyz, 5e-4);
    assert_string_equal(space.name, "CIE XYZ");
    assert_true(weft_colour_space_of_primaries(rec709, &space));
    weft_colour_space_round(&space);
    assert_true(weft_colour_space_has_srgb_primaries(&space));
    assert_false(weft_colour_space_of_primaries(flat, &space));
    assert_false(weft_colour_space_of_primaries(nothing, &space));
}

static weft_colour_space read_profile(const icc_profile *profile)
{
    weft_colour_space space;
    assert_true(weft_icc_profile_read(profile->bytes, profile->size, &space));
    return space;
}

static void profiles_are_read_in_both_versions(void **state)
{
    (void)state;
    icc_curve gamma = icc_gamma(2.19921875);
    icc_profile profile = icc_profile_make(2, "Adobe RGB (1998)", "RGB ", icc_adobe_rgb, &gamma);
    weft_colour_space space = read_profile(&profile);
    assert_string_equal(space.name, "Adobe RGB (1998)");
    assert_matrix(&space, of_adobe, 2e-3);
    assert_white(&space);
    assert_float_equal(weft_curve_decode(&space.curve[0], 0.25f), pow(0.25, 2.19921875), 1e-6);

    profile = icc_profile_make(4, "Display P3", "RGB ", icc_display_p3, &icc_srgb_curve);
    space = read_profile(&profile);
    assert_string_equal(space.name, "Display P3");
    assert_matrix(&space, of_p3, 2e-3);
    assert_true(space.curve[1].kind == WEFT_CURVE_SRGB);
}

static void profiles_of_srgb_are_srgb_to_the_last_bit(void **state)
{
    (void)state;
    icc_curve table = {.kind = -1, .count = 512}, gamma = icc_gamma(2.2);
    for (int i = 0; i < table.count; i++)
        table.table[i] = (uint16_t)lround(65535 * (double)weft_linear_of_srgb((float)i / 511));
    icc_profile profile = icc_profile_make(2, "sRGB IEC61966-2.1", "RGB ", icc_srgb, &table);
    weft_colour_space space = read_profile(&profile);
    assert_true(weft_colour_space_is_srgb(&space));
    profile = icc_profile_make(2, "sRGB", "RGB ", icc_srgb, &gamma);
    space = read_profile(&profile);
    assert_true(weft_colour_space_has_srgb_primaries(&space));
    assert_false(weft_colour_space_is_srgb(&space));
}

static float decode(const icc_curve *curve, float encoded)
{
    icc_profile profile = icc_profile_make(4, "curve", "GRAY", NULL, curve);
    weft_colour_space space = read_profile(&profile);
    assert_true(weft_colour_space_has_srgb_primaries(&space));
    assert_memory_equal(&space.curve[0], &space.curve[2], sizeof space.curve[0]);
    return weft_curve_decode(&space.curve[0], encoded);
}

/* ICC.1:2010, table 65. */
static void all_kinds_of_curves_are_read(void **state)
{
    (void)state;
    icc_curve curve = {.kind = 0, .number = {3}};
    assert_float_equal(decode(&curve, 0.5f), 0.125, 1e-6);
    curve = (icc_curve){.kind = 1, .number = {2, 2, -0.5}};
    assert_float_equal(decode(&curve, 0.5f), 0.25, 1e-6);
    assert_float_equal(decode(&curve, 0.125f), 0, 0);
    curve = (icc_curve){.kind = 2, .number = {2, 2, -0.5, 0.125}};
    assert_float_equal(decode(&curve, 0.5f), 0.375, 1e-6);
    assert_float_equal(decode(&curve, 0.125f), 0.125, 1e-6);
    curve = (icc_curve){.kind = 3, .number = {2, 0.5, 0.5, 0.25, 0.375}};
    assert_float_equal(decode(&curve, 0.5f), 0.5625, 1e-6);
    assert_float_equal(decode(&curve, 0.25f), 0.0625, 1e-6);
    curve = (icc_curve){.kind = 4, .number = {2, 0.5, 0.5, 0.25, 0.375, 0.125, 0.03125}};
    assert_float_equal(decode(&curve, 0.5f), 0.6875, 1e-6);
    assert_float_equal(decode(&curve, 0.25f), 0.09375, 1e-6);
    curve = (icc_curve){.kind = -1, .count = 3, .table = {0, 16384, 65535}};
    assert_float_equal(decode(&curve, 0.25f), 0.125, 1e-4);
    assert_float_equal(decode(&curve, 0.75f), 0.625, 1e-4);
    assert_float_equal(decode(&curve, 1), 1, 1e-6);
    curve = (icc_curve){.kind = -1, .count = 0};
    assert_float_equal(decode(&curve, 0.3f), 0.3f, 0);
}

static void other_profiles_are_refused(void **state)
{
    (void)state;
    icc_curve gamma = icc_gamma(1.8), none = icc_gamma(0), unknown = {.kind = 0, .number = {1}};
    weft_colour_space space;
    icc_profile profile = icc_profile_make(2, "Coated FOGRA39", "CMYK", NULL, &gamma);
    assert_false(weft_icc_profile_read(profile.bytes, profile.size, &space));
    assert_string_equal(space.name, "Coated FOGRA39");
    profile = icc_profile_make(2, "of tables", "RGB ", NULL, &gamma);
    assert_false(weft_icc_profile_read(profile.bytes, profile.size, &space));
    const double flat[3][3] = {{0.4, 0.4, 0.4}, {0.4, 0.4, 0.4}, {0.1, 0.2, 0.3}};
    profile = icc_profile_make(2, "flat", "RGB ", flat, &gamma);
    assert_false(weft_icc_profile_read(profile.bytes, profile.size, &space));
    profile = icc_profile_make(2, "no gamma", "RGB ", icc_srgb, &none);
    assert_false(weft_icc_profile_read(profile.bytes, profile.size, &space));
    profile = icc_profile_make(2, "another", "GRAY", NULL, &unknown);
    assert_true(weft_icc_profile_read(profile.bytes, profile.size, &space));
    assert_memory_equal(profile.bytes + 176, "para", 4);
    profile.bytes[185] = 5;
    assert_false(weft_icc_profile_read(profile.bytes, profile.size, &space));
}

/* Each copy has no byte beyond its end, for tools that look. */
static void damaged_profiles_are_read_within_their_bytes(void **state)
{
    (void)state;
    icc_curve table = {.kind = -1, .count = 16};
    icc_profile profile = icc_profile_make(4, "Display P3", "RGB ", icc_display_p3, &table);
    weft_colour_space space;
    for (size_t size = 0; size < profile.size; size++) {
        uint8_t *part = malloc(size + 1);
        memcpy(part, profile.bytes, size);
        part = realloc(part, size ? size : 1);
        weft_icc_profile_read(part, size, &space);
        free(part);
    }
    for (size_t i = 0; i < profile.size; i++) {
        for (int bit = 0; bit < 8; bit += 7) {
            uint8_t *copy = malloc(profile.size);
            memcpy(copy, profile.bytes, profile.size);
            copy[i] ^= (uint8_t)(1 << bit);
            if (weft_icc_profile_read(copy, profile.size, &space))
                assert_true(isfinite(space.matrix[0][0]));
            free(copy);
        }
    }
}

static weft_colour_claim claim_of(weft_colour_tags tags)
{
    weft_colour_claim claim;
    weft_colour_claim_of(&tags, &claim);
    return claim;
}

static void what_a_file_says_is_weighed(void **state)
{
    (void)state;
    icc_profile profile = icc_profile_make(4, "Display P3", "RGB ", icc_display_p3, &icc_srgb_curve);
    weft_colour_claim claim = claim_of((weft_colour_tags){.gamma = 1});
    assert_true(claim.kind == WEFT_CLAIM_CLEAR && strstr(claim.words, "gamma 1"));
    assert_float_equal(weft_curve_decode(&claim.space.curve[0], 0.3f), 0.3, 1e-6);
    claim = claim_of((weft_colour_tags){.gamma = 1 / 0.45455});
    assert_true(weft_colour_space_is_srgb(&claim.space) && !claim.words[0]);
    claim = claim_of((weft_colour_tags){.profile = profile.bytes, .profile_size = profile.size, .gamma = 1});
    assert_non_null(strstr(claim.words, "'Display P3'"));
    assert_true(claim.space.curve[0].kind == WEFT_CURVE_SRGB);
    claim =
        claim_of((weft_colour_tags){.profile = profile.bytes, .profile_size = profile.size, .is_uncalibrated = true});
    assert_true(claim.kind == WEFT_CLAIM_CLEAR && strstr(claim.words, "'Display P3'"));
    claim = claim_of((weft_colour_tags){.profile = profile.bytes, .profile_size = profile.size, .is_float = true});
    assert_true(claim.space.curve[0].kind == WEFT_CURVE_LINEAR);
    assert_false(weft_colour_space_has_srgb_primaries(&claim.space));
    claim = claim_of((weft_colour_tags){.profile = profile.bytes, .profile_size = profile.size, .is_grey = true});
    assert_true(weft_colour_space_is_srgb(&claim.space));
    claim = claim_of((weft_colour_tags){.is_uncalibrated = true});
    assert_true(claim.kind == WEFT_CLAIM_UNCLEAR && strstr(claim.words, "Adobe RGB"));
    assert_true(weft_colour_space_is_srgb(&claim.space));
    claim = claim_of((weft_colour_tags){.is_raw = true});
    assert_true(claim.kind == WEFT_CLAIM_UNCLEAR && claim.space.curve[0].kind == WEFT_CURVE_LINEAR);
    claim = claim_of((weft_colour_tags){.model = "CMYK"});
    assert_true(claim.kind == WEFT_CLAIM_UNCLEAR && claim.words[0]);
    claim = claim_of((weft_colour_tags){.gamma = 0.45, .is_float = true});
    assert_true(claim.kind == WEFT_CLAIM_NONE && !claim.words[0]);
    claim = claim_of((weft_colour_tags){.bits = 16});
    assert_true(claim.kind == WEFT_CLAIM_NONE && strstr(claim.words, "--linear"));
    claim = claim_of((weft_colour_tags){.bits = 16, .is_float = true});
    assert_true(claim.kind == WEFT_CLAIM_NONE && !claim.words[0]);
    claim = claim_of((weft_colour_tags){.bits = 8});
    assert_true(claim.kind == WEFT_CLAIM_NONE && weft_colour_space_is_srgb(&claim.space) && !claim.words[0]);
}

int test_colour_space(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_spaces_have_the_matrices_that_are_published),
        cmocka_unit_test(chromaticities_are_adapted_to_their_white),
        cmocka_unit_test(profiles_are_read_in_both_versions),
        cmocka_unit_test(profiles_of_srgb_are_srgb_to_the_last_bit),
        cmocka_unit_test(all_kinds_of_curves_are_read),
        cmocka_unit_test(other_profiles_are_refused),
        cmocka_unit_test(damaged_profiles_are_read_within_their_bytes),
        cmocka_unit_test(what_a_file_says_is_weighed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
