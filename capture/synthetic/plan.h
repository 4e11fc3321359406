/* What a person with a camera and a lamp does: where both are, photograph by photograph, how the camera exposes, and
 * what goes wrong. A function of request and seed alone. */
#ifndef WEFT_CAPTURE_SYNTHETIC_PLAN_H
#define WEFT_CAPTURE_SYNTHETIC_PLAN_H

#include "base/status.h"
#include "capture/synthetic/scene.h"
#include "capture/virtual/random.h"

#include <stddef.h>
#include <stdint.h>

/* ---- From light to the numbers of a file: exposure, the sensor's noise, white balance and the tone curve of the camera. ---- */

/* Tone curves of cameras. */
typedef enum weft_synthetic_curve {
    WEFT_SYNTHETIC_CONTRAST, /* t = x^2 / (x + 0.002), then t^n / (t^n + m) over the same at x = 1, n = 0.85, m = 0.4^n:
                           a toe, and a shoulder (the response of Naka and Rushton 1966). Darker than sRGB in the dark
                         */
    WEFT_SYNTHETIC_SOFT      /* ((1 - e^-2x) / (1 - e^-2))^(1/2.2): grains that are hit or not (Poisson), on a screen of
                           gamma 2.2. Brighter than sRGB in the dark */
} weft_synthetic_curve;

typedef struct weft_synthetic_exposure {
    double seconds, f_number, iso; /* as the camera says */
    double gain;                   /* part of the sensor's range that 1 cd/m^2 fills, truly */
    double white_balance[3];       /* multiplies the channels behind the sensor; green is 1 */
} weft_synthetic_exposure;

/* gain = seconds iso / (120 f_number^2): the sensor is full where ISO 12232 has it (78 / iso lux seconds, with 0.65 of
 * the light on the axis). The shutter makes it a little more or less. Pure. */
double weft_synthetic_gain(double seconds, double f_number, double iso);

/* linear [count] 0..1 = what the sensor reads of radiance [count] (count = 3 pixels), black level taken off, white
 * balance applied, clipped: 14 bits, shot and read noise (capture/virtual/sensor.h). `key` alone decides the noise.
 * Parallel. Errors: WEFT_SYSTEM. */
weft_code weft_synthetic_sense(const weft_synthetic_exposure *exposure, const float *radiance, size_t count,
                               uint64_t key, float *linear, weft_error *error);

/* The tone curve of the camera's JPEG, 0..1 to 0..1. Pure. */
double weft_synthetic_tone(weft_synthetic_curve curve, double linear);

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
                                             const weft_synthetic_sheet *sheet, const weft_virtual_sample *content);

const char *weft_synthetic_fault_name(weft_synthetic_fault fault);

/* ---- Random numbers of one synthetic photograph, in the order in which they are asked for. ---- */

enum { WEFT_DICE_CHANCES = 4096 }; /* random numbers of a photograph */

typedef struct weft_dice {
    uint64_t seed, next;
} weft_dice;

/* Those of a photograph; what all share has negative ones. */
static inline weft_dice weft_dice_of(uint64_t seed, int photograph)
{
    return (weft_dice){seed, (uint64_t)photograph * WEFT_DICE_CHANCES};
}

/* Uniform in [low, high). */
static inline double weft_dice_between(weft_dice *d, double low, double high)
{
    return low + (high - low) * weft_random_uniform(d->seed, WEFT_RANDOM_HAND, d->next++);
}

/* Normal, with a mean of 0. */
static inline double weft_dice_normal(weft_dice *d, double deviation)
{
    return deviation * weft_random_normal(d->seed, WEFT_RANDOM_HAND, d->next++);
}

/* ---- What goes wrong with photographs of a hand. ---- */

/* The rubbish lies evenly among the photographs, each kind in turn. Pure. */
weft_synthetic_fault weft_synthetic_fault_of(const weft_synthetic_request *request, int photograph);

/* Where the hand of a shot is. One that shades keeps out of the picture of the opening if it can; one over the plate
 * does not. Pure. */
void weft_synthetic_place_hand(const weft_synthetic_request *request, weft_dice *d, weft_synthetic_shot *shot);

/* What the fault of a shot does to its exposure and its pose. Pure. */
void weft_synthetic_spoil(weft_dice *d, weft_synthetic_shot *shot);

#endif
