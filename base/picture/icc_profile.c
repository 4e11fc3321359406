#include "base/picture/colour_space.h"

#include <lcms2.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Printable ASCII without quotes, in the first language where there is no English. */
static void read_name(cmsHPROFILE profile, weft_colour_space *space)
{
    cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", space->name, sizeof space->name);
    space->name[sizeof space->name - 1] = 0;
    for (char *at = space->name; *at; at++) {
        if (*at < 0x20 || *at > 0x7e || *at == '\'')
            *at = '?';
    }
}

static bool read_curve(cmsHPROFILE profile, cmsTagSignature tag, weft_curve *curve)
{
    const cmsToneCurve *read = cmsReadTag(profile, tag);
    *curve = (weft_curve){.kind = WEFT_CURVE_LINEAR};
    if (!read)
        return false;
    if (cmsIsToneCurveLinear(read))
        return true;
    curve->kind = WEFT_CURVE_TABLE;
    curve->count = WEFT_CURVE_STEPS;
    for (int i = 0; i < WEFT_CURVE_STEPS; i++) {
        curve->table[i] = cmsEvalToneCurveFloat(read, (float)i / (WEFT_CURVE_STEPS - 1));
        if (!isfinite(curve->table[i]))
            return false;
    }
    return curve->table[WEFT_CURVE_STEPS - 1] > curve->table[0];
}

static bool read_colorants(cmsHPROFILE profile, weft_colour_space *space)
{
    static const cmsTagSignature tag[] = {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag};
    weft_colorants colorants;
    for (int i = 0; i < 3; i++) {
        const cmsCIEXYZ *xyz = cmsReadTag(profile, tag[i]);
        if (!xyz)
            return false;
        const double axis[] = {xyz->X, xyz->Y, xyz->Z};
        memcpy(colorants.xyz[i], axis, sizeof axis);
    }
    return weft_colour_space_of_colorants(&colorants, space);
}

static bool read_space(cmsHPROFILE profile, weft_colour_space *space)
{
    static const cmsTagSignature tag[] = {cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag};
    bool is_grey = cmsGetColorSpace(profile) == cmsSigGrayData;
    if (is_grey)
        weft_colour_space_make_grey(space);
    else if (cmsGetColorSpace(profile) != cmsSigRgbData || !read_colorants(profile, space))
        return false;
    for (int c = 0; c < 3; c++) {
        if (!read_curve(profile, is_grey ? cmsSigGrayTRCTag : tag[c], &space->curve[c]))
            return false;
    }
    weft_colour_space_round(space);
    return true;
}

/* The context is our own: threads share nothing, and the library prints nothing. */
bool weft_icc_profile_read(const uint8_t *bytes, size_t size, weft_colour_space *space)
{
    bool is_read = false;
    memset(space, 0, sizeof *space);
    cmsContext context = size <= UINT32_MAX ? cmsCreateContext(NULL, NULL) : NULL;
    cmsHPROFILE profile = context ? cmsOpenProfileFromMemTHR(context, bytes, (cmsUInt32Number)size) : NULL;
    if (profile) {
        is_read = read_space(profile, space);
        read_name(profile, space);
        cmsCloseProfile(profile);
    }
    if (context)
        cmsDeleteContext(context);
    return is_read;
}
