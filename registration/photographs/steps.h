/* The steps of a registration of photographs. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_STEPS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_STEPS_H

#include "base/half.h"
#include "base/picture/image.h"
#include "btf/dataset/dataset.h"
#include "registration/lamp/evidence.h"
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

/* What the files of photographs say of their colours: a phone writes Display P3, a camera can write Adobe RGB. */

/* A line of the notes for all photographs in use that say the same: turned into sRGB, or not understood. */
weft_code weft_photographs_note_colours(weft_photograph_set *set, weft_error *error);

/* Small pictures for the report. */

/* The photograph reduced to about 260 pixels across, sRGB. The caller frees it with weft_image_free. Errors:
 * WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_thumbnail_of_photograph(const weft_light_values *values, weft_image *thumbnail, weft_error *error);

/* Reflectance times cosine [height][width][3] reduced to at most 160 texels across, sRGB: 1 is white. As above. */
weft_code weft_thumbnail_of_texels(const weft_half *texel, int width, int height, weft_image *thumbnail,
                                   weft_error *error);

/* Photographs of one view under one light that differ in exposure alone. The darker one tells the tone curve, and what
 * the brighter one has clipped. It is no image of its own: what is held out of a dataset must not be in it twice. */

/* Leaves out the darker one of every pair of which both are used, with a remark. */
void weft_photographs_leave_out_darker(weft_photograph_set *set);

/* The next darker photograph of what `photograph` shows; -1: none. */
int weft_photographs_darker_of_pair(const weft_photograph_set *set, int photograph);

/* Takes the texels [count][3] that are masked as saturated alone from a darker photograph, where that knows them.
 * Returns how many. Pure. */
long weft_photographs_fill_saturated(const weft_half *darker, const uint8_t *darker_mask, size_t count,
                                     weft_half *texel, uint8_t *mask);

/* What stands on the sheet, the pin and the mirror balls, hides parts of the sample from a low lamp or a low camera.
 * The dataset does not have these texels: they show no cloth in that light. */

/* Masks the texels [height][width] whose line to the lamp or to the camera at `eye` (mm, as the lamp) comes nearer to
 * the pin or a ball of `settings` than its radius and what is soft of a shadow: 0.03 of the way for the lamp, 0.01 for
 * the camera. Sets WEFT_MASK_MISSING; *hidden_texels receives how many texels that adds. A pin and balls that are not
 * there hide nothing: their height or diameter is 0. Pure. */
void weft_photographs_mask_hidden(const weft_photographs_settings *settings, weft_vec3 lamp, weft_vec3 eye,
                                  uint8_t *mask, long *hidden_texels);

/* How far photographs can be trusted: what the dataset keeps of each as figures of its image, and what the user should
 * know of all. */

/* Standard error of the direction of the camera from the middle of the sample, degrees: that of the pose, a least
 * squares fit to the corners, each of which lies corner_rms_px off. The lens counts as known. 90 where the corners do
 * not tell. Pure. */
double weft_photographs_view_error_deg(const weft_camera *camera, const weft_photographs_photograph *photograph);

/* Relative standard deviation of the green of texels [count] that are valid; 0 without any. Pure. */
double weft_photographs_contrast(const weft_half *texel, const uint8_t *mask, size_t count);

/* Masks texels [count][3] whose brightest channel is below `darkest`, WEFT_MASK_DARK, where they are valid; writes to
 * `photograph` how many these are, and how many are masked as clipped. */
void weft_photographs_mask_dark(const float *texel, float darkest, size_t count, uint8_t *mask,
                                weft_photographs_photograph *photograph);

/* Relative variance of the samples of a photograph,
 *     s0^2 + e^2 + (d tan theta)^2 / 2 + d^4 / 4 + (c 12 b^2 / (12 b^2 + p^2))^2,
 * of which its weight is the inverse. s0 = 0.02 is what all photographs are wrong by and no figure of one tells, e the
 * residual of its paper, d the standard error of the direction of its lamp, of which one of two axes turns the lamp
 * towards the horizon, theta the angle of the lamp from the normal; c the contrast of the sample, b the standard
 * deviation of its blur on the sheet, p the pitch of texels: a texel takes the share 12 b^2 / (12 b^2 + p^2) of its
 * light from beside it. Pure. */
double weft_photographs_variance(const weft_photograph_set *set, const weft_photographs_photograph *photograph,
                                 double contrast, double pitch_mm);

/* Puts the figures of the images: image i is photograph index[i]. Weights are 1 / variance with mean 1, the contrast
 * being the median over the photographs; the error of the values is that of s0, e and the tone curve
 * (lamps.dark_error). Errors: those of weft_dataset_writer_put_figure. */
weft_code weft_photographs_put_figures(const weft_photograph_set *set, const int *index, int count, double pitch_mm,
                                       weft_dataset_writer *writer, weft_error *error);

/* Adds a line to the notes of `set` where the sheet is not flat, where the lens is assumed, and where the tone curve
 * leaves dark cloth open.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_photographs_note(const weft_target *target, weft_photograph_set *set, weft_error *error);

/* ---- Mistakes, named for what they are ---- */

/* Gives a photograph that shows too little paper a remark: why most places of it cannot be used. */
void weft_photographs_say_paperless(const weft_paper_samples *paper, weft_photographs_photograph *photograph);

/* One contradiction: the error WEFT_BAD_INPUT, or with settings->force a note. */
__attribute__((format(printf, 5, 6))) weft_code weft_photographs_contradict(const char *folder,
                                                                            const weft_photographs_settings *settings,
                                                                            weft_photograph_set *set, weft_error *error,
                                                                            const char *format, ...);

/* Refuses a folder in which more than a fifth of the photographs have another size than `common`. Errors:
 * WEFT_BAD_INPUT naming one; WEFT_SYSTEM for memory. */
weft_code weft_photographs_check_sizes(const char *folder, const weft_photographs_settings *settings,
                                       const weft_exif *common, weft_photograph_set *set, weft_error *error);

/* Gives a remark to photographs whose focal length, as the camera wrote it, is not that of most. */
void weft_photographs_leave_out_other_lenses(weft_photograph_set *set);

/* Gives a remark to photographs whose lamp has less than a fifth of the power of the median, where exposures are
 * written. */
void weft_photographs_leave_out_unlit(weft_photograph_set *set);

/* Refuses photographs whose lamp lies within 12 degrees of the camera in nine of ten, without --flash; at least two
 * must be taken from the side. Errors: as weft_photographs_check_sizes. */
weft_code weft_photographs_check_flash(const char *folder, const weft_photographs_settings *settings,
                                       weft_photograph_set *set, weft_error *error);

/* Refuses photographs in which the sample lies elsewhere in the opening than in the one from most nearly above: its
 * small picture there correlates much better when it is moved. Errors: as weft_photographs_check_sizes. Uses OpenMP. */
weft_code weft_photographs_check_still(const char *folder, const weft_photographs_settings *settings,
                                       weft_photograph_set *set, weft_error *error);

/* Refuses photographs whose light contradicts itself: ink and paper that no printer makes, bare paper that no lamp
 * lights so, highlights or shadows of the pin that lie elsewhere than the lamp makes them. settings->force makes a note
 * of each instead. Errors: WEFT_BAD_INPUT naming the folder and the contradiction; WEFT_SYSTEM for memory. */
weft_code weft_photographs_check_light(const char *folder, const weft_photographs_settings *settings,
                                       weft_photograph_set *set, weft_error *error);

/* Refuses photographs that all show the cloth from one side under one light, within 3 degrees. Errors: WEFT_BAD_INPUT
 * naming the folder. Pure. */
weft_code weft_photographs_check_variety(const char *folder, const weft_photograph_set *set, weft_error *error);

#endif
