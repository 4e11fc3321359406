/* Evaluates and filters a material in somebody else's program: a row of pixels on a plane, seen ever more obliquely.
 *
 *     cc evaluate.c $(pkg-config --cflags --libs weft) -lm -o evaluate && ./evaluate cloth.weft */
#include <weft/weft.h>

#include <math.h>
#include <stdio.h>

enum { PIXELS = 8 };

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: evaluate NAME.weft\n");
        return WEFT_BAD_USAGE;
    }
    weft_error error = {0};
    weft_model *model;
    if (weft_model_open(argv[1], NULL, &model, &error) != WEFT_OK) {
        fprintf(stderr, "%s\n", error.message);
        return (int)weft_class_of(error.code);
    }
    double uv[PIXELS][2], level[PIXELS], light[PIXELS][3], view[PIXELS][3], brdf[PIXELS][3];
    for (int i = 0; i < PIXELS; i++) {
        double theta = 1.4 * i / PIXELS;                   /* of the view, radians from the normal */
        double pixel[4] = {0.01, 0, 0, 0.01 / cos(theta)}; /* du/dx, dv/dx, du/dy, dv/dy: longer where it is oblique */
        uv[i][0] = uv[i][1] = 0.1 * i;
        level[i] = weft_model_level_of_footprint(model, pixel);
        light[i][0] = 0, light[i][1] = 0.6, light[i][2] = 0.8;
        view[i][0] = 0, view[i][1] = -sin(theta), view[i][2] = cos(theta);
    }
    weft_code code = weft_evaluate(model, PIXELS, *uv, level, *light, *view, *brdf, &error);
    for (int i = 0; code == WEFT_OK && i < PIXELS; i++)
        printf("u,v %.1f,%.1f level %.2f: %.5f %.5f %.5f 1/sr\n", uv[i][0], uv[i][1], level[i], brdf[i][0], brdf[i][1],
               brdf[i][2]);
    if (code != WEFT_OK)
        fprintf(stderr, "%s\n", error.message);
    weft_model_close(model);
    return (int)weft_class_of(code);
}
