#include "registration/lens/fit.h"

#include <stdlib.h>
#include <string.h>

void weft_lens_fit_free(weft_lens_fit *fit)
{
    free(fit->photograph);
    free(fit->point_count);
    free(fit->rotation);
    free(fit->board_mm);
    free(fit->pixel);
    free(fit->residual_px);
    free(fit->source);
    *fit = (weft_lens_fit){0};
}

static weft_code allocate(const weft_board_photograph *photograph, int count, weft_lens_fit *fit, weft_error *error)
{
    size_t points = 1, views = (size_t)count + 1;
    for (int i = 0; i < count; i++)
        points += (size_t)photograph[i].count;
    *fit = (weft_lens_fit){.photograph = calloc(views, sizeof *fit->photograph),
                           .point_count = calloc(views, sizeof *fit->point_count),
                           .rotation = calloc(views, sizeof *fit->rotation),
                           .board_mm = calloc(points, sizeof *fit->board_mm),
                           .pixel = calloc(points, sizeof *fit->pixel),
                           .residual_px = calloc(points, sizeof *fit->residual_px),
                           .source = calloc(points, sizeof *fit->source)};
    if (fit->photograph && fit->point_count && fit->rotation && fit->board_mm && fit->pixel && fit->residual_px &&
        fit->source)
        return WEFT_OK;
    return weft_fail_memory(error, "corners", points * sizeof *fit->pixel);
}

static void add_view(const weft_board_photograph *photograph, int index, weft_lens_fit *fit)
{
    const weft_board_photograph *p = &photograph[index];
    int view = fit->views++;
    fit->photograph[view] = index;
    for (int i = 0; i < p->count; i++) {
        if (p->stray[i])
            continue;
        memcpy(fit->board_mm[fit->points], p->point[i].board_mm, sizeof p->point[i].board_mm);
        memcpy(fit->pixel[fit->points], p->point[i].pixel, sizeof p->point[i].pixel);
        fit->source[fit->points++] = i;
        fit->point_count[view]++;
    }
}

weft_code weft_lens_fit_run(const weft_board_photograph *photograph, int count, const weft_lens_model *model, int fold,
                            int folds, weft_lens_fit *fit, weft_error *error)
{
    int used = 0, width = 0, height = 0;
    weft_code code = allocate(photograph, count, fit, error);
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        if (!weft_board_is_used(&photograph[i]))
            continue;
        width = photograph[i].width;
        height = photograph[i].height;
        if (folds == 0 || used % folds != fold)
            add_view(photograph, i, fit);
        used++;
    }
    if (code == WEFT_OK)
        code = weft_opencv_calibrate(width, height, fit->views, fit->point_count, (const double(*)[2])fit->board_mm,
                                     (const double(*)[2])fit->pixel, model, fit->value, fit->standard_error,
                                     fit->rotation, fit->residual_px, &fit->rms_px, error);
    if (code != WEFT_OK)
        weft_lens_fit_free(fit);
    return code;
}
