/* Exposure: how bright a photograph is, and how long the next one should be. */
#ifndef WEFT_CAPTURE_EXPOSURE_H
#define WEFT_CAPTURE_EXPOSURE_H

#include "btf/session/session.h"

/* The pixels that the meter looks at: the opening and the white patches, where the calibrated camera expects them. */
typedef struct weft_meter {
    int opening_count, white_count;
    int *opening, *white; /* indices of pixels */
} weft_meter;

/* Places the meter for a view. The outlines are drawn in by a twentieth of the opening, for the pose is only nominal.
 * The caller frees with weft_meter_free, also after a failure. Errors: WEFT_SYSTEM; WEFT_BAD_INPUT where the view
 * shows nothing of the opening. */
weft_code weft_meter_make(const weft_session *session, weft_angles view, weft_meter *meter, weft_error *error);
void weft_meter_free(weft_meter *meter);

/* Brightness of a photograph relative to what it should be: the larger of the 99.5th percentile of the opening (of its
 * brightest channel) over `weft_opening_aim` and that of the white patches over `weft_white_aim`, both as fractions of
 * full scale. Above 1: too long. Clipped photographs give at least the value of full scale. Pure. */
double weft_meter_read(const weft_meter *meter, const weft_session *session, const uint16_t *samples);

/* What the white patches show above the black level in the green channel, in raw values; 0 where none is seen. Pure. */
double weft_meter_white(const weft_meter *meter, const weft_session *session, const uint16_t *samples);

extern const double weft_opening_aim, weft_white_aim;

/* What the shutter can do. */
typedef struct weft_exposure_limits {
    double shortest_s, longest_s;
} weft_exposure_limits;

/* The longest exposure of the series of third stops (2^(k/3) s) that is at most `exposure_s`, within the limits. Pure.
 */
double weft_exposure_in_thirds(double exposure_s, weft_exposure_limits limits);

/* The exposure to take after one of `exposure_s` whose meter reading was `level`: the same where it was right (at most
 * one third stop and a little below the aim) or the limits allow no better. Pure. */
double weft_exposure_after(double exposure_s, double level, weft_exposure_limits limits);

/* The exposure that was taken where `asked_s` was asked for: what a camera does that has only so many exposure times is
 * another one; what it rounds, by less than a hundredth, is not. Pure. */
double weft_exposure_taken(double asked_s, double read_back_s);

/* Exposure of the next photograph of a bracket, 0 where none is needed or possible. `samples` holds the photographs of
 * the shot so far, [1 + record->bracket_count][height][width][3]. Where the sensor clipped in the opening of the first:
 * an eighth of it. Then, from the histogram of the longest so far: so long that the 0.5th percentile of the opening (of
 * its darkest channel) reaches a thirty-second of full scale, at most 16 times as long as that. So what one photograph
 * shows too dark, another shows well. Pure. */
double weft_exposure_of_bracket(const weft_meter *meter, const weft_session *session, const uint16_t *samples,
                                const weft_shot_record *record, weft_exposure_limits limits);

#endif
