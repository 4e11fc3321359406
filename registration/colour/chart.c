#include "registration/colour/chart.h"

#include "registration/colour/difference.h"

#include <stddef.h>

const char *const weft_chart_word[] = {"classic", "classic-2005", "sg", NULL};

const char *const weft_chart_patch_name[WEFT_CHART_PATCHES] = {
    "dark skin", "light skin",    "blue sky",     "foliage",   "blue flower",  "bluish green",
    "orange",    "purplish blue", "moderate red", "purple",    "yellow green", "orange yellow",
    "blue",      "green",         "red",          "yellow",    "magenta",      "cyan",
    "white",     "neutral 8",     "neutral 6.5",  "neutral 5", "neutral 3.5",  "black"};

/* X-Rite, "New color specifications for ColorChecker SG and Classic charts" (2016), and the values of 2005 before it.
 * Those of the SG are E2 to J2, E3 to J3 and so on of X-Rite's list for charts of before November 2014. */
static const double lab_d50[][WEFT_CHART_PATCHES][3] = {
    {{37.54, 14.37, 14.92},  {64.66, 19.27, 17.50},   {49.32, -3.82, -22.54}, {43.46, -12.74, 22.72},
     {54.94, 9.61, -24.79},  {70.48, -32.26, -0.37},  {62.73, 35.83, 56.50},  {39.43, 10.75, -45.17},
     {50.57, 48.64, 16.67},  {30.10, 22.54, -20.87},  {71.77, -24.13, 58.19}, {71.51, 18.24, 67.37},
     {28.37, 15.42, -49.80}, {54.38, -39.72, 32.27},  {42.43, 51.05, 28.62},  {81.80, 2.67, 80.41},
     {50.63, 51.28, -14.12}, {49.57, -29.71, -28.32}, {95.19, -1.03, 2.93},   {81.29, -0.57, 0.44},
     {66.89, -0.75, -0.06},  {50.76, -0.13, 0.14},    {35.63, -0.46, -0.48},  {20.64, 0.07, -0.46}},
    {{37.986, 13.555, 14.059},  {65.711, 18.130, 17.810},   {49.927, -4.880, -21.925}, {43.139, -13.095, 21.905},
     {55.112, 8.844, -25.399},  {70.719, -33.397, -0.199},  {62.661, 36.067, 57.096},  {40.020, 10.410, -45.964},
     {51.124, 48.239, 16.248},  {30.325, 22.976, -21.587},  {72.532, -23.709, 57.255}, {71.941, 19.363, 67.857},
     {28.778, 14.179, -50.297}, {55.261, -38.342, 31.370},  {42.101, 53.378, 28.190},  {81.733, 4.039, 79.819},
     {51.935, 49.986, -14.574}, {51.038, -28.631, -28.638}, {96.539, -0.425, 1.186},   {81.257, -0.638, -0.335},
     {66.766, -0.734, -0.504},  {50.867, -0.153, -0.270},   {35.656, -0.421, -1.231},  {20.461, -0.079, -0.973}},
    {{31.91, 18.62, 21.99},  {63.42, 20.19, 19.22},   {46.37, -5.09, -24.46}, {38.18, -16.99, 30.87},
     {51.56, 9.16, -26.88},  {68.93, -34.58, -0.34},  {60.74, 38.66, 70.97},  {34.94, 11.64, -50.70},
     {47.08, 52.97, 20.49},  {21.31, 29.14, -27.51},  {70.83, -24.26, 64.77}, {69.65, 20.09, 78.57},
     {19.35, 22.23, -58.86}, {52.03, -44.15, 39.04},  {36.04, 64.92, 38.51},  {80.57, 3.85, 89.61},
     {48.06, 55.33, -15.61}, {47.79, -33.18, -30.21}, {96.52, -0.91, 0.62},   {79.43, 0.29, -0.17},
     {65.05, 0.00, -0.32},   {49.71, -0.20, 0.03},    {35.26, -0.09, -0.24},  {15.94, -0.42, -1.20}}};

weft_chart_layout weft_chart_layout_of(weft_chart_kind kind)
{
    return kind == WEFT_CHART_SG ? (weft_chart_layout){14, 10, 4, 1}
                                 : (weft_chart_layout){WEFT_CHART_COLUMNS, WEFT_CHART_ROWS, 0, 0};
}

weft_chart_colours weft_chart_reference(weft_chart_kind kind)
{
    weft_chart_colours reference;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        weft_linear_srgb_of_lab_d50(lab_d50[kind][i], reference.rgb[i]);
    return reference;
}
