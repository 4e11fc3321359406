/* How far one picture looks from another, by measures that others use, too. */
#ifndef WEFT_COMPARE_PICTURES_PICTURE_QUALITY_H
#define WEFT_COMPARE_PICTURES_PICTURE_QUALITY_H

#include "base/picture/image.h"
#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of a viewer 0.7 m before a screen of 0.7 m and 3840 pixels, as in the article on FLIP. */
static const double weft_pixels_per_degree = 67;

typedef struct weft_picture_quality {
    double psnr_db; /* of the sRGB values, whose peak is 1; infinite where the pictures are equal */
    double ssim;    /* 1: equal */
    double flip;    /* 0: equal, 1: as different as can be */
} weft_picture_quality;

/* Compares two pictures of one size, sRGB encoded, 0..1. SSIM is the mean of Wang et al. (2004, eq. 13) over pixels and
 * channels, with their Gaussian window of 11 x 11 and standard deviation 1.5, K1 = 0.01, K2 = 0.03; beyond the border
 * the picture is mirrored. FLIP is the mean over the pixels of the difference of Andersson et al. (2020) for pictures
 * of low dynamic range. Thread-safe. Errors: WEFT_BAD_USAGE for pictures of different sizes; WEFT_SYSTEM. */
weft_code weft_picture_quality_measure(const weft_image *reference, const weft_image *test,
                                       weft_picture_quality *result, weft_error *error);

/* The same by regions of the picture: `regions` [height][width] has bit k where a pixel lies in region k, and pixels[k]
 * counts these. PSNR, and the means of SSIM and FLIP, are of the pixels of a region; their windows reach beyond it. A
 * region without a pixel has 0 of all. Errors: as above. */
weft_code weft_picture_quality_by_region(const weft_image *reference, const weft_image *test, const uint8_t *regions,
                                         int region_count, weft_picture_quality *result, long *pixels,
                                         weft_error *error);

#ifdef __cplusplus
}
#endif

#endif
