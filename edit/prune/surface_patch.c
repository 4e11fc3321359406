#include "edit/prune/visibility_bounds.h"

/* Of angles: what single precision, in which a pixel computes them, makes of them. */
static const double angle_margin = 1e-3;
static const double largest_angle = 0.045; /* of the patch, seen from the eye or in its axes */
static const double level_margin = 0.02;
static const double no_level = 30;
static const double thinnest = 1e-7; /* of a triangle by its length: thinner ones cover no pixel in single precision */

/* ---- Shape ---- */

static weft_vec3 edge(const weft_patch *p, int i)
{
    return weft_subtract(p->corner[i].position, p->corner[0].position);
}

/* The texture's gradients on the plane: u = u_0 + gradient . (position - position_0). */
static weft_vec3 gradient(const weft_patch *p, weft_vec3 across, double first, double second)
{
    double square = weft_dot(across, across);
    return weft_add(weft_scale(weft_cross(edge(p, 2), across), first / square),
                    weft_scale(weft_cross(across, edge(p, 1)), second / square));
}

bool weft_patch_set_plane(weft_patch *p, double texels_u, double texels_v)
{
    const weft_patch_corner *c = p->corner;
    weft_vec3 across = weft_cross(edge(p, 1), edge(p, 2));
    p->normal = weft_unit(across);
    double longest = fmax(weft_dot(edge(p, 1), edge(p, 1)), weft_dot(edge(p, 2), edge(p, 2)));
    if (!(weft_length(across) > thinnest * longest))
        return false;
    weft_vec3 u = weft_scale(gradient(p, across, c[1].u - c[0].u, c[2].u - c[0].u), texels_u);
    weft_vec3 v = weft_scale(gradient(p, across, c[1].v - c[0].v, c[2].v - c[0].v), texels_v);
    /* Singular values of the map with the rows u and v: the smaller one by the area, which does not cancel. */
    double sum = weft_dot(u, u) + weft_dot(v, v), cross = weft_dot(u, v);
    double difference = weft_dot(u, u) - weft_dot(v, v);
    double root = sqrt(difference * difference + 4 * cross * cross);
    p->largest_stretch = sqrt((sum + root) / 2);
    p->least_stretch = p->largest_stretch > 0 ? weft_length(weft_cross(u, v)) / p->largest_stretch : 0;
    return isfinite(p->largest_stretch);
}

static weft_patch_corner between(const weft_patch_corner *a, const weft_patch_corner *b)
{
    return (weft_patch_corner){weft_scale(weft_add(a->position, b->position), 0.5),
                               weft_scale(weft_add(a->normal, b->normal), 0.5),
                               weft_scale(weft_add(a->tangent, b->tangent), 0.5),
                               (a->handedness + b->handedness) / 2,
                               (a->u + b->u) / 2,
                               (a->v + b->v) / 2};
}

weft_patch weft_patch_quarter(const weft_patch *p, int part)
{
    const weft_patch_corner *c = p->corner;
    const weft_patch_corner middle[3] = {between(&c[1], &c[2]), between(&c[2], &c[0]), between(&c[0], &c[1])};
    weft_patch quarter = *p;
    for (int i = 0; i < 3; i++)
        quarter.corner[i] = part == 3 || i != part ? middle[part == 3 ? i : 3 - part - i] : c[part];
    return quarter;
}

/* ---- Directions ---- */

static double angle_between(weft_vec3 a, weft_vec3 b)
{
    return atan2(weft_length(weft_cross(a, b)), weft_dot(a, b));
}

/* A sum of vectors with positive weights is no further from an axis than the furthest of them, if less than a right
 * angle. */
static weft_direction_cap cap_of(const weft_vec3 vector[3])
{
    weft_direction_cap cap = {weft_unit(weft_add(vector[0], weft_add(vector[1], vector[2]))), 0};
    for (int i = 0; i < 3; i++) {
        double angle = weft_dot(vector[i], vector[i]) > 0 ? angle_between(cap.axis, vector[i]) : WEFT_PI;
        cap.angle_rad = fmax(cap.angle_rad, angle);
    }
    if (cap.angle_rad > 1.4)
        cap.angle_rad = WEFT_PI;
    return cap;
}

/* The axes of the surface in the middle of the patch, and how far any others of it are turned against them. */
typedef struct patch_axes {
    weft_vec3 x, y, z;
    double turn_rad;
} patch_axes;

/* The chord that a turn moves a unit vector by, at most, as an angle. */
static double angle_of_chord(double chord)
{
    return chord < 2 ? 2 * asin(chord / 2) : WEFT_PI;
}

static patch_axes axes_of(const weft_patch *p)
{
    const weft_patch_corner *c = p->corner;
    const weft_direction_cap n = cap_of((weft_vec3[]){c[0].normal, c[1].normal, c[2].normal});
    const weft_direction_cap t = cap_of((weft_vec3[]){c[0].tangent, c[1].tangent, c[2].tangent});
    weft_vec3 across = weft_subtract(t.axis, weft_scale(n.axis, weft_dot(n.axis, t.axis)));
    double length = weft_length(across), hand = c[0].handedness + c[1].handedness + c[2].handedness;
    patch_axes axes = {.x = weft_unit(across), .z = n.axis, .turn_rad = WEFT_PI};
    axes.y = weft_scale(weft_cross(axes.z, axes.x), hand < 0 ? -1 : 1);
    /* The part of the tangent across the normal is off by no more than tangent and normal together. */
    double off = t.angle_rad + n.angle_rad;
    bool is_mirrored_in_part = fabs(hand) < 3 * (1 - 1e-6);
    if (!(length > 0) || off >= length || is_mirrored_in_part)
        return axes;
    double tangent = asin(off / length), both = tangent + n.angle_rad;
    axes.turn_rad = angle_of_chord(sqrt(tangent * tangent + n.angle_rad * n.angle_rad + both * both)) + angle_margin;
    return axes;
}

static weft_direction_cap in_axes(const patch_axes *axes, weft_vec3 direction, double angle_rad)
{
    return (weft_direction_cap){
        {weft_dot(direction, axes->x), weft_dot(direction, axes->y), weft_dot(direction, axes->z)},
        fmin(angle_rad + axes->turn_rad, WEFT_PI)};
}

weft_direction_cap weft_cap_behind(const weft_direction_cap *cap)
{
    return (weft_direction_cap){weft_vec3_of(-cap->axis.x, cap->axis.y, -cap->axis.z), cap->angle_rad};
}

/* ---- Footprints ---- */

/* A ball round the patch, and where the eye is from there. */
typedef struct patch_ball {
    weft_vec3 centre, to_eye; /* not unit */
    double radius, distance;
    double slack; /* how far eye and point together may be from what is said of them */
} patch_ball;

static patch_ball ball_of(const weft_patch *p, const weft_camera_span *span)
{
    patch_ball ball = {.slack = span->eye_shift};
    for (int i = 0; i < 3; i++)
        ball.centre = weft_add(ball.centre, weft_scale(p->corner[i].position, 1.0 / 3));
    for (int i = 0; i < 3; i++)
        ball.radius = fmax(ball.radius, weft_length(weft_subtract(p->corner[i].position, ball.centre)));
    ball.to_eye = weft_subtract(span->eye, ball.centre);
    ball.distance = weft_length(ball.to_eye);
    ball.slack += ball.radius;
    return ball;
}

/* Whether all of the ball lies beyond a side of the picture, with a pixel to spare: shifted pictures, and pixels beside
 * an edge. */
static bool is_beside(const patch_ball *ball, const weft_camera_span *span, weft_vec3 axis, double half)
{
    double aside = fabs(weft_dot(ball->to_eye, axis)), ahead = weft_dot(ball->to_eye, span->axes.backward);
    double edge_at = half + span->pixel, slack = ball->slack + (ball->distance + ball->slack) * span->turn_rad;
    return aside - ahead * edge_at > slack * sqrt(1 + edge_at * edge_at);
}

/* Depths of its points along the view, at least and at most. */
static void depths_of(const patch_ball *ball, const weft_camera_span *span, double depth[2])
{
    double ahead = weft_dot(ball->to_eye, span->axes.backward);
    double slack = ball->slack + (ball->distance + ball->slack) * span->turn_rad;
    depth[0] = fmax(ahead - slack, span->nearest);
    depth[1] = ahead + slack;
}

/* The vector on the plane from where the ray of one pixel meets it to where that of its neighbour does is at least as
 * long as the way from the first point to the second ray, and at most that way over the sine between ray and plane. The
 * longer of the two, across and up, counts at most, and one of them is nearly across the ray; where frames see the rest
 * of a long pixel, its width counts, and no pixel is narrower than that way. From pixel to pixel the depth grows by the
 * sine, too, hence its square. */
static void find_levels(const weft_patch *p, const patch_ball *ball, const weft_camera_span *span,
                        weft_patch_bounds *bounds)
{
    double depth[2], shorter = fmin(span->half_width, span->half_height);
    depths_of(ball, span, depth);
    double across_ray = 1 / sqrt(1 + shorter * shorter),
           longest_ray = hypot(1, hypot(span->half_width, span->half_height));
    double least = depth[0] * span->pixel * p->least_stretch * across_ray / (1 + span->pixel);
    double spread = asin(fmin(ball->slack / ball->distance, 1));
    double slant = angle_between(p->normal, ball->to_eye);
    slant = fmin(slant, WEFT_PI - slant) + spread + 2 * span->pixel;
    double sine = slant < WEFT_PI / 2 ? cos(slant) : 0;
    double most = depth[1] * span->pixel * longest_ray * p->largest_stretch / fmax(sine * sine, 1e-9);
    bounds->level_low = log2(fmax(least, 1e-9)) - level_margin;
    bounds->level_high = sine > 0 ? log2(fmax(most, 1e-9)) + level_margin : no_level;
}

weft_patch_bounds weft_patch_bounds_of(const weft_patch *p, const weft_camera_span *span)
{
    weft_patch_bounds bounds = {0};
    patch_ball ball = ball_of(p, span);
    double depth[2];
    depths_of(&ball, span, depth);
    bounds.visible = depth[1] > depth[0] && !is_beside(&ball, span, span->axes.right, span->half_width) &&
                     !is_beside(&ball, span, span->axes.up, span->half_height);
    if (!bounds.visible)
        return bounds;
    double height = weft_dot(p->normal, ball.to_eye), margin = 1e-6 * ball.distance;
    bounds.front = height + span->eye_shift + margin > 0;
    bounds.back = height - span->eye_shift - margin < 0;
    patch_axes axes = axes_of(p);
    double seen = ball.slack < ball.distance ? asin(ball.slack / ball.distance) : WEFT_PI;
    bounds.view = in_axes(&axes, weft_unit(ball.to_eye), seen);
    for (int i = 0; i < span->light_count; i++)
        bounds.light[i] = in_axes(&axes, span->light[i].axis, span->light[i].angle_rad);
    find_levels(p, &ball, span, &bounds);
    bounds.is_large = ball.radius > largest_angle * ball.distance;
    bounds.is_bent = axes.turn_rad > 4 * largest_angle;
    return bounds;
}
