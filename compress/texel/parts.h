/* What the sources of a texel's fit share. Private to texel*.c. */
#ifndef WEFT_COMPRESS_TEXEL_PARTS_H
#define WEFT_COMPRESS_TEXEL_PARTS_H

#include "compress/fit/kernels.h"
#include "compress/fit/light_table.h"
#include "compress/texel/peak.h"
#include "compress/texel/texel.h"

/* A model of the three channels as it is stored, and as it will be read. */
typedef struct weft_texel_result {
    weft_packed packed[WEFT_CHANNELS];
    weft_fit as_read[WEFT_CHANNELS];
    int16_t frame[3];
    uint8_t *code, *light_code; /* [channel][view_count] of T, [channel][light_count] of S */
    bool turns, second_start;   /* its frame was turned; its lobes began as thrown back to the light */
    double residual;            /* of its channels before they were rounded */
    bool held;                  /* it would have been too bright somewhere */
} weft_texel_result;

struct weft_texel_fitter {
    const weft_texel_source *source;
    weft_bundle bundle;
    weft_samples samples;
    weft_fit_workspace *workspace;
    weft_frame_search frames;
    int most_lobes;                /* that the samples of the texel can carry */
    double *table;                 /* [2][view_count] of one channel; then room */
    int *seen;                     /* [view_count] valid samples */
    weft_texel_result now;         /* the last model that was fitted */
    weft_texel_result kept;        /* another, kept for comparison */
    float *decoded;                /* T of one channel as it will be read */
    double *factor;                /* [2][view_count] for compress/texel/hold.c */
    weft_peak_net net[2];          /* a coarse one, which suffices for most texels, and a fine one */
    weft_peak_lights peak_lights;  /* of S */
    weft_peak most[WEFT_CHANNELS]; /* no value of the texel may exceed it, in scaled units */
    int light_count;               /* of S; 0 without */
    double *light, *decoded_light; /* S of one channel, and as it will be read */
    double *grey_light;            /* S of the grey samples */
    weft_grey_fit lit;             /* of the same: lobes and T beside it */
    weft_light_workspace lights;
    const weft_fit_kernels *kernels;
    weft_error_tally *tally;
};

/* Is this one of the texels whose errors go into the percentiles? */
bool weft_texel_is_tallied(const weft_material_level *level, int x, int y);

/* What S needs; freed with weft_texel_light_free, also after an error. Errors: WEFT_SYSTEM. */
weft_code weft_texel_light_create(weft_texel_fitter *fitter, weft_error *error);
void weft_texel_light_free(weft_texel_fitter *fitter);

/* The fit of the grey samples with S, begun from `start`: S takes over what lobes and frame stood in for without it, so
 * that the frame, if it is fitted, must turn with it. */
const weft_grey_fit *weft_texel_light_start(weft_texel_fitter *fitter, const weft_fit_options *options,
                                            const weft_grey_fit *start);

/* Improves the fit of a channel and its T, and codes its S, which goes on from that of the grey samples. The largest
 * value of S becomes 1: what it is divided by goes into rho and the amplitudes when the fit is refined once more for S
 * as it will be read. */
void weft_texel_light_refine(weft_texel_fitter *fitter, const weft_fit_options *options, int channel, weft_fit *fit);

/* The samples of a channel with S as it will be read on their cosines. */
weft_samples weft_texel_samples_as_lit(weft_texel_fitter *fitter, int channel);

/* T of a channel is the mean of the others in views without any valid sample. Lowers its code where the model, whose
 * lobes were fitted to the others and may be of any size there, would glare beside the nearest view with samples. */
void weft_texel_limit_unseen(weft_texel_fitter *fitter, int channel);

/* What weft_texel_hold needs; freed with weft_texel_hold_free, also after an error. Errors: those of
 * weft_peak_net_create. */
weft_code weft_texel_hold_create(weft_texel_fitter *fitter, weft_error *error);
void weft_texel_hold_free(weft_texel_fitter *fitter);

/* Finds from the samples how bright the texel may be. */
void weft_texel_limit(weft_texel_fitter *fitter);

/* Holds a channel of the last model, fitted and packed, to that limit everywhere on the hemisphere. Lowers T of the
 * views that it would glare in or between. Without T, fits again with lobes that may not be so bright. Lowers all terms
 * where that does not suffice. `options` are those of the fit. */
void weft_texel_hold(weft_texel_fitter *fitter, int channel, const weft_fit_options *options);

/* Whether a channel of the last model, T and S as their codes are now, exceeds that limit. */
bool weft_texel_exceeds(weft_texel_fitter *fitter, int channel);

/* Whether any channel does. */
bool weft_texel_is_too_bright(weft_texel_fitter *fitter);

/* Squared error of the last model as it will be read, by the weights that it was fitted with. */
double weft_texel_weighted_error(weft_texel_fitter *fitter);

/* The last model as it will be read, against the samples. */
weft_error_sums weft_texel_measure(weft_texel_fitter *fitter, bool tallied);

/* Measures every candidate of the source's judgement; returns the sums of the last. One whose codes exceed the limit
 * only since they were rounded leaves an infinite error. */
weft_error_sums weft_texel_judge(weft_texel_fitter *fitter, int level, int x, int y);

#endif
