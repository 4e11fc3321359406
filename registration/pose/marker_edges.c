#include "registration/pose/marker_edges.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { POINTS = 40, STEPS = 12, ROUNDS = 3, FEWEST = POINTS / 2 };

/* How far along an edge points are taken, of its length, and how far across it the grey is looked at, of a cell. */
static const double first_point = 0.1, last_point = 0.9, reach_cells = 0.7, longest_reach = 6, least_contrast = 12;

typedef struct picture {
    const uint8_t *grey;
    int width, height;
} picture;

/* normal . p = offset */
typedef struct line {
    double normal[2], offset;
} line;

/* Bilinear; negative outside. */
static double grey_at(const picture *p, double x, double y)
{
    if (!(x >= 0 && y >= 0 && x < p->width - 1 && y < p->height - 1))
        return -1;
    int column = (int)x, row = (int)y;
    double u = x - column, v = y - row;
    const uint8_t *g = p->grey + (long)row * p->width + column;
    return (1 - v) * ((1 - u) * g[0] + u * g[1]) + v * ((1 - u) * g[p->width] + u * g[p->width + 1]);
}

/* Where along `outward` from a point, within `reach`, dark turns light. */
static bool cross_edge(const picture *p, const double at[2], const double outward[2], double reach, double *distance)
{
    double grey[STEPS + 1], step = 2 * reach / STEPS;
    for (int i = 0; i <= STEPS; i++) {
        double d = i * step - reach;
        grey[i] = grey_at(p, at[0] + d * outward[0], at[1] + d * outward[1]);
        if (grey[i] < 0)
            return false;
    }
    double dark = (grey[0] + grey[1]) / 2, light = (grey[STEPS] + grey[STEPS - 1]) / 2, half = (dark + light) / 2;
    if (light - dark < least_contrast)
        return false;
    for (int i = 0; i < STEPS; i++) {
        if (grey[i] < half && grey[i + 1] >= half) {
            *distance = (i + (half - grey[i]) / (grey[i + 1] - grey[i])) * step - reach;
            return true;
        }
    }
    return false;
}

/* Through the points with weights, along the axis of their spread. */
static line fit_line(double (*point)[2], const double *weight, int count)
{
    double sum = 0, mean[2] = {0, 0}, xx = 0, xy = 0, yy = 0;
    for (int i = 0; i < count; i++) {
        sum += weight[i];
        mean[0] += weight[i] * point[i][0];
        mean[1] += weight[i] * point[i][1];
    }
    mean[0] /= sum;
    mean[1] /= sum;
    for (int i = 0; i < count; i++) {
        double x = point[i][0] - mean[0], y = point[i][1] - mean[1];
        xx += weight[i] * x * x;
        xy += weight[i] * x * y;
        yy += weight[i] * y * y;
    }
    double angle = atan2(2 * xy, xx - yy) / 2;
    line fitted = {{-sin(angle), cos(angle)}, 0};
    fitted.offset = fitted.normal[0] * mean[0] + fitted.normal[1] * mean[1];
    return fitted;
}

/* Twice with weights that fall with the distance from the line: a stain or a shadow's edge pulls little. */
static line fit_robustly(double (*point)[2], int count)
{
    double weight[POINTS];
    line fitted;
    for (int i = 0; i < count; i++)
        weight[i] = 1;
    for (int round = 0; round < 3; round++) {
        fitted = fit_line(point, weight, count);
        for (int i = 0; i < count; i++) {
            double distance = fitted.normal[0] * point[i][0] + fitted.normal[1] * point[i][1] - fitted.offset;
            weight[i] = 1 / (1 + distance * distance / (0.15 * 0.15));
        }
    }
    return fitted;
}

/* The line along the edge from corner a to corner b, of which the marker lies toward `inside`. */
static bool find_edge(const picture *p, const double a[2], const double b[2], const double inside[2], double cells,
                      line *edge)
{
    double along[2] = {b[0] - a[0], b[1] - a[1]}, length = hypot(along[0], along[1]);
    double outward[2] = {along[1] / length, -along[0] / length};
    double depth = outward[0] * (a[0] - inside[0]) + outward[1] * (a[1] - inside[1]);
    if (depth < 0) {
        depth = -depth;
        outward[0] = -outward[0];
        outward[1] = -outward[1];
    }
    double reach = fmin(longest_reach, fmax(1.5, reach_cells * 2 * depth / cells)), point[POINTS][2];
    int count = 0;
    for (int i = 0; i < POINTS; i++) {
        double share = first_point + (last_point - first_point) * i / (POINTS - 1), distance;
        double at[2] = {a[0] + share * along[0], a[1] + share * along[1]};
        if (!cross_edge(p, at, outward, reach, &distance))
            continue;
        point[count][0] = at[0] + distance * outward[0];
        point[count++][1] = at[1] + distance * outward[1];
    }
    if (count < FEWEST)
        return false;
    *edge = fit_robustly(point, count);
    return true;
}

static bool meet(const line *a, const line *b, double point[2])
{
    double determinant = a->normal[0] * b->normal[1] - a->normal[1] * b->normal[0];
    point[0] = (a->offset * b->normal[1] - b->offset * a->normal[1]) / determinant;
    point[1] = (a->normal[0] * b->offset - b->normal[0] * a->offset) / determinant;
    return isfinite(point[0]) && isfinite(point[1]);
}

static bool refine_once(const picture *p, int cells, double corner[4][2])
{
    double middle[2] = {0, 0}, next[4][2];
    line edge[4];
    for (int i = 0; i < 4; i++) {
        middle[0] += corner[i][0] / 4;
        middle[1] += corner[i][1] / 4;
    }
    for (int i = 0; i < 4; i++) {
        if (!find_edge(p, corner[i], corner[(i + 1) % 4], middle, cells, &edge[i]))
            return false;
    }
    for (int i = 0; i < 4; i++) {
        if (!meet(&edge[(i + 3) % 4], &edge[i], next[i]))
            return false;
    }
    memcpy(corner, next, sizeof next);
    return true;
}

void weft_marker_refine(const uint8_t *grey, int width, int height, int cells, double corner[4][2])
{
    const picture p = {grey, width, height};
    double refined[4][2];
    memcpy(refined, corner, sizeof refined);
    for (int round = 0; round < ROUNDS; round++) {
        if (!refine_once(&p, cells, refined))
            return;
    }
    for (int i = 0; i < 4; i++) {
        const double *next = corner[(i + 1) % 4];
        double side = hypot(next[0] - corner[i][0], next[1] - corner[i][1]);
        if (!(hypot(refined[i][0] - corner[i][0], refined[i][1] - corner[i][1]) < fmax(3, side / cells / 2)))
            return;
    }
    memcpy(corner, refined, sizeof refined);
}
