/* How far photographs can be trusted: what the dataset keeps of each as figures of its image, and what the user should
 * know of all. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_CERTAINTY_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_CERTAINTY_H

#include "btf/dataset/dataset.h"
#include "registration/photographs/photographs.h"

/* Standard error of the direction of the camera from the middle of the sample, degrees: that of the pose, a least
 * squares fit to the corners, each of which lies corner_rms_px off. The lens counts as known. 90 where the corners do
 * not tell. Pure. */
double weft_photographs_view_error_deg(const weft_camera *camera, const weft_photographs_photograph *photograph);

/* How far bare paper lies from what the lamp explains: 1.4826 times the median deviation of the logarithm of light from
 * its median, which is the standard deviation where most of it is free of shadows and stains. `lamps` gives tone curve,
 * vignetting and beam. 0 without paper. Errors: WEFT_SYSTEM. */
weft_code weft_photographs_paper_residual(const weft_paper_places *places, const weft_lamp_evidence *evidence,
                                          const weft_lamp_solution *lamps, const weft_lamp_place *lamp,
                                          double *residual, weft_error *error);

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

/* Adds a line to the notes of `set` where balls or pin contradict the paper, and where the tone curve leaves dark
 * cloth open. Errors: WEFT_SYSTEM for memory. */
weft_code weft_photographs_note(weft_photograph_set *set, weft_error *error);

/* Refuses photographs that all show the cloth from one side under one light, within 3 degrees. Errors: WEFT_BAD_INPUT
 * naming the folder. Pure. */
weft_code weft_photographs_check_variety(const char *folder, const weft_photograph_set *set, weft_error *error);

#endif
