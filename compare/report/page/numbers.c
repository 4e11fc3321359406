#include "compare/report/page/sections.h"

#include "base/text/chart.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The error to judge the material by, before any other. */
static void print_held_out(weft_page *page, const weft_hold_out *held_out)
{
    char line[WEFT_HOLD_OUT_LINE];
    fputs("<p id=\"held-out\"><b>The material ", page->html);
    weft_hold_out_headline(held_out, line);
    weft_page_text(page, line);
    fputs(".</b> As <code>weft compress</code> ", page->html);
    weft_hold_out_explain(held_out, line);
    weft_page_text(page, line);
    fputs(". All other numbers on this page are of fitted samples.</p>\n", page->html);
}

/* A drape shows many more views and lights than a few photographs have: what is drawn of them there is no measure. */
static bool measures_drape(const weft_comparison *comparison)
{
    const weft_error_summary *e = &comparison->scenes.scene[0].error[WEFT_MODE_COMPRESSED];
    return comparison->scenes.drawn && e->count > 0 && isfinite(e->psnr_db) && !comparison->has_few_images;
}

/* What a reader of pictures asks first: the first scene, a drape. */
static void print_drape(weft_page *page, const weft_comparison *comparison)
{
    const weft_error_summary *e = &comparison->scenes.scene[0].error[WEFT_MODE_COMPRESSED];
    char label[80];
    if (!measures_drape(comparison))
        return;
    snprintf(label, sizeof label, "on a drape, %.1f %% from the photographs it was fitted to", 100 * e->relative_rmse);
    weft_page_tile(page, label, "%.0f dB", e->psnr_db);
}

/* Whether the numbers are good ones. */
static void explain_tiles(weft_page *page, const weft_comparison *comparison)
{
    if (!measures_drape(comparison) && !comparison->has_held_out)
        return;
    fputs("<p class=\"note\">", page->html);
    if (measures_drape(comparison))
        fputs("As a rule of thumb, two pictures are hard to tell apart from 40 dB on, at 30 dB they look alike until "
              "they lie side by side, and below 25 dB the difference is plain. ",
              page->html);
    if (comparison->has_held_out)
        fputs("The error of the interpolated photographs shows how much lies between their directions. A good "
              "material has no larger error.",
              page->html);
    fputs("</p>\n", page->html);
}

void weft_page_summary(weft_page *page, const weft_dataset_layout *layout, const weft_comparison *comparison)
{
    const weft_error_summary *all = &comparison->model[0].texture.all;
    fprintf(page->html, "<p>%d \u00d7 %d texels of %.4g mm, %d images from %d views; lights and cameras %s.</p>\n",
            layout->width, layout->height, layout->texel_pitch_mm, layout->image_count, layout->view_count,
            layout->distance == WEFT_NEAR ? "near, their directions differ from texel to texel" : "far away");
    if (comparison->has_held_out)
        print_held_out(page, &comparison->held_out);
    fputs("<div class=\"tiles\">\n", page->html);
    print_drape(page, comparison);
    if (comparison->has_held_out)
        weft_page_tile(page, "relative RMSE where it was not fitted", "%.2f %%",
                       100 * comparison->held_out.material.all.relative_rmse);
    weft_page_tile(page, "relative RMSE, fitted samples, level 0", "%.2f %%", 100 * all->relative_rmse);
    weft_page_tile(page, "median relative error, fitted samples, level 0", "%.2f %%", 100 * all->median_relative);
    weft_page_tile(page, "half floats : material", "%.1f : 1",
                   comparison->half_float_bytes / comparison->material_bytes);
    fputs("</div>\n", page->html);
    explain_tiles(page, comparison);
}

/* What the columns of errors mean. */
static void explain_error(weft_page *page)
{
    fprintf(page->html,
            "Relative RMSE: \u221a(\u03a3 (p \u2212 s)\u00b2 / \u03a3 s\u00b2) over samples s and predictions p. "
            "Median relative and 80th percentile: of |p \u2212 s| / s, without dim samples of at most %g of "
            "the largest.",
            weft_dim_share);
}

static void print_weave(weft_page *page, const weft_comparison *comparison)
{
    if (comparison->weave_name[0] == 0)
        return;
    fprintf(page->html, " The analytic cloth is the %s \u201c",
            comparison->weave_is_threads ? "microcylinder cloth" : "weave");
    weft_page_text(page, comparison->weave_name);
    fprintf(page->html, "\u201d, ");
    weft_page_text(page, comparison->weave_origin);
    if (comparison->weave_is_threads) {
        fputs(".", page->html);
        return;
    }
    const weft_weave_layout *layout = &comparison->weave_layout;
    fprintf(page->html, "; %.4g \u00d7 %.4g tiles across the material", layout->tiles_u, layout->tiles_v);
    if (comparison->weave_on_yarns)
        fprintf(page->html,
                ", placed by the fit (a tile begins %.2f tiles to the right of the lower left "
                "corner and %.2f above it)",
                layout->corner_u, layout->corner_v);
    fputs(".", page->html);
    const weft_error_summary *before = &comparison->fit.before, *after = &comparison->fit.after;
    if (comparison->fit.image_count > 0)
        fprintf(page->html,
                " The relative error of the mean BRDF that the fit saw was %.2f %% (median) and %.2f %% (80th "
                "percentile) before the fit, and is %.2f %% and %.2f %% after it. The table has the error over the "
                "whole material. <a href=\"fitted.wv\">fitted.wv</a> is the fitted weave.",
                100 * before->median_relative, 100 * before->percentile80_relative, 100 * after->median_relative,
                100 * after->percentile80_relative);
}

static void print_model_error(weft_page *page, const char *name, const weft_error_summary *e)
{
    fprintf(page->html, "<tr><td>%s</td><td>%ld</td><td>%.2f %%</td><td>%.2f %%</td><td>%.2f %%</td></tr>\n", name,
            e->count, 100 * e->relative_rmse, 100 * e->median_relative, 100 * e->percentile80_relative);
}

void weft_page_models(weft_page *page, const weft_comparison *comparison)
{
    fputs("<h2 id=\"models\">Models against the data</h2>\n<table>", page->html);
    weft_page_columns(page, "every sample of every texel|values|relative RMSE|median relative|80th percentile");
    for (int i = 0; i < comparison->model_count; i++)
        print_model_error(page, comparison->model[i].name, &comparison->model[i].texture.all);
    weft_page_columns(page, "mean BRDF of the material||||");
    for (int i = 0; i < comparison->model_count; i++)
        print_model_error(page, comparison->model[i].name, &comparison->model[i].mean);
    fputs("</table>\n<p class=\"note\">", page->html);
    explain_error(page);
    fputs(" Samples in the quantity of the dataset, the analytic cloth averaged over each texel and without its noise; "
          "mean BRDFs over the directions of the images, as <code>weft eval</code> gives them without texture "
          "coordinates.",
          page->html);
    print_weave(page, comparison);
    fputs("</p>\n", page->html);
}

/* Of components alone level 0 has an error, of the texels that they were learned from. */
static void print_levels(weft_page *page, const weft_material *material)
{
    if (weft_material_has_components_alone(material))
        return;
    fprintf(page->html, "<h2>Error of the %s on the samples it was fitted to, level by level</h2>\n",
            weft_material_errors_of(material) ? weft_material_errors_of(material) : "material");
    if (weft_material_errors_of(material))
        fputs("<p class=\"note\">This is what players without components show. The errors of the components stand "
              "above and "
              "below.</p>\n",
              page->html);
    fputs("<p class=\"note\">Measured over all valid samples when the file was written, decoded as a player sees it; "
          "percentiles to 2 % of their value.</p>\n<table>",
          page->html);
    weft_page_columns(page, "texels|relative RMSE|median relative|80th percentile|PSNR|RMSE");
    for (int i = 0; i < material->level_count; i++) {
        const weft_material_level *level = &material->level[i];
        const weft_error_summary *e = &level->error;
        fprintf(page->html,
                "<tr><td>%d\u00a0\u00d7\u00a0%d</td><td>%.2f %%</td><td>%.2f %%</td><td>%.2f %%</td><td>%.1f dB</td>"
                "<td>%.4f</td></tr>\n",
                level->width, level->height, 100 * e->relative_rmse, 100 * e->median_relative,
                100 * e->percentile80_relative, e->psnr_db, e->rmse);
    }
    fputs("</table>\n", page->html);
}

static void print_error(weft_page *page, const char *name, const weft_error_summary *e)
{
    if (e->count == 0)
        return;
    fprintf(page->html, "<tr><td>%s</td><td>%ld</td><td>%.2f %%</td><td>%.2f %%</td></tr>\n", name, e->count,
            100 * e->relative_rmse, 100 * e->median_relative);
}

static void print_rings(weft_page *page, const char *title, const weft_error_summary ring[WEFT_RING_COUNT])
{
    weft_page_columns(page, title);
    for (int i = 0; i < WEFT_RING_COUNT; i++) {
        char name[32];
        snprintf(name, sizeof name, "about %d\u00b0", 15 * i);
        print_error(page, name, &ring[i]);
    }
}

/* The relative RMSE of every model by ring of the view, or of the light. */
static void draw_rings(weft_page *page, const weft_comparison *comparison, bool of_light)
{
    double point[WEFT_CONTENDER_COUNT - 1][WEFT_RING_COUNT][2];
    weft_chart_series series[WEFT_CONTENDER_COUNT - 1];
    for (int m = 0; m < comparison->model_count; m++) {
        const weft_measurement *texture = &comparison->model[m].texture;
        const weft_error_summary *ring = of_light ? texture->by_light : texture->by_view;
        for (int i = 0; i < WEFT_RING_COUNT; i++) {
            point[m][i][0] = 15 * i;
            point[m][i][1] = ring[i].count > 0 ? 100 * ring[i].relative_rmse : NAN;
        }
        series[m] = (weft_chart_series){comparison->model[m].name,    m,   WEFT_CHART_LINE, WEFT_RING_COUNT,
                                        (const double(*)[2])point[m], NULL};
    }
    weft_chart chart = {of_light ? "Error by light" : "Error by view",
                        {of_light ? "light from the normal" : "view from the normal", "\u00b0", 0, 75, 0},
                        {"relative RMSE, fitted samples", " %", 0, 10, 0},
                        comparison->model_count,
                        series};
    weft_chart_write(page, &chart);
}

static void print_directions(weft_page *page, const weft_dataset_layout *layout, const weft_comparison *comparison)
{
    const weft_measurement *measurement = &comparison->model[0].texture;
    fputs("<h2>Error by direction</h2>\n", page->html);
    fprintf(page->html,
            "<p class=\"note\">Level 0 against the dataset, measured for this page over %ld of %ld texels. ",
            measurement->texel_count, (long)layout->width * layout->height);
    explain_error(page);
    fputs("</p>\n<div class=\"plots\">\n", page->html);
    draw_rings(page, comparison, false);
    draw_rings(page, comparison, true);
    fputs("</div>\n<table>", page->html);
    weft_page_columns(page, "the material|values|relative RMSE|median relative");
    print_error(page, "all", &measurement->all);
    print_rings(page, "view from the normal|||", measurement->by_view);
    print_rings(page, "light from the normal|||", measurement->by_light);
    fputs("</table>\n", page->html);
}

static void print_covered(weft_page *page, const char *name, const weft_coverage_share *share, const char *says)
{
    if (share->count > 0)
        fprintf(page->html,
                "<tr><td>%s</td><td>%ld</td><td>%.1f %%</td><td>%.1f %%</td><td class=\"text\">%s</td></tr>\n", name,
                share->count, 100 * share->covered, 100 * share->width, says);
}

/* What the material says of its error, and whether the samples of the dataset keep to it. */
static void print_certificate(weft_page *page, const weft_comparison *comparison)
{
    const weft_coverage *coverage = &comparison->model[0].texture.coverage;
    const weft_certificate *certificate = &comparison->held_out.certificate;
    char line[WEFT_HOLD_OUT_LINE], name[64];
    if (coverage->all.count == 0)
        return;
    weft_certificate_describe(certificate, line);
    fputs("<h2 id=\"certificate\">Certificate</h2>\n<p class=\"note\">The interval about a pixel holds for ",
          page->html);
    weft_page_text(page, line);
    fprintf(
        page->html,
        ". The table counts the samples of this dataset inside their intervals; of fitted samples more lie inside than "
        "predicted. Widths are means relative to the mean sample; one width for all samples would have to be %.1f %%. "
        "On "
        "the right: half the width for a predicted value of %.3g under light at 30\u00b0, and the shares of its parts.",
        100 * coverage->even_width, certificate->mean);
    weft_certificate_describe_levels(certificate, line);
    if (line[0])
        fputs(" The interval is ", page->html);
    weft_page_text(page, line);
    fputs(line[0] ? ".</p>\n<table>" : "</p>\n<table>", page->html);
    weft_page_columns(page, "|values|in their interval|width|:its parts");
    print_covered(page, "all", &coverage->all, "");
    print_covered(page, "darkest fifth of the predictions", &coverage->dark, "");
    print_covered(page, "brightest fifth of the predictions", &coverage->bright, "");
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        snprintf(name, sizeof name, "view about %d\u00b0", 15 * ring);
        weft_certificate_row(certificate, ring, line);
        print_covered(page, name, &coverage->by_view[ring], line);
    }
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        snprintf(name, sizeof name, "light about %d\u00b0", 15 * ring);
        print_covered(page, name, &coverage->by_light[ring], "");
    }
    fputs("</table>\n", page->html);
}

static void print_sizes(weft_page *page, const weft_comparison *comparison)
{
    fputs("<h2>Size</h2>\n<table>\n", page->html);
    weft_page_fact(page, "samples as half floats", "%.0f bytes", comparison->half_float_bytes);
    weft_page_fact(page, "dataset on disk", "%.0f bytes", comparison->dataset_bytes);
    weft_page_fact(page, "material", "%.0f bytes", comparison->material_bytes);
    weft_page_fact(page, "half floats : material", "%.1f : 1",
                   comparison->half_float_bytes / comparison->material_bytes);
    weft_page_fact(page, "dataset : material", "%.1f : 1", comparison->dataset_bytes / comparison->material_bytes);
    if (comparison->warning[0])
        weft_page_fact(page, "warning", "%s", comparison->warning);
    fputs("</table>\n", page->html);
}

/* One line for a number or text, one for each member of an object. */
static weft_code print_fit_value(weft_page *page, const char *name, json_t *value, weft_error *error)
{
    char title[128];
    const char *member;
    json_t *inner;
    if (json_is_object(value)) {
        json_object_foreach (value, member, inner) {
            snprintf(title, sizeof title, "%s: %s", name, member);
            WEFT_TRY(print_fit_value(page, title, inner, error));
        }
        return WEFT_OK;
    }
    const char *bare = json_string_value(value);
    char *text = bare ? NULL : json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(4));
    if (!bare && !text)
        return weft_fail_memory(error, name, 0);
    snprintf(title, sizeof title, "%s", name);
    for (char *c = title; *c; c++)
        *c = *c == '_' ? ' ' : *c;
    weft_page_fact(page, title, "%s", bare ? bare : text);
    free(text);
    return WEFT_OK;
}

/* What the material says of its fit. */
static weft_code print_fit(weft_page *page, const weft_material *material, weft_error *error)
{
    json_t *metadata = json_loads(material->metadata, 0, NULL);
    if (!metadata)
        return weft_fail_memory(error, "metadata", strlen(material->metadata));
    const char *name;
    json_t *value;
    weft_code code = WEFT_OK;
    fputs("<h2>Fit</h2>\n<table>\n", page->html);
    weft_page_fact(page, "lobes", "%d", material->lobe_count);
    weft_page_fact(page, "views in the table", "%d", material->view_count);
    json_object_foreach (json_object_get(metadata, "fit"), name, value) {
        if (code == WEFT_OK && strcmp(name, "lobes") != 0)
            code = print_fit_value(page, name, value, error);
    }
    fputs("</table>\n", page->html);
    json_decref(metadata);
    return code;
}

static void print_times(weft_page *page, const weft_scenes *scenes)
{
    if (!scenes->drawn)
        return;
    fputs("<h2>Time</h2>\n<table>\n", page->html);
    for (int model = 0; model < WEFT_SCENE_MODELS; model++) {
        if (scenes->has[model])
            weft_page_fact(page, weft_scenes_model_name(model), "%.2f ms a frame", scenes->frame_ms[model]);
    }
    fputs("</table>\n", page->html);
    fprintf(
        page->html,
        "<p class=\"note\">Frames of %d \u00d7 %d pixels of the first scene, timed while this page was made, drawn by ",
        scenes->width, scenes->height);
    weft_page_text(page, scenes->renderer);
    fputs(".</p>\n", page->html);
}

static void print_masks(weft_page *page, const weft_measurement *measurement)
{
    double percent = 100 / fmax((double)measurement->sample_count, 1);
    fputs("<h2>Masked samples</h2>\n<table>\n", page->html);
    weft_page_fact(page, "samples (texels \u00d7 images)", "%ld", measurement->sample_count);
    weft_page_fact(page, "missing", "%ld (%.2f %%)", measurement->missing, percent * (double)measurement->missing);
    weft_page_fact(page, "saturated", "%ld (%.2f %%)", measurement->saturated,
                   percent * (double)measurement->saturated);
    weft_page_fact(page, "masked for other reasons", "%ld (%.2f %%)", measurement->other,
                   percent * (double)measurement->other);
    fputs("</table>\n", page->html);
}

weft_code weft_page_numbers(weft_page *page, const weft_dataset_layout *layout, const weft_material *material,
                            const weft_comparison *comparison, weft_error *error)
{
    print_levels(page, material);
    print_directions(page, layout, comparison);
    print_certificate(page, comparison);
    print_sizes(page, comparison);
    WEFT_TRY(print_fit(page, material, error));
    print_times(page, &comparison->scenes);
    print_masks(page, &comparison->model[0].texture);
    return WEFT_OK;
}
