/* The grid of lights for S, and of directions that a lobe may point to. */
#include "compress/texel/peak.h"
#include "compress/texel/peak_rows.h"

#include <math.h>
#include <stdlib.h>

#define NO_LIGHT 1e-9f

/* Light number `i` of the grid, the first ring at the normal, the last at the horizon. */
static weft_vec3 grid_light(int i)
{
    double theta = (double)(i / WEFT_PEAK_RING) * WEFT_PI / 2 / (WEFT_PEAK_RINGS - 1);
    double phi = 2 * WEFT_PI * (i % WEFT_PEAK_RING) / WEFT_PEAK_RING;
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), fmax(cos(theta), 0));
}

/* Corner number `i` of the folded octahedron, on its face. */
static weft_vec3 grid_aim(int i)
{
    double u = 2.0 * (i % (WEFT_PEAK_CELLS + 1)) / WEFT_PEAK_CELLS - 1;
    double v = 2.0 * (i / (WEFT_PEAK_CELLS + 1)) / WEFT_PEAK_CELLS - 1, z = 1 - fabs(u) - fabs(v);
    return z >= 0 ? weft_vec3_of(u, v, z) : weft_vec3_of(copysign(1 - fabs(v), u), copysign(1 - fabs(u), v), z);
}

static weft_code allocate_lights(weft_peak_lights *lights, weft_error *error)
{
    lights->stride = weft_whole_lanes(lights->count);
    lights->at = calloc((size_t)lights->count, sizeof *lights->at);
    lights->aim_at = calloc(WEFT_PEAK_AIMS, sizeof *lights->aim_at);
    lights->log_cosine = weft_lane_row(WEFT_PEAK_AIMS * lights->stride);
    float **by_light[] = {&lights->z, &lights->log_r, &lights->log_f};
    float **by_aim[] = {&lights->aim_z, &lights->log_length, &lights->own_r,
                        &lights->own_f, &lights->aim_r,      &lights->aim_f};
    bool complete = lights->at && lights->aim_at && lights->log_cosine;
    for (size_t i = 0; i < sizeof by_light / sizeof *by_light; i++)
        complete = (*by_light[i] = weft_lane_row(lights->stride)) && complete;
    for (size_t i = 0; i < sizeof by_aim / sizeof *by_aim; i++)
        complete = (*by_aim[i] = weft_lane_row(weft_whole_lanes(WEFT_PEAK_AIMS))) && complete;
    size_t bytes = (size_t)WEFT_PEAK_AIMS * (size_t)lights->stride * sizeof *lights->log_cosine;
    return complete ? WEFT_OK : weft_fail_memory(error, "grid of lights", bytes);
}

static void fill_lights(const weft_vec3 *light, const weft_triangulation *triangulation, weft_peak_lights *lights)
{
    int grid = WEFT_PEAK_RINGS * WEFT_PEAK_RING;
    for (int i = 0; i < lights->count; i++) {
        weft_vec3 own = i < grid ? grid_light(i) : weft_unit(light[i - grid]);
        lights->at[i] = weft_triangulation_lookup(triangulation, own);
        lights->z[i] = (float)own.z;
        for (int a = 0; a < WEFT_PEAK_AIMS; a++)
            lights->log_cosine[a * lights->stride + i] =
                (float)log2(fmin(fmax(weft_dot(weft_unit(grid_aim(a)), own), 1e-30), 1));
    }
    for (int a = 0; a < WEFT_PEAK_AIMS; a++) {
        weft_vec3 aim = grid_aim(a), unit = weft_unit(aim);
        lights->log_length[a] = (float)(0.5 * log2(weft_dot(aim, aim)));
        lights->aim_z[a] = (float)fmax(unit.z, 0);
        lights->aim_at[a] =
            unit.z > 0 ? weft_triangulation_lookup(triangulation, unit) : (weft_barycentric){{-1, -1, -1}, {0, 0, 0}};
    }
}

weft_code weft_peak_lights_create(const weft_vec3 *light, int light_count, weft_peak_lights *lights, weft_error *error)
{
    *lights = (weft_peak_lights){.count = WEFT_PEAK_RINGS * WEFT_PEAK_RING + light_count};
    weft_triangulation *triangulation = NULL;
    WEFT_TRY(weft_triangulation_build(light, light_count, &triangulation, error));
    weft_code code = allocate_lights(lights, error);
    if (code == WEFT_OK)
        fill_lights(light, triangulation, lights);
    else
        weft_peak_lights_free(lights);
    weft_triangulation_free(triangulation);
    return code;
}

void weft_peak_lights_free(weft_peak_lights *lights)
{
    free(lights->at);
    free(lights->aim_at);
    free(lights->log_cosine);
    free(lights->z);
    free(lights->log_r);
    free(lights->log_f);
    free(lights->aim_z);
    free(lights->log_length);
    free(lights->own_r);
    free(lights->own_f);
    free(lights->aim_r);
    free(lights->aim_f);
    *lights = (weft_peak_lights){0};
}

/* log2 of S at `count` lights, and of S cos(theta). */
static void place_light(const weft_barycentric *at, const float *z, int count, const double *s, float *log_r,
                        float *log_f)
{
    for (int i = 0; i < count; i++) {
        double own = 0;
        for (int k = 0; k < 3 && at[i].index[k] >= 0; k++)
            own += at[i].weight[k] * s[at[i].index[k]];
        log_f[i] = log2f(fmaxf((float)own, NO_LIGHT));
        log_r[i] = log2f(fmaxf((float)own * z[i], NO_LIGHT));
    }
}

void weft_peak_lights_set(weft_peak_lights *lights, const double *s)
{
    place_light(lights->at, lights->z, lights->count, s, lights->log_r, lights->log_f);
    place_light(lights->aim_at, lights->aim_z, WEFT_PEAK_AIMS, s, lights->own_r, lights->own_f);
    lights->most_r = lights->most_f = log2(NO_LIGHT);
    for (int i = 0; i < lights->count; i++) {
        lights->most_r = fmax(lights->most_r, (double)lights->log_r[i]);
        lights->most_f = fmax(lights->most_f, (double)lights->log_f[i]);
    }
    for (int i = lights->count; i < lights->stride; i++)
        lights->log_r[i] = lights->log_f[i] = log2f(NO_LIGHT);
}
