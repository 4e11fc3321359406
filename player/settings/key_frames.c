#include "player/settings/key_frames.h"

#include "base/text/csv.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_KEYS = 100000 };

/* What a value is interpolated as. */
typedef enum value_scale { PLAIN, DEGREES, LOGARITHM, LOGARITHM_ABOVE_1 } value_scale;

typedef struct value_column {
    const char *name;
    size_t offset; /* in weft_scene */
    value_scale scale;
    double low, high;
} value_column;

static const value_column columns[WEFT_PATH_VALUE_COUNT] = {
    {"azimuth_deg", offsetof(weft_scene, orbit.azimuth_rad), DEGREES, -3.6e6, 3.6e6},
    {"elevation_deg", offsetof(weft_scene, orbit.elevation_rad), DEGREES, -90, 90},
    {"distance", offsetof(weft_scene, orbit.distance), LOGARITHM_ABOVE_1, 1 + 1e-6, 1e9},
    {"pan_right", offsetof(weft_scene, orbit.pan_right), PLAIN, -1e6, 1e6},
    {"pan_up", offsetof(weft_scene, orbit.pan_up), PLAIN, -1e6, 1e6},
    {"light_theta_deg", offsetof(weft_scene, light[0].direction.theta_rad), DEGREES, -3.6e6, 3.6e6},
    {"light_phi_deg", offsetof(weft_scene, light[0].direction.phi_rad), DEGREES, -3.6e6, 3.6e6},
    {"exposure", offsetof(weft_scene, exposure), LOGARITHM, 1e-9, 1e9},
    {"environment_turn_deg", offsetof(weft_scene, environment_turn_rad), DEGREES, -3.6e6, 3.6e6},
};

static double scaled(value_scale scale, double value)
{
    switch (scale) {
    case DEGREES:
        return weft_rad_of_deg(value);
    case LOGARITHM:
        return log(value);
    case LOGARITHM_ABOVE_1:
        return log(value - 1);
    default:
        return value;
    }
}

/* Back to what the scene holds; nothing overshoots what can be drawn. */
static double unscaled(const value_column *column, double value)
{
    switch (column->scale) {
    case DEGREES:
        return fmin(fmax(value, weft_rad_of_deg(column->low)), weft_rad_of_deg(column->high));
    case LOGARITHM:
        return fmin(fmax(exp(value), column->low), column->high);
    case LOGARITHM_ABOVE_1:
        return fmin(fmax(1 + exp(value), column->low), column->high);
    default:
        return fmin(fmax(value, column->low), column->high);
    }
}

/* ---- Reading ---- */

static weft_code find_columns(const weft_csv *csv, int at[WEFT_PATH_VALUE_COUNT], int *time_at, weft_error *error)
{
    int known = 1;
    *time_at = weft_csv_column(csv, "time_s");
    if (*time_at < 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has no column 'time_s'", csv->path);
    for (int v = 0; v < WEFT_PATH_VALUE_COUNT; v++) {
        at[v] = weft_csv_column(csv, columns[v].name);
        known += at[v] >= 0;
    }
    for (int c = 0; known < csv->column_count && c < csv->column_count; c++) {
        bool found = c == *time_at;
        for (int v = 0; v < WEFT_PATH_VALUE_COUNT; v++)
            found |= at[v] == c;
        if (!found)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': a path has no column '%s'", csv->path, csv->column[c]);
    }
    return WEFT_OK;
}

static weft_code read_value(const weft_csv *csv, int row, int at, const value_column *column, double *value,
                            weft_error *error)
{
    double number;
    WEFT_TRY(weft_csv_number(csv, row, at, &number, error));
    if (!(number >= column->low && number <= column->high))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: %s is %g, not from %g to %g", csv->path, csv->line[row],
                         column->name, number, column->low, column->high);
    *value = scaled(column->scale, number);
    return WEFT_OK;
}

static weft_code read_key(const weft_csv *csv, int row, const int at[WEFT_PATH_VALUE_COUNT], int time_at,
                          weft_path *path, weft_error *error)
{
    WEFT_TRY(weft_csv_number(csv, row, time_at, &path->time_s[row], error));
    if (row > 0 && !(path->time_s[row] > path->time_s[row - 1]))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: the time %g s does not follow %g s", csv->path, csv->line[row],
                         path->time_s[row], path->time_s[row - 1]);
    for (int v = 0; v < WEFT_PATH_VALUE_COUNT; v++)
        if (at[v] >= 0)
            WEFT_TRY(read_value(csv, row, at[v], &columns[v], &path->value[row][v], error));
    return WEFT_OK;
}

static weft_code read_table(const weft_csv *csv, weft_path *path, weft_error *error)
{
    int at[WEFT_PATH_VALUE_COUNT], time_at;
    WEFT_TRY(find_columns(csv, at, &time_at, error));
    if (csv->row_count < 1 || csv->row_count > MAX_KEYS)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d key frames, not 1 to %d", csv->path, csv->row_count,
                         MAX_KEYS);
    path->key_count = csv->row_count;
    path->time_s = calloc((size_t)csv->row_count, sizeof *path->time_s);
    path->value = calloc((size_t)csv->row_count, sizeof *path->value);
    if (!path->time_s || !path->value)
        return weft_fail_memory(error, "path", (size_t)csv->row_count * sizeof *path->value);
    for (int v = 0; v < WEFT_PATH_VALUE_COUNT; v++)
        path->given[v] = at[v] >= 0;
    for (int row = 0; row < csv->row_count; row++)
        WEFT_TRY(read_key(csv, row, at, time_at, path, error));
    return WEFT_OK;
}

weft_code weft_path_read(const char *file, weft_path *path, weft_error *error)
{
    weft_csv csv;
    *path = (weft_path){0};
    WEFT_TRY(weft_csv_read(file, true, &csv, error));
    weft_code code = read_table(&csv, path, error);
    weft_csv_free(&csv);
    if (code != WEFT_OK)
        weft_path_free(path);
    return code;
}

void weft_path_free(weft_path *path)
{
    free(path->time_s);
    free(path->value);
    *path = (weft_path){0};
}

/* ---- Between the keys ---- */

static double slope(const weft_path *path, int key, int v)
{
    int before = key > 0 ? key - 1 : key, after = key + 1 < path->key_count ? key + 1 : key;
    return (path->value[after][v] - path->value[before][v]) / (path->time_s[after] - path->time_s[before]);
}

/* The value v between `key` and the next, at the fraction t of the way. */
static double between(const weft_path *path, int key, double t, int v)
{
    double length = path->time_s[key + 1] - path->time_s[key], s = 1 - t;
    double from = path->value[key][v] * (1 + 2 * t) + length * slope(path, key, v) * t;
    double to = path->value[key + 1][v] * (1 + 2 * s) - length * slope(path, key + 1, v) * s;
    return from * s * s + to * t * t;
}

void weft_path_apply(const weft_path *path, double time_s, weft_scene *scene)
{
    int key = 0, last = path->key_count - 1;
    while (key < last - 1 && time_s >= path->time_s[key + 1])
        key++;
    double t = last > 0 ? (time_s - path->time_s[key]) / (path->time_s[key + 1] - path->time_s[key]) : 0;
    t = fmin(fmax(t, 0), 1);
    for (int v = 0; v < WEFT_PATH_VALUE_COUNT; v++) {
        if (!path->given[v])
            continue;
        double value = last > 0 ? between(path, key, t, v) : path->value[0][v];
        *(double *)((char *)scene + columns[v].offset) = unscaled(&columns[v], value);
    }
}

/* ---- Bounds ---- */

static double mixed(double a, double b, double t)
{
    return a + t * (b - a);
}

/* The blossom of a Bezier cubic: symmetric, and the curve itself where all three times are alike. */
static double blossom(const double point[4], double r, double s, double t)
{
    double a = mixed(point[0], point[1], r), b = mixed(point[1], point[2], r), c = mixed(point[2], point[3], r);
    return mixed(mixed(a, b, s), mixed(b, c, s), t);
}

/* Widens range [2] by the curve of value v after `key`, from a to b of the way. */
static void add_curve(const weft_path *path, int key, int v, double a, double b, double range[2])
{
    double third = (path->time_s[key + 1] - path->time_s[key]) / 3;
    double first = path->value[key][v], last = path->value[key + 1][v];
    const double point[4] = {first, first + third * slope(path, key, v), last - third * slope(path, key + 1, v), last};
    const double part[4] = {blossom(point, a, a, a), blossom(point, a, a, b), blossom(point, a, b, b),
                            blossom(point, b, b, b)};
    for (int i = 0; i < 4; i++) {
        range[0] = fmin(range[0], part[i]);
        range[1] = fmax(range[1], part[i]);
    }
}

static void find_range(const weft_path *path, double from_s, double to_s, int v, double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int key = 0; key + 1 < path->key_count; key++) {
        double start = path->time_s[key], length = path->time_s[key + 1] - start;
        double a = fmin(fmax((from_s - start) / length, 0), 1), b = fmin(fmax((to_s - start) / length, 0), 1);
        bool rests = (key == 0 && from_s < start) || (key + 2 == path->key_count && to_s > start + length);
        if (a < b || rests || (from_s >= start && from_s <= start + length))
            add_curve(path, key, v, a, b, range);
    }
    if (path->key_count == 1)
        range[0] = range[1] = path->value[0][v];
}

void weft_path_span(const weft_path *path, double from_s, double to_s, weft_scene *low, weft_scene *high)
{
    for (int v = 0; v < WEFT_PATH_VALUE_COUNT; v++) {
        double range[2];
        if (!path->given[v])
            continue;
        find_range(path, from_s, to_s, v, range);
        *(double *)((char *)low + columns[v].offset) = unscaled(&columns[v], range[0]);
        *(double *)((char *)high + columns[v].offset) = unscaled(&columns[v], range[1]);
    }
}

weft_code weft_path_count_frames(const weft_path *path, double frames_per_second, int *count, weft_error *error)
{
    double last = (path->time_s[path->key_count - 1] - path->time_s[0]) * frames_per_second;
    /* A last key that rounding puts just before its frame still gets it. */
    double frames = floor(last * (1 + 1e-12) + 1e-9) + 1;
    if (!(frames <= WEFT_PATH_MAX_FRAMES))
        return weft_fail(error, WEFT_BAD_INPUT, "a path of %g frames, more than %d", frames, WEFT_PATH_MAX_FRAMES);
    *count = (int)frames;
    return WEFT_OK;
}
