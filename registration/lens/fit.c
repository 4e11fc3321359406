#include "registration/lens/fit.h"

#include <stdlib.h>
#include <string.h>

void weft_lens_fit_free(weft_lens_fit *fit)
{
    free(fit->photograph);
    free(fit->view);
    free(fit->corners.pose);
    free(fit->corners.residual_px);
    free(fit->board_mm);
    free(fit->pixel);
    free(fit->source);
    *fit = (weft_lens_fit){0};
}

static weft_code allocate(const weft_board_photograph *photograph, int count, weft_lens_fit *fit, weft_error *error)
{
    size_t points = 1, views = (size_t)count + 1;
    for (int i = 0; i < count; i++)
        points += (size_t)photograph[i].count;
    *fit = (weft_lens_fit){
        .photograph = calloc(views, sizeof *fit->photograph),
        .view = calloc(views, sizeof *fit->view),
        .corners = {.pose = calloc(views, sizeof(weft_pose)), .residual_px = calloc(points, sizeof *fit->pixel)},
        .board_mm = calloc(points, sizeof *fit->board_mm),
        .pixel = calloc(points, sizeof *fit->pixel),
        .source = calloc(points, sizeof *fit->source)};
    if (fit->photograph && fit->view && fit->corners.pose && fit->corners.residual_px && fit->board_mm && fit->pixel &&
        fit->source)
        return WEFT_OK;
    return weft_fail_memory(error, "corners", points * sizeof *fit->pixel);
}

static void add_view(const weft_board_photograph *photograph, int index, weft_lens_fit *fit)
{
    const weft_board_photograph *p = &photograph[index];
    weft_corner_view *view = &fit->view[fit->views];
    fit->photograph[fit->views++] = index;
    view->plate = (const double(*)[2])fit->board_mm + fit->points;
    view->seen = (const double(*)[2])fit->pixel + fit->points;
    for (int i = 0; i < p->count; i++) {
        if (p->stray[i])
            continue;
        memcpy(fit->board_mm[fit->points], p->point[i].board_mm, sizeof p->point[i].board_mm);
        memcpy(fit->pixel[fit->points], p->point[i].pixel, sizeof p->point[i].pixel);
        fit->source[fit->points++] = i;
        view->count++;
    }
}

weft_code weft_lens_fit_run(const weft_board_photograph *photograph, int count, unsigned fixed, int fold, int folds,
                            weft_lens_fit *fit, weft_error *error)
{
    int used = 0;
    weft_code code = allocate(photograph, count, fit, error);
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        if (!weft_board_is_used(&photograph[i]))
            continue;
        fit->camera.width = photograph[i].width;
        fit->camera.height = photograph[i].height;
        if (folds == 0 || used % folds != fold)
            add_view(photograph, i, fit);
        used++;
    }
    if (code == WEFT_OK)
        code = weft_opencv_calibrate(fit->view, fit->views, fixed, false, &fit->camera, &fit->corners, error);
    if (code != WEFT_OK)
        weft_lens_fit_free(fit);
    return code;
}
