#include "registration/photographs/report.h"

#include "base/numeric/statistics.h"
#include "base/picture/colour.h"
#include "base/text/chart.h"
#include "registration/photographs/steps.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void weft_photographs_describe_tone(const weft_photograph_set *set, char words[WEFT_PHOTOGRAPHS_TEXT_SIZE])
{
    if (!set->tone_found) {
        snprintf(words, WEFT_PHOTOGRAPHS_TEXT_SIZE, "the files are linear");
        return;
    }
    int length = snprintf(words, WEFT_PHOTOGRAPHS_TEXT_SIZE, "found in the light of paper and ink");
    if (set->pair_count > 0)
        length += snprintf(words + length, WEFT_PHOTOGRAPHS_TEXT_SIZE - (size_t)length,
                           ", and in %d pairs of photographs that differ in exposure alone", set->pair_count);
    snprintf(words + length, WEFT_PHOTOGRAPHS_TEXT_SIZE - (size_t)length,
             "; the light of a tenth of white paper is known to %.1f %%, ink, %.3f of the paper, to %.0f %% (standard "
             "errors)",
             100 * set->lamps.dark_error, set->lamps.ink, 100 * set->lamps.ink_error);
}

void weft_photographs_describe_masks(const weft_photograph_set *set, const weft_photographs_settings *settings,
                                     char words[WEFT_PHOTOGRAPHS_TEXT_SIZE])
{
    long clipped = 0, dark = 0, hidden = 0;
    for (int i = 0; i < set->count; i++) {
        clipped += set->photograph[i].clipped_texels;
        dark += set->photograph[i].dark_texels;
        hidden += set->photograph[i].hidden_texels;
    }
    snprintf(words, WEFT_PHOTOGRAPHS_TEXT_SIZE,
             "%ld of %ld samples are clipped, %ld are too dark to be read, %ld lie behind the pin or a ball", clipped,
             (long)settings->width * settings->height * set->used_count, dark, hidden);
}

static weft_vec3 view_of(const weft_photographs_photograph *p)
{
    return weft_pose_camera_position(&p->pose);
}

static weft_code median_lamp_error(const weft_photograph_set *set, double *median, weft_error *error)
{
    size_t count = 0, bytes = ((size_t)set->count + 1) * sizeof(double);
    double *value = malloc(bytes);
    if (!value)
        return weft_fail_memory(error, "errors of lamps", bytes);
    for (int i = 0; i < set->count; i++) {
        if (weft_photographs_used(&set->photograph[i]))
            value[count++] = set->photograph[i].lamp.uncertainty_deg;
    }
    *median = weft_quantile(value, count, 0.5);
    free(value);
    return WEFT_OK;
}

static weft_code write_tiles(weft_page *page, const weft_photograph_set *set, weft_error *error)
{
    double lamp_error;
    WEFT_TRY(median_lamp_error(set, &lamp_error, error));
    fputs("<div class=\"tiles\">\n", page->html);
    weft_page_tile(page, "photographs in the dataset", "%d of %d", set->used_count, set->count);
    weft_page_tile(page, "pixels: corners of markers about the lens, RMS", "%.2f", set->lens.rms_px);
    weft_page_tile(page, "direction of the lamp, standard error, median", "%.2f\xc2\xb0", lamp_error);
    weft_page_tile(page, "distinct views", "%d", set->lens.distinct_views);
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static const char *knowledge_name(weft_lens_knowledge knowledge)
{
    switch (knowledge) {
    case WEFT_LENS_UNKNOWN:
        return "found in the photographs";
    case WEFT_LENS_FOCAL_ONLY:
        return "focal length as the camera wrote it: there are too few distinct views to find it";
    case WEFT_LENS_KNOWN:
        break;
    }
    return "from the lens file";
}

/* What is known of the lens; standard errors where the photographs told it. */
static void write_lens(weft_page *page, const weft_lens_estimate *lens)
{
    const weft_camera *c = &lens->camera;
    const weft_lens_errors *e = &lens->errors;
    if (lens->knowledge == WEFT_LENS_UNKNOWN) {
        weft_page_fact(page, "focal length", "%.1f \u00b1 %.1f pixels (standard error)", c->fx, e->focal_px);
        weft_page_fact(page, "distortion", "k1 %.4f \u00b1 %.4f, k2 %.4f \u00b1 %.4f", c->k1, e->k1, c->k2, e->k2);
    } else {
        weft_page_fact(page, "focal length", "%.1f pixels", c->fx);
        weft_page_fact(page, "distortion", "k1 %.4f, k2 %.4f", c->k1, c->k2);
    }
    weft_page_fact(page, "principal point", "%.1f, %.1f", c->cx, c->cy);
    weft_page_fact(page, "corners of markers about the lens, RMS", "%.2f pixels", lens->rms_px);
}

static void write_camera(weft_page *page, const weft_photographs_settings *settings, const weft_photograph_set *set)
{
    char words[WEFT_PHOTOGRAPHS_TEXT_SIZE];
    const weft_camera *c = &set->lens.camera;
    double corner = hypot(c->width, c->height) / 2 / c->fx, r2 = corner * corner;
    fputs("<h2>Camera</h2>\n<table>\n", page->html);
    weft_page_fact(page, "lens", "%s", knowledge_name(set->lens.knowledge));
    write_lens(page, &set->lens);
    weft_page_fact(page, "sheet",
                   set->lens.bend_error_mm > 0 ? "not flat: the print rises and falls by %.1f mm" : "flat",
                   weft_lens_bow_mm(&set->lens.bend, &settings->target));
    weft_page_fact(page, "light in the corner of the picture", "%.0f %% of that in the middle",
                   100 * (1 + r2 * (c->vignetting[0] + r2 * (c->vignetting[1] + r2 * c->vignetting[2]))));
    weft_page_fact(page, "ink against paper", "%.3f \u00b1 %.3f (standard error)", set->lamps.ink,
                   set->lamps.ink * set->lamps.ink_error);
    weft_photographs_describe_tone(set, words);
    weft_page_fact(page, "tone curve", "%s", words);
    weft_photographs_describe_masks(set, settings, words);
    weft_page_fact(page, "masked", "%s", words);
    fputs("</table>\n", page->html);
}

/* ---- Charts ---- */

enum { CHART_WIDTH = 560, CHART_HEIGHT = 270, RADIUS = 104, MIDDLE = 152 };

static void draw_direction(weft_page *page, const weft_photographs_photograph *p, bool lamps, int x)
{
    weft_angles angles = weft_angles_of_direction(weft_unit(lamps ? p->lamp.position_mm : view_of(p)));
    double reach = RADIUS * weft_deg_of_rad(angles.theta_rad) / 90;
    fprintf(page->html, "<circle class=\"colour%d\" cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"><title>", lamps ? 3 : 0,
            x + reach * cos(angles.phi_rad), MIDDLE - reach * sin(angles.phi_rad));
    weft_page_text(page, p->name);
    fputs("</title></circle>\n", page->html);
}

/* The hemisphere over the sample, seen from above, about (x, MIDDLE). */
static void draw_hemisphere(weft_page *page, const weft_photograph_set *set, bool lamps, int x)
{
    fprintf(page->html, "<text class=\"title\" x=\"%d\" y=\"20\" text-anchor=\"middle\">%s</text>\n", x,
            lamps ? "Lamps" : "Views");
    for (int deg = 30; deg <= 90; deg += 30)
        fprintf(page->html,
                "<circle class=\"ring\" cx=\"%d\" cy=\"%d\" r=\"%d\"/><text x=\"%d\" y=\"%d\">%d\u00b0</text>\n", x,
                MIDDLE, RADIUS * deg / 90, x + 3, MIDDLE - RADIUS * deg / 90 - 3, deg);
    for (int i = 0; i < set->count; i++) {
        if (weft_photographs_used(&set->photograph[i]))
            draw_direction(page, &set->photograph[i], lamps, x);
    }
}

static void plot_directions(weft_page *page, const weft_photograph_set *set)
{
    const char *title = "Directions of views and lamps, as seen from above the sample";
    fprintf(page->html, "<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"%s\">\n", CHART_WIDTH,
            CHART_HEIGHT, title);
    draw_hemisphere(page, set, false, CHART_WIDTH / 4);
    draw_hemisphere(page, set, true, 3 * CHART_WIDTH / 4);
    fputs("</svg>\n", page->html);
}

static void plot_tone(weft_page *page, const weft_photograph_set *set)
{
    enum { STEPS = 16 };
    weft_tone_curve srgb = weft_tone_srgb();
    double camera[STEPS + 1][2], standard[STEPS + 1][2];
    for (int i = 0; i <= STEPS; i++) {
        camera[i][0] = standard[i][0] = (double)i / STEPS;
        camera[i][1] = (double)set->tone.linear[i * (WEFT_TONE_STEPS / STEPS)];
        standard[i][1] = (double)srgb.linear[i * (WEFT_TONE_STEPS / STEPS)];
    }
    const weft_chart_series series[] = {
        {"sRGB", 6, WEFT_CHART_LINE, STEPS + 1, (const double(*)[2])standard, NULL},
        {"the camera", 0, WEFT_CHART_LINE, STEPS + 1, (const double(*)[2])camera, NULL}};
    const weft_chart chart = {"The tone curve", {"value in the file", "", 0, 1, 0}, {"light", "", 0, 1, 0}, 2, series};
    weft_chart_write(page, &chart);
}

/* ---- Photographs ---- */

static void write_left_out(weft_page *page, const weft_photograph_set *set)
{
    if (set->used_count == set->count)
        return;
    fputs("<h2>Left out</h2>\n<table>\n", page->html);
    weft_page_columns(page, "photograph|:why");
    for (int i = 0; i < set->count; i++) {
        if (weft_photographs_used(&set->photograph[i]))
            continue;
        fputs("<tr class=\"bad\"><td>", page->html);
        weft_page_text(page, set->photograph[i].name);
        fputs("</td><td class=\"text\">", page->html);
        weft_page_text(page, set->photograph[i].remark);
        fputs("</td></tr>\n", page->html);
    }
    fputs("</table>\n", page->html);
}

static void write_row(weft_page *page, const weft_photographs_photograph *p)
{
    weft_vec3 eye = view_of(p), lamp = p->lamp.position_mm;
    weft_angles view = weft_angles_of_direction(weft_unit(eye)), light = weft_angles_of_direction(weft_unit(lamp));
    fputs("<tr><td>", page->html);
    weft_page_text(page, p->name);
    fprintf(page->html,
            "</td><td>%.1f, %.1f</td><td>%.0f</td><td>%.1f, %.1f</td><td>%.0f</td><td>%.2f</td><td>%.2f</td>"
            "<td>%.4f</td><td>%d of %d</td></tr>\n",
            weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad), (double)weft_length(eye),
            weft_deg_of_rad(light.theta_rad), weft_deg_of_rad(light.phi_rad), (double)weft_length(lamp),
            p->lamp.uncertainty_deg, p->corner_rms_px, p->uncertainty_mm, p->corner_count, 4 * p->marker_count);
}

static void write_table(weft_page *page, const weft_photograph_set *set)
{
    fputs("<h2>All that are used</h2>\n<table class=\"long\">\n", page->html);
    weft_page_columns(page, "photograph|view: theta, phi, degrees|camera, mm|lamp: theta, phi, degrees|lamp, mm|lamp: "
                            "standard error, degrees|corners, pixels RMS|warp: standard error, mm|corners used");
    for (int i = 0; i < set->count; i++) {
        if (weft_photographs_used(&set->photograph[i]))
            write_row(page, &set->photograph[i]);
    }
    fputs("</table>\n", page->html);
}

static weft_code write_thumbnail(const char *folder, int index, const char *what, const weft_image *image,
                                 weft_error *error)
{
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/%03d_%s.png", folder, index, what) >= (int)sizeof path)
        return weft_fail(error, WEFT_BAD_USAGE, "the report's folder has too long a name");
    return weft_image_write(path, image, NULL, error);
}

static weft_code write_gallery(weft_page *page, const weft_photograph_set *set, weft_error *error)
{
    fputs(
        "<h2>Pictures</h2>\n<p>Left: the photograph. Right: the sample in it, seen straight from above, white paper as "
        "white.</p>\n<div class=\"gallery\">\n",
        page->html);
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        fprintf(page->html, "<figure%s><div>", weft_photographs_used(p) ? "" : " class=\"bad\"");
        if (p->thumbnail.pixels) {
            WEFT_TRY(write_thumbnail(page->folder, i, "photograph", &p->thumbnail, error));
            fprintf(page->html, "<img loading=\"lazy\" alt=\"photograph\" src=\"%03d_photograph.png\">", i);
        }
        if (p->rectified.pixels) {
            WEFT_TRY(write_thumbnail(page->folder, i, "sample", &p->rectified, error));
            fprintf(page->html, "<img class=\"texels\" loading=\"lazy\" alt=\"sample\" src=\"%03d_sample.png\">", i);
        }
        fputs("</div><figcaption>", page->html);
        weft_page_text(page, p->name);
        if (!weft_photographs_used(p))
            fputs(": left out", page->html);
        fputs("</figcaption></figure>\n", page->html);
    }
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static weft_code write_page(weft_page *page, const char *dataset, const weft_photographs_settings *settings,
                            const weft_photograph_set *set, weft_error *error)
{
    fputs("<p class=\"note\">Dataset ", page->html);
    weft_page_text(page, dataset);
    fprintf(page->html, ", %d \u00d7 %d texels of %.3f mm</p>\n", settings->width, settings->height,
            settings->target.opening_mm / settings->width);
    WEFT_TRY(write_tiles(page, set, error));
    write_left_out(page, set);
    fputs("<h2>Where camera and lamp stood</h2>\n<p class=\"note\">Directions as seen from above the sample, by their "
          "angle "
          "from its normal.</p>\n<div class=\"plots\">\n",
          page->html);
    plot_directions(page, set);
    plot_tone(page, set);
    fputs("</div>\n", page->html);
    write_camera(page, settings, set);
    WEFT_TRY(write_gallery(page, set, error));
    write_table(page, set);
    return WEFT_OK;
}

weft_code weft_photographs_report(const char *folder, const char *dataset, const weft_photographs_settings *settings,
                                  const weft_photograph_set *set, weft_error *error)
{
    weft_page page;
    WEFT_TRY(weft_page_begin(folder, "From your photographs to a dataset", &page, error));
    weft_code code = write_page(&page, dataset, settings, set, error);
    if (code == WEFT_OK)
        return weft_page_finish(&page, error);
    weft_page_abandon(&page);
    return code;
}

/* ---- Small pictures ---- */

enum { photograph_width = 260, texels_width = 160 };

static int step_for(int width, int most)
{
    return (width + most - 1) / most;
}

weft_code weft_thumbnail_of_photograph(const weft_light_values *values, weft_image *thumbnail, weft_error *error)
{
    int step = step_for(values->width, photograph_width);
    WEFT_TRY(weft_image_create(values->width / step, values->height / step, thumbnail, error));
    for (int y = 0; y < thumbnail->height; y++) {
        for (int x = 0; x < thumbnail->width; x++) {
            float sum[3] = {0, 0, 0};
            for (int i = 0; i < step * step; i++) {
                const uint16_t *s =
                    values->samples + 3 * ((long)(y * step + i / step) * values->width + x * step + i % step);
                for (int c = 0; c < 3; c++)
                    sum[c] += s[c];
            }
            for (int c = 0; c < 3; c++)
                thumbnail->pixels[3 * ((long)y * thumbnail->width + x) + c] =
                    weft_srgb_of_linear(sum[c] / (float)(step * step * WEFT_PHOTOGRAPHS_FULL_SCALE));
        }
    }
    return WEFT_OK;
}

weft_code weft_thumbnail_of_texels(const weft_half *texel, int width, int height, weft_image *thumbnail,
                                   weft_error *error)
{
    int step = step_for(width > height ? width : height, texels_width);
    WEFT_TRY(weft_image_create(width / step, height / step, thumbnail, error));
    for (int y = 0; y < thumbnail->height; y++) {
        for (int x = 0; x < thumbnail->width; x++) {
            for (int c = 0; c < 3; c++) {
                float sum = 0;
                for (int i = 0; i < step * step; i++)
                    sum +=
                        weft_float_of_half(texel[3 * ((long)(y * step + i / step) * width + x * step + i % step) + c]);
                thumbnail->pixels[3 * ((long)y * thumbnail->width + x) + c] =
                    weft_srgb_of_linear(fminf(sum / (float)(step * step), 1));
            }
        }
    }
    return WEFT_OK;
}
