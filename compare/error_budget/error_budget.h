/* Where the error of a material comes from, on virtual cloth whose reflectance is known everywhere
 * (docs/guide/truth.md). */
#ifndef WEFT_COMPARE_ERROR_BUDGET_ERROR_BUDGET_H
#define WEFT_COMPARE_ERROR_BUDGET_ERROR_BUDGET_H

#include "base/progress.h"
#include "base/status.h"
#include "capture/virtual/sample.h"
#include "capture/virtual/virtual_rig.h"
#include "capture/virtual/virtual_settings.h"

#include <jansson.h>
#include <limits.h>
#include <stddef.h>
#include <stdint.h>

/* ---- Chain ---- */

/* From virtual cloth to a file, as a user would do it, but without heights: photographs, dataset, material. */

typedef struct weft_chain_request {
    const char *plan;    /* capture/plan.h */
    int size;            /* texels along a side */
    int component_count; /* of the material, at most 32; WEFT_COMPONENTS_AUTOMATIC as weft compress chooses */
} weft_chain_request;

/* What was made: files in a folder. */
typedef struct weft_chain {
    char session[PATH_MAX], registered[PATH_MAX], fitted[PATH_MAX], stored[PATH_MAX];
    int photograph_count, registered_count, component_count;
} weft_chain;

/* Takes the photographs with an open rig, registers them, and fits components twice: once with coefficients of 15 bits,
 * for `fitted`, and once of 8 bits as weft compress does, for `stored`. The photographs are removed once they are
 * registered. The caller removes the rest with weft_chain_remove, also after a failure. Errors: those of the stages. */
weft_code weft_chain_make(const weft_chain_request *request, weft_virtual_rig *rig, const char *folder,
                          const weft_progress *progress, weft_chain *chain, weft_error *error);
void weft_chain_remove(const weft_chain *chain);

/* ---- Cloth ---- */

/* The reflectance of virtual cloth from any direction, photographed or not. */

/* A texel of an opening cut into width x height; row 0 at the top. */
typedef struct weft_cloth_texel {
    int width, height, x, y;
} weft_cloth_texel;

/* pi BRDF cos(theta_light) for a far light and a far camera, the mean over the texel as the plane of the plate shows
 * it, from `paths` places drawn evenly, each with a path of light of its own. `key` decides them: other keys give
 * independent answers. Thread-safe. */
weft_rgb weft_cloth_reflectance(const weft_virtual_sample *sample, const weft_cloth_texel *texel, weft_vec3 light,
                                weft_vec3 view, int paths, uint64_t key);

/* ---- Stack ---- */

/* The error of a material split into what each stage from the cloth to the file added to it.
 *
 * Five values answer every query, a place, a light and a view drawn at random: t, the cloth itself; s, what its exact
 * samples in the measured directions say, interpolated; r, the samples that registration made of photographs of these
 * directions, interpolated alike; m, the material that was fitted to those; f, the same as its file says it. With
 * E = sum t^2 over queries and channels the squared relative error of a stage is
 *
 *     e(x) = sum (x - t)^2 / E
 *
 * and the parts are what it grew by from one stage to the next:
 *
 *     directions e(s),  registration e(r) - e(s),  model e(m) - e(r),  storage e(f) - e(m)
 *
 * They add up to e(f), the square of the relative RMSE (base/numeric/error_summary.h), by construction. They are no
 * independent errors. A part is the square of what its stage changed, and twice the product of that with the error that
 * was there before,
 *
 *     e(r) - e(s) = sum (r - s)^2 / E + 2 sum (r - s)(s - t) / E
 *
 * so that it is negative where a stage makes up for an error before it, as a smooth model does that is fitted to noise.
 * What its stage changed alone is `own`.
 *
 * t and s may come from random paths of light. Both are given twice, each time from paths of its own, and squares are
 * products of the two: the noise drops out of the mean without being known. So an error that is small beside its noise
 * may come out below 0. */

typedef enum weft_error_source {
    WEFT_SOURCE_DIRECTIONS,
    WEFT_SOURCE_REGISTRATION, /* the photographs, too: lens, sensor, lamp */
    WEFT_SOURCE_MODEL,
    WEFT_SOURCE_STORAGE,
    WEFT_SOURCE_COUNT
} weft_error_source;

/* "directions", "registration", "model", "storage". Pure. */
const char *weft_error_source_name(weft_error_source source);

/* The answers to a query, reflectance times cosine by channel. */
typedef struct weft_source_answer {
    double cloth[2][3], sampled[2][3]; /* t and s, twice */
    double registered[3], fitted[3], stored[3];
} weft_source_answer;

/* With the ends of an interval of 95 %. */
typedef struct weft_source_share {
    double value, low, high;
} weft_source_share;

typedef struct weft_error_stack {
    size_t query_count;
    weft_source_share part[WEFT_SOURCE_COUNT], whole; /* squared relative errors */
    double own[WEFT_SOURCE_COUNT];                    /* what each stage changed, squared, in the same unit */
    double noise; /* standard error of the cloth's mean of its two answers, RMS, relative to the RMS of the cloth */
} weft_error_stack;

/* Intervals are the percentiles of 1000 draws of as many queries with replacement (the bootstrap of Efron 1979): they
 * hold for other queries of the same photographs, not for other photographs. `seed` decides the draws. Errors:
 * WEFT_BAD_USAGE without a query or where the cloth is black; WEFT_SYSTEM for memory. */
weft_code weft_error_stack_of(const weft_source_answer *answer, size_t count, uint64_t seed, weft_error_stack *stack,
                              weft_error *error);

/* ---- Measure ---- */

/* The answers of every stage to queries drawn at random. */

/* What is asked. */
typedef struct weft_source_stages {
    const weft_virtual_sample *sample;
    const char *registered; /* NAME.btf.h5, a far dataset of the opening of the sample */
    const char *fitted;     /* NAME.weft, before it was rounded */
    const char *stored;     /* the same as it is kept */
} weft_source_stages;

typedef struct weft_source_queries {
    int count;
    int paths; /* of light for each value of the cloth */
    uint64_t seed;
} weft_source_queries;

/* Where queries lie. */
typedef struct weft_source_span {
    double theta_rad; /* lights and views are at most so far from the normal: as the outermost that were photographed */
    int asked, unseen; /* queries, and how many of them no registered sample answers, which are left out */
} weft_source_span;

/* Draws queries: a texel of the dataset, asked at its centre, and independently a light and a view, evenly in solid
 * angle within the span. The exact samples that s is made of are those of the cloth in the directions of the dataset,
 * which raw BTF would take (evaluate/model.h). The same for any number of threads. answer [queries->count]
 * receives span->asked - span->unseen answers. Errors: WEFT_BAD_INPUT where a file cannot be read or the dataset is
 * near; those of reading; WEFT_SYSTEM. */
weft_code weft_source_answers(const weft_source_stages *stages, const weft_source_queries *queries,
                              const weft_progress *progress, weft_source_answer *answer, weft_source_span *span,
                              weft_error *error);

/* ---- Sources ---- */

/* Where the error of a material comes from, on virtual cloth whose reflectance is known everywhere
 * (docs/guide/truth.md). */

typedef struct weft_error_budget_request {
    weft_virtual_settings rig;
    double tiles; /* of a stitch across the opening; opening, lens and errors of places are scaled; 0: as they are */
    weft_chain_request chain;
    weft_source_queries queries; /* its seed is that of the rig, too */
    const char *folder;          /* for files that are gone in the end */
} weft_error_budget_request;

/* Of one cloth. */
typedef struct weft_error_budget {
    char name[128];    /* that the file gives the cloth */
    double opening_mm; /* that was photographed */
    int photograph_count, registered_count, size, component_count;
    weft_source_span span;
    weft_error_stack stack;
} weft_error_budget;

/* Photographs the weave or stitch `cloth` virtually, registers and compresses it, and splits the error of the material
 * against the cloth itself. Makes the folder. The same request gives the same result, for any number of threads.
 * Errors: those of the stages; WEFT_BAD_USAGE where no query can be answered. */
weft_code weft_error_budget_measure(const weft_error_budget_request *request, const char *cloth,
                                    const weft_progress *progress, weft_error_budget *result, weft_error *error);

/* The result as JSON. The caller owns it; NULL where memory is short. */
json_t *weft_error_budget_to_json(const weft_error_budget *budget);

/* Writes a table of comma-separated values, a row for each cloth and source, atomically. Errors: WEFT_SYSTEM. */
weft_code weft_error_budget_write_csv(const weft_error_budget *budget, int count, const char *path, weft_error *error);

/* Writes folder/index.html with one stack for each cloth. Errors: WEFT_SYSTEM. */
weft_code weft_error_budget_write_page(const weft_error_budget *budget, int count,
                                       const weft_error_budget_request *request, weft_error *error);

#endif
