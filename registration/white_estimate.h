/* White levels of photographs in which no reference patch could be measured, from those of the others. */
#ifndef WEFT_REGISTRATION_WHITE_ESTIMATE_H
#define WEFT_REGISTRATION_WHITE_ESTIMATE_H

#include "registration/outcome/outcome.h"

/* Whether a registered viewpoint holds a usable photograph without a white level. Pure. */
bool weft_white_lacking(const weft_registration *registration, int viewpoint);

/* For every photograph of the session (*estimated, [shot_count], owned by the caller, free) the median of the levels
 * measured under the same light where there are three or more, else of all levels measured. Nothing is computed where
 * none is lacking. Errors: WEFT_BAD_INPUT where some are lacking and none was measured; WEFT_SYSTEM. */
weft_code weft_white_estimate(const weft_session *session, const weft_registration *registration,
                              weft_white **estimated, weft_error *error);

#endif
