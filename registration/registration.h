/* Registration: a session of photographs becomes a dataset. */
#ifndef WEFT_REGISTRATION_REGISTRATION_H
#define WEFT_REGISTRATION_REGISTRATION_H

#include "base/progress.h"
#include "btf/session/camera_list.h"
#include "registration/outcome/outcome.h"
#include "weft/register.h"

#include <limits.h>

/* 64 x 64 texels; a view within an eighth of the opening of the predicted pose, correlated with its drawing by 0.8. */
weft_registration_settings weft_registration_defaults(const weft_session *session);

/* Registers `session` into the dataset `output`, and writes the report where one is asked for. On success the caller
 * frees `registration` with weft_registration_free. A view that cannot be found and a photograph that cannot be used
 * are masked WEFT_MASK_MISSING and named in `registration`; they are no errors. Errors: WEFT_BAD_INPUT for an
 * unfinished session (unless allowed), and where nothing at all can be used; WEFT_SYSTEM. Memory: about 600 MB at most
 * besides the dataset's writer. Uses OpenMP. */
weft_code weft_register_session(const weft_session *session, const char *output,
                                const weft_registration_settings *settings, const weft_progress *progress,
                                weft_registration *registration, weft_error *error);

/* The same for the sessions of `count` cameras that photographed one sample: one dataset of all, the images of each
 * camera behind those of the one before. Each has its own lens, sensor, vignetting, white levels and report: settings
 * and registrations are [count]; the size of the dataset is that of settings[0]. Further errors: WEFT_BAD_INPUT for
 * cameras whose colours are not known to be the same quantities, or with openings of two sizes. */
weft_code weft_register_cameras(const weft_session *sessions, int count, const char *output,
                                const weft_registration_settings *settings, const weft_progress *progress,
                                weft_registration *registrations, weft_error *error);

/* What came of the session in a folder, of one camera or of several. */
typedef struct weft_registered {
    int count;
    weft_camera_list list; /* empty where there is one camera without a name */
    bool is_done;
    weft_session *session;                                 /* [count] */
    weft_registration_settings settings[WEFT_CAMERAS_MAX]; /* [count] */
    char report_folder[WEFT_CAMERAS_MAX][PATH_MAX];
    weft_registration registration[WEFT_CAMERAS_MAX]; /* [count] */
} weft_registered;

/* weft_register, with all that was found; the caller frees *result with weft_registered_free. Errors: those of
 * weft_register. */
weft_code weft_register_folder(const char *folder, const char *output, const weft_register_options *options,
                               const weft_progress *progress, weft_registered **result, weft_error *error);

/* NULL is fine. */
void weft_registered_free(weft_registered *registered);

#endif
