#include "registration/outcome/lamp_drift.h"

#include <math.h>

weft_stay_white weft_stay_white_of(const weft_registration *registration, int stay)
{
    const weft_stay *one = &registration->survey.stay[stay];
    weft_stay_white white = {0, {0, 0, 0}};
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
    for (int stay = 0; stay < registration->survey.stay_count; stay++) {
        weft_stay_white white = weft_stay_white_of(registration, stay);
        double level = white.level[0] + white.level[1] + white.level[2];
        if (white.photographs == 0)
            continue;
        drift.stays++;
        sum += level;
        drift.lowest = fmin(drift.lowest, level);
        drift.highest = fmax(drift.highest, level);
    }
    if (drift.stays == 0)
        return (weft_lamp_drift){0, 0, 0};
    drift.lowest = drift.lowest * drift.stays / sum - 1;
    drift.highest = drift.highest * drift.stays / sum - 1;
    return drift;
}
