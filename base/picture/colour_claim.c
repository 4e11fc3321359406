#include "base/picture/colour_claim.h"

#include "base/picture/colour_space.h"

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

static void of_primaries(const weft_colour_tags *tags, weft_colour_claim *claim)
{
    if (!weft_colour_space_of_primaries(tags->primaries, &claim->space)) {
        unclear(claim, "its chromaticities span no colours");
        return;
    }
    claim->kind = WEFT_CLAIM_CLEAR;
    weft_colour_space_round(&claim->space);
    if (!weft_colour_space_has_srgb_primaries(&claim->space))
        snprintf(claim->words, sizeof claim->words, "its chromaticities say %s", claim->space.name);
}

/* One over 0.45455 is what programs write that mean sRGB. */
static void of_gamma(double gamma, weft_colour_claim *claim)
{
    take_by_custom(WEFT_CLAIM_CLEAR, claim);
    if (fabs(gamma - 2.2) < 0.03)
        return;
    for (int c = 0; c < 3; c++) {
        weft_curve curve = {.kind = WEFT_CURVE_POWER, .gamma = gamma};
        claim->space.curve[c] = curve;
    }
    snprintf(claim->space.name, sizeof claim->space.name, "gamma %.3g", gamma);
    snprintf(claim->words, sizeof claim->words, "it says gamma %.3g", gamma);
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
    else if (tags->profile)
        of_profile(tags, claim);
    else if (tags->has_primaries)
        of_primaries(tags, claim);
    else if (tags->gamma > 0.1 && tags->gamma < 10 && !tags->is_float)
        of_gamma(tags->gamma, claim);
    else if (tags->is_uncalibrated)
        unclear(claim, "its Exif data say that it is not sRGB; often it is Adobe RGB");
    else
        say_nothing(tags, claim);
    if (tags->is_float || tags->is_raw)
        weft_colour_space_make_linear(&claim->space);
    if (tags->is_grey)
        weft_colour_space_make_grey(&claim->space);
}

weft_code weft_colour_claim_read(const char *path, weft_colour_claim *claim, weft_error *error)
{
    weft_colour_tags tags;
    weft_code code = weft_colour_tags_read(path, &tags, error);
    if (code == WEFT_OK && strstr(tags.model, "LAB"))
        code = weft_fail(error, WEFT_BAD_INPUT, "image '%s' holds CIE L*a*b*, not RGB: convert it", path);
    if (code == WEFT_OK)
        weft_colour_claim_of(&tags, claim);
    weft_colour_tags_free(&tags);
    return code;
}
