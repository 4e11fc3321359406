#include "registration/photographs/steps.h"

#include "registration/pose/refine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { reduced_side = 1600 };
static const double least_correlation = 0.9;

/* Standard deviation of the point spread, in reduced pixels, from which a photograph is blurred. */
static const double blurred_px = 2;

/* Pixel centres: the centre of a reduced pixel lies amid those that it averages. */
static weft_camera reduced_camera(const weft_camera *camera, int reduction)
{
    weft_camera small = *camera;
    double middle = (reduction - 1) / 2.0;
    small.width = camera->width / reduction, small.height = camera->height / reduction;
    small.fx /= reduction, small.fy /= reduction;
    small.cx = (camera->cx - middle) / reduction, small.cy = (camera->cy - middle) / reduction;
    return small;
}

weft_code weft_reduced_sight_create(const weft_camera *camera, const weft_target *target, double pixels_per_mm,
                                    weft_reduced_sight *reduced, weft_error *error)
{
    int side = camera->width > camera->height ? camera->width : camera->height;
    reduced->reduction = (side + reduced_side - 1) / reduced_side;
    weft_camera small = reduced_camera(camera, reduced->reduction);
    return weft_sight_create(&small, target, pixels_per_mm / reduced->reduction, &reduced->sight, error);
}

void weft_reduced_sight_free(weft_reduced_sight *reduced)
{
    weft_sight_free(&reduced->sight);
}

static float *reduce(const weft_light_values *values, const weft_camera *small, int reduction)
{
    float *picture = malloc((size_t)small->width * (size_t)small->height * sizeof *picture);
    for (int y = 0; picture && y < small->height; y++) {
        for (int x = 0; x < small->width; x++) {
            float sum = 0;
            for (int i = 0; i < reduction * reduction; i++)
                sum +=
                    values->grey[(long)(y * reduction + i / reduction) * values->width + x * reduction + i % reduction];
            picture[(long)y * small->width + x] = sum / (float)(reduction * reduction);
        }
    }
    return picture;
}

/* Homographies of the full and of the reduced photograph differ by a map of the pixels. */
static weft_homography scaled(const weft_homography *homography, double factor, double shift)
{
    weft_homography result = *homography;
    for (int row = 0; row < 2; row++)
        for (int column = 0; column < 3; column++)
            result.m[row][column] = factor * homography->m[row][column] + shift * homography->m[2][column];
    return result;
}

static void take(const weft_refinement *refinement, int reduction, weft_photographs_photograph *p)
{
    double middle = (reduction - 1) / 2.0, pixels = (double)reduction * reduction;
    p->correlation = refinement->correlation;
    p->uncertainty_mm = refinement->uncertainty_mm;
    if (!(refinement->correlation >= least_correlation))
        snprintf(p->remark, sizeof p->remark,
                 "it looks unlike the drawing of the target (correlation %.2f, below %.2f): it is %s",
                 refinement->correlation, least_correlation,
                 sqrt(refinement->point_spread.constant) > blurred_px ? "blurred" : "covered in part");
    else if (!refinement->converged)
        snprintf(p->remark, sizeof p->remark, "its pose did not settle in %d steps", refinement->iterations);
    p->homography = scaled(&refinement->homography, reduction, middle);
    p->point_spread =
        (weft_point_spread){refinement->point_spread.constant * pixels, refinement->point_spread.depth * pixels};
}

weft_code weft_photographs_pose_refine(const weft_reduced_sight *reduced, const weft_camera *camera,
                                       const weft_light_values *values, weft_photographs_photograph *photograph,
                                       weft_error *error)
{
    int reduction = reduced->reduction;
    double middle = (reduction - 1) / 2.0;
    weft_homography start = weft_homography_of_pose(camera, &photograph->pose);
    weft_refinement refinement = {.homography = scaled(&start, 1.0 / reduction, -middle / reduction),
                                  .point_spread = {0.2, 0}};
    float *picture = reduce(values, &reduced->sight.camera, reduction);
    if (!picture)
        return weft_fail_memory(error, "a reduced photograph", 4ull * reduced_side * reduced_side);
    weft_code code = weft_refinement_run(&reduced->sight, picture, 0, &refinement, error);
    if (code == WEFT_OK)
        take(&refinement, reduction, photograph);
    free(picture);
    return code;
}
