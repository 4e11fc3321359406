#include "registration/outcome/outcome.h"

#include <stdlib.h>

void weft_registration_free(weft_registration *registration)
{
    weft_survey_free(&registration->survey);
    free(registration->pose);
    free(registration->used);
    free(registration->fault);
    free(registration->white);
    free(registration->saturated);
    *registration = (weft_registration){0};
}

double weft_registration_uncertainty_texels(const weft_session *session, const weft_registration *registration,
                                            int viewpoint)
{
    return registration->pose[viewpoint].uncertainty_mm * registration->settings.width / session->target.opening_mm;
}
