#include "compare/report/page/sections.h"

#include "compare/pictures/sample_picture.h"

#include <stdio.h>

static const int shown_width = 262;

static const char *const captions[WEFT_TRUTH_MODELS] = {"raw: the dataset, interpolated", "compressed: the material",
                                                        "truth: the geometry, traced"};

/* Encodes, writes and frees one picture of a row. */
static weft_code put_picture(weft_page *page, const char *row, const char *name, weft_image *picture,
                             const char *caption, weft_error *error)
{
    char file[128];
    snprintf(file, sizeof file, "%s-%s", row, name);
    weft_code code = weft_page_picture(page, file, picture, shown_width, caption, error);
    weft_image_free(picture);
    return code;
}

static weft_code put_difference(weft_page *page, const char *row, const weft_truth_pictures *under, int model,
                                double exposure, weft_error *error)
{
    char name[64], caption[160];
    const weft_truth_error *e = &under->error[model];
    snprintf(name, sizeof name, "%s-minus-truth", weft_truth_model_name((weft_truth_model)model));
    snprintf(caption, sizeof caption, "%s minus truth: relative RMSE %.2f %%, %.1f dB; of blocks %.2f %%",
             weft_truth_model_name((weft_truth_model)model), 100 * e->error.relative_rmse, e->error.psnr_db,
             100 * e->block_relative_rmse);
    weft_image picture;
    WEFT_TRY(weft_picture_difference(&under->picture[WEFT_TRUTH_TRACED], &under->picture[model], NULL, exposure,
                                     &picture, error));
    return put_picture(page, row, name, &picture, caption, error);
}

static weft_code put_row(weft_page *page, const char *row, const weft_truth_pictures *under, double exposure,
                         weft_error *error)
{
    fputs("<div class=\"row even\">\n", page->html);
    for (int model = 0; model < WEFT_TRUTH_MODELS; model++) {
        weft_image picture;
        WEFT_TRY(weft_picture_encode(&under->picture[model], NULL, exposure, &picture, error));
        WEFT_TRY(
            put_picture(page, row, weft_truth_model_name((weft_truth_model)model), &picture, captions[model], error));
    }
    for (int model = 0; model < WEFT_TRUTH_TRACED; model++)
        WEFT_TRY(put_difference(page, row, under, model, exposure, error));
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static weft_code put_scene(weft_page *page, int index, const weft_traced_truth *truth, weft_error *error)
{
    static const char *const what[WEFT_TRUTH_LIGHTS] = {"all light", "light of the cloth near by"};
    static const char *const file[WEFT_TRUTH_LIGHTS] = {"all", "near"};
    const weft_truth_scene *scene = &truth->scene[index];
    const weft_image *traced = &scene->under[WEFT_TRUTH_ALL].picture[WEFT_TRUTH_TRACED];
    double exposure;
    WEFT_TRY(weft_picture_exposure(traced, NULL, &exposure, error));
    for (int light = 0; light < WEFT_TRUTH_LIGHTS; light++) {
        char row[32];
        snprintf(row, sizeof row, "truth-%d-%s", index, file[light]);
        fputs("<h3>", page->html);
        weft_page_text(page, scene->caption);
        fprintf(page->html, ", %s (shown %.3g times brighter)</h3>\n", what[light], exposure);
        WEFT_TRY(put_row(page, row, &scene->under[light], exposure, error));
    }
    return WEFT_OK;
}

static void print_errors(weft_page *page, const weft_truth_error *e)
{
    fprintf(page->html, "<td>%.2f %%</td><td>%.2f %%</td><td>%.1f dB</td><td>%.2f %%</td>",
            100 * e->error.relative_rmse, 100 * e->error.median_relative, e->error.psnr_db,
            100 * e->block_relative_rmse);
}

static void print_row(weft_page *page, const weft_truth_scene *scene, int model, bool flat)
{
    fputs("<tr><td>", page->html);
    weft_page_text(page, scene->caption);
    fprintf(page->html, "</td><td>%s%s</td>", weft_truth_model_name((weft_truth_model)model),
            flat ? " without heights" : "");
    for (int light = 0; light < WEFT_TRUTH_LIGHTS; light++)
        print_errors(page, flat ? &scene->under[light].flat[model] : &scene->under[light].error[model]);
    fprintf(page->html, "<td>%.2f %%</td></tr>\n", 100 * scene->noise);
}

static void print_table(weft_page *page, const weft_traced_truth *truth)
{
    fputs("<table><tr><td></td><td></td><th scope=\"colgroup\" colspan=\"4\">all light</th><th scope=\"colgroup\" "
          "colspan=\"4\">light of the cloth near by</th><td></td></tr>\n",
          page->html);
    weft_page_columns(page, "scene||relative RMSE|median relative|PSNR|of blocks|relative RMSE|median "
                            "relative|PSNR|of blocks|noise of the truth");
    for (int i = 0; i < WEFT_TRUTH_SCENE_COUNT; i++)
        for (int model = 0; model < WEFT_TRUTH_TRACED; model++) {
            print_row(page, &truth->scene[i], model, false);
            if (truth->has_heights[model])
                print_row(page, &truth->scene[i], model, true);
        }
    fputs("</table>\n", page->html);
}

weft_code weft_page_truth(weft_page *page, const weft_traced_truth *truth, weft_error *error)
{
    if (!truth->drawn && truth->why_not[0] == 0)
        return WEFT_OK;
    fputs("<h2>Truth</h2>\n", page->html);
    if (!truth->drawn) {
        fputs("<p>There is no picture beside the truth: ", page->html);
        weft_page_text(page, truth->why_not);
        fputs("</p>\n", page->html);
        return WEFT_OK;
    }
    fputs("<p class=\"note\">The drape with the geometry of ", page->html);
    weft_page_text(page, truth->stitch);
    fprintf(
        page->html,
        " laid over it, %d tiles across %.3g mm, %d triangles (%d of %d cells across a tile), traced with %d paths "
        "a pixel and %d bounces. All light: the player casts the shadows of the mesh. Light of the cloth near by: "
        "cloth farther than %.2g mm away neither shades nor lights anything, and the player casts no shadows, as in "
        "a material. Errors are over the lit pixels of the mesh; errors of blocks compare means over %d "
        "x %d pixels.%s</p>\n",
        WEFT_TRUTH_REPEAT, truth->cloth_mm, truth->triangles, truth->cells, truth->finest_cells, truth->paths,
        truth->bounces, truth->reach_mm, WEFT_TRUTH_BLOCK, WEFT_TRUTH_BLOCK,
        truth->has_heights[WEFT_TRUTH_RAW] || truth->has_heights[WEFT_TRUTH_COMPRESSED]
            ? " Pictures are through the heights of dataset and material."
            : "");
    if (truth->warning[0]) {
        fputs("<p>", page->html);
        weft_page_text(page, truth->warning);
        fputs("</p>\n", page->html);
    }
    print_table(page, truth);
    for (int i = 0; i < WEFT_TRUTH_SCENE_COUNT; i++)
        WEFT_TRY(put_scene(page, i, truth, error));
    return WEFT_OK;
}
