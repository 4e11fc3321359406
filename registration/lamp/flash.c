#include "registration/lamp/flash.h"

double weft_flash_log_beam(const weft_flash *flash, const weft_pose *pose, double x, double y)
{
    const double *along[3] = {&pose->translation.x, &pose->translation.y, &pose->translation.z}, *beam = flash->beam;
    double to[3];
    for (int axis = 0; axis < 3; axis++)
        to[axis] = pose->rotation[axis][0] * x + pose->rotation[axis][1] * y + *along[axis] - flash->place_mm[axis];
    double u = to[0] / to[2], v = to[1] / to[2];
    return u * (beam[0] + beam[2] * u + beam[3] * v) + v * (beam[1] + beam[4] * v);
}
