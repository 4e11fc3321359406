/* How well photographs tell a lens. */
#ifndef WEFT_REGISTRATION_LENS_JUDGEMENT_H
#define WEFT_REGISTRATION_LENS_JUDGEMENT_H

#include "registration/lens/calibration.h"
#include "registration/lens/fit.h"

/* Raises the standard errors of the fit to the jackknife's where those are larger, as far as there are photographs to
 * leave out. Errors: WEFT_SYSTEM. */
weft_code weft_lens_jackknife(const weft_board_photograph *photograph, int count, const weft_lens_model *model,
                              const weft_progress *progress, weft_lens_fit *fit, weft_error *error);

/* Measures tilt, reach, pattern and noise, and warns. The lens of the report is that of the fit. Errors: WEFT_SYSTEM.
 */
weft_code weft_lens_judge(const weft_lens_fit *fit, weft_lens_report *report, weft_error *error);

#endif
