/* One adjustment of a rig to the shots of a series. Beside what all shots share, each has a place of its own: the plate
 * lies, or the axes stand, a little differently every time. Those six numbers a shot are unknowns, too. Their standard
 * deviations, and that of a point, are found with them (MacKay 1992), so that errors of the rig are those of so many
 * shots, not of so many points. */
#ifndef WEFT_REGISTRATION_AXES_FIT_H
#define WEFT_REGISTRATION_AXES_FIT_H

#include "btf/session/rig_poses.h"
#include "registration/axes/adjustment.h"

/* ---- What may be unknown of a rig: terms, each of a few numbers, free or held as specified ---- */

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

/* A point of the target: where it is drawn, and where it is seen. */
typedef struct weft_axes_point {
    double plate_mm[2], pixel[2];
} weft_axes_point;

enum { WEFT_AXES_POINTS = 4 };

/* A photograph of the target. The drawing gives a projective map of the plane, which is four points. */
typedef struct weft_axes_shot {
    const char *name;
    weft_turns turns;
    weft_axes_point point[WEFT_AXES_POINTS];
    char left_out[160]; /* why; "": it is used */
} weft_axes_shot;

/* Standard deviations: of the plate's own place a component, and of a point a coordinate. */
typedef struct weft_axes_scatter {
    double rotation_rad, translation_mm, point_px;
} weft_axes_scatter;

typedef struct weft_axes_fit {
    weft_free_terms terms;
    weft_rig_poses poses;
    weft_axes_scatter scatter;
    int unknowns;
    double unknown[WEFT_UNKNOWNS], covariance[WEFT_UNKNOWNS * WEFT_UNKNOWNS]; /* [unknowns][unknowns] */
    double squares; /* minus twice the logarithm of the probability, but for what the scatter fixes */
} weft_axes_fit;

/* Shots to fit: those that are not left out, and but for those of one fold of `folds` among them (0: of all). */
typedef struct weft_axes_choice {
    const weft_axes_shot *shot;
    int count, fold, folds;
} weft_axes_choice;

/* Whether shot `index` is fitted, or is held out. Pure. */
bool weft_axes_fitted(const weft_axes_choice *choice, int index);
bool weft_axes_held_out(const weft_axes_choice *choice, int index);

/* Adjusts the free terms. `fit` holds terms and scatter; the latter is found anew where `find_scatter`. `apart` [count]
 * may be NULL; it receives how far each shot is from its place in all, root mean square of its six numbers in units of
 * the scatter; 0 for shots that are not fitted. Errors: WEFT_BAD_INPUT where nothing fits; WEFT_SYSTEM. */
weft_code weft_axes_fit_run(const weft_axes_choice *choice, const weft_rig_poses *nominal, bool find_scatter,
                            weft_axes_fit *fit, double *apart, weft_error *error);

/* Sum of the squared distances of the points of a shot from where `poses` put them, pixels^2; infinite where one is
 * behind the camera. Pure. */
double weft_axes_squares(const weft_rig_poses *poses, const weft_axes_shot *shot);

/* Where a camera sees a point of the plate: a pixel of the photograph. NAN behind the camera. Pure. */
weft_pixel weft_pose_sees(const weft_camera *camera, const weft_pose *pose, double x_mm, double y_mm);

#endif
