#include "study/compare_page.h"

#include "study/picture.h"

#include <stdio.h>

static const int shown_width = 262;

static const char *const captions[WEFT_TRUTH_PICTURES] = {"raw: the dataset, interpolated", "compressed: the material",
                                                          "truth: the geometry, traced",
                                                          "truth, light of the cloth near by alone"};

/* Encodes, writes and frees one picture of a row. */
static weft_code put_picture(weft_page *page, int scene, const char *name, weft_image *picture, const char *caption,
                             weft_error *error)
{
    char file[96];
    snprintf(file, sizeof file, "truth-%d-%s", scene, name);
    weft_code code = weft_page_picture(page, file, picture, shown_width, caption, error);
    weft_image_free(picture);
    return code;
}

static weft_code put_difference(weft_page *page, int index, const weft_truth_scene *scene, weft_truth_picture model,
                                weft_truth_picture truth, double exposure, weft_error *error)
{
    char name[64], caption[160];
    const weft_truth_error *e = truth == WEFT_TRUTH_ALL ? &scene->all[model] : &scene->near[model];
    snprintf(name, sizeof name, "%s-minus-%s", weft_truth_picture_name(model), weft_truth_picture_name(truth));
    snprintf(caption, sizeof caption, "%s minus %s: relative RMSE %.4f, %.1f dB", weft_truth_picture_name(model),
             truth == WEFT_TRUTH_ALL ? "truth" : "truth with near light", e->error.relative_rmse, e->psnr_db);
    weft_image picture;
    WEFT_TRY(weft_picture_difference(&scene->picture[truth], &scene->picture[model], NULL, exposure, &picture, error));
    return put_picture(page, index, name, &picture, caption, error);
}

static weft_code put_scene(weft_page *page, int index, const weft_truth *truth, weft_error *error)
{
    const weft_truth_scene *scene = &truth->scene[index];
    double exposure = weft_picture_exposure(&scene->picture[WEFT_TRUTH_ALL], NULL);
    fputs("<h3>", page->html);
    weft_page_text(page, scene->caption);
    fprintf(page->html, " (shown %.3g times brighter)</h3>\n<div class=\"row\">\n", exposure);
    for (int i = 0; i < WEFT_TRUTH_PICTURES; i++) {
        weft_image picture;
        WEFT_TRY(weft_picture_encode(&scene->picture[i], NULL, exposure, &picture, error));
        WEFT_TRY(
            put_picture(page, index, weft_truth_picture_name((weft_truth_picture)i), &picture, captions[i], error));
    }
    for (int truth_of = WEFT_TRUTH_ALL; truth_of <= WEFT_TRUTH_NEAR; truth_of++)
        for (int model = 0; model < WEFT_TRUTH_MODELS; model++)
            WEFT_TRY(put_difference(page, index, scene, (weft_truth_picture)model, (weft_truth_picture)truth_of,
                                    exposure, error));
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static void print_errors(weft_page *page, const weft_truth_error *e)
{
    fprintf(page->html, "<td>%.4f</td><td>%.2f dB</td><td>%.2f %%</td><td>%.4f</td>", e->error.relative_rmse,
            e->psnr_db, 100 * e->error.median_relative, e->block_relative_rmse);
}

static void print_row(weft_page *page, const weft_truth_scene *scene, weft_truth_picture model)
{
    fputs("<tr><td>", page->html);
    weft_page_text(page, scene->caption);
    fprintf(page->html, "</td><td>%s</td>", weft_truth_picture_name(model));
    print_errors(page, &scene->all[model]);
    print_errors(page, &scene->near[model]);
    fprintf(page->html, "<td>%.2f %%</td></tr>\n", 100 * scene->noise);
}

static void print_table(weft_page *page, const weft_truth *truth)
{
    static const char *const columns = "<th>relative RMSE</th><th>PSNR</th><th>median relative</th><th>of blocks</th>";
    fprintf(page->html,
            "<table><tr><th></th><th></th><th colspan=\"4\">against the truth</th><th colspan=\"4\">with the light of "
            "cloth near by</th><th></th></tr>\n<tr><th>scene</th><th></th>%s%s<th>noise of the truth</th></tr>\n",
            columns, columns);
    for (int i = 0; i < WEFT_TRUTH_SCENE_COUNT; i++)
        for (int model = 0; model < WEFT_TRUTH_MODELS; model++)
            print_row(page, &truth->scene[i], (weft_truth_picture)model);
    fputs("</table>\n", page->html);
}

weft_code weft_page_truth(weft_page *page, const weft_truth *truth, weft_error *error)
{
    if (!truth->drawn && truth->why_not[0] == 0)
        return WEFT_OK;
    fputs("<h2>Truth</h2>\n", page->html);
    if (!truth->drawn) {
        fputs("<p>There is nothing beside the truth: ", page->html);
        weft_page_text(page, truth->why_not);
        fputs("</p>\n", page->html);
        return WEFT_OK;
    }
    fputs("<p class=\"note\">The drape with the geometry of ", page->html);
    weft_page_text(page, truth->stitch);
    fprintf(page->html,
            " laid over it, %d tiles across %.3g mm, %d triangles (%d of %d cells across a tile), traced with %d paths "
            "a pixel and %d bounces. With "
            "the light of cloth near by alone, shadows and light from beyond %.2g mm are left out: what no material "
            "that is laid over a mesh can know. Errors are those of the lit pixels of the mesh; those of blocks are of "
            "means over %d x %d pixels.</p>\n",
            WEFT_TRUTH_REPEAT, truth->cloth_mm, truth->triangles, truth->cells, truth->finest_cells, truth->paths,
            truth->bounces, truth->reach_mm, WEFT_TRUTH_BLOCK, WEFT_TRUTH_BLOCK);
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
