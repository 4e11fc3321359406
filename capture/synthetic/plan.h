/* What a person with a camera and a lamp does: where both are, photograph by photograph, how the camera exposes, and
 * what goes wrong. A function of request and seed alone. */
#ifndef WEFT_CAPTURE_SYNTHETIC_PLAN_H
#define WEFT_CAPTURE_SYNTHETIC_PLAN_H

#include "capture/synthetic/develop.h"
#include "capture/synthetic/lens.h"
#include "capture/synthetic/scene.h"

typedef enum weft_synthetic_set {
    WEFT_SYNTHETIC_FREE,   /* camera in one hand, lamp in the other */
    WEFT_SYNTHETIC_FLASH,  /* a flash on the camera */
    WEFT_SYNTHETIC_TRIPOD, /* the camera stands, the lamp moves */
    WEFT_SYNTHETIC_STEPPED /* a turntable under the sheet, and arms for camera and lamp: poses of a table, nearly */
} weft_synthetic_set;

typedef enum weft_synthetic_format {
    WEFT_SYNTHETIC_JPEG, /* 8 bits behind a tone curve, quality 93 */
    WEFT_SYNTHETIC_TIFF, /* 16 bits, linear */
    WEFT_SYNTHETIC_EXR   /* half floats, linear */
} weft_synthetic_format;

/* What a photograph should not be. */
typedef enum weft_synthetic_fault {
    WEFT_SYNTHETIC_GOOD,
    WEFT_SYNTHETIC_SHAKEN,
    WEFT_SYNTHETIC_OTHER_SCENE,
    WEFT_SYNTHETIC_LENS_CAP,
    WEFT_SYNTHETIC_HAND_OVER,
    WEFT_SYNTHETIC_UNDEREXPOSED,
    WEFT_SYNTHETIC_HALF_OUT,
    WEFT_SYNTHETIC_FAULT_COUNT
} weft_synthetic_fault;

typedef struct weft_synthetic_request {
    const char *folder;  /* made; must be empty or not there */
    const char *content; /* "checker", or a file of a weave or stitch */
    weft_synthetic_set set;
    weft_synthetic_format format;
    uint64_t seed;
    int photograph_count, rubbish_count; /* the latter among the former */
    int series_count;                    /* of them are taken twice, the second time two stops darker; at most half */
    weft_synthetic_curve curve;          /* of the camera's JPEG */
    int width;                           /* pixels; the height is 2/3 of it */
    double opening_mm, focal_length_mm, max_view_rad;
    double lamp_radius_mm;
    double hand_shadows;  /* part of the photographs where a hand shades the sheet */
    double gloss;         /* of paper and ink */
    double window;        /* luminance, cd/m^2 */
    double white_balance; /* relative standard deviation of its gains */
    double breathing;     /* how much of a simple lens's extension the focal length follows: 0 none, 1 all */
    bool no_balls, no_pin;
    int truth_size; /* texels along a side; 0: the truth holds no reflectance */
} weft_synthetic_request;

enum { WEFT_SYNTHETIC_NAME_SIZE = 32 };

typedef struct weft_synthetic_shot {
    char name[WEFT_SYNTHETIC_NAME_SIZE]; /* of the file */
    char date[20];                       /* as EXIF has it */
    uint64_t key;                        /* of its noise */
    weft_synthetic_fault fault;
    weft_synthetic_lens lens; /* of this photograph: its focus, and what focus changes */
    weft_pose pose;           /* sheet to camera, as the pixels of the file lie */
    int orientation;          /* EXIF: 1, or 6 or 8 where the camera stood upright */
    weft_synthetic_lamp lamp;
    weft_synthetic_exposure exposure;
    bool hand_shadow;
    weft_vec3 hand, hand_along;                /* where the shading hand is */
    double nominal_theta_rad, nominal_phi_rad; /* stepped: what the table says of the view */
} weft_synthetic_shot;

weft_synthetic_request weft_synthetic_request_default(void);

/* Fills shot [photograph_count]. Pure. */
void weft_synthetic_plan(const weft_synthetic_request *request, weft_synthetic_shot *shot);

/* The scene of a shot. `sheet` is that of its fault: another one where the scene is another. */
weft_synthetic_scene weft_synthetic_scene_of(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                             const weft_synthetic_sheet *sheet, const weft_synthetic_content *content);

const char *weft_synthetic_fault_name(weft_synthetic_fault fault);

#endif
