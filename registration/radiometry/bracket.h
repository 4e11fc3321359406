/* One picture of several photographs of a shot, whose exposures differ. */
#ifndef WEFT_REGISTRATION_RADIOMETRY_BRACKET_H
#define WEFT_REGISTRATION_RADIOMETRY_BRACKET_H

#include "btf/session/session.h"

#include <stddef.h>

typedef struct weft_bracket_frame {
    const uint16_t *samples; /* raw, as many as of every other */
    double exposure_s;       /* as the camera reports it */
    double gain;             /* by which its values exceed those of the first, per second: the lamp has drifted, or the
                                shutter, or the sensor is not linear; 0: the frame is of no use */
} weft_bracket_frame;

/* Fills the gains from what each frame and the first show both well: of the longer of the two, values between 0.3 and
 * 0.9 of full scale, of which the sums are compared. A gain that differs from 1 by more than a tenth is no drift: such
 * a frame gets 0. Fewer than 200 such samples tell nothing: gain 1. Pure. */
void weft_bracket_compare(const weft_session *session, weft_bracket_frame *frame, int count, size_t sample_count);

/* Merges frames into values above black in the scale of the first (raw values in its exposure), with their variances.
 * Of rate r (value per second), frame i of exposure t_i shows x_i with the variance
 *   v_i = r t_i / e + (s / e)^2 + 1/12
 * for e electrons per value and the read noise s: shot noise, read noise, rounding. The estimate of least variance is
 *   r = sum (t_i / v_i) x_i / sum (t_i^2 / v_i)
 * (as Hasinoff, Durand and Freeman 2010, with rounding). v_i takes r from the frames themselves, all from the same, so
 * that dark noise does not weigh more than bright noise: first from the longest that does not clip, then from the
 * estimate. Values above 0.98 of full scale are left out; where all are, value is INFINITY and variance 0. A sensor of
 * unknown noise is taken for one of 1 electron a value and no read noise. Pure; thread-safe. */
void weft_bracket_merge(const weft_session *session, const weft_bracket_frame *frame, int count, size_t sample_count,
                        float *value, float *variance);

#endif
