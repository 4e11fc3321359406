#include "tests/support/icc_profile.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

const double icc_adobe_rgb[3][3] = {
    {0.60974, 0.31111, 0.01947}, {0.20528, 0.62567, 0.06087}, {0.14919, 0.06322, 0.74457}};
const double icc_display_p3[3][3] = {
    {0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}};
const double icc_srgb[3][3] = {{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.71410}};
const icc_curve icc_srgb_curve = {.kind = 3, .number = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}};

icc_curve icc_gamma(double gamma)
{
    return (icc_curve){.kind = -1, .count = 1, .table = {(uint16_t)lround(gamma * 256)}};
}

static void put_number(icc_profile *p, uint32_t value, int count)
{
    for (int i = count - 1; i >= 0; i--)
        p->bytes[p->size++] = (uint8_t)(value >> 8 * i);
}

static void put_fixed(icc_profile *p, double value)
{
    put_number(p, (uint32_t)(int32_t)lround(value * 65536), 4);
}

static void put_text(icc_profile *p, const char *text)
{
    for (; *text; text++)
        p->bytes[p->size++] = (uint8_t)*text;
}

static void put_name(icc_profile *p, int version, const char *name)
{
    put_text(p, version == 2 ? "desc" : "mluc");
    put_number(p, 0, 4);
    if (version == 2) {
        put_number(p, (uint32_t)strlen(name) + 1, 4);
        put_text(p, name);
        put_number(p, 0, 1);
        return;
    }
    put_number(p, 1, 4);
    put_number(p, 12, 4);
    put_text(p, "enUS");
    put_number(p, 2 * (uint32_t)strlen(name), 4);
    put_number(p, 28, 4);
    for (; *name; name++)
        put_number(p, (uint8_t)*name, 2);
}

static void put_curve(icc_profile *p, const icc_curve *curve)
{
    static const int numbers[] = {1, 3, 4, 5, 7};
    put_text(p, curve->kind < 0 ? "curv" : "para");
    put_number(p, 0, 4);
    if (curve->kind < 0) {
        put_number(p, (uint32_t)curve->count, 4);
        for (int i = 0; i < curve->count; i++)
            put_number(p, curve->table[i], 2);
        return;
    }
    put_number(p, (uint32_t)curve->kind, 2);
    put_number(p, 0, 2);
    for (int i = 0; i < numbers[curve->kind]; i++)
        put_fixed(p, curve->number[i]);
}

/* Writes where a tag begins; its size follows when it is written. */
static void begin_tag(icc_profile *p, int index, const char *name)
{
    while (p->size % 4)
        put_number(p, 0, 1);
    size_t end = p->size;
    p->size = 132 + 12 * (size_t)index;
    put_text(p, name);
    put_number(p, (uint32_t)end, 4);
    p->size = end;
}

static void end_tag(icc_profile *p, int index)
{
    size_t end = p->size, at = 132 + 12 * (size_t)index;
    size_t begin = (size_t)p->bytes[at + 6] << 8 | p->bytes[at + 7];
    p->size = at + 8;
    put_number(p, (uint32_t)(end - begin), 4);
    p->size = end;
}

static void put_header(icc_profile *p, int version, const char *colour)
{
    p->size = 8;
    put_number(p, (uint32_t)version, 1);
    p->size = 12;
    put_text(p, "mntr");
    put_text(p, colour);
    put_text(p, "XYZ ");
    p->size = 36;
    put_text(p, "acsp");
    p->size = 128;
}

icc_profile icc_profile_make(int version, const char *name, const char *colour, const double colorant[3][3],
                             const icc_curve *curve)
{
    static const char *const curve_tag[] = {"rTRC", "gTRC", "bTRC"}, *const colorant_tag[] = {"rXYZ", "gXYZ", "bXYZ"};
    icc_profile p = {.size = 0};
    bool is_grey = strcmp(colour, "GRAY") == 0;
    int curves = is_grey ? 1 : 3, tags = 1 + curves + (colorant ? 3 : 0), tag = 0;
    put_header(&p, version, colour);
    put_number(&p, (uint32_t)tags, 4);
    p.size = 132 + 12 * (size_t)tags;
    begin_tag(&p, tag, "desc");
    put_name(&p, version, name);
    end_tag(&p, tag++);
    for (int i = 0; i < curves; i++) {
        begin_tag(&p, tag, is_grey ? "kTRC" : curve_tag[i]);
        put_curve(&p, curve);
        end_tag(&p, tag++);
    }
    for (int i = 0; colorant && i < 3; i++) {
        begin_tag(&p, tag, colorant_tag[i]);
        put_text(&p, "XYZ ");
        put_number(&p, 0, 4);
        for (int axis = 0; axis < 3; axis++)
            put_fixed(&p, colorant[i][axis]);
        end_tag(&p, tag++);
    }
    size_t size = p.size;
    p.size = 0;
    put_number(&p, (uint32_t)size, 4);
    p.size = size;
    return p;
}
