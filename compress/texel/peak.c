#include "compress/texel/peak.h"

#include "base/integers.h"
#include "base/processor.h"
#include "compress/fit/normal.h"
#include "compress/texel/peak_kernel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

WEFT_DECLARE_PEAK_KERNELS(baseline);
#if defined(__x86_64__)
WEFT_DECLARE_PEAK_KERNELS(avx2);
WEFT_DECLARE_PEAK_KERNELS(avx512);
#endif

enum { MOST_DIVISIONS = 8, RINGS = 7, RING = 24 };

#define NO_LIGHT 1e-9f
#define SLACK 1.001   /* for rounding in single precision; exponents reach thousands */
#define LIT_SLACK 1.1 /* for lights between those of the grid: up to 5 % was seen */

/* ---- Whole triangles: those between views, those from the last views down to the horizon, or even ones ---- */

typedef struct triangle_list {
    weft_vec3 (*triangle)[3];
    int count;
} triangle_list;

/* Whether the normal meets one of the triangles: what is not inside the border then lies below it. */
static bool holds_normal(const triangle_list *list)
{
    for (int t = 0; t < list->count; t++) {
        int left = 0, right = 0;
        for (int k = 0; k < 3; k++) {
            double side = weft_cross(list->triangle[t][k], list->triangle[t][(k + 1) % 3]).z;
            left += side >= 0;
            right += side <= 0;
        }
        if (left == 3 || right == 3)
            return true;
    }
    return false;
}

static bool has_edge(const int triangle[3], int a, int b)
{
    int found = 0;
    for (int k = 0; k < 3; k++)
        found += triangle[k] == a || triangle[k] == b;
    return found == 2;
}

/* `share` of the way from a direction down to the horizon. */
static weft_vec3 lowered(weft_vec3 direction, double share)
{
    double theta = acos(fmin(1, direction.z)), phi = atan2(direction.y, direction.x);
    theta += share * (WEFT_PI / 2 - theta);
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

static void add(triangle_list *list, weft_vec3 a, weft_vec3 b, weft_vec3 c)
{
    weft_vec3 *to = list->triangle[list->count++];
    to[0] = a;
    to[1] = b;
    to[2] = c;
}

/* Below an edge of the border. */
static void add_below(triangle_list *list, weft_vec3 a, weft_vec3 b)
{
    weft_vec3 low_a = lowered(a, 1), low_b = lowered(b, 1);
    add(list, a, b, low_a);
    add(list, b, low_b, low_a);
}

static void add_patch(triangle_list *list, const weft_vec3 *view, const int (*triangle)[3], int count)
{
    for (int t = 0; t < count; t++)
        add(list, weft_unit(view[triangle[t][0]]), weft_unit(view[triangle[t][1]]), weft_unit(view[triangle[t][2]]));
    if (!holds_normal(list)) {
        list->count = 0;
        return;
    }
    for (int t = 0; t < count; t++) {
        for (int k = 0; k < 3; k++) {
            int a = triangle[t][k], b = triangle[t][(k + 1) % 3], uses = 0;
            for (int other = 0; other < count; other++)
                uses += has_edge(triangle[other], a, b);
            if (uses == 1)
                add_below(list, weft_unit(view[a]), weft_unit(view[b]));
        }
    }
}

/* Where views have no patch around the normal, rings of even triangles from the normal to the horizon. */
static void add_rings(triangle_list *list)
{
    for (int ring = 0; ring < RINGS - 1; ring++) {
        for (int i = 0; i < RING; i++) {
            weft_vec3 corner[2][2];
            for (int k = 0; k < 4; k++) {
                double theta = (ring + k / 2) * WEFT_PI / 2 / (RINGS - 1), phi = (i + k % 2) * 2 * WEFT_PI / RING;
                corner[k / 2][k % 2] = weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
            }
            add(list, corner[0][0], corner[1][0], corner[1][1]);
            if (ring > 0)
                add(list, corner[0][0], corner[0][1], corner[1][1]);
        }
    }
}

static weft_code list_triangles(const weft_vec3 *view, const weft_triangulation *triangulation, triangle_list *list,
                                bool *follows_views, weft_error *error)
{
    int count = weft_triangulation_triangle_count(triangulation);
    size_t most = (size_t)weft_larger(7 * count, 2 * RINGS * RING);
    *list = (triangle_list){calloc(most, sizeof *list->triangle), 0};
    if (!list->triangle)
        return weft_fail_memory(error, "net of views", most * sizeof *list->triangle);
    add_patch(list, view, weft_triangulation_triangles(triangulation), count);
    *follows_views = list->count > 0;
    if (!*follows_views)
        add_rings(list);
    return WEFT_OK;
}

/* ---- The net ---- */

static int divisions(const weft_vec3 triangle[3], double widest_rad)
{
    double widest = 0;
    for (int k = 0; k < 3; k++)
        widest = fmax(widest, acos(fmin(1, weft_dot(triangle[k], triangle[(k + 1) % 3]))));
    return (int)fmin(fmax(ceil(widest / widest_rad), 1), MOST_DIVISIONS);
}

/* One over the distance of the corners' plane from the origin, at the nearest point that they span: at most that of
 * the plane across their mean beyond which all of them lie. */
static double growth_of(const weft_peak_net *net, const int corner[3])
{
    weft_vec3 direction[3], sum = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        direction[k] = weft_vec3_of((double)net->xyz[0][corner[k]], (double)net->xyz[1][corner[k]],
                                    (double)net->xyz[2][corner[k]]);
        sum = weft_add(sum, direction[k]);
    }
    weft_vec3 mean = weft_unit(sum);
    double least = 1;
    for (int k = 0; k < 3; k++)
        least = fmin(least, weft_dot(mean, direction[k]));
    return 1 / fmax(least, 0.1);
}

static void add_triangle(weft_peak_net *net, int a, int b, int c)
{
    const int corner[3] = {a, b, c};
    for (int k = 0; k < 3; k++)
        net->corner[k][net->triangle_count] = corner[k];
    net->log_growth[net->triangle_count++] = (float)log2(growth_of(net, corner));
}

/* A triangle in `parts` x `parts` smaller ones; its corners stand row by row. */
static void divide(weft_peak_net *net, const weft_triangulation *triangulation, const weft_vec3 triangle[3], int parts)
{
    int first = net->corner_count;
    for (int i = 0; i <= parts; i++) {
        for (int j = 0; j <= i; j++) {
            weft_vec3 point = weft_scale(triangle[0], parts - i);
            point = weft_add(point, weft_scale(triangle[1], i - j));
            point = weft_unit(weft_add(point, weft_scale(triangle[2], j)));
            net->at[net->corner_count] = weft_triangulation_lookup(triangulation, point);
            net->xyz[0][net->corner_count] = (float)point.x;
            net->xyz[1][net->corner_count] = (float)point.y;
            net->xyz[2][net->corner_count++] = (float)point.z;
        }
    }
    for (int i = 0; i < parts; i++) {
        int upper = first + i * (i + 1) / 2, lower = upper + i + 1;
        for (int j = 0; j <= i; j++) {
            add_triangle(net, upper + j, lower + j, lower + j + 1);
            if (j < i)
                add_triangle(net, upper + j, upper + j + 1, lower + j + 1);
        }
    }
}

static int whole_lanes(int count)
{
    return (count + WEFT_STRIP_LANES - 1) / WEFT_STRIP_LANES * WEFT_STRIP_LANES;
}

static void *allocate_row(int count)
{
    size_t bytes = (size_t)count * sizeof(float);
    void *row = aligned_alloc(64, bytes);
    if (row)
        memset(row, 0, bytes);
    return row;
}

static weft_code allocate(weft_peak_net *net, int corners, int triangles, weft_error *error)
{
    net->corner_stride = whole_lanes(corners);
    net->triangle_stride = whole_lanes(triangles);
    net->at = calloc((size_t)corners, sizeof *net->at);
    float **by_corner[] = {&net->xyz[0], &net->xyz[1], &net->xyz[2], &net->log_r, &net->log_f, &net->table};
    float **by_triangle[] = {&net->log_growth, &net->sum_r, &net->sum_f};
    bool complete = net->at != NULL;
    for (size_t i = 0; i < sizeof by_corner / sizeof *by_corner; i++)
        complete = (*by_corner[i] = allocate_row(net->corner_stride)) && complete;
    for (size_t i = 0; i < sizeof by_triangle / sizeof *by_triangle; i++)
        complete = (*by_triangle[i] = allocate_row(net->triangle_stride)) && complete;
    for (int k = 0; k < 3; k++)
        complete = (net->corner[k] = allocate_row(net->triangle_stride)) && complete;
    return complete ? WEFT_OK
                    : weft_fail_memory(error, "net of views", (size_t)net->corner_stride * 8 * sizeof *net->table);
}

static weft_code fill(const triangle_list *list, const weft_triangulation *triangulation, double widest_rad,
                      weft_peak_net *net, weft_error *error)
{
    int corners = 0, triangles = 0;
    for (int t = 0; t < list->count; t++) {
        int parts = divisions(list->triangle[t], widest_rad);
        corners += (parts + 1) * (parts + 2) / 2;
        triangles += parts * parts;
    }
    WEFT_TRY(allocate(net, corners, triangles, error));
    for (int t = 0; t < list->count; t++)
        divide(net, triangulation, list->triangle[t], divisions(list->triangle[t], widest_rad));
    return WEFT_OK;
}

weft_code weft_peak_net_create(const weft_vec3 *view, int view_count, double widest_rad, weft_peak_net *net,
                               weft_error *error)
{
    *net = (weft_peak_net){.view_count = view_count};
    weft_triangulation *triangulation = NULL;
    triangle_list list = {0};
    WEFT_TRY(weft_triangulation_build(view, view_count, &triangulation, error));
    weft_code code = list_triangles(view, triangulation, &list, &net->follows_table, error);
    if (code == WEFT_OK)
        code = fill(&list, triangulation, widest_rad, net, error);
    weft_triangulation_free(triangulation);
    free(list.triangle);
    if (code != WEFT_OK)
        weft_peak_net_free(net);
    return code;
}

void weft_peak_net_free(weft_peak_net *net)
{
    free(net->at);
    for (int k = 0; k < 3; k++) {
        free(net->xyz[k]);
        free(net->corner[k]);
    }
    free(net->log_growth);
    free(net->log_r);
    free(net->log_f);
    free(net->sum_r);
    free(net->sum_f);
    free(net->table);
    *net = (weft_peak_net){0};
}

/* ---- Lights ---- */

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
    lights->stride = whole_lanes(lights->count);
    lights->at = calloc((size_t)lights->count, sizeof *lights->at);
    lights->aim_at = calloc(WEFT_PEAK_AIMS, sizeof *lights->aim_at);
    lights->log_cosine = allocate_row(WEFT_PEAK_AIMS * lights->stride);
    float **by_light[] = {&lights->z, &lights->log_r, &lights->log_f};
    float **by_aim[] = {&lights->aim_z, &lights->log_length, &lights->own_r,
                        &lights->own_f, &lights->aim_r,      &lights->aim_f};
    bool complete = lights->at && lights->aim_at && lights->log_cosine;
    for (size_t i = 0; i < sizeof by_light / sizeof *by_light; i++)
        complete = (*by_light[i] = allocate_row(lights->stride)) && complete;
    for (size_t i = 0; i < sizeof by_aim / sizeof *by_aim; i++)
        complete = (*by_aim[i] = allocate_row(whole_lanes(WEFT_PEAK_AIMS))) && complete;
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

/* ---- The bound ---- */

static void add_lobe(const weft_peak_net *net, const weft_gram_point *point, int lobe, const weft_peak_lights *lights)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        weft_peak_add_lobe_avx512(net, point, lobe, lights);
    else if (set == WEFT_AVX2)
        weft_peak_add_lobe_avx2(net, point, lobe, lights);
    else
#endif
        weft_peak_add_lobe_baseline(net, point, lobe, lights);
}

static weft_peak largest(const weft_peak_net *net)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        return weft_peak_largest_avx512(net);
    if (set == WEFT_AVX2)
        return weft_peak_largest_avx2(net);
#endif
    return weft_peak_largest_baseline(net);
}

/* T at every corner, or the largest. */
static void place_table(weft_peak_net *net, const double *table)
{
    double most = table ? 0 : 1;
    for (int view = 0; table && view < net->view_count; view++)
        most = fmax(most, table[view]);
    for (int c = 0; c < net->corner_count; c++) {
        double t = net->follows_table && table ? 0 : most;
        for (int k = 0; net->follows_table && table && k < 3 && net->at[c].index[k] >= 0; k++)
            t += net->at[c].weight[k] * table[net->at[c].index[k]];
        net->table[c] = (float)t;
    }
}

static void spread(weft_peak_lights *lights, float exponent)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        weft_peak_spread_avx512(lights, exponent);
    else if (set == WEFT_AVX2)
        weft_peak_spread_avx2(lights, exponent);
    else
#endif
        weft_peak_spread_baseline(lights, exponent);
}

weft_peak weft_peak_of_fit(weft_peak_net *net, const weft_fit *fit, const weft_peak_tables *tables)
{
    weft_gram_point point = weft_gram_point_of_fit(fit);
    weft_peak_lights *lights = tables->light;
    double r = lights ? exp2(lights->most_r) : 1, f = lights ? exp2(lights->most_f) : 1;
    place_table(net, tables->view);
    for (int t = 0; t < net->triangle_stride; t++) {
        net->sum_r[t] = (float)(fit->diffuse * r);
        net->sum_f[t] = (float)(fit->diffuse * f);
    }
    for (int i = 0; i < fit->lobe_count; i++) {
        if (!(fit->lobe[i].amplitude > 0))
            continue;
        if (lights)
            spread(lights, point.exponent[i]);
        add_lobe(net, &point, i, lights);
    }
    weft_peak peak = largest(net);
    net->slack = lights ? LIT_SLACK : SLACK;
    return (weft_peak){net->slack * peak.r, net->slack * peak.f};
}

void weft_peak_factors(const weft_peak_net *net, weft_peak most, double *factor)
{
    for (int view = 0; view < net->view_count; view++)
        factor[view] = 1;
    for (int t = 0; t < net->triangle_count; t++) {
        double table = 0;
        for (int k = 0; k < 3; k++)
            table = fmax(table, (double)net->table[net->corner[k][t]]);
        double over = fmax((double)net->sum_r[t] / most.r, (double)net->sum_f[t] / most.f) * table * net->slack;
        if (!(over > 1))
            continue;
        for (int view = 0; !net->follows_table && view < net->view_count; view++)
            factor[view] = fmin(factor[view], 1 / over);
        for (int k = 0; net->follows_table && k < 9; k++) {
            const weft_barycentric *at = &net->at[net->corner[k / 3][t]];
            if (at->index[k % 3] >= 0 && at->weight[k % 3] > 0)
                factor[at->index[k % 3]] = fmin(factor[at->index[k % 3]], 1 / over);
        }
    }
}
