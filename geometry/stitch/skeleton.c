#include "geometry/stitch/segment_grid.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#define STATIONS_PER_RADIUS 6
#define MIN_ACROSS 0.05 /* |z x tangent|: about 3 degrees from upright */

enum { MAX_STATIONS = 1 << 19, BEZIER_LENGTH_STEPS = 16 };

typedef struct bezier {
    weft_vec3 handle[4];
} bezier;

weft_code weft_stitch_fail_at(const weft_stitch *stitch, const char *path, int yarn, int point, weft_error *error,
                              const char *format, ...)
{
    char what[WEFT_MESSAGE_SIZE];
    weft_text_place place = stitch->yarn[yarn].place[point];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return weft_fail(error, WEFT_BAD_INPUT, "%s:%d:%d: %s", path, place.line, place.column, what);
}

/* A control point of the endless yarn; index -1 .. point_count. */
static weft_vec3 control_point(const weft_stitch *stitch, const weft_stitch_yarn *yarn, int index)
{
    int period = yarn->point_count - 1, wraps = index < 0 ? -1 : index / period;
    weft_vec3 shift = weft_vec3_of(wraps * yarn->tiles_x * stitch->width, wraps * yarn->tiles_y * stitch->height, 0);
    return weft_add(yarn->point[index - wraps * period], shift);
}

/* Derivative of the Catmull-Rom curve at b by its parameter, whose steps are `before` (a to b) and `after` (b to c). */
static weft_vec3 spline_velocity(weft_vec3 a, weft_vec3 b, weft_vec3 c, weft_real before, weft_real after)
{
    weft_vec3 velocity = weft_scale(weft_subtract(b, a), 1 / before);
    velocity = weft_subtract(velocity, weft_scale(weft_subtract(c, a), 1 / (before + after)));
    return weft_add(velocity, weft_scale(weft_subtract(c, b), 1 / after));
}

/* The piece from control point `index` to the next. */
static bezier spline_piece(const weft_stitch *stitch, const weft_stitch_yarn *yarn, int index)
{
    weft_vec3 p[4];
    weft_real step[3];
    for (int i = 0; i < 4; i++)
        p[i] = control_point(stitch, yarn, index + i - 1);
    for (int i = 0; i < 3; i++)
        step[i] = sqrt(weft_length(weft_subtract(p[i + 1], p[i])));
    weft_vec3 start = spline_velocity(p[0], p[1], p[2], step[0], step[1]);
    weft_vec3 end = spline_velocity(p[1], p[2], p[3], step[1], step[2]);
    return (bezier){{p[1], weft_add(p[1], weft_scale(start, step[1] / 3)),
                     weft_subtract(p[2], weft_scale(end, step[1] / 3)), p[2]}};
}

static weft_vec3 bezier_at(const bezier *piece, weft_real t)
{
    weft_real s = 1 - t;
    const weft_real weight[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    weft_vec3 sum = {0};
    for (int i = 0; i < 4; i++)
        sum = weft_add(sum, weft_scale(piece->handle[i], weight[i]));
    return sum;
}

static weft_vec3 bezier_velocity(const bezier *piece, weft_real t)
{
    weft_real s = 1 - t;
    const weft_real weight[3] = {3 * s * s, 6 * s * t, 3 * t * t};
    weft_vec3 sum = {0};
    for (int i = 0; i < 3; i++)
        sum = weft_add(sum, weft_scale(weft_subtract(piece->handle[i + 1], piece->handle[i]), weight[i]));
    return sum;
}

static weft_real bezier_length(const bezier *piece)
{
    weft_real length = 0;
    for (int i = 0; i < BEZIER_LENGTH_STEPS; i++)
        length += weft_length(bezier_velocity(piece, (i + (weft_real)0.5) / BEZIER_LENGTH_STEPS));
    return length / BEZIER_LENGTH_STEPS;
}

static int piece_stations(const weft_stitch_yarn *yarn, const bezier *piece)
{
    weft_real radius = fmin(yarn->radius_side, yarn->radius_up);
    return (int)fmin(ceil(bezier_length(piece) / radius * STATIONS_PER_RADIUS), MAX_STATIONS) + 1;
}

static weft_code count_stations(const weft_stitch *stitch, const char *path, weft_yarn_skeleton *skeleton,
                                weft_error *error)
{
    long long total = 0;
    for (int i = 0; i < stitch->yarn_count; i++) {
        const weft_stitch_yarn *yarn = &stitch->yarn[i];
        long long of_yarn = 1;
        for (int k = 0; k + 1 < yarn->point_count; k++) {
            bezier piece = spline_piece(stitch, yarn, k);
            of_yarn += piece_stations(yarn, &piece);
        }
        total += of_yarn * yarn->copy_count;
        if (total > MAX_STATIONS)
            return weft_stitch_fail_at(stitch, path, i, 0, error,
                                       "yarns up to this one are too long for their radius: %lld stations, at most %d",
                                       total, MAX_STATIONS);
        skeleton->strand_count += yarn->copy_count;
    }
    skeleton->station_count = (int)total;
    return WEFT_OK;
}

static weft_code place_station(const weft_stitch *stitch, const char *path, int yarn, const bezier *piece, weft_real t,
                               weft_yarn_station *station, weft_error *error)
{
    station->at = bezier_at(piece, t);
    station->tangent = weft_unit(bezier_velocity(piece, t));
    weft_vec3 across = weft_vec3_of(-station->tangent.y, station->tangent.x, 0);
    if (!(weft_length(across) >= MIN_ACROSS))
        return weft_stitch_fail_at(
            stitch, path, yarn, station->point, error,
            "after this point the yarn stands upright at (%.3g, %.3g, %.3g) mm, where its cross-section "
            "has no direction",
            station->at.x, station->at.y, station->at.z);
    station->side = weft_unit(across);
    station->up = weft_cross(station->tangent, station->side);
    return WEFT_OK;
}

/* The stations of one yarn, not displaced; *count of them. */
static weft_code trace_yarn(const weft_stitch *stitch, const char *path, int yarn_index, weft_yarn_station *station,
                            int *count, weft_error *error)
{
    const weft_stitch_yarn *yarn = &stitch->yarn[yarn_index];
    int n = 0, last = yarn->point_count - 2;
    for (int k = 0; k <= last; k++) {
        bezier piece = spline_piece(stitch, yarn, k);
        int steps = piece_stations(yarn, &piece);
        for (int i = 0; i < steps + (k == last); i++, n++) {
            station[n].point = k;
            WEFT_TRY(place_station(stitch, path, yarn_index, &piece, (weft_real)i / steps, &station[n], error));
            station[n].arclength =
                n == 0 ? 0 : station[n - 1].arclength + weft_length(weft_subtract(station[n].at, station[n - 1].at));
        }
    }
    *count = n;
    return WEFT_OK;
}

static void copy_strand(weft_yarn_station *to, const weft_yarn_station *from, int count, weft_vec3 displacement)
{
    for (int i = 0; i < count; i++) {
        to[i] = from[i];
        to[i].at = weft_add(from[i].at, displacement);
    }
}

/* The twist nearest to that of the yarn with which each ply meets a ply after one period. */
static weft_real periodic_twist(const weft_stitch_yarn *yarn, weft_real length)
{
    return round(yarn->twist * length * yarn->plies) / (yarn->plies * length);
}

static weft_code trace_strands(const char *path, weft_yarn_skeleton *skeleton, weft_error *error)
{
    const weft_stitch *stitch = skeleton->stitch;
    weft_yarn_station *next = skeleton->station;
    weft_yarn_strand *strand = skeleton->strand;
    for (int i = 0; i < stitch->yarn_count; i++) {
        const weft_stitch_yarn *yarn = &stitch->yarn[i];
        weft_yarn_station *original = next;
        int count;
        WEFT_TRY(trace_yarn(stitch, path, i, original, &count, error));
        weft_real twist = periodic_twist(yarn, original[count - 1].arclength);
        for (int c = yarn->copy_count - 1; c >= 0; c--, strand++) {
            /* The original lies in the place of the last of its copies, which is made at the end. */
            weft_yarn_station *place = original + (ptrdiff_t)c * count;
            copy_strand(place, original, count, yarn->copy[c]);
            *strand = (weft_yarn_strand){i, (int)(place - skeleton->station), count, twist};
        }
        next = original + (ptrdiff_t)yarn->copy_count * count;
    }
    return WEFT_OK;
}

weft_code weft_yarn_skeleton_create(const weft_stitch *stitch, const char *path, weft_yarn_skeleton *skeleton,
                                    weft_error *error)
{
    *skeleton = (weft_yarn_skeleton){.stitch = stitch};
    WEFT_TRY(count_stations(stitch, path, skeleton, error));
    skeleton->station = calloc((size_t)skeleton->station_count, sizeof *skeleton->station);
    skeleton->strand = calloc((size_t)skeleton->strand_count, sizeof *skeleton->strand);
    weft_code code;
    if (!skeleton->station || !skeleton->strand)
        code =
            weft_fail_memory(error, "stations of yarns", (size_t)skeleton->station_count * sizeof(weft_yarn_station));
    else
        code = trace_strands(path, skeleton, error);
    if (code != WEFT_OK)
        weft_yarn_skeleton_free(skeleton);
    return code;
}

void weft_yarn_skeleton_free(weft_yarn_skeleton *skeleton)
{
    free(skeleton->station);
    free(skeleton->strand);
    *skeleton = (weft_yarn_skeleton){0};
}
