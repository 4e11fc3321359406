/* The views above the horizon, covered by small triangles. */
#include "base/integers.h"
#include "compress/texel/peak.h"
#include "compress/texel/peak_rows.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_DIVISIONS = 8, RINGS = 7, RING = 24 };

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

static weft_code allocate(weft_peak_net *net, int corners, int triangles, weft_error *error)
{
    net->corner_stride = weft_whole_lanes(corners);
    net->triangle_stride = weft_whole_lanes(triangles);
    net->at = calloc((size_t)corners, sizeof *net->at);
    float **by_corner[] = {&net->xyz[0], &net->xyz[1], &net->xyz[2], &net->log_r, &net->log_f, &net->table};
    float **by_triangle[] = {&net->log_growth, &net->sum_r, &net->sum_f};
    bool complete = net->at != NULL;
    for (size_t i = 0; i < sizeof by_corner / sizeof *by_corner; i++)
        complete = (*by_corner[i] = weft_lane_row(net->corner_stride)) && complete;
    for (size_t i = 0; i < sizeof by_triangle / sizeof *by_triangle; i++)
        complete = (*by_triangle[i] = weft_lane_row(net->triangle_stride)) && complete;
    for (int k = 0; k < 3; k++)
        complete = (net->corner[k] = weft_lane_row(net->triangle_stride)) && complete;
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
