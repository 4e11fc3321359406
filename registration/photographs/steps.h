/* The steps of a registration of photographs. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_STEPS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_STEPS_H

#include "registration/lamp/photograph.h"
#include "registration/lamp/read.h"
#include "registration/photographs/photographs.h"

/* Fills marker_count, corner_count, plate and seen with corners that one plane explains, and the remark where there are
 * too few. Errors: WEFT_SYSTEM. */
weft_code weft_corners_find(const weft_target *target, const weft_light_values *values,
                            weft_photographs_photograph *photograph, weft_error *error);

/* ---- The folder of photographs: which there are, and which have the size that most have ---- */

/* Fewer photographs than this make no material. */
enum { WEFT_PHOTOGRAPHS_FEWEST = 3 };

/* Fills an empty `set` with the photographs of a folder, their names and what the camera wrote of them. One that
 * cannot be read, or has another size than most, gets a remark. The caller frees `set` with weft_photographs_free,
 * also after an error. Errors: WEFT_BAD_INPUT where there are too few, or none can be read; WEFT_SYSTEM. Uses OpenMP.
 */
weft_code weft_photographs_list(const char *folder, weft_photograph_set *set, weft_error *error);

/* Of a photograph of the size that most of those in use have; NULL where none is in use. Pure. */
const weft_exif *weft_photographs_common_size(const weft_photograph_set *set);

/* ---- The pose of a photograph below a pixel, against the drawing of the whole target ---- */

/* What all photographs of one camera share: the drawing, seen in a photograph that is reduced by averaging squares of
 * `reduction` x `reduction` pixels. The reduced one still shows a place to a hundredth of its pixel. */
typedef struct weft_reduced_sight {
    int reduction;
    weft_sight sight;
} weft_reduced_sight;

/* Chooses the reduction that leaves at most 1600 pixels. `pixels_per_mm`: of a typical photograph, not reduced. The
 * caller frees with weft_reduced_sight_free. Errors: as weft_sight_create. */
weft_code weft_reduced_sight_create(const weft_camera *camera, const weft_target *target, double pixels_per_mm,
                                    weft_reduced_sight *reduced, weft_error *error);
void weft_reduced_sight_free(weft_reduced_sight *reduced);

/* Refines photograph->homography, starting from its pose, and fills point_spread (of the full photograph), correlation
 * and uncertainty_mm; a remark where the drawing is not found. Errors: WEFT_SYSTEM. */
weft_code weft_photographs_pose_refine(const weft_reduced_sight *reduced, const weft_camera *camera,
                                       const weft_light_values *values, weft_photographs_photograph *photograph,
                                       weft_error *error);

/* ---- The used photographs as images of a dataset ---- */

/* Resamples the photographs under their poses, divides by what a perfect white diffuser would show at every texel, and
 * writes the dataset. Errors: WEFT_BAD_INPUT where a file has gone since; WEFT_SYSTEM. Uses OpenMP. */
weft_code weft_photographs_write_dataset(const char *folder, const char *output,
                                         const weft_photographs_settings *settings, const weft_progress *progress,
                                         weft_photograph_set *set, weft_error *error);

#endif
