/* A cloth laid over a round table, by position-based dynamics (Mueller et al. 2007) with many small steps of one
 * iteration each (Macklin et al. 2019). The result is refined with a bicubic B-spline for smooth highlights; finer than
 * that, triangles would be smaller than the blocks of pixels that rasterisers shade. */
#include "player/mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 57, STEPS = 1500, REFINE = 2, FINE = (SIDE - 1) * REFINE + 1 };

static const float spacing = 1.0f / (SIDE - 1);
static const float step_s = 1.0f / 300;
static const float gravity = 3;
static const float drag = 1.2f; /* of the velocity, lost per second */
static const float table_radius = 0.27f, rim_radius = 0.03f;
static const float friction = 0.35f;

typedef struct point {
    float x, y, z;
} point;

/* Coordinates apart, for vector instructions. */
typedef struct cloth {
    float x[SIDE * SIDE], y[SIDE * SIDE], z[SIDE * SIDE];
    point previous[SIDE * SIDE];
} cloth;

/* Distances that are kept between particles some cells apart: along the threads and across them (shear), and over
 * two and four cells, which resists bending. Stiffness is the share of the error mended in one step. */
typedef struct link_kind {
    int columns, rows;
    float stiffness;
} link_kind;
static const link_kind link_kinds[] = {{1, 0, 1},     {0, 1, 1},     {1, 1, 0.3f},  {1, -1, 0.3f},
                                       {2, 0, 0.12f}, {0, 2, 0.12f}, {4, 0, 0.05f}, {0, 4, 0.05f}};

static point add(point a, point b)
{
    return (point){a.x + b.x, a.y + b.y, a.z + b.z};
}

static point scale(point a, float s)
{
    return (point){a.x * s, a.y * s, a.z * s};
}

static point subtract(point a, point b)
{
    return (point){a.x - b.x, a.y - b.y, a.z - b.z};
}

static point position_of(const cloth *c, int i)
{
    return (point){c->x[i], c->y[i], c->z[i]};
}

static void set_position(cloth *c, int i, point position)
{
    c->x[i] = position.x;
    c->y[i] = position.y;
    c->z[i] = position.z;
}

static void lay_flat(cloth *c)
{
    /* Turned and off centre: a symmetric cloth would hang in four equal folds. */
    const float turn_rad = 0.35f, offset_x = 0.035f, offset_y = -0.02f, height = 0.01f;
    for (int i = 0; i < SIDE * SIDE; i++) {
        float u = (float)(i % SIDE) * spacing - 0.5f, v = (float)(i / SIDE) * spacing - 0.5f;
        c->previous[i] = (point){cosf(turn_rad) * u - sinf(turn_rad) * v + offset_x,
                                 sinf(turn_rad) * u + cosf(turn_rad) * v + offset_y, height};
        set_position(c, i, c->previous[i]);
    }
}

static void move_freely(cloth *c)
{
    const float keep = 1 - drag * step_s;
    for (int i = 0; i < SIDE * SIDE; i++) {
        point now = position_of(c, i), velocity_step = scale(subtract(now, c->previous[i]), keep);
        c->previous[i] = now;
        set_position(c, i, add(now, velocity_step));
        c->z[i] -= gravity * step_s * step_s;
    }
}

/* `count` links that share no particle, each from `first` + i `stride` to the particle `reach` further on. */
static void keep_distances_of(cloth *c, int first, int stride, int count, int reach, float rest, float stiffness)
{
    float *x = c->x + first, *y = c->y + first, *z = c->z + first;
#pragma omp simd
    for (int i = 0; i < count * stride; i += stride) {
        float dx = x[i + reach] - x[i], dy = y[i + reach] - y[i], dz = z[i + reach] - z[i];
        float length = sqrtf(dx * dx + dy * dy + dz * dz);
        /* A branch would keep the compiler from vector instructions; where the length is 0, so is the difference. */
        float share = stiffness * 0.5f * (length - rest) / (length > 1e-20f ? length : 1e-20f);
        x[i] += dx * share;
        y[i] += dy * share;
        z[i] += dz * share;
        x[i + reach] -= dx * share;
        y[i + reach] -= dy * share;
        z[i + reach] -= dz * share;
    }
}

static void keep_distances(cloth *c)
{
    for (size_t k = 0; k < sizeof link_kinds / sizeof link_kinds[0]; k++) {
        link_kind kind = link_kinds[k];
        float rest = spacing * hypotf((float)kind.columns, (float)kind.rows);
        int reach = kind.rows * SIDE + kind.columns;
        for (int column = 0; kind.rows == 0 && column + kind.columns < SIDE; column++)
            keep_distances_of(c, column, SIDE, SIDE, reach, rest, kind.stiffness);
        int start = kind.rows < 0 ? -kind.rows : 0;
        for (int row = start; kind.rows != 0 && row < SIDE && row + kind.rows < SIDE; row++)
            keep_distances_of(c, row * SIDE, 1, SIDE - kind.columns, reach, rest, kind.stiffness);
    }
}

/* Signed distance to a table top with a round rim whose upper face is z = 0, and the direction away from it. */
static float table_distance(point p, point *away)
{
    float radial = hypotf(p.x, p.y), inner = table_radius - rim_radius;
    float out = fmaxf(radial - inner, 0), up = p.z + rim_radius;
    if (out == 0) {
        *away = (point){0, 0, up < 0 ? -1 : 1};
        return fabsf(up) - rim_radius;
    }
    float distance = hypotf(out, up);
    float share = distance > 0 ? 1 / distance : 0;
    *away = (point){p.x / radial * out * share, p.y / radial * out * share, up * share};
    return distance - rim_radius;
}

static void keep_off_table(cloth *c)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        point away;
        if (c->z[i] <= -2 * rim_radius)
            continue;
        float distance = table_distance(position_of(c, i), &away);
        if (distance >= 0)
            continue;
        point outside = subtract(position_of(c, i), scale(away, distance));
        /* Friction: part of the way along the table since the last step is undone. */
        point moved = subtract(outside, c->previous[i]);
        float normal_part = moved.x * away.x + moved.y * away.y + moved.z * away.z;
        point along = subtract(moved, scale(away, normal_part));
        set_position(c, i, subtract(outside, scale(along, friction)));
    }
}

static void simulate(cloth *c)
{
    lay_flat(c);
    for (int step = 0; step < STEPS; step++) {
        move_freely(c);
        keep_distances(c);
        keep_off_table(c);
    }
}

/* ---- Refinement ---- */

/* Weights of the four control points around fraction t of a uniform cubic B-spline. */
static void spline_weights(float t, float weight[4])
{
    float s = 1 - t;
    weight[0] = s * s * s / 6;
    weight[1] = (3 * t * t * t - 6 * t * t + 4) / 6;
    weight[2] = (3 * s * s * s - 6 * s * s + 4) / 6;
    weight[3] = t * t * t / 6;
}

/* Beyond the hem the cloth goes on straight, so that the spline ends on it. */
static point control_point(const point *line, int stride, int i)
{
    if (i < 0)
        return subtract(scale(line[0], 2), line[stride]);
    if (i >= SIDE)
        return subtract(scale(line[(SIDE - 1) * stride], 2), line[(SIDE - 2) * stride]);
    return line[i * stride];
}

/* FINE points on the spline through a line of SIDE control points. */
static void refine_line(const point *line, int stride, point *fine, int fine_stride)
{
    for (int i = 0; i < FINE; i++) {
        float weight[4];
        spline_weights((float)(i % REFINE) / REFINE, weight);
        point sum = {0, 0, 0};
        for (int k = 0; k < 4; k++)
            sum = add(sum, scale(control_point(line, stride, i / REFINE - 1 + k), weight[k]));
        fine[i * fine_stride] = sum;
    }
}

static void refine(const cloth *c, point *between, point *fine)
{
    for (int row = 0; row < SIDE; row++) {
        point line[SIDE];
        for (int column = 0; column < SIDE; column++)
            line[column] = position_of(c, row * SIDE + column);
        refine_line(line, 1, between + row * FINE, 1);
    }
    for (int column = 0; column < FINE; column++)
        refine_line(between + column, FINE, fine + column, FINE);
}

static void fill_mesh(const point *fine, weft_mesh *mesh)
{
    for (int i = 0; i < FINE * FINE; i++) {
        mesh->vertex[i] = (weft_vertex){
            .position = {fine[i].x, fine[i].y, fine[i].z},
            .coordinate = {(float)(i % FINE) / (FINE - 1), (float)(i / FINE) / (FINE - 1)},
        };
    }
    weft_mesh_index_grid(mesh, FINE, FINE);
}

weft_code weft_mesh_drape(weft_mesh *mesh, weft_error *error)
{
    WEFT_TRY(weft_mesh_allocate(FINE * FINE, 2 * (FINE - 1) * (FINE - 1), mesh, error));
    cloth *c = malloc(sizeof *c);
    point *between = malloc(sizeof(point) * SIDE * FINE), *fine = malloc(sizeof(point) * FINE * FINE);
    weft_code code = WEFT_OK;
    if (!c || !between || !fine) {
        code = weft_fail_memory(error, "cloth", sizeof(point) * FINE * FINE);
    } else {
        simulate(c);
        refine(c, between, fine);
        fill_mesh(fine, mesh);
        code = weft_mesh_compute_normals(mesh, NULL, error);
    }
    if (code == WEFT_OK)
        code = weft_mesh_compute_tangents(mesh, error);
    free(c);
    free(between);
    free(fine);
    if (code != WEFT_OK)
        weft_mesh_free(mesh);
    return code;
}
