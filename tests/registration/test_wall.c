#include "registration/pose/refine.h"

#include "base/picture/image.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* A real wall photographed twice (the graffiti of Mikolajczyk & Schmid 2005): the first photograph is the drawing, the
 * second is registered to it. */

enum { SIDE = 800 };

/* graf/H1to3p.xml: pixels of the first photograph to pixels of the third. */
static const weft_homography published = {{{7.6285898e-01, -2.9922929e-01, 2.2567123e+02},
                                           {3.3443473e-01, 1.0143901e+00, -7.6999973e+01},
                                           {3.4663091e-04, -1.4364524e-05, 1.0}}};

static weft_image wall, other;

static int read_photographs(void **state)
{
    (void)state;
    return weft_image_read(WEFT_SHARED "/real/graf/graf1.png", &wall, NULL, NULL) == WEFT_OK &&
                   weft_image_read(WEFT_SHARED "/real/graf/graf3.png", &other, NULL, NULL) == WEFT_OK &&
                   wall.width <= SIDE && wall.height <= SIDE
               ? 0
               : -1;
}

static int free_photographs(void **state)
{
    (void)state;
    weft_image_free(&wall);
    weft_image_free(&other);
    return 0;
}

static float grey(const weft_image *image, int x, int y)
{
    const float *p = image->pixels + 3 * ((long)y * image->width + x);
    return (p[0] + p[1] + p[2]) / 3;
}

/* A drawing of one cell a pixel; cell (column, row) is the pixel of the same place, what is beyond the picture
 * excluded. */
static void draw_wall(weft_drawing *drawing)
{
    size_t stride = SIDE + 1;
    *drawing = (weft_drawing){.side = SIDE, .cell_mm = 1, .half_mm = SIDE / 2.0};
    drawing->reflectance = calloc((size_t)SIDE * SIDE, sizeof *drawing->reflectance);
    drawing->sums = calloc(stride * stride, sizeof *drawing->sums);
    assert_true(drawing->reflectance && drawing->sums);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            bool inside = x < wall.width && y < wall.height;
            uint32_t(*sum)[2] = drawing->sums + ((size_t)y + 1) * stride + (size_t)x + 1;
            drawing->reflectance[y * SIDE + x] = inside ? grey(&wall, x, y) : 0;
            for (int k = 0; k < 2; k++)
                sum[0][k] = sum[-1][k] + sum[-(long)stride][k] - sum[-(long)stride - 1][k] + (k == 0 || !inside);
        }
    }
}

static void look(weft_sight *sight)
{
    sight->camera = (weft_camera){.width = other.width, .height = other.height, .fx = 800, .fy = 800};
    sight->camera.cx = other.width / 2.0;
    sight->camera.cy = other.height / 2.0;
    sight->opening_mm = 400;
    draw_wall(&sight->drawing);
    sight->undistorted = malloc((size_t)other.width * (size_t)other.height * sizeof *sight->undistorted);
    assert_non_null(sight->undistorted);
    for (int i = 0; i < other.width * other.height; i++) {
        sight->undistorted[i][0] = (float)(i % other.width);
        sight->undistorted[i][1] = (float)(i / other.width);
    }
}

/* From the drawing's mm (the pixel p of the wall lies at p + 1/2 - half) to the other photograph. */
static weft_homography of_drawing(const weft_homography *of_pixels)
{
    weft_homography h = *of_pixels;
    for (int row = 0; row < 3; row++)
        h.m[row][2] += (h.m[row][0] + h.m[row][1]) * (SIDE / 2.0 - 0.5);
    return h;
}

/* RMS distance between two maps over the part of the wall that the other photograph shows, pixels. */
static double distance_px(const weft_homography *a, const weft_homography *b)
{
    double sum = 0;
    int count = 0;
    for (int y = 0; y < wall.height; y += 20) {
        for (int x = 0; x < wall.width; x += 20) {
            double u = x + 0.5 - SIDE / 2.0, v = y + 0.5 - SIDE / 2.0;
            weft_pixel p = weft_homography_apply(a, u, v), q = weft_homography_apply(b, u, v);
            if (p.x < 0 || p.y < 0 || p.x >= other.width || p.y >= other.height)
                continue;
            sum += (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
            count++;
        }
    }
    return sqrt(sum / count);
}

static void the_published_homography_is_recovered_from_a_start_six_pixels_off(void **state)
{
    (void)state;
    weft_sight sight = {0};
    look(&sight);
    float *picture = malloc((size_t)other.width * (size_t)other.height * sizeof *picture);
    assert_non_null(picture);
    for (int i = 0; i < other.width * other.height; i++)
        picture[i] = grey(&other, i % other.width, i / other.width);
    weft_homography truth = of_drawing(&published), off = published;
    off.m[0][2] += 5;
    off.m[1][2] -= 4;
    off.m[0][0] *= 1.004;
    weft_refinement refinement = {.homography = of_drawing(&off)};
    double start = distance_px(&truth, &refinement.homography);
    const double blur[] = {6, 2, 0};
    for (int i = 0; i < 3; i++)
        assert_int_equal(weft_refinement_run(&sight, picture, blur[i], &refinement, NULL), WEFT_OK);
    double end = distance_px(&truth, &refinement.homography);
    print_message("from %.2f to %.3f pixels of the published map, correlation %.4f\n", start, end,
                  refinement.correlation);
    assert_true(start > 5);
    assert_true(end < 1);
    assert_true(refinement.correlation > 0.8);
    free(picture);
    weft_sight_free(&sight);
}

int test_wall(void)
{
    if (access(WEFT_SHARED "/real/graf/graf1.png", R_OK) != 0) {
        puts("skipped: the photographs of the wall are not there");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_published_homography_is_recovered_from_a_start_six_pixels_off),
    };
    return cmocka_run_group_tests(tests, read_photographs, free_photographs);
}
