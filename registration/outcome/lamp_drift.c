#include "registration/outcome/lamp_drift.h"

#include <math.h>

weft_viewpoint_white weft_viewpoint_white_of(const weft_registration *registration, int viewpoint)
{
    const weft_viewpoint *one = &registration->survey.viewpoint[viewpoint];
    weft_viewpoint_white white = {0, {0, 0, 0}};
    for (int i = 0; i < one->count; i++) {
        const weft_white *measured = &registration->white[one->shot[i]];
        for (int c = 0; c < 3 && measured->patches > 0; c++)
            white.level[c] += measured->level[c];
        white.photographs += measured->patches > 0;
    }
    for (int c = 0; c < 3 && white.photographs > 0; c++)
        white.level[c] /= white.photographs;
    return white;
}

weft_lamp_drift weft_lamp_drift_of(const weft_registration *registration)
{
    weft_lamp_drift drift = {0, INFINITY, -INFINITY};
    double sum = 0;
    for (int viewpoint = 0; viewpoint < registration->survey.viewpoint_count; viewpoint++) {
        weft_viewpoint_white white = weft_viewpoint_white_of(registration, viewpoint);
        double level = white.level[0] + white.level[1] + white.level[2];
        if (white.photographs == 0)
            continue;
        drift.viewpoints++;
        sum += level;
        drift.lowest = fmin(drift.lowest, level);
        drift.highest = fmax(drift.highest, level);
    }
    if (drift.viewpoints == 0)
        return (weft_lamp_drift){0, 0, 0};
    drift.lowest = drift.lowest * drift.viewpoints / sum - 1;
    drift.highest = drift.highest * drift.viewpoints / sum - 1;
    return drift;
}
