#include "registration/pose/markers.h"

#include "registration/pose/opencv_bridge.h"

#include <math.h>
#include <stdlib.h>

enum { front_side = 720 };

static const double ransac_reach_px = 1.5;

static double front_mm_per_pixel(const weft_target *target)
{
    return 2.1 * weft_target_radius_mm(target) / front_side;
}

static weft_pixel plate_of_front(const weft_target *target, double column, double row)
{
    double scale = front_mm_per_pixel(target), middle = (front_side - 1) / 2.0;
    return (weft_pixel){(column - middle) * scale, (middle - row) * scale};
}

/* Bilinear; 0 outside and where a neighbour is unknown. */
static float sample_at(const float *photograph, int width, int height, weft_pixel at)
{
    if (!(at.x >= 0 && at.y >= 0 && at.x < width - 1 && at.y < height - 1))
        return 0;
    int x = (int)at.x, y = (int)at.y;
    double u = at.x - x, v = at.y - y;
    const float *p = photograph + (long)y * width + x;
    double value = (1 - v) * ((1 - u) * p[0] + u * p[1]) + v * ((1 - u) * p[width] + u * p[width + 1]);
    return isfinite(value) ? (float)value : 0;
}

static void draw_front(const weft_sight *sight, const weft_target *target, const float *photograph,
                       const weft_homography *predicted, float *front)
{
#pragma omp parallel for schedule(static)
    for (int row = 0; row < front_side; row++) {
        for (int column = 0; column < front_side; column++) {
            weft_pixel plate = plate_of_front(target, column, row);
            weft_pixel seen = weft_camera_distort(&sight->camera, weft_homography_apply(predicted, plate.x, plate.y));
            front[row * front_side + column] = sample_at(photograph, sight->camera.width, sight->camera.height, seen);
        }
    }
}

/* Grey values by the square root, white at twice the mean: the plate is half dark. */
static void expose_front(const float *front, uint8_t *grey)
{
    double sum = 0;
    for (int i = 0; i < front_side * front_side; i++)
        sum += front[i] > 0 ? front[i] : 0;
    double white = 2 * sum / (front_side * front_side);
    for (int i = 0; i < front_side * front_side; i++) {
        double value = white > 0 && front[i] > 0 ? 255 * sqrt(front[i] / white) : 0;
        grey[i] = (uint8_t)(value < 255 ? value : 255);
    }
}

/* Fills the corners of the target's own markers, on the plate (mm) and in the photograph (undistorted pixels). */
static int pair_corners(const weft_target *target, const weft_homography *predicted, const weft_marker *marker,
                        int marker_count, double (*plate)[2], double (*seen)[2])
{
    int count = 0;
    for (int i = 0; i < marker_count; i++) {
        if (marker[i].id < 0 || marker[i].id >= WEFT_TARGET_MARKER_COUNT)
            continue;
        weft_rectangle r = weft_target_marker(target, marker[i].id);
        const double outline[4][2] = {{r.x0, r.y1}, {r.x1, r.y1}, {r.x1, r.y0}, {r.x0, r.y0}};
        for (int corner = 0; corner < 4; corner++, count++) {
            const double *front = marker[i].corner[corner];
            weft_pixel predicted_at = plate_of_front(target, front[0], front[1]);
            weft_pixel pixel = weft_homography_apply(predicted, predicted_at.x, predicted_at.y);
            plate[count][0] = outline[corner][0];
            plate[count][1] = outline[corner][1];
            seen[count][0] = pixel.x;
            seen[count][1] = pixel.y;
        }
    }
    return count;
}

static weft_code fit_corners(double (*plate)[2], double (*seen)[2], int count, weft_marker_start *start,
                             weft_error *error)
{
    uint8_t agrees[4 * WEFT_MARKERS_LIMIT] = {0};
    weft_code code = weft_opencv_fit_homography((const double(*)[2])plate, (const double(*)[2])seen, count,
                                                ransac_reach_px, start->homography.m, agrees, error);
    double sum = 0;
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        weft_pixel back = weft_homography_apply(&start->homography, plate[i][0], plate[i][1]);
        if (agrees[i]) {
            sum += (back.x - seen[i][0]) * (back.x - seen[i][0]) + (back.y - seen[i][1]) * (back.y - seen[i][1]);
            start->corners++;
        }
    }
    start->rms_px = start->corners ? sqrt(sum / start->corners) : 0;
    return code == WEFT_BAD_INPUT ? WEFT_OK : code; /* no homography: start->corners stays 0 */
}

weft_code weft_markers_locate(const weft_sight *sight, const weft_target *target, const float *photograph,
                              const weft_homography *predicted, weft_marker_start *start, weft_error *error)
{
    *start = (weft_marker_start){0};
    float *front = malloc(sizeof *front * front_side * front_side);
    uint8_t *grey = malloc(sizeof *grey * front_side * front_side);
    weft_marker marker[WEFT_MARKERS_LIMIT];
    double plate[4 * WEFT_MARKERS_LIMIT][2], seen[4 * WEFT_MARKERS_LIMIT][2];
    weft_code code = WEFT_OK;
    int count = 0;
    if (!front || !grey) {
        code = weft_fail_memory(error, "a front view", 5ull * front_side * front_side);
        goto done;
    }
    draw_front(sight, target, photograph, predicted, front);
    expose_front(front, grey);
    code = weft_opencv_find_markers(NULL, grey, front_side, front_side, marker, WEFT_MARKERS_LIMIT, &count, error);
    if (code != WEFT_OK)
        goto done;
    count = pair_corners(target, predicted, marker, count, plate, seen);
    start->found = count / 4;
    if (start->found >= 2)
        code = fit_corners(plate, seen, count, start, error);
done:
    free(front);
    free(grey);
    return code;
}
