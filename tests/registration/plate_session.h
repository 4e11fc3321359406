/* A session of plate photographs on disk: 3 views x 3 lights, 208 x 208 pixels, a white diffuser in the opening. */
#ifndef WEFT_TESTS_REGISTRATION_PLATE_SESSION_H
#define WEFT_TESTS_REGISTRATION_PLATE_SESSION_H

#include "btf/session/session.h"

enum {
    PLATE_SESSION_VIEWS = 3,
    PLATE_SESSION_LIGHTS = 3,
    PLATE_SESSION_SHOTS = PLATE_SESSION_VIEWS * PLATE_SESSION_LIGHTS,
    PLATE_SESSION_SIZE = 208
};

/* Reflectance of the sample. */
#define PLATE_SESSION_SAMPLE 0.4

/* What goes wrong with a session. */
typedef struct plate_faults {
    int covered_view; /* its target is covered; -1: none */
    int untaken;      /* shot that is not taken; -1: none */
    int overexposed;  /* shot whose white patches are saturated; -1: none */
} plate_faults;

extern const plate_faults plate_no_faults;

/* Writes the session into the new folder `folder` of the current one. Fails the running test where it cannot. */
void plate_session_write(const char *folder, const plate_faults *faults);

/* Path of a photograph of the session. */
void plate_session_photograph(const char *folder, int shot, char path[512]);

#endif
