/* What a person with a camera and a lamp does: where both are, photograph by photograph, how the camera exposes, and
 * what goes wrong. A function of request and seed alone. */
#ifndef WEFT_CAPTURE_HAND_PLAN_H
#define WEFT_CAPTURE_HAND_PLAN_H

#include "capture/hand/develop.h"
#include "capture/hand/lens.h"
#include "capture/hand/scene.h"

typedef enum weft_snap_set {
    WEFT_SNAP_FREE,   /* camera in one hand, lamp in the other */
    WEFT_SNAP_FLASH,  /* a flash on the camera */
    WEFT_SNAP_TRIPOD, /* the camera stands, the lamp moves */
    WEFT_SNAP_STEPPED /* a turntable under the sheet, and arms for camera and lamp: poses of a table, nearly */
} weft_snap_set;

typedef enum weft_snap_format {
    WEFT_SNAP_JPEG, /* 8 bits behind a tone curve, quality 93 */
    WEFT_SNAP_TIFF, /* 16 bits, linear */
    WEFT_SNAP_EXR   /* half floats, linear */
} weft_snap_format;

/* What a photograph should not be. */
typedef enum weft_snap_fault {
    WEFT_SNAP_GOOD,
    WEFT_SNAP_SHAKEN,
    WEFT_SNAP_OTHER_SCENE,
    WEFT_SNAP_LENS_CAP,
    WEFT_SNAP_HAND_OVER,
    WEFT_SNAP_UNDEREXPOSED,
    WEFT_SNAP_HALF_OUT,
    WEFT_SNAP_FAULT_COUNT
} weft_snap_fault;

typedef struct weft_snap_request {
    const char *folder;  /* made; must be empty or not there */
    const char *content; /* "checker", or a file of a weave or stitch */
    weft_snap_set set;
    weft_snap_format format;
    uint64_t seed;
    int photograph_count, rubbish_count; /* the latter among the former */
    int series_count;                    /* of them are taken twice, the second time two stops darker; at most half */
    weft_snap_curve curve;               /* of the camera's JPEG */
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
} weft_snap_request;

enum { WEFT_SNAP_NAME_SIZE = 32 };

typedef struct weft_snap_shot {
    char name[WEFT_SNAP_NAME_SIZE]; /* of the file */
    char date[20];                  /* as EXIF has it */
    uint64_t key;                   /* of its noise */
    weft_snap_fault fault;
    weft_snap_lens lens; /* of this photograph: its focus, and what focus changes */
    weft_pose pose;      /* sheet to camera, as the pixels of the file lie */
    int orientation;     /* EXIF: 1, or 6 or 8 where the camera stood upright */
    weft_snap_lamp lamp;
    weft_snap_exposure exposure;
    bool hand_shadow;
    weft_vec3 hand, hand_along;                /* where the shading hand is */
    double nominal_theta_rad, nominal_phi_rad; /* stepped: what the table says of the view */
} weft_snap_shot;

weft_snap_request weft_snap_request_default(void);

/* Fills shot [photograph_count]. Pure. */
void weft_snap_plan(const weft_snap_request *request, weft_snap_shot *shot);

/* The scene of a shot. `sheet` is that of its fault: another one where the scene is another. */
weft_snap_scene weft_snap_scene_of(const weft_snap_request *request, const weft_snap_shot *shot,
                                   const weft_snap_sheet *sheet, const weft_snap_content *content);

const char *weft_snap_fault_name(weft_snap_fault fault);

#endif
