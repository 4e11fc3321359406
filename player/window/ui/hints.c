#include "player/window/ui/ui_bridge.h"

#include <string.h>

typedef struct hint {
    const char *label, *text;
} hint;

static const hint hints[] = {
    /* What is shown */
    {"Raw", "the photographs themselves, interpolated (1)"},
    {"Compressed", "the material that was made of them (2)"},
    {"Analytic", "the weave or the threads of a file (3)"},
    {"Panes", "all that there is, side by side (S)"},
    {"Wipe", "one left, one right of a line that you drag (W)"},
    {"Difference", "the second minus the first, in false colour (X)"},
    /* Light */
    {"Shadows", "what the cloth hides of the light (C)"},
    {"Ground", "a ground below, which takes the shadow"},
    {"Add a light", "another lamp, without a shadow"},
    {"Studio", "soft boxes about the cloth, and a key light"},
    {"Overcast", "a grey sky, brightest above; no key light"},
    {"Sky", "a clear sky and its sun"},
    {"Bare", "one lamp in the dark"},
    {"Environment", "light from all sides (E)"},
    {"Strength", "how bright the environment is"},
    {"Turn", "the environment, about the vertical"},
    {"Height", "of the lamp above the table"},
    {"Around", "where the lamp stands about the vertical"},
    {"Irradiance", "on a surface that faces the lamp: red, green, blue"},
    /* Material */
    {"Components / 4", "fewer components are coarser and drawn faster"},
    {"View table T", "what the lobes lack, by the direction of the eye"},
    {"Light table S", "what the lobes lack, by the direction of the light"},
    /* Weave */
    {"Yarn", "the one that the sliders change"},
    {"Change all yarns like it", "those of the same direction and numbers, too"},
    {"Twist", "of the fibres in the yarn; 0: filament"},
    {"Incline", "largest slope of the yarn where it comes up"},
    {"Curvature", "of its arc: below 0 flat on top, above 0 sharp"},
    {"Uniform", "light that a fibre scatters in all directions"},
    {"Forward", "how narrowly a fibre scatters light forward"},
    {"Fade", "how softly a highlight ends along the yarn"},
    {"Highlight", "width of the highlight, as a share of the segment"},
    {"Width", "of a segment of yarn, in cells"},
    {"Length", "of a segment of yarn, in cells"},
    {"Noise", "no two segments alike"},
    {"Seed", "another throw of the dice"},
    {"Fineness", "bright and dark spots along a segment; 0: none"},
    {"Period", "cells between bends of the yarns; 0: straight"},
    {"Save this weave", "as a .wv file beside the picture"},
    /* Picture */
    {"Drape", "cloth on a round table (D)"},
    {"Ball", "all slopes at once (O)"},
    {"Plane", "flat, as it was photographed (P)"},
    {"Repeats", "how often the material lies across the mesh"},
    {"Trilinear", "far cloth is filtered, between two mip levels (M)"},
    {"Nearest", "far cloth is filtered, by the nearest mip level (M)"},
    {"None", "far cloth is not filtered: it flickers (M)"},
    {"Exposure", "darker, brighter ([ ])"},
    {"Clip", "what is brighter than the screen is white"},
    {"Soft", "highlights keep their colour"},
    {"Auto", "a few neighbours by chance while things move, all of them at rest"},
    {"Exact", "all neighbours in texels and directions"},
    {"Stochastic", "one neighbour by chance: fast, with grain"},
    {"Show levels", "which mip level a pixel takes, in false colour (N)"},
    {"Tint extrapolation", "where no photograph saw that direction (T)"},
};

static const size_t hint_count = sizeof hints / sizeof *hints;

const char *weft_hint_of(const char *label)
{
    for (size_t i = 0; i < hint_count; i++) {
        if (strcmp(hints[i].label, label) == 0)
            return hints[i].text;
    }
    return NULL;
}

const char *weft_hint_at(size_t number, const char **label)
{
    if (number >= hint_count)
        return NULL;
    *label = hints[number].label;
    return hints[number].text;
}
