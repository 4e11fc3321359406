/* The images of a dataset in the order in which a fit wants them: a view a lane, one light after the other, so that
 * what belongs to a view adds up without leaving its lane. Samples of a texel are gathered into this order once and
 * then read many times. */
#ifndef WEFT_COMPRESS_FIT_BUNDLE_H
#define WEFT_COMPRESS_FIT_BUNDLE_H

#include "base/status.h"
#include "btf/dataset/dataset.h"

#include <stdbool.h>

enum { WEFT_STRIP_LANES = 16, WEFT_COARSE_SAMPLES = 2460 /* 3/8 of 81 x 81 */ };

/* Samples that are looked at together, sixteen at a time. Slot s of lane i is sample first + 16 s + i. */
typedef struct weft_strip {
    int first;
    int slots;
    int coarse_slots; /* the first slots: a quarter of the lights, more where samples are few */
    int view;         /* lane i holds the samples of view + i; where `split`, all lanes hold those of `view` */
    bool split;
} weft_strip;

/* Which slots of the strips a pass looks at. */
typedef enum weft_part { WEFT_PART_COARSE, WEFT_PART_ALL } weft_part;

/* Owned by the caller. The order depends on the directions alone, not on the order of the images. Inside a view the
 * lights are shuffled evenly, so that its first slots alone are a fair coarse sample. */
typedef struct weft_bundle {
    int view_count, image_count;
    int view_stride; /* view_count rounded up to whole strips: the length of what is kept for every view */
    int sample_count;
    int strip_count;
    bool is_coarse;     /* some strip has fewer coarse slots than slots */
    weft_strip *strip;  /* [strip_count] */
    int32_t *image;     /* [sample_count] the image whose sample stands here, -1 in the padding */
    int32_t *view_of;   /* [sample_count] */
    float *weight;      /* [sample_count] of the image, 1 in the mean over the bundled images */
    weft_vec3 *view;    /* [view_count] unit, in the frame of the surface */
    float *view_xyz[3]; /* [view_stride] the same; 0 in the padding */
    float *light[3];    /* [sample_count] unit, in the frame of the surface; 0 in the padding */
} weft_bundle;

/* Bundles the images of a layout; those with held_out[image] != 0 are left out (held_out may be NULL). Directions are
 * set for far datasets; for near ones call weft_bundle_aim. Errors: WEFT_SYSTEM. */
weft_code weft_bundle_create(const weft_dataset_layout *layout, const uint8_t *held_out, weft_bundle *bundle,
                             weft_error *error);
void weft_bundle_free(weft_bundle *bundle);

/* Directions as seen from the point (x_mm, y_mm) of the material, for near datasets; no effect on far ones. */
void weft_bundle_aim(weft_bundle *bundle, const weft_dataset_layout *layout, double x_mm, double y_mm);

/* Place in mm, origin at the centre of the material, of the centre of the texels [x0, x1) x [y0, y1). Pure. */
void weft_bundle_place(const weft_dataset_layout *layout, int x0, int y0, int x1, int y1, double *x_mm, double *y_mm);

enum { WEFT_CHANNELS = 3, WEFT_GREY = 3 };

/* The samples of one texel in the order of a bundle, scaled by the root of their weights and by one factor for the
 * whole texel that brings their mean square to 1. Arrays are [sample_count]; samples of zero weight are 0. */
typedef struct weft_samples {
    int sample_count;
    float *cosine;                    /* root of the weight times l_z */
    float *value[WEFT_CHANNELS + 1];  /* root of the weight times the sample / scale: r, g, b and their mean */
    double energy[WEFT_CHANNELS + 1]; /* sum of squares of value */
    double scale;                     /* multiply by it to return to the units of the dataset */
    double weight;                    /* sum of the weights */
    int valid_count;                  /* samples of positive weight */
} weft_samples;

weft_code weft_samples_create(const weft_bundle *bundle, weft_samples *samples, weft_error *error);
void weft_samples_free(weft_samples *samples);

/* Gathers sums of samples over a group of texels: sum [image_count][3], count [image_count] valid texels among
 * `group_size`. Value = mean over the valid ones, weight = their share times that of the image; lights at or
 * below the horizon get weight 0.
 * Samples without the cosine (WEFT_REFLECTANCE) are multiplied by it. Returns nothing; not-finite sums get weight 0. */
void weft_samples_gather(const weft_bundle *bundle, weft_values values, const float *sum, const float *count,
                         int group_size, weft_samples *samples);

/* Multiplies the weight of every sample r, its cosine included, by 1 / (1 + grey(r) / (WEFT_SCREEN_TOE rms)), where rms
 * is that of the texel: on a screen, which shows r^(1 / 2.2) above a toe, the square of an error of r counts about as 1
 * / r. Where two lobes cannot follow a highlight, what lies beside it is then no longer given up for it. */
#define WEFT_SCREEN_TOE 0.5
void weft_samples_weigh_for_screen(const weft_bundle *bundle, weft_samples *samples);

#endif
