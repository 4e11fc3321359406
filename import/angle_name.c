#include "import/angle_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ANGLE_COUNT = 4 };

static const char digits[] = "0123456789", separators[] = " _-";

/* A word like "tl030" or "pv7.5". */
static bool parse_word(const char *word, double angle_deg[ANGLE_COUNT], bool found[ANGLE_COUNT])
{
    static const char *const prefix[ANGLE_COUNT] = {"tl", "pl", "tv", "pv"};
    for (int i = 0; i < ANGLE_COUNT; i++) {
        if (strncasecmp(word, prefix[i], 2) != 0 || strspn(word + 2, "0123456789.") != strlen(word + 2))
            continue;
        char *end;
        double value = strtod(word + 2, &end);
        if (end == word + 2 || *end)
            return true;
        if (found[i])
            return false;
        angle_deg[i] = value;
        found[i] = true;
    }
    return true;
}

/* The name without folders and extension, in `text`; false where it is too long. */
static bool copy_stem(const char *name, char text[256])
{
    const char *slash = strrchr(name, '/');
    int length = snprintf(text, 256, "%s", slash ? slash + 1 : name);
    char *dot = strrchr(text, '.');
    if (dot)
        *dot = 0;
    return length >= 0 && length < 256;
}

bool weft_angle_name_parse(const char *name, weft_named_angles *angles)
{
    char text[256];
    if (!copy_stem(name, text))
        return false;
    double angle_deg[ANGLE_COUNT] = {0};
    bool found[ANGLE_COUNT] = {false};
    for (char *rest = text; rest;) {
        if (!parse_word(strsep(&rest, separators), angle_deg, found))
            return false;
    }
    if (!(found[0] && found[1] && found[2] && found[3]))
        return false;
    angles->light = (weft_angles){weft_rad_of_deg(angle_deg[0]), weft_rad_of_deg(angle_deg[1])};
    angles->view = (weft_angles){weft_rad_of_deg(angle_deg[2]), weft_rad_of_deg(angle_deg[3])};
    return true;
}

static bool is_digits(const char *word)
{
    return *word && strspn(word, digits) == strlen(word);
}

const char *weft_angle_name_doubt(const char *name)
{
    char text[256];
    if (!copy_stem(name, text))
        return NULL;
    bool follows_angle = false, follows_decimals = false;
    for (char *rest = text; rest;) {
        double angle_deg[ANGLE_COUNT];
        bool found[ANGLE_COUNT] = {false};
        const char *word = strsep(&rest, separators);
        parse_word(word, angle_deg, found);
        bool is_angle = found[0] || found[1] || found[2] || found[3];
        if (is_angle && is_digits(word + 2) && strlen(word + 2) > 3)
            return "four digits and more are degrees or tenths of them: write a point, as tl023.5, or a directions.csv";
        if (is_angle && follows_decimals)
            return "a number between two angles may be decimals: write a point, as tl023.5, or a directions.csv";
        follows_decimals = follows_angle && is_digits(word);
        follows_angle = is_angle;
    }
    return NULL;
}

void weft_angle_name_write(const weft_named_angles *angles, char name[64])
{
    snprintf(name, 64, "tl%03.0f_pl%03.0f_tv%03.0f_pv%03.0f", weft_deg_of_rad(angles->light.theta_rad),
             weft_deg_of_rad(angles->light.phi_rad), weft_deg_of_rad(angles->view.theta_rad),
             weft_deg_of_rad(angles->view.phi_rad));
}
