#include "btf/session/camera.h"

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

weft_pixel weft_camera_distort(const weft_camera *camera, weft_pixel undistorted)
{
    double x, y, r2 = radius_squared(camera, undistorted, &x, &y);
    double factor = 1 + r2 * (camera->k1 + r2 * camera->k2);
    return (weft_pixel){camera->cx + camera->fx * x * factor, camera->cy + camera->fy * y * factor};
}

weft_pixel weft_camera_undistort(const weft_camera *camera, weft_pixel distorted)
{
    double x, y, distorted_radius = sqrt(radius_squared(camera, distorted, &x, &y));
    double radius = distorted_radius;
    /* Newton on radius (1 + k1 radius^2 + k2 radius^4) = distorted_radius. */
    for (int iteration = 0; iteration < 20; iteration++) {
        double r2 = radius * radius;
        double excess = radius * (1 + r2 * (camera->k1 + r2 * camera->k2)) - distorted_radius;
        double slope = 1 + r2 * (3 * camera->k1 + 5 * r2 * camera->k2);
        if (fabs(excess) <= 1e-14 || slope < 1e-3)
            break;
        radius -= excess / slope;
    }
    double factor = distorted_radius > 0 ? radius / distorted_radius : 1;
    return (weft_pixel){camera->cx + camera->fx * x * factor, camera->cy + camera->fy * y * factor};
}

double weft_camera_vignetting(const weft_camera *camera, weft_pixel distorted)
{
    double x, y, r2 = radius_squared(camera, weft_camera_undistort(camera, distorted), &x, &y);
    return 1 + r2 * (camera->vignetting[0] + r2 * (camera->vignetting[1] + r2 * camera->vignetting[2]));
}
