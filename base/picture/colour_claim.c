#include "base/picture/colour_claim.h"

#include "base/picture/colour.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void take_by_custom(weft_claim_kind kind, weft_colour_claim *claim)
{
    claim->kind = kind;
    weft_colour_space_make(WEFT_COLOURS_SRGB, &claim->space);
}

static void unclear(weft_colour_claim *claim, const char *words)
{
    take_by_custom(WEFT_CLAIM_UNCLEAR, claim);
    snprintf(claim->words, sizeof claim->words, "%s", words);
}

static bool has_gamma(const weft_colour_tags *tags)
{
    return tags->gamma > 0.1 && tags->gamma < 10 && !tags->is_float;
}

static void of_profile(const weft_colour_tags *tags, weft_colour_claim *claim)
{
    bool is_read = weft_icc_profile_read(tags->profile, tags->profile_size, &claim->space);
    if (!is_read) {
        snprintf(claim->words, sizeof claim->words, "its ICC profile '%s' does not consist of curves and primaries",
                 claim->space.name);
        take_by_custom(WEFT_CLAIM_UNCLEAR, claim);
        return;
    }
    claim->kind = WEFT_CLAIM_CLEAR;
    if (!weft_colour_space_is_srgb(&claim->space))
        snprintf(claim->words, sizeof claim->words, "its ICC profile says '%s'", claim->space.name);
}

static void set_curve(weft_colour_claim *claim, const weft_curve *curve)
{
    for (int c = 0; c < 3; c++)
        claim->space.curve[c] = *curve;
}

/* One over 0.45455 is what programs write that mean sRGB. */
static void of_gamma(double gamma, weft_colour_claim *claim)
{
    const weft_curve curve = {.kind = WEFT_CURVE_POWER, .gamma = gamma};
    size_t length = strlen(claim->words);
    if (fabs(gamma - 2.2) < 0.03)
        return;
    set_curve(claim, &curve);
    snprintf(claim->space.name, sizeof claim->space.name, "gamma %.3g", gamma);
    snprintf(claim->words + length, sizeof claim->words - length, "%sit says gamma %.3g", length ? "; " : "", gamma);
}

/* Either may be unsaid; the curve is that of sRGB then, and so are the primaries. */
static void of_primaries_and_gamma(const weft_colour_tags *tags, weft_colour_claim *claim)
{
    const weft_curve srgb = {.kind = WEFT_CURVE_SRGB};
    take_by_custom(WEFT_CLAIM_CLEAR, claim);
    if (tags->has_primaries) {
        if (!weft_colour_space_of_primaries(tags->primaries, &claim->space)) {
            unclear(claim, "its chromaticities span no colours");
            return;
        }
        weft_colour_space_round(&claim->space);
        set_curve(claim, &srgb);
    }
    if (!weft_colour_space_has_srgb_primaries(&claim->space))
        snprintf(claim->words, sizeof claim->words, "its chromaticities say %s", claim->space.name);
    if (has_gamma(tags))
        of_gamma(tags->gamma, claim);
}

/* ---- Code points of ITU-T H.273 ---- */

static double of_bt709(double x)
{
    return x < 0.081 ? x / 4.5 : pow((x + 0.099) / 1.099, 1 / 0.45);
}

/* 1 is the white of a page, 203 cd/m^2 (ITU-R BT.2408). */
static double of_pq(double x)
{
    const double m1 = 2610.0 / 16384, m2 = 2523.0 / 32, c1 = 3424.0 / 4096, c2 = 2413.0 / 128, c3 = 2392.0 / 128;
    double power = pow(x, 1 / m2);
    return 10000.0 / 203 * pow(fmax(power - c1, 0) / (c2 - c3 * power), 1 / m1);
}

static double of_hlg_scene(double x)
{
    const double a = 0.17883277, b = 0.28466892, c = 0.55991073;
    return x <= 0.5 ? x * x / 3 : (exp((x - c) / a) + b) / 12;
}

/* The light of the scene, relative to the same white, which is coded as 0.75. */
static double of_hlg(double x)
{
    return of_hlg_scene(x) / of_hlg_scene(0.75);
}

static double of_srgb(double x)
{
    return (double)weft_linear_of_srgb((float)x);
}

static double of_linear(double x)
{
    return x;
}

static double of_gamma_22(double x)
{
    return pow(x, 2.2);
}

static double of_gamma_28(double x)
{
    return pow(x, 2.8);
}

static double of_cinema(double x)
{
    return 52.37 / 48 * pow(x, 2.6);
}

typedef double (*transfer)(double encoded);

/* NULL: not known here. */
static transfer transfer_of(int code)
{
    static const transfer known[] = {
        [1] = of_bt709,  [4] = of_gamma_22, [5] = of_gamma_28, [6] = of_bt709,   [8] = of_linear, [13] = of_srgb,
        [14] = of_bt709, [15] = of_bt709,   [16] = of_pq,      [17] = of_cinema, [18] = of_hlg};
    return code < (int)(sizeof known / sizeof *known) ? known[code] : NULL;
}

/* NULL: not known here. */
static const double *primaries_of(int code)
{
    static const struct {
        int code;
        double xy[8];
    } known[] = {
        {1, {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}},
        {4, {0.67, 0.33, 0.21, 0.71, 0.14, 0.08, 0.310, 0.316}},
        {5, {0.64, 0.33, 0.29, 0.60, 0.15, 0.06, 0.3127, 0.3290}},
        {6, {0.630, 0.340, 0.310, 0.595, 0.155, 0.070, 0.3127, 0.3290}},
        {7, {0.630, 0.340, 0.310, 0.595, 0.155, 0.070, 0.3127, 0.3290}},
        {8, {0.681, 0.319, 0.243, 0.692, 0.145, 0.049, 0.310, 0.316}},
        {9, {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}},
        {10, {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3}},
        {11, {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.314, 0.351}},
        {12, {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}},
        {22, {0.630, 0.340, 0.295, 0.605, 0.155, 0.077, 0.3127, 0.3290}},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (known[i].code == code)
            return known[i].xy;
    }
    return NULL;
}

/* Of a narrow range, that of video, 16/255 is black and 235/255 white. */
static void tabulate(transfer decode, bool is_full_range, weft_curve *curve)
{
    *curve = (weft_curve){.kind = WEFT_CURVE_TABLE, .count = WEFT_CURVE_STEPS};
    for (int i = 0; i < WEFT_CURVE_STEPS; i++) {
        double x = (double)i / (WEFT_CURVE_STEPS - 1);
        curve->table[i] = (float)decode(is_full_range ? x : fmin(fmax((255 * x - 16) / 219, 0), 1));
    }
}

static void of_code_points(const weft_colour_tags *tags, weft_colour_claim *claim)
{
    const uint8_t *code = tags->cicp;
    const double *xy = primaries_of(code[0]);
    transfer decode = transfer_of(code[1]);
    weft_curve curve;
    if (!xy || !decode || code[2] != 0 || !weft_colour_space_of_primaries(xy, &claim->space)) {
        take_by_custom(WEFT_CLAIM_UNCLEAR, claim);
        snprintf(claim->words, sizeof claim->words, "it states primaries %d, curve %d and matrix %d of ITU-T H.273",
                 code[0], code[1], code[2]);
        return;
    }
    tabulate(decode, code[3] != 0, &curve);
    claim->kind = WEFT_CLAIM_CLEAR;
    set_curve(claim, &curve);
    weft_colour_space_round(&claim->space);
    if (weft_colour_space_is_srgb(&claim->space))
        return;
    if (code[0] == 12 && code[1] == 13)
        snprintf(claim->space.name, sizeof claim->space.name, "Display P3");
    else
        snprintf(claim->space.name, sizeof claim->space.name, "primaries %d and curve %d of ITU-T H.273", code[0],
                 code[1]);
    snprintf(claim->words, sizeof claim->words, "it states %s", claim->space.name);
}

/* Programs write 16 bits for linear values, and for others. */
static void say_nothing(const weft_colour_tags *tags, weft_colour_claim *claim)
{
    take_by_custom(WEFT_CLAIM_NONE, claim);
    if (tags->bits >= 16 && !tags->is_float)
        snprintf(claim->words, sizeof claim->words,
                 "it has %d bits and does not state its tone curve; if its values are linear, pass --linear",
                 tags->bits);
}

void weft_colour_claim_of(const weft_colour_tags *tags, weft_colour_claim *claim)
{
    claim->words[0] = 0;
    claim->is_grey = tags->is_grey;
    claim->has_more = tags->has_more;
    if (tags->is_raw)
        unclear(claim, "it is camera raw, in the colours of the camera and without white balance");
    else if (tags->model[0])
        unclear(claim, "it holds CMYK inks; their conversion to RGB is approximate");
    else if (tags->has_cicp)
        of_code_points(tags, claim);
    else if (tags->profile)
        of_profile(tags, claim);
    else if (tags->says_srgb)
        take_by_custom(WEFT_CLAIM_CLEAR, claim);
    else if (tags->has_primaries || has_gamma(tags))
        of_primaries_and_gamma(tags, claim);
    else if (tags->is_uncalibrated)
        unclear(claim, "its Exif data say that it is not sRGB; often it is Adobe RGB");
    else
        say_nothing(tags, claim);
    if (tags->is_float || tags->is_raw)
        weft_colour_space_make_linear(&claim->space);
    if (tags->is_grey)
        weft_colour_space_make_grey(&claim->space);
}

weft_code weft_colour_claim_read(const char *path, weft_image *image, weft_image_kind *kind, weft_exif *exif,
                                 weft_colour_claim *claim, weft_error *error)
{
    weft_colour_tags tags;
    weft_code code = weft_picture_read(path, image, kind, exif, &tags, error);
    if (code == WEFT_OK && strstr(tags.model, "LAB")) {
        code = weft_fail(error, WEFT_BAD_INPUT, "image '%s' holds CIE L*a*b*, not RGB: convert it", path);
        if (image)
            weft_image_free(image);
    }
    if (code == WEFT_OK)
        weft_colour_claim_of(&tags, claim);
    weft_colour_tags_free(&tags);
    return code;
}
