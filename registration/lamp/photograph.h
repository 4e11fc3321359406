/* One photograph of a camera in the hand, and what is found out about it. */
#ifndef WEFT_REGISTRATION_LAMP_PHOTOGRAPH_H
#define WEFT_REGISTRATION_LAMP_PHOTOGRAPH_H

#include "base/picture/exif.h"
#include "base/picture/image.h"
#include "btf/session/camera.h"
#include "btf/session/colour.h"
#include "btf/session/target.h"
#include "registration/pose/prediction.h"

#include <stdbool.h>
#include <stdint.h>

enum { WEFT_PLATE_CORNERS = 4 * WEFT_SHEET_MARKER_COUNT };

/* What tells where the lamp stood. */
typedef enum weft_lamp_source {
    WEFT_LAMP_UNKNOWN,
    WEFT_LAMP_PAPER, /* the fall of light over the paper alone */
    WEFT_LAMP_BALLS, /* highlights on mirror balls, and the paper */
    WEFT_LAMP_PIN,   /* the shadow of the pin, and the paper */
    WEFT_LAMP_LIST,  /* a list of lamps, and the paper */
    WEFT_LAMP_FLASH  /* fixed to the camera, the same in all photographs */
} weft_lamp_source;

typedef struct weft_lamp_place {
    weft_lamp_source source;
    weft_vec3 position_mm;  /* in the plate frame */
    double uncertainty_deg; /* standard error of its direction from the middle of the sample */
    double level[3]; /* linear value of a perfect white diffuser in the middle, lit along its normal from there */
    double residual; /* of bare paper: standard deviation of the logarithm of light */
} weft_lamp_place;

typedef struct weft_photographs_photograph {
    char *name; /* of the file, in its folder */
    weft_exif exif;
    char remark[192];        /* why it is left out; empty where it is used */
    char colours[200];       /* what the file says of its colours; empty where it is sRGB, or nothing is said */
    bool assumes_srgb;       /* nothing is said, and the file is neither raw nor of floats */
    weft_colour file_colour; /* to linear sRGB, by that; no terms where there is nothing to do */
    bool is_darker_of_pair;  /* left out as the darker one of a pair, and sound otherwise */

    int marker_count;                                                 /* found; each has four corners */
    int corner_count;                                                 /* of them, that lie on the plane of the sheet */
    double plate[WEFT_PLATE_CORNERS][2], seen[WEFT_PLATE_CORNERS][2]; /* corners: mm, and pixels */
    double corner_rms_px;                                             /* under the lens of all photographs */

    weft_pose pose;
    weft_homography homography; /* plate mm to undistorted pixels, refined against the drawing */
    weft_point_spread point_spread;
    double correlation, uncertainty_mm;

    double view_uncertainty_deg; /* standard error of the direction of the camera */

    weft_lamp_place lamp;

    double contrast;                                 /* of the texels: relative standard deviation */
    long clipped_texels, dark_texels, hidden_texels; /* that are masked */

    weft_image thumbnail, rectified; /* for the report, sRGB; without pixels where there is none */
} weft_photographs_photograph;

/* Keeps those corners whose `keep` [corner_count] is not 0. */
static inline void weft_photographs_keep_corners(weft_photographs_photograph *photograph, const uint8_t *keep)
{
    int kept = 0;
    for (int i = 0; i < photograph->corner_count; i++) {
        if (!keep[i])
            continue;
        for (int axis = 0; axis < 2; axis++) {
            photograph->plate[kept][axis] = photograph->plate[i][axis];
            photograph->seen[kept][axis] = photograph->seen[i][axis];
        }
        kept++;
    }
    photograph->corner_count = kept;
}

static inline bool weft_photographs_used(const weft_photographs_photograph *photograph)
{
    return photograph->remark[0] == 0;
}

#endif
