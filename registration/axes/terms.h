/* What may be unknown of a rig: terms, each of a few numbers, free or held as specified. */
#ifndef WEFT_REGISTRATION_AXES_TERMS_H
#define WEFT_REGISTRATION_AXES_TERMS_H

#include "btf/session/rig_poses.h"

typedef enum weft_term_kind {
    WEFT_TERM_HOME,  /* where the camera is when all turns are 0: 6 */
    WEFT_TERM_LENS,  /* fx, fy, cx, cy: 4. (The target is in the middle of every photograph: it tells no distortion.) */
    WEFT_TERM_LINE,  /* of a joint: its direction, and where it is: 4 */
    WEFT_TERM_SCALE, /* 1 */
    WEFT_TERM_UNEVEN, /* 2 */
    WEFT_TERM_WOBBLE, /* 4 */
    WEFT_TERM_KINDS
} weft_term_kind;

/* A term, of a joint where there is one for each. */
typedef struct weft_term {
    weft_term_kind kind;
    int joint;
} weft_term;

enum { WEFT_TERMS = 2 + 4 * WEFT_JOINTS, WEFT_TERM_NUMBERS = 6, WEFT_UNKNOWNS = 10 + 11 * WEFT_JOINTS };

/* All of them, in the order of their unknowns. */
weft_term weft_term_of(int index);
int weft_term_index(weft_term_kind kind, int joint);

/* How many numbers it has. */
int weft_term_numbers(weft_term_kind kind);

typedef struct weft_free_terms {
    bool free[WEFT_TERMS];
} weft_free_terms;

/* Unknowns of the free terms together, and the first one of a free term. */
int weft_unknown_count(const weft_free_terms *terms);
int weft_unknown_first(const weft_free_terms *terms, int index);

/* How far a number of a term is from its specification in rigs that were built with a ruler: standard deviation.
 * Unknowns are in this unit. rad, mm, pixels or none. */
double weft_term_unit(const weft_camera *camera, weft_term_kind kind, int number);

/* The rig with those unknowns. Pure. */
weft_rig_poses weft_rig_poses_with(const weft_rig_poses *nominal, const weft_free_terms *terms, const double *unknown);

#endif
