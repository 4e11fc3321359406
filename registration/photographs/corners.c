#include "registration/photographs/steps.h"

#include "registration/pose/opencv_bridge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { fewest_markers = 3 };

/* How far the distortion of a lens may take a corner from a plane, as a share of the longer side. */
static const double distortion_share = 0.01;

/* ---- Markers ---- */

/* Marker search takes what is clipped as white. */
static weft_code find_markers(const weft_light_values *values, weft_marker *marker, int *count, weft_error *error)
{
    size_t pixels = (size_t)values->width * (size_t)values->height;
    float *grey = malloc(pixels * sizeof *grey);
    if (!grey)
        return weft_fail_memory(error, "a photograph", pixels * sizeof *grey);
    for (size_t i = 0; i < pixels; i++)
        grey[i] = isfinite(values->grey[i]) ? values->grey[i] : 1;
    weft_code code = weft_opencv_find_markers_in_photograph(grey, values->width, values->height, marker,
                                                            WEFT_MARKERS_LIMIT, count, error);
    free(grey);
    return code;
}

/* A marker seen twice is none: one of them is a reflection, or another sheet. */
static bool is_unique(const weft_marker *marker, int count, int index)
{
    for (int i = 0; i < count; i++) {
        if (i != index && marker[i].id == marker[index].id)
            return false;
    }
    return true;
}

static int pair_corners(const weft_target *target, const weft_marker *marker, int marker_count, double (*plate)[2],
                        double (*seen)[2])
{
    int count = 0;
    for (int i = 0; i < marker_count; i++) {
        if (marker[i].id < 0 || marker[i].id >= WEFT_SHEET_MARKER_COUNT || !is_unique(marker, marker_count, i))
            continue;
        weft_rectangle r = weft_target_marker(target, marker[i].id);
        const double outline[4][2] = {{r.x0, r.y1}, {r.x1, r.y1}, {r.x1, r.y0}, {r.x0, r.y0}};
        for (int corner = 0; corner < 4; corner++, count++) {
            for (int axis = 0; axis < 2; axis++) {
                plate[count][axis] = outline[corner][axis];
                seen[count][axis] = marker[i].corner[corner][axis];
            }
        }
    }
    return count;
}

/* Keeps the corners that lie on one plane, but for the distortion of the lens. */
static weft_code keep_plane(const weft_light_values *values, weft_photographs_photograph *p, weft_error *error)
{
    weft_homography homography;
    uint8_t agrees[WEFT_PLATE_CORNERS] = {0};
    double reach = distortion_share * fmax(values->width, values->height);
    weft_code code = weft_opencv_fit_homography((const double(*)[2])p->plate, (const double(*)[2])p->seen,
                                                p->corner_count, reach, homography.m, agrees, error);
    weft_photographs_keep_corners(p, agrees);
    return code == WEFT_BAD_INPUT ? WEFT_OK : code;
}

/* ---- Why a photograph shows no target ---- */

enum { longer_lag = 8 };

static const double darkest_mean = 0.004, clipped_share = 0.5;

/* Of sharp edges the sharpness is 1, of edges as wide as the longer lag and wider 1 / longer_lag. */
static const double least_sharpness = 0.3;

/* Mean squared difference of the square root of light at a lag, which evens out its noise. */
static double difference(const weft_light_values *values, int dx, int dy)
{
    double sum = 0;
    long count = 0;
    int reach = longer_lag;
    for (int y = reach; y < values->height - reach; y += 2) {
        for (int x = reach; x < values->width - reach; x++) {
            float a = values->grey[(long)y * values->width + x],
                  b = values->grey[(long)(y + dy) * values->width + x + dx];
            if (!isfinite(a) || !isfinite(b))
                continue;
            double step = sqrt((double)b) - sqrt((double)a);
            sum += step * step;
            count++;
        }
    }
    return count > 0 ? sum / (double)count : 0;
}

static double sharpness(const weft_light_values *values)
{
    static const int direction[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    double least = INFINITY;
    for (int i = 0; i < 4; i++) {
        int dx = direction[i][0], dy = direction[i][1];
        double far = difference(values, longer_lag * dx, longer_lag * dy);
        least = fmin(least, far > 0 ? longer_lag * difference(values, dx, dy) / far : 0);
    }
    return least;
}

/* In words: it is dark, overexposed, blurred, or of something else. An edge between two greys that is spread over w
 * pixels has the sum of squared differences 1 / w at a lag of one pixel, and lag / w (w >= lag) at a longer lag; so the
 * share of the two tells how wide edges are, whatever the picture shows. The least of four directions counts, because a
 * shake blurs one. */
static const char *fault_of(const weft_light_values *values)
{
    double sum = 0, clipped = 0, pixels = (double)values->width * values->height;
    for (long i = 0; i < (long)values->width * values->height; i++) {
        if (isfinite(values->grey[i]))
            sum += (double)values->grey[i];
        else
            clipped++;
    }
    if (clipped > clipped_share * pixels)
        return "it is overexposed";
    if (sum < darkest_mean * pixels)
        return "it is dark (was the lens covered?)";
    if (sharpness(values) < least_sharpness)
        return "it is blurred";
    return "it shows something else, or too little of the sheet";
}

/* ---- All of it ---- */

weft_code weft_corners_find(const weft_target *target, const weft_light_values *values,
                            weft_photographs_photograph *photograph, weft_error *error)
{
    weft_marker marker[WEFT_MARKERS_LIMIT];
    int count = 0;
    WEFT_TRY(find_markers(values, marker, &count, error));
    photograph->corner_count = pair_corners(target, marker, count, photograph->plate, photograph->seen);
    photograph->marker_count = photograph->corner_count / 4;
    if (photograph->marker_count >= fewest_markers)
        WEFT_TRY(keep_plane(values, photograph, error));
    if (photograph->marker_count < fewest_markers)
        snprintf(photograph->remark, sizeof photograph->remark, "%d of the target's %d markers are seen: %s",
                 photograph->marker_count, WEFT_SHEET_MARKER_COUNT, fault_of(values));
    else if (photograph->corner_count < 4 * fewest_markers)
        snprintf(photograph->remark, sizeof photograph->remark,
                 "its markers do not match the target: it is another print, or the sheet is bent");
    return WEFT_OK;
}
