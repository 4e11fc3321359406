/* Where the lamp stood in every photograph, and how bright it was: from the fall of its light over the paper, and from
 * its highlights on mirror balls. The tone curve of the camera and the vignetting of its lens are found with it,
 * because the same brightness tells all three. */
#ifndef WEFT_REGISTRATION_LAMP_LAMP_H
#define WEFT_REGISTRATION_LAMP_LAMP_H

#include "btf/session/camera.h"
#include "registration/lamp/evidence.h"
#include "registration/lamp/listed.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- A lamp that is fixed to the camera ---- */

/* Coefficients of u, v, u^2, u v, v^2. */
enum { WEFT_BEAM_TERMS = 5 };

/* In the frame of the camera: x right, y down, z forward. */
typedef struct weft_flash {
    double place_mm[3];
    double beam[WEFT_BEAM_TERMS];
} weft_flash;

/* Logarithm of what the flash sends towards the place (x, y) of the plate, over what it sends straight ahead:
 *     beam[0] u + beam[1] v + beam[2] u^2 + beam[3] u v + beam[4] v^2,
 * u and v being the tangents, right and down, of the direction in which the flash sees the place. To second order
 * cos^n has beam[2] = beam[4] = -n / 2. 0 without a beam. Pure. */
double weft_flash_log_beam(const weft_flash *flash, const weft_pose *pose, double x, double y);

/* What one photograph tells. */
typedef struct weft_lamp_evidence {
    weft_pose pose;
    weft_paper_samples paper;
    weft_highlight highlight[WEFT_TARGET_BALL_COUNT];
    weft_pin_shadow pin;
    weft_listed_lamp listed;
    double exposure; /* weft_exif_exposure; 0: the camera wrote none */
} weft_lamp_evidence;

/* Two photographs of one view under one lamp, which differ in their exposure. */
typedef struct weft_exposure_pair {
    int bright, dark;
    double log_ratio; /* of their exposures */
} weft_exposure_pair;

typedef struct weft_lamp_problem {
    const weft_target *target;
    const weft_paper_places *places;
    int count;
    const weft_lamp_evidence *evidence; /* [count] */
    int pair_count;
    const weft_exposure_pair *pair; /* [pair_count], by their place in `evidence` */
    double ball_diameter_mm;        /* 0: no balls */
    double pin_height_mm;           /* 0: no pin */
    double corner_radius_squared;   /* of the photograph, in the units of the samples' radius_squared */
    weft_bend bend;                 /* of the sheet */
    bool flash;                     /* the lamp is fixed to the camera */
    bool tone_unknown;              /* find the corrections of the tone curve, too */
} weft_lamp_problem;

typedef struct weft_lamp_solution {
    weft_lamp_place *place;         /* [count]; in: where the search starts */
    double tone[WEFT_TONE_TERMS];   /* corrections of the tone curve */
    double vignetting[3];           /* as weft_camera has it */
    double ink;                     /* reflectance of ink over that of paper */
    double ink_error;               /* its standard error, relative */
    double ball_misfit, pin_misfit; /* medians of how far highlights and shadows lie off, in standard errors */
    double size, size_error;        /* of balls and pin over what is told, with the relative standard error of that; 1
                                       and 0 where none is seen */
    double dark_error;              /* standard error of the tone curve, relative: of light of a tenth of the paper's; 0
                                       where the curve is known */
    weft_flash flash;               /* with a beam of zeros where the lamp is none */
} weft_lamp_solution;

/* Fills solution->place with a first guess: where the rays from the balls meet, else by the shadow of the pin, else as
 * listed, else by a search over directions and distances for what the paper shows; a listed lamp must explain the paper
 * nearly as well as that search does. The flash begins at the camera. Pure. */
void weft_lamp_guess(const weft_lamp_problem *problem, weft_lamp_solution *solution);

/* Finds the pairs: every photograph with the next darker one of the same view, within a degree, and the same light,
 * which is told by the paper: what a place has in one follows from what it has in the other. pair [problem->count];
 * those of `problem` are not looked at. Errors: WEFT_SYSTEM for memory. */
weft_code weft_exposure_pairs_find(const weft_lamp_problem *problem, weft_exposure_pair *pair, int *count,
                                   weft_error *error);

/* The corrections of the tone curve that pairs of exposures alone determine, by their law in weft_lamp_solve: where the
 * search for lamps starts. Of the evidence only the samples of paper count, which may be of any reflectance here.
 * Errors: WEFT_SYSTEM. */
weft_code weft_tone_of_pairs(const weft_lamp_problem *problem, double tone[WEFT_TONE_TERMS], weft_error *error);

/* Least squares over all photographs together (Ceres), from the guess. A sample of paper at place x of the
 * sheet, whose normal there is n, under a lamp at L obeys
 *     log light = log level + log((L - x).n |L|^2 / |L - x|^3) + log V(r^2) + [ink] log ink + [flash] log beam(x)
 * after Lambert's and the inverse square law; a highlight obeys the law of reflection on a sphere; lamp, head of the
 * pin and its shadow lie on a line; a list is believed within its standard errors. In a pair of exposures the
 * logarithms of the light of a place differ by that of their ratio, which is as written within a fiftieth in green and
 * free in red and blue (Debevec and Malik 1997). Shadows, stains and wrong rows hardly count (Cauchy's weight). One
 * lamp has one power: level |L|^2 / exposure is the same in all photographs, within a tenth, where the camera wrote its
 * exposure. Deviations from this model are smooth over the sheet, so the samples of one photograph count as
 * `independent_samples` in all. Errors: WEFT_SYSTEM. */
weft_code weft_lamp_solve(const weft_lamp_problem *problem, weft_lamp_solution *solution, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
