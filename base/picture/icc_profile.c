#include "base/picture/icc_profile.h"

#include <math.h>
#include <string.h>

enum { HEADER_BYTES = 128, ENTRY_BYTES = 12, MOST_TAGS = 200 };

/* A part of the profile; size 0: there is none. */
typedef struct part {
    const uint8_t *bytes;
    size_t size;
} part;

static uint32_t number_of(const uint8_t *bytes, int count)
{
    uint32_t value = 0;
    for (int i = 0; i < count; i++)
        value = value << 8 | bytes[i];
    return value;
}

/* s15Fixed16Number */
static double fixed_of(const uint8_t *bytes)
{
    return (double)(int32_t)number_of(bytes, 4) / 65536;
}

static bool begins(part p, const char *type)
{
    return p.size >= 12 && memcmp(p.bytes, type, 4) == 0;
}

static part find(part profile, const char *tag)
{
    uint32_t count = number_of(profile.bytes + HEADER_BYTES, 4);
    for (size_t i = 0; i < count && i < MOST_TAGS; i++) {
        size_t at = HEADER_BYTES + 4 + ENTRY_BYTES * i;
        if (at + ENTRY_BYTES > profile.size)
            break;
        const uint8_t *entry = profile.bytes + at;
        size_t offset = number_of(entry + 4, 4), size = number_of(entry + 8, 4);
        if (memcmp(entry, tag, 4) == 0 && offset <= profile.size && size <= profile.size - offset)
            return (part){profile.bytes + offset, size};
    }
    return (part){0};
}

/* ---- Name ---- */

/* Every `step`th byte, as far as it is printable. */
static void copy_name(part text, size_t step, char *name, size_t room)
{
    size_t length = 0;
    for (size_t i = step - 1; i < text.size && length + 1 < room && text.bytes[i] != 0; i += step)
        name[length++] =
            text.bytes[i] >= 0x20 && text.bytes[i] < 0x7f && text.bytes[i] != '\'' ? (char)text.bytes[i] : '?';
    name[length] = 0;
}

/* Of version 2 a text of ASCII, of version 4 one of UTF-16 in the first language. */
static void read_name(part profile, weft_colour_space *space)
{
    part p = find(profile, "desc");
    if (begins(p, "desc"))
        copy_name((part){p.bytes + 12, p.size - 12}, 1, space->name, sizeof space->name);
    if (!begins(p, "mluc") || p.size < 28)
        return;
    size_t size = number_of(p.bytes + 20, 4), offset = number_of(p.bytes + 24, 4);
    if (offset <= p.size && size <= p.size - offset)
        copy_name((part){p.bytes + offset, size}, 2, space->name, sizeof space->name);
}

/* ---- Curves ---- */

/* How many numbers the five kinds of formula have: gamma a b c d e f, as far as they go. */
static const int formula_numbers[] = {1, 3, 4, 5, 7};

static bool read_formula(part p, weft_curve *curve)
{
    uint32_t kind = number_of(p.bytes + 8, 2);
    if (kind > 4 || p.size < 12 + 4 * (size_t)formula_numbers[kind])
        return false;
    double number[7] = {1, 1, 0, 0, 0, 0, 0};
    for (int i = 0; i < formula_numbers[kind]; i++)
        number[i] = fixed_of(p.bytes + 12 + 4 * (size_t)i);
    *curve = (weft_curve){.kind = WEFT_CURVE_FORMULA, .gamma = number[0], .a = number[1], .b = number[2]};
    if (kind == 2)
        curve->e = curve->f = number[3];
    if (kind == 1 || kind == 2)
        curve->d = curve->a > 0 ? -curve->b / curve->a : 0;
    if (kind >= 3) {
        curve->c = number[3];
        curve->d = number[4];
        curve->e = number[5];
        curve->f = number[6];
    }
    return curve->gamma > 0;
}

static bool read_table(part p, uint32_t count, weft_curve *curve)
{
    if (count > (p.size - 12) / 2)
        return false;
    curve->kind = WEFT_CURVE_TABLE;
    curve->count = count < WEFT_CURVE_STEPS ? (int)count : WEFT_CURVE_STEPS;
    for (int i = 0; i < curve->count; i++) {
        double place = (double)i / (curve->count - 1) * (count - 1);
        size_t below = (size_t)fmin(place, count - 2);
        double low = number_of(p.bytes + 12 + 2 * below, 2), high = number_of(p.bytes + 14 + 2 * below, 2);
        curve->table[i] = (float)((low + (place - (double)below) * (high - low)) / 65535);
    }
    return true;
}

static bool read_curve(part profile, const char *tag, weft_curve *curve)
{
    part p = find(profile, tag);
    memset(curve, 0, sizeof *curve);
    if (begins(p, "para"))
        return read_formula(p, curve);
    if (!begins(p, "curv"))
        return false;
    uint32_t count = number_of(p.bytes + 8, 4);
    if (count == 0)
        return true;
    if (count > 1)
        return read_table(p, count, curve);
    *curve = (weft_curve){.kind = WEFT_CURVE_FORMULA, .a = 1};
    curve->gamma = p.size >= 14 ? number_of(p.bytes + 12, 2) / 256.0 : 0;
    if (curve->gamma == 1)
        curve->kind = WEFT_CURVE_LINEAR;
    return curve->gamma > 0;
}

/* ---- Spaces ---- */

static bool read_colorants(part profile, weft_colour_space *space)
{
    static const char *const tag[] = {"rXYZ", "gXYZ", "bXYZ"};
    weft_colorants colorants;
    for (int i = 0; i < 3; i++) {
        part p = find(profile, tag[i]);
        if (!begins(p, "XYZ ") || p.size < 20)
            return false;
        for (int axis = 0; axis < 3; axis++)
            colorants.xyz[i][axis] = fixed_of(p.bytes + 8 + 4 * (size_t)axis);
    }
    return weft_colour_space_of_colorants(&colorants, space);
}

static bool read_space(part profile, weft_colour_space *space)
{
    static const char *const colour[] = {"rTRC", "gTRC", "bTRC"}, *const grey[] = {"kTRC", "kTRC", "kTRC"};
    bool is_grey = memcmp(profile.bytes + 16, "GRAY", 4) == 0;
    if (is_grey)
        weft_colour_space_make_grey(space);
    else if (memcmp(profile.bytes + 16, "RGB ", 4) != 0 || !read_colorants(profile, space))
        return false;
    for (int c = 0; c < 3; c++) {
        if (!read_curve(profile, is_grey ? grey[c] : colour[c], &space->curve[c]))
            return false;
    }
    weft_colour_space_round(space);
    return true;
}

bool weft_icc_profile_read(const uint8_t *bytes, size_t size, weft_colour_space *space)
{
    memset(space, 0, sizeof *space);
    part profile = {bytes, size};
    if (size < HEADER_BYTES + 4)
        return false;
    bool is_read = read_space(profile, space);
    read_name(profile, space);
    return is_read;
}
