#include "btf/session/camera.h"

#include <stdbool.h>

weft_pose weft_pose_of_view(weft_angles view, double distance_mm)
{
    double sine = sin(view.theta_rad), cosine = cos(view.theta_rad);
    weft_vec3 toward_camera = weft_direction_of_angles(view);
    /* Minus the derivative of the direction by theta: the meridian toward the zenith. */
    weft_vec3 up = {-cosine * cos(view.phi_rad), -cosine * sin(view.phi_rad), sine};
    weft_vec3 down = weft_scale(up, -1), forward = weft_scale(toward_camera, -1);
    weft_vec3 right = weft_cross(down, forward);
    weft_pose pose = {{{right.x, right.y, right.z}, {down.x, down.y, down.z}, {forward.x, forward.y, forward.z}},
                      {0, 0, distance_mm}};
    return pose;
}

weft_vec3 weft_pose_camera_position(const weft_pose *pose)
{
    const double(*r)[3] = pose->rotation;
    weft_vec3 t = pose->translation;
    return (weft_vec3){-(r[0][0] * t.x + r[1][0] * t.y + r[2][0] * t.z),
                       -(r[0][1] * t.x + r[1][1] * t.y + r[2][1] * t.z),
                       -(r[0][2] * t.x + r[1][2] * t.y + r[2][2] * t.z)};
}

weft_homography weft_homography_of_pose(const weft_camera *camera, const weft_pose *pose)
{
    weft_homography homography;
    const double translation[3] = {pose->translation.x, pose->translation.y, pose->translation.z};
    for (int column = 0; column < 3; column++) {
        double point[3];
        for (int row = 0; row < 3; row++)
            point[row] = column < 2 ? pose->rotation[row][column] : translation[row];
        homography.m[0][column] = camera->fx * point[0] + camera->cx * point[2];
        homography.m[1][column] = camera->fy * point[1] + camera->cy * point[2];
        homography.m[2][column] = point[2];
    }
    return homography;
}

weft_pixel weft_homography_apply(const weft_homography *homography, double x, double y)
{
    const double(*m)[3] = homography->m;
    double w = m[2][0] * x + m[2][1] * y + m[2][2];
    return (weft_pixel){(m[0][0] * x + m[0][1] * y + m[0][2]) / w, (m[1][0] * x + m[1][1] * y + m[1][2]) / w};
}

/* Cofactor of element (row, column), with its sign. */
static double cofactor(const double m[3][3], int row, int column)
{
    int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
}

weft_homography weft_homography_inverse(const weft_homography *homography)
{
    weft_homography inverse = {{{0}}};
    double determinant = 0;
    for (int column = 0; column < 3; column++)
        determinant += homography->m[0][column] * cofactor(homography->m, 0, column);
    if (determinant == 0)
        return inverse;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            inverse.m[row][column] = cofactor(homography->m, column, row) / determinant;
    }
    return inverse;
}

static double radius_squared(const weft_camera *camera, weft_pixel pixel, double *x, double *y)
{
    *x = (pixel.x - camera->cx) / camera->fx;
    *y = (pixel.y - camera->cy) / camera->fy;
    return *x * *x + *y * *y;
}

/* In normalised coordinates. */
static weft_pixel distort(const weft_camera *c, weft_pixel p)
{
    double r2 = p.x * p.x + p.y * p.y, radial = 1 + r2 * (c->k1 + r2 * (c->k2 + r2 * c->k3));
    return (weft_pixel){p.x * radial + 2 * c->p1 * p.x * p.y + c->p2 * (r2 + 2 * p.x * p.x),
                        p.y * radial + c->p1 * (r2 + 2 * p.y * p.y) + 2 * c->p2 * p.x * p.y};
}

/* Derivative of `distort`: of x by x, of both crosswise (it is symmetric), of y by y. */
typedef struct distortion_slope {
    double xx, xy, yy;
} distortion_slope;

static distortion_slope slope_at(const weft_camera *c, weft_pixel p)
{
    double r2 = p.x * p.x + p.y * p.y, radial = 1 + r2 * (c->k1 + r2 * (c->k2 + r2 * c->k3));
    double by_r2 = c->k1 + r2 * (2 * c->k2 + r2 * 3 * c->k3);
    return (distortion_slope){radial + 2 * p.x * p.x * by_r2 + 2 * c->p1 * p.y + 6 * c->p2 * p.x,
                              2 * p.x * p.y * by_r2 + 2 * c->p1 * p.x + 2 * c->p2 * p.y,
                              radial + 2 * p.y * p.y * by_r2 + 6 * c->p1 * p.y + 2 * c->p2 * p.x};
}

static double determinant_of(distortion_slope s)
{
    return s.xx * s.yy - s.xy * s.xy;
}

/* Where the lens has not turned back: its slope is positive definite there. */
static bool is_on_the_side_of_the_axis(distortion_slope s)
{
    return s.xx + s.yy > 0 && determinant_of(s) > 1e-6;
}

static weft_pixel excess_at(const weft_camera *c, weft_pixel p, weft_pixel wanted)
{
    weft_pixel got = distort(c, p);
    return (weft_pixel){got.x - wanted.x, got.y - wanted.y};
}

static double squared(double x, double y)
{
    return x * x + y * y;
}

/* Whether it is certain that the lens has not turned back anywhere within a radius. The least eigenvalue of the slope
 * is at least 1 + k1 r^2 + ... or 1 + 3 k1 r^2 + 5 k2 r^4 + 7 k3 r^6, less what the decentring can take from it. */
static bool is_straight_within(const weft_camera *c, double r2)
{
    double k1 = fmin(c->k1, 0), k2 = fmin(c->k2, 0), k3 = fmin(c->k3, 0);
    double radial = 1 + r2 * (3 * k1 + r2 * (5 * k2 + r2 * 7 * k3));
    return radial - 8 * (fabs(c->p1) + fabs(c->p2)) * sqrt(r2) > 0.01;
}

/* How far a straight way goes from a point on the side of the axis before the lens turns back: 1 is all of it. Looked
 * at every twentieth of the focal length. */
static double way_on_the_side_of_the_axis(const weft_camera *c, weft_pixel from, weft_pixel to)
{
    if (is_straight_within(c, fmax(squared(from.x, from.y), squared(to.x, to.y))))
        return 1;
    double length = sqrt(squared(to.x - from.x, to.y - from.y));
    int steps = length < 50 ? (int)ceil(20 * length) : 1000;
    for (int i = 1; i <= steps; i++) {
        double share = (double)i / steps;
        weft_pixel at = {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
        if (!is_on_the_side_of_the_axis(slope_at(c, at)))
            return (double)(i - 1) / steps;
    }
    return 1;
}

/* One step of Newton's method, shortened until it comes nearer and stays on the side of the axis. False where none
 * does. */
static bool step_nearer(const weft_camera *c, weft_pixel wanted, weft_pixel *p, weft_pixel *excess)
{
    distortion_slope s = slope_at(c, *p);
    double determinant = determinant_of(s), distance = squared(excess->x, excess->y);
    weft_pixel step = {(s.yy * excess->x - s.xy * excess->y) / determinant,
                       (s.xx * excess->y - s.xy * excess->x) / determinant};
    for (int halvings = 0; halvings < 20; halvings++) {
        double share = ldexp(1, -halvings);
        weft_pixel next = {p->x - share * step.x, p->y - share * step.y}, left = excess_at(c, next, wanted);
        if (squared(left.x, left.y) < distance && way_on_the_side_of_the_axis(c, *p, next) == 1) {
            *p = next;
            *excess = left;
            return true;
        }
    }
    return false;
}

weft_pixel weft_camera_distort(const weft_camera *camera, weft_pixel undistorted)
{
    weft_pixel p;
    radius_squared(camera, undistorted, &p.x, &p.y);
    p = distort(camera, p);
    return (weft_pixel){camera->cx + camera->fx * p.x, camera->cy + camera->fy * p.y};
}

weft_pixel weft_camera_undistort(const weft_camera *camera, weft_pixel distorted)
{
    weft_pixel wanted;
    radius_squared(camera, distorted, &wanted.x, &wanted.y);
    double way = way_on_the_side_of_the_axis(camera, (weft_pixel){0, 0}, wanted);
    weft_pixel p = {way * wanted.x, way * wanted.y};
    weft_pixel excess = excess_at(camera, p, wanted);
    for (int iteration = 0; iteration < 50 && squared(excess.x, excess.y) > 1e-30; iteration++) {
        if (!step_nearer(camera, wanted, &p, &excess))
            break;
    }
    return (weft_pixel){camera->cx + camera->fx * p.x, camera->cy + camera->fy * p.y};
}

double weft_camera_vignetting(const weft_camera *camera, weft_pixel distorted)
{
    double x, y, r2 = radius_squared(camera, weft_camera_undistort(camera, distorted), &x, &y);
    return 1 + r2 * (camera->vignetting[0] + r2 * (camera->vignetting[1] + r2 * camera->vignetting[2]));
}
