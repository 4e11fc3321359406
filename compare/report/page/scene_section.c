#include "compare/report/page/sections.h"

#include "compare/pictures/sample_picture.h"

#include <stdio.h>

/* Five pictures side by side fill the page; a click shows them as large as they are. */
static const int shown_width = 224;

/* Encodes, writes and frees one picture of a row. */
static weft_code put_picture(weft_page *page, int scene, const char *name, weft_image *picture, const char *caption,
                             weft_error *error)
{
    char file[96];
    snprintf(file, sizeof file, "scene-%d-%s", scene, name);
    weft_code code = weft_page_picture(page, file, picture, shown_width, caption, error);
    weft_image_free(picture);
    return code;
}

static weft_code put_difference(weft_page *page, int index, const weft_scene_pictures *scene, int model,
                                double exposure, weft_error *error)
{
    char name[64], caption[160];
    const weft_error_summary *e = &scene->error[model];
    snprintf(name, sizeof name, "%s-minus-raw", weft_scenes_model_name(model));
    snprintf(caption, sizeof caption,
             "%s minus raw: relative RMSE %.2f %%, median relative %.2f %%, 80th percentile %.2f %%",
             weft_scenes_model_name(model), 100 * e->relative_rmse, 100 * e->median_relative,
             100 * e->percentile80_relative);
    weft_image picture;
    WEFT_TRY(weft_picture_difference(&scene->picture[WEFT_MODE_RAW], &scene->picture[model], NULL, exposure, &picture,
                                     error));
    return put_picture(page, index, name, &picture, caption, error);
}

static weft_code put_scene(weft_page *page, int index, const weft_scenes *scenes, weft_error *error)
{
    const weft_scene_pictures *scene = &scenes->scene[index];
    double exposure;
    WEFT_TRY(weft_picture_exposure(&scene->picture[WEFT_MODE_RAW], NULL, &exposure, error));
    fputs("<h3>", page->html);
    weft_page_text(page, scene->caption);
    fprintf(page->html, " (shown %.3g times brighter)</h3>\n<div class=\"row even\">\n", exposure);
    for (int model = 0; model < WEFT_SCENE_MODELS; model++) {
        if (!scenes->has[model])
            continue;
        weft_image picture;
        const char *name = weft_scenes_model_name(model);
        WEFT_TRY(weft_picture_encode(&scene->picture[model], NULL, exposure, &picture, error));
        WEFT_TRY(put_picture(page, index, name, &picture, name, error));
    }
    for (int model = WEFT_MODE_COMPRESSED; model < WEFT_SCENE_MODELS; model++) {
        if (scenes->has[model])
            WEFT_TRY(put_difference(page, index, scene, model, exposure, error));
    }
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

weft_code weft_page_scenes(weft_page *page, const weft_scenes *scenes, weft_error *error)
{
    fputs("<h2>Scenes</h2>\n", page->html);
    if (!scenes->drawn) {
        fputs("<p>There are no pictures of scenes: ", page->html);
        weft_page_text(page, scenes->why_not);
        fputs("</p>\n", page->html);
        return WEFT_OK;
    }
    fprintf(page->html, "<p class=\"note\">Raw: the dataset, interpolated%s. Compressed: the material. ",
            scenes->has_heights ? " through its heights" : "");
    if (scenes->has[WEFT_MODE_ANALYTIC])
        fputs("Analytic: the model of the cloth, without noise. ", page->html);
    if (scenes->has[WEFT_SCENE_BARD])
        fputs("BARD: predicted from the photographs under one light. ", page->html);
    if (scenes->near_lights)
        fputs("The lights of this dataset are near: raw is drawn with their directions at its centre, so its borders "
              "do not meet. ",
              page->html);
    if (scenes->skipped_levels > 0)
        fprintf(page->html, "The dataset did not fit into graphics memory: its finest %d levels are left out. ",
                scenes->skipped_levels);
    fputs("Errors are over the lit pixels of the mesh. Differences: see <a href=\"#texels\">Texels</a>.</p>\n",
          page->html);
    for (int i = 0; i < WEFT_SCENE_COUNT; i++)
        WEFT_TRY(put_scene(page, i, scenes, error));
    return WEFT_OK;
}
