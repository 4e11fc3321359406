/* Photographs of two lenses, or of two zooms, in one folder, where no file says so: each part has a lens of its own
 * that explains its corners much better than one lens does all. */
#include "registration/photographs/lens.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 8, FEWEST = 2 };

/* One lens that fits leaves less than this, pixels and as a share of the longer side. */
static const double suspicious_px = 0.5, suspicious_share = 4e-4;

/* The search starts from lenses longer and shorter by this. Two lenses count where they lower the squares by a third at
 * least, and differ by more than the breathing of a lens that focuses. */
static const double start_factor = 1.2, most_squares = 0.67, least_difference = 0.04;

static const unsigned lens_terms = (1 << WEFT_BUNDLE_BEND) - 1;

/* The photographs that are used. */
typedef struct folder {
    int count;
    int *photograph;        /* [count] */
    weft_corner_view *view; /* [count] */
    weft_pose *pose[2];     /* [2][count] under either lens */
    bool *second;           /* [count] is of the second lens */
    weft_corner_view *part; /* [count] those of one lens, packed, and their poses */
    weft_pose *part_pose;
} folder;

static void folder_free(folder *f)
{
    free(f->photograph);
    free(f->view);
    free(f->pose[0]);
    free(f->pose[1]);
    free(f->second);
    free(f->part);
    free(f->part_pose);
}

static weft_code folder_of(const weft_photographs_photograph *photograph, int count, folder *f, weft_error *error)
{
    size_t n = (size_t)count + 1;
    *f = (folder){0,
                  calloc(n, sizeof *f->photograph),
                  calloc(n, sizeof *f->view),
                  {calloc(n, sizeof(weft_pose)), calloc(n, sizeof(weft_pose))},
                  calloc(n, sizeof *f->second),
                  calloc(n, sizeof *f->part),
                  calloc(n, sizeof *f->part_pose)};
    if (!f->photograph || !f->view || !f->pose[0] || !f->pose[1] || !f->second || !f->part || !f->part_pose)
        return weft_fail_memory(error, "corners of photographs", n * sizeof *f->view);
    for (int i = 0; i < count; i++) {
        const weft_photographs_photograph *p = &photograph[i];
        if (!weft_photographs_used(p))
            continue;
        f->photograph[f->count] = i;
        f->pose[0][f->count] = f->pose[1][f->count] = p->pose;
        f->view[f->count++] =
            (weft_corner_view){p->corner_count, (const double(*)[2])p->plate, (const double(*)[2])p->seen};
    }
    return WEFT_OK;
}

/* Gives every photograph to the lens that explains it better; *squares: what is left over then. */
static weft_code assign(const weft_bundle lens[2], folder *f, double *squares, bool *changed, weft_error *error)
{
    *changed = false;
    *squares = 0;
    for (int i = 0; i < f->count; i++) {
        double left[2];
        for (int k = 0; k < 2; k++) {
            weft_bundle one = {.camera = lens[k].camera, .bend = lens[k].bend, .pose = &f->pose[k][i]};
            WEFT_TRY(weft_bundle_adjust(&f->view[i], 1, 0, &one, error));
            left[k] = one.squares;
        }
        *changed = *changed || f->second[i] != (left[1] < left[0]);
        f->second[i] = left[1] < left[0];
        *squares += fmin(left[0], left[1]);
    }
    return WEFT_OK;
}

/* *seconds: how many photographs are of the second lens. */
static weft_code fit_parts(weft_bundle lens[2], folder *f, int *seconds, weft_error *error)
{
    *seconds = 0;
    for (int i = 0; i < f->count; i++)
        *seconds += f->second[i];
    for (int k = 0; k < 2; k++) {
        int count = 0;
        for (int i = 0; i < f->count; i++) {
            if (f->second[i] != (k == 1))
                continue;
            f->part_pose[count] = f->pose[k][i];
            f->part[count++] = f->view[i];
        }
        lens[k].pose = f->part_pose;
        if (count >= FEWEST)
            WEFT_TRY(weft_bundle_adjust(f->part, count, lens_terms, &lens[k], error));
    }
    return WEFT_OK;
}

/* The part of fewer photographs is left out; returns how many. */
static int leave_out(const weft_bundle lens[2], const folder *f, int seconds, weft_photographs_photograph *photograph)
{
    bool second = 2 * seconds <= f->count;
    double focal = lens[second].camera.fx, other = lens[!second].camera.fx;
    int left_out = second ? seconds : f->count - seconds;
    if (left_out < FEWEST || fabs(focal / other - 1) < least_difference)
        return 0;
    for (int i = 0; i < f->count; i++) {
        weft_photographs_photograph *p = &photograph[f->photograph[i]];
        if (f->second[i] == second)
            snprintf(p->remark, sizeof p->remark,
                     "it was taken with another lens or zoom: its focal length is some %.0f pixels, that of most %.0f; "
                     "photographs of another lens need a folder of their own",
                     focal, other);
    }
    return left_out;
}

static weft_code search(const weft_lens_estimate *one, folder *f, weft_bundle lens[2], double *squares, int *seconds,
                        weft_error *error)
{
    bool changed = true;
    for (int k = 0; k < 2; k++) {
        double factor = k ? 1 / start_factor : start_factor;
        lens[k] = (weft_bundle){.camera = one->camera, .bend = one->bend};
        lens[k].camera.fx *= factor;
        lens[k].camera.fy *= factor;
        for (int i = 0; i < f->count; i++)
            f->pose[k][i].translation.z *= factor;
    }
    WEFT_TRY(assign(lens, f, squares, &changed, error));
    for (int round = 0; round < ROUNDS && changed; round++) {
        WEFT_TRY(fit_parts(lens, f, seconds, error));
        WEFT_TRY(assign(lens, f, squares, &changed, error));
    }
    return WEFT_OK;
}

weft_code weft_lens_leave_out_second(const weft_lens_estimate *one, weft_photographs_photograph *photograph, int count,
                                     int *left_out, weft_error *error)
{
    double together = 0, apart = 0, corners = 0;
    int seconds = 0;
    weft_bundle lens[2];
    folder f;
    weft_code code = folder_of(photograph, count, &f, error);
    *left_out = 0;
    for (int i = 0; code == WEFT_OK && i < f.count; i++) {
        const weft_photographs_photograph *p = &photograph[f.photograph[i]];
        together += p->corner_rms_px * p->corner_rms_px * p->corner_count;
        corners += p->corner_count;
    }
    double limit = fmax(suspicious_px, suspicious_share * fmax(one->camera.width, one->camera.height));
    if (code == WEFT_OK && f.count >= 3 * FEWEST && together > limit * limit * corners) {
        code = search(one, &f, lens, &apart, &seconds, error);
        if (code == WEFT_OK && apart < most_squares * together)
            *left_out = leave_out(lens, &f, seconds, photograph);
    }
    folder_free(&f);
    return code;
}
