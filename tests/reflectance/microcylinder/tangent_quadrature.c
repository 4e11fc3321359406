#include "tests/reflectance/microcylinder/tangent_quadrature.h"

enum { NODES = 8, MAX_CUTS = 40, LEVELS = 3 };

static const double node[NODES / 2] = {0.96028985649753623168, 0.79666647741362673959, 0.52553240991632898582,
                                       0.18343464249564980494};
static const double weight[NODES / 2] = {0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734,
                                         0.36268378337836198297};

#define QUARTER ((double)WEFT_PI / 2)

typedef struct cuts {
    double at[MAX_CUTS];
    int count;
} cuts;

/* Keeps the cuts in increasing order; one outside of the first and the last is dropped. */
static void insert(cuts *list, double x)
{
    if (!(x > list->at[0] && x < list->at[list->count - 1]))
        return;
    int i = list->count++;
    for (; list->at[i - 1] > x; i--)
        list->at[i] = list->at[i - 1];
    list->at[i] = x;
}

/* A cut and finer and finer panels towards it: where weft or warp meets the horizon, all directions of psi meet in one
 * point, and the horizon is steep in the angles of a thread that is nearly flat. */
static void insert_graded(cuts *list, double x)
{
    insert(list, x);
    double distance = 0.3;
    for (int level = 0; level < LEVELS; level++, distance /= 7) {
        insert(list, x - distance);
        insert(list, x + distance);
    }
}

typedef void (*node_visitor)(void *context, double x, double dx);

static void visit_panel(double low, double high, node_visitor visit, void *context)
{
    double middle = (low + high) / 2, half = (high - low) / 2;
    for (int i = 0; i < NODES / 2; i++) {
        visit(context, middle - half * node[i], half * weight[i]);
        visit(context, middle + half * node[i], half * weight[i]);
    }
}

static void visit_pieces(const cuts *list, double step, node_visitor visit, void *context)
{
    for (int i = 0; i + 1 < list->count; i++) {
        double low = list->at[i], length = list->at[i + 1] - low;
        int panels = (int)ceil(length / step);
        for (int k = 0; k < panels; k++)
            visit_panel(low + length * k / panels, low + length * (k + 1) / panels, visit, context);
    }
}

typedef struct vector {
    double x, y, z;
} vector;

static double dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector combined(double s, vector a, double t, vector b)
{
    return (vector){s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

/* Planes through the origin on which the integrand has a kink or a jump, by their normals. */
enum { PLANES = 5 };

typedef struct rule {
    vector tangent, middle, across; /* t, m, b */
    vector plane[PLANES];
    double step;
    direction_visitor visit;
    void *context;
    vector azimuth; /* of the line of constant phi that is being visited */
    double dphi;
} rule;

static void visit_theta(void *context, double theta, double dtheta)
{
    const rule *r = context;
    vector d = combined(sin(theta), r->tangent, cos(theta), r->azimuth);
    if (d.z > 0)
        r->visit(r->context, weft_vec3_of((weft_real)d.x, (weft_real)d.y, (weft_real)d.z),
                 cos(theta) * dtheta * r->dphi);
}

static void visit_phi(void *context, double phi, double dphi)
{
    rule *r = context;
    r->azimuth = combined(cos(phi), r->middle, sin(phi), r->across);
    r->dphi = dphi;
    cuts theta = {.at = {-QUARTER, QUARTER}, .count = 2};
    double tilt = asin(r->tangent.z);
    insert_graded(&theta, 0);
    insert_graded(&theta, (cos(phi) > 0) == (tilt > 0) ? fabs(tilt) - QUARTER : QUARTER - fabs(tilt));
    for (int i = 0; i < PLANES; i++) {
        double along = dot(r->plane[i], r->tangent);
        if (along != 0)
            insert(&theta, atan(-dot(r->plane[i], r->azimuth) / along));
    }
    visit_pieces(&theta, r->step, visit_theta, r);
}

static rule rule_of(const weft_thread_tangent *tangent, weft_vec3 view)
{
    double c = tangent->cos_tilt, s = tangent->sin_tilt;
    rule r = {
        .plane = {{0, 0, 1}, {view.z, 0, -view.x}, {view.z, 0, view.x}, {0, view.z, -view.y}, {0, view.z, view.y}}};
    bool x = tangent->axis == WEFT_AXIS_X;
    r.tangent = x ? (vector){c, 0, s} : (vector){0, c, s};
    r.middle = x ? (vector){-s, 0, c} : (vector){0, -s, c};
    r.across = x ? (vector){0, 1, 0} : (vector){-1, 0, 0};
    return r;
}

void tangent_quadrature(const weft_thread_tangent *tangent, weft_vec3 view, double azimuth_rad, double step_rad,
                        direction_visitor visit, void *context)
{
    rule r = rule_of(tangent, view);
    r.step = step_rad;
    r.visit = visit;
    r.context = context;
    vector out = {view.x, view.y, view.z};
    double phi_view = atan2(dot(out, r.across), dot(out, r.middle));
    cuts phi = {.at = {-azimuth_rad, azimuth_rad}, .count = 2};
    insert_graded(&phi, -QUARTER);
    insert_graded(&phi, 0);
    insert_graded(&phi, QUARTER);
    insert(&phi, phi_view);
    insert(&phi, -phi_view);
    visit_pieces(&phi, step_rad, visit_phi, &r);
}
