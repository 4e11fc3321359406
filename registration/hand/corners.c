#include "registration/hand/corners.h"

#include "registration/hand/fault.h"
#include "registration/hand/hand_bridge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { fewest_markers = 3 };

/* How far the distortion of a lens may take a corner from a plane, as a share of the longer side. */
static const double distortion_share = 0.01;

/* Marker search takes what is clipped as white. */
static weft_code find_markers(const weft_light_values *values, weft_marker *marker, int *count, weft_error *error)
{
    size_t pixels = (size_t)values->width * (size_t)values->height;
    float *grey = malloc(pixels * sizeof *grey);
    if (!grey)
        return weft_fail_memory(error, "a photograph", pixels * sizeof *grey);
    for (size_t i = 0; i < pixels; i++)
        grey[i] = isfinite(values->grey[i]) ? values->grey[i] : 1;
    weft_code code = weft_opencv_find_markers_in_photograph(grey, values->width, values->height, marker, count, error);
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
static weft_code keep_plane(const weft_light_values *values, weft_hand_photograph *p, weft_error *error)
{
    weft_homography homography;
    uint8_t agrees[WEFT_PLATE_CORNERS] = {0};
    double reach = distortion_share * fmax(values->width, values->height);
    weft_code code = weft_opencv_fit_homography((const double(*)[2])p->plate, (const double(*)[2])p->seen,
                                                p->corner_count, reach, homography.m, agrees, error);
    int kept = 0;
    for (int i = 0; code == WEFT_OK && i < p->corner_count; i++) {
        if (!agrees[i])
            continue;
        for (int axis = 0; axis < 2; axis++) {
            p->plate[kept][axis] = p->plate[i][axis];
            p->seen[kept][axis] = p->seen[i][axis];
        }
        kept++;
    }
    p->corner_count = kept;
    return code == WEFT_BAD_INPUT ? WEFT_OK : code;
}

weft_code weft_corners_find(const weft_target *target, const weft_light_values *values,
                            weft_hand_photograph *photograph, weft_error *error)
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
                 photograph->marker_count, WEFT_SHEET_MARKER_COUNT, weft_photograph_fault(values));
    else if (photograph->corner_count < 4 * fewest_markers)
        snprintf(photograph->remark, sizeof photograph->remark,
                 "its markers lie otherwise than on the target: it is another print, or the sheet is bent");
    return WEFT_OK;
}
