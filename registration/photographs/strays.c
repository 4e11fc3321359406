#include "registration/photographs/strays.h"

#include "registration/pose/opencv_bridge.h"

#include <math.h>

/* Fewer corners than this, or than this share of those that were found, are no majority to trust. */
enum { fewest_corners = 12 };
static const double least_share = 0.75;

/* Distance in undistorted pixels. */
static double distance(const weft_homography *homography, const double plate[2], const double straight[2])
{
    weft_pixel put = weft_homography_apply(homography, plate[0], plate[1]);
    return hypot(put.x - straight[0], put.y - straight[1]);
}

weft_code weft_strays_drop(const weft_camera *camera, double reach_px, weft_photographs_photograph *photograph,
                           int *dropped, weft_error *error)
{
    const int count = photograph->corner_count, found = 4 * photograph->marker_count;
    int agreeing = 0;
    double straight[WEFT_PLATE_CORNERS][2];
    uint8_t agrees[WEFT_PLATE_CORNERS] = {0};
    weft_homography homography;
    *dropped = 0;
    if (count < fewest_corners)
        return WEFT_OK;
    for (int i = 0; i < count; i++) {
        weft_pixel pixel = weft_camera_undistort(camera, (weft_pixel){photograph->seen[i][0], photograph->seen[i][1]});
        straight[i][0] = pixel.x, straight[i][1] = pixel.y;
    }
    weft_code code = weft_opencv_fit_homography((const double(*)[2])photograph->plate, (const double(*)[2])straight,
                                                count, reach_px, homography.m, agrees, error);
    if (code != WEFT_OK)
        return code == WEFT_BAD_INPUT ? WEFT_OK : code;
    for (int i = 0; i < count; i++) {
        agrees[i] = distance(&homography, photograph->plate[i], straight[i]) <= reach_px;
        agreeing += agrees[i];
    }
    if (agreeing < fewest_corners || agreeing < least_share * found)
        return WEFT_OK;
    weft_photographs_keep_corners(photograph, agrees);
    *dropped = count - agreeing;
    return WEFT_OK;
}
