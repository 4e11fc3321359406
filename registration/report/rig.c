#include "registration/report/tables.h"

#include <math.h>
#include <stdio.h>

double weft_bend_depth_mm(const weft_bend_found *found)
{
    /* The larger of the two principal curvatures. */
    const weft_bend *b = &found->bend;
    double mean = (b->xx + b->yy) / 2, spread = hypot((b->xx - b->yy) / 2, b->xy / 2);
    return (fabs(mean) + spread) * found->unit_mm * found->unit_mm;
}

double weft_vignetting_loss(const weft_vignetting *vignetting)
{
    return 1 - exp((vignetting->r2 + vignetting->r4 * vignetting->reach) * vignetting->reach);
}

/* Median white level times exposure, raw values above black; 0 where none was measured. */
static double white_raw(const weft_session *session, const weft_registration *r)
{
    double sum = 0;
    int count = 0;
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (r->white[shot].patches > 0) {
            double cosine = cos(session->shot[shot].light_driven.theta_rad);
            sum += r->white[shot].level[1] * session->record[shot].exposure_s * cosine;
            count++;
        }
    }
    return count ? sum / count : 0;
}

void weft_write_rig(weft_page *page, const weft_session *session, const weft_registration *r)
{
    const weft_bend_found *bend = &r->found.bend;
    const weft_vignetting *v = &r->found.vignetting;
    double white = white_raw(session, r);
    fputs("<h2>What the photographs tell of the rig</h2>\n<ul>\n", page->html);
    if (bend->viewpoints > 0)
        fprintf(page->html,
                "<li>The plate is bent by %.3f mm between its middle and its rim (random error %.4f mm, from %d "
                "viewpoints); "
                "this is taken out.</li>\n",
                weft_bend_depth_mm(bend), bend->standard_error_mm, bend->viewpoints);
    else
        fputs("<li>Its bend could not be found: the plate is taken as flat.</li>\n", page->html);
    if (v->photographs > 0)
        fprintf(
            page->html,
            "<li>Beside the calibrated vignetting, the outermost white patch loses %.2f %% (standard error %.2f %%, "
            "from %d photographs); this is taken out.</li>\n",
            100 * weft_vignetting_loss(v), 100 * v->standard_error, v->photographs);
    const weft_sensor_summary *sensor = &r->found.sensor;
    if (sensor->dark_frames > 0)
        fprintf(
            page->html,
            "<li>The sensor gathers %.3g raw values per second without light (from %d dark frames at %.3g s, and as "
            "many brief ones); this is subtracted. %d hot pixels are masked.</li>\n",
            sensor->dark_rate, sensor->dark_frames, sensor->longest_s, sensor->hot);
    if (sensor->flat_frames > 0)
        fprintf(page->html,
                "<li>Pixels respond with %.1f to %.1f %% of the usual one (0.1st and 99.9th percentile, from %d flat "
                "frames), and %+.2f %% toward the rim beside the calibrated vignetting; this is divided out. %d dead "
                "pixels are masked.</li>\n",
                100 * sensor->least, 100 * sensor->most, sensor->flat_frames, 100 * sensor->fall_off, sensor->dead);
    fputs("</ul>\n<h2>What they cannot tell</h2>\n<ul>\n<li>The scale of the print: millimetres are those that are "
          "printed.</li>\n<li>How high the cloth lies over the paper: 0.1 mm moves it by 0.17 mm in a view from 60 "
          "degrees. It is taken to lie in the surface that continues the print.</li>\n<li>The reflectance of the white "
          "patches: all reflectances scale with it.</li>\n",
          page->html);
    if (white > 0 && sensor->dark_frames == 0)
        fprintf(
            page->html,
            "<li>The black level: where it is off by one raw value, a reflectance of 0.05 is off by %.2f %%.</li>\n",
            100 / (0.05 * white));
    fputs("</ul>\n", page->html);
}
