#include "compare/report/page/sections.h"

#include "btf/direction/direction.h"
#include "compare/pictures/sample_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { DISC = 150, LABEL = 24 };

/* The picture of a row, white where there is no value. */
static weft_code write_picture(const char *path, const weft_slices *slices, int row, double exposure, uint8_t *mask,
                               weft_error *error)
{
    weft_image linear = {0}, shown = {0};
    weft_code code = weft_slices_picture(slices, row, DISC, &linear, mask, error);
    if (code == WEFT_OK)
        code = weft_picture_encode(&linear, mask, exposure, &shown, error);
    for (int i = 0; code == WEFT_OK && i < 3 * shown.width * shown.height; i++) {
        if (mask[i / 3])
            shown.pixels[i] = 1;
    }
    if (code == WEFT_OK)
        code = weft_image_write(path, &shown, slices->name[row], error);
    weft_image_free(&linear);
    weft_image_free(&shown);
    return code;
}

static void draw_circle(weft_page *page, const char *class, double x, double y, double radius)
{
    fprintf(page->html, "<circle class=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/>", class, x, y, radius);
}

/* Rings of 30, 60 and 90 degrees, the exitant direction (cross) and its mirror direction (ring). */
static void draw_axes(weft_page *page, weft_vec3 view)
{
    const double radius = DISC / 2.0, x = radius, y = LABEL + radius, arm = 4;
    draw_circle(page, "ring", x, y, radius - 0.5);
    for (int theta_deg = 30; theta_deg <= 60; theta_deg += 30)
        draw_circle(page, "ring dashed", x, y, radius * sin(weft_rad_of_deg(theta_deg)));
    double view_x = x + radius * view.x, view_y = y - radius * view.y;
    fprintf(page->html, "<path class=\"curve colour1\" d=\"M%.1f %.1fh%.1fm%.1f %.1fv%.1f\"/>", view_x - arm, view_y,
            2 * arm, -arm, -arm, 2 * arm);
    draw_circle(page, "curve colour0", 2 * x - view_x, 2 * y - view_y, arm);
    weft_angles at = weft_angles_of_direction(view);
    fprintf(page->html, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">\u03b8 %.0f\u00b0, \u03c6 %.0f\u00b0</text>",
            x, LABEL - 8, weft_deg_of_rad(at.theta_rad),
            at.theta_rad < 1e-3 ? 0 : fmod(weft_deg_of_rad(at.phi_rad) + 360, 360));
}

/* Its part of the picture of the row, cut round to what was measured, so that the page is seen beside it. */
static void draw_disc(weft_page *page, const weft_slices *slices, int row, int view)
{
    const double radius = DISC / 2.0;
    fprintf(page->html,
            "<svg class=\"plot disc\" viewBox=\"-4 0 %d %d\" role=\"img\" aria-label=\"%s\">\n"
            "<image href=\"slices-%d.png\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" "
            "style=\"clip-path:circle(%.1fpx at %.1fpx %.1fpx)\"/>\n",
            DISC + 8, DISC + LABEL + 4, slices->name[row], row, -view * DISC, LABEL, slices->view_count * DISC, DISC,
            radius * sin(slices->largest_theta_rad), view * DISC + radius, radius);
    draw_axes(page, slices->view[view]);
    fputs("\n</svg>\n", page->html);
}

static void draw_row(weft_page *page, const weft_slices *slices, int row)
{
    fprintf(page->html, "<h3>%s</h3>\n<div class=\"row\">\n", slices->name[row]);
    for (int view = 0; view < slices->view_count; view++)
        draw_disc(page, slices, row, view);
    fputs("</div>\n", page->html);
}

static weft_code data_exposure(const weft_slices *slices, uint8_t *mask, double *exposure, weft_error *error)
{
    weft_image data;
    WEFT_TRY(weft_slices_picture(slices, 0, DISC, &data, mask, error));
    weft_code code = weft_picture_exposure(&data, mask, exposure, error);
    weft_image_free(&data);
    return code;
}

static weft_code put_rows(weft_page *page, const weft_slices *slices, uint8_t *mask, weft_error *error)
{
    double exposure;
    WEFT_TRY(data_exposure(slices, mask, &exposure, error));
    fprintf(page->html,
            "<p class=\"note\">Mean BRDF of the material. Each disc is the hemisphere of incident directions in "
            "projection onto the cloth (u to the right, v up), measured out to %.0f\u00b0; dashed: 30\u00b0 and "
            "60\u00b0. The exitant direction stands above it: cross; ring: its mirror direction. All rows have the "
            "same tone scale (\u03c0 f, %.3g times brighter, sRGB). Evaluated at %d directions a disc and interpolated "
            "between them; the data between its views and lights. The numbers: <a "
            "href=\"slices.csv\">slices.csv</a>.</p>\n",
            weft_deg_of_rad(slices->largest_theta_rad), exposure, (int)WEFT_SLICE_LIGHTS);
    for (int row = 0; row < slices->row_count; row++) {
        char *path;
        if (asprintf(&path, "%s/slices-%d.png", page->folder, row) < 0)
            return weft_fail_memory(error, "path", 0);
        weft_code code = write_picture(path, slices, row, exposure, mask, error);
        free(path);
        WEFT_TRY(code);
        draw_row(page, slices, row);
    }
    return WEFT_OK;
}

weft_code weft_page_slices(weft_page *page, const weft_slices *slices, weft_error *error)
{
    if (slices->view_count == 0)
        return WEFT_OK;
    fputs("<h2 id=\"slices\">BRDF slices</h2>\n", page->html);
    char *path = NULL;
    uint8_t *mask = malloc((size_t)DISC * DISC * (size_t)slices->view_count);
    weft_code code = WEFT_OK;
    if (!mask || asprintf(&path, "%s/slices.csv", page->folder) < 0)
        code = weft_fail_memory(error, "BRDF slices", (size_t)DISC * DISC * (size_t)slices->view_count);
    else
        code = weft_slices_write(slices, path, error);
    if (code == WEFT_OK)
        code = put_rows(page, slices, mask, error);
    free(path);
    free(mask);
    return code;
}
