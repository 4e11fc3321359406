/* A photograph of a colour chart as a camera with a spectrum would take it, made without anything of the program but
 * its pictures. */
#ifndef WEFT_TESTS_SUPPORT_CHART_PICTURE_H
#define WEFT_TESTS_SUPPORT_CHART_PICTURE_H

#include "base/picture/image.h"
#include "tests/support/spectral_colour.h"

enum { CHART_PICTURE_PATCHES = 24 };

typedef struct chart_picture {
    int width, height;
    double corner[4][2]; /* pixels: top left, top right, bottom right and bottom left of the 6 x 4 cells */
    const spectral_camera *camera;
    const spectral_lamp *lamp;
    double exposure;     /* value of a perfect white diffuser in the middle, in the brightest channel */
    double fall;         /* share of the lamp's light that is lost from the left end of the chart to the right one */
    double vignetting;   /* share that is lost in the corners of the picture */
    double noise;        /* standard deviation at the value 1; less in the dark, as of shot noise */
    int covered_columns; /* of the chart, from the right, that lie under a leaf */
    int stained_patch;   /* half of it glares; -1: none */
    unsigned seed;
} chart_picture;

/* An upright chart that fills most of a picture of 540 x 360 pixels, seen a little from the side, under the first lamp
 * by the first camera. */
chart_picture chart_picture_usual(void);

/* CIE L*, a*, b* under D50 of ColorChecker Classic, November 2014, patch by row. */
void chart_picture_lab_d50(int patch, double lab[3]);

/* Linear values. The caller frees with weft_image_free. */
weft_image chart_picture_render(const chart_picture *picture);

/* Writes values through a tone curve of 8 bits and an S in it, as cameras write JPEG; clipped at 1. */
void chart_picture_write_jpeg(const chart_picture *picture, const char *path);

/* Writes linear half floats. */
void chart_picture_write_exr(const chart_picture *picture, const char *path);

#endif
