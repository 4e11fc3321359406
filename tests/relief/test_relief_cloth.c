/* Heights of simulated cloth against the surface of its yarns, which the estimate never sees. The floors are those of
 * held-out views. Not independent: the renderer of the photographs is Weft's own; test_relief.c has one that is not. */
#include "btf/direction/direction.h"
#include "geometry/acquisition/acquisition.h"
#include "geometry/stitch/stitch.h"
#include "relief/relief.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 20, HEIGHT = 16, DIRECTIONS = 55 };

typedef struct cloth {
    weft_stitch stitch;
    weft_tile_mesh mesh;
} cloth;

static cloth knit;

/* Rings up to 75 degrees, of twelve directions at most. */
static weft_vec3 direction_number(int i)
{
    static const int first[6] = {0, 1, 7, 19, 31, 43}, count[6] = {1, 6, 12, 12, 12, 12};
    int ring = 5;
    while (i < first[ring])
        ring--;
    double phi_deg = 360.0 * (i - first[ring]) / count[ring] + 7 * ring;
    return weft_direction_of_angles(
        (weft_angles){weft_rad_of_deg(15 * ring), weft_rad_of_deg(remainder(phi_deg, 360))});
}

static void simulate(const char *path)
{
    const weft_acquisition_options options = {.width = WIDTH, .height = HEIGHT, .bounces = 0, .noise = 0.05, .seed = 1};
    weft_vec3 direction[DIRECTIONS];
    weft_acquisition_report report;
    weft_error error = {0};
    for (int i = 0; i < DIRECTIONS; i++)
        direction[i] = direction_number(i);
    expect_ok(weft_stitch_read(WEFT_ASSETS "/stitches/plain_knit.stitch", &knit.stitch, &error), &error);
    expect_ok(weft_tile_mesh_create(&knit.stitch, 40, "plain_knit", &knit.mesh, &error), &error);
    expect_ok(weft_acquire(&knit.stitch, &knit.mesh, direction, DIRECTIONS, &options, path, NULL, &report, &error),
              &error);
}

/* ---- The true surface ---- */

/* Height of a triangle above (x, y); -INFINITY beside it. */
static double height_of_triangle(const cloth *c, int triangle, double x, double y)
{
    const uint32_t *corner = c->mesh.triangle[triangle];
    const float *a = c->mesh.position[corner[0]], *b = c->mesh.position[corner[1]], *d = c->mesh.position[corner[2]];
    double bx = b[0] - a[0], by = b[1] - a[1], dx = d[0] - a[0], dy = d[1] - a[1], area = bx * dy - by * dx;
    double v = ((x - a[0]) * dy - (y - a[1]) * dx) / area, w = (bx * (y - a[1]) - by * (x - a[0])) / area;
    if (!(fabs(area) > 1e-12) || v < 0 || w < 0 || v + w > 1)
        return -INFINITY;
    return a[2] + v * (b[2] - a[2]) + w * (d[2] - a[2]);
}

/* The highest point above every place of a grid, below the top of the mesh; -INFINITY in a hole. */
static double *true_heights(const cloth *c, int width, int height)
{
    double *result = malloc((size_t)width * (size_t)height * sizeof *result);
    assert_non_null(result);
    for (int i = 0; i < width * height; i++) {
        double x = (i % width + 0.5) / width * c->mesh.width;
        double y = c->mesh.height - (i / width + 0.5) / height * c->mesh.height;
        result[i] = -INFINITY;
        for (int t = 0; t < c->mesh.triangle_count; t++)
            result[i] = fmax(result[i], height_of_triangle(c, t, x, y) - c->mesh.top);
    }
    return result;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_error(const weft_relief_report *report)
{
    double *truth = true_heights(&knit, report->width, report->height);
    int count = 0;
    for (int i = 0; i < report->width * report->height; i++)
        if (isfinite(truth[i]))
            truth[count++] = fabs((double)report->height_mm_of[i] - truth[i]);
    qsort(truth, (size_t)count, sizeof *truth, compare_doubles);
    double median = truth[count / 2];
    free(truth);
    return median;
}

static void a_knit_has_the_heights_of_its_yarns(void **state)
{
    (void)state;
    const weft_relief_options options = {0};
    weft_relief_report report;
    weft_dataset *dataset;
    weft_error error = {0};
    simulate("knit.btf.h5");
    expect_ok(weft_dataset_open("knit.btf.h5", &dataset, &error), &error);
    expect_ok(weft_relief_estimate(dataset, &options, NULL, &report, &error), &error);
    weft_dataset_close(dataset);
    double median = median_error(&report);
    print_message("median error %.4f mm; relief / plane %.3f, relief / flat %.3f\n", median,
                  report.error.heights / report.error.plane, report.error.heights / report.error.flat);
    assert_int_equal(report.verdict, WEFT_RELIEF_HEIGHTS);
    assert_true(median < 0.035);
    assert_true(report.error.heights <= 0.82 * report.error.plane);
    assert_true(report.error.heights <= 0.60 * report.error.flat);
    weft_relief_report_free(&report);
    weft_tile_mesh_free(&knit.mesh);
    weft_stitch_free(&knit.stitch);
}

int test_relief_cloth(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_knit_has_the_heights_of_its_yarns)};
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
