#include "inspect/inspect.h"

#include "base/picture/letters.h"
#include "base/text/html_page.h"
#include "btf/material/models.h"
#include "player/texture/mip_layout.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WANTED_SIDE = 512, LEGEND_WIDTH = 300, LETTER_SIZE = 14, LINE_HEIGHT = 18, SWATCH = 10 };

/* Dark, so that the picture stands well on a light page and on a dark one. */
#define GROUND 0.13f

void weft_model_colour(uint8_t code, float rgb[3])
{
    /* Greys without tables, blues with T, oranges with S, greens with both; the paler the fewer bits. */
    static const float base[4][3] = {{0.9f, 0.9f, 0.9f}, {0.45f, 0.65f, 1}, {1, 0.65f, 0.3f}, {0.45f, 0.9f, 0.5f}};
    weft_model_parts parts = weft_model_decode(code);
    int bits = parts.table_bits > parts.light_table_bits ? parts.table_bits : parts.light_table_bits;
    const float *hue = base[(parts.table_bits > 0) + 2 * (parts.light_table_bits > 0)];
    float brightness = 1 - 0.2f * (float)parts.lobe_count, pale = bits > 0 ? (float)(8 - bits) * 0.17f : 0;
    for (int c = 0; c < 3; c++)
        rgb[c] = brightness * (hue[c] + pale * (1 - hue[c]));
}

static void fill_square(weft_image *image, int x, int y, int width, int height, const float rgb[3])
{
    for (int row = y; row < y + height && row < image->height; row++) {
        for (int column = x; column < x + width && column < image->width; column++)
            memcpy(image->pixels + 3 * ((size_t)row * (size_t)image->width + (size_t)column), rgb, 3 * sizeof *rgb);
    }
}

static void write_letter(weft_image *image, const weft_letters *letters, const stbtt_bakedchar *glyph, int x, int y)
{
    for (int row = glyph->y0; row < glyph->y1; row++) {
        for (int column = glyph->x0; column < glyph->x1; column++) {
            float share = GROUND + (1 - GROUND) * (float)letters->coverage[row * letters->side + column] / 255;
            const float ink[3] = {share, share, share};
            fill_square(image, x + column - glyph->x0, y + row - glyph->y0, 1, 1, ink);
        }
    }
}

/* White on the ground, from the left end of the baseline. */
static void write_text(weft_image *image, const weft_letters *letters, int x, int y, const char *text)
{
    for (; *text; text++) {
        const stbtt_bakedchar *glyph = weft_letters_find(letters, *text);
        write_letter(image, letters, glyph, x + (int)lroundf(glyph->xoff), y + (int)lroundf(glyph->yoff));
        x += weft_letters_advance(letters, *text);
    }
}

static void draw_level(weft_image *image, const weft_material_level *level, weft_mip_area area, int scale)
{
    for (int i = 0; i < level->width * level->height; i++) {
        float rgb[3];
        weft_model_colour(level->model[i], rgb);
        fill_square(image, (area.x + i % level->width) * scale, (area.y + i / level->width) * scale, scale, scale, rgb);
    }
}

/* The models that occur in any level, with their number in each. */
typedef struct model_counts {
    long count[WEFT_MATERIAL_MAX_LEVELS][WEFT_MODEL_CODES];
    int used[WEFT_MODEL_CODES], used_count;
} model_counts;

static model_counts count_models(const weft_material *material)
{
    model_counts counts = {0};
    for (int k = 0; k < material->level_count; k++)
        weft_material_count_models(material, k, counts.count[k]);
    for (int code = 0; code < WEFT_MODEL_CODES; code++) {
        long all = 0;
        for (int k = 0; k < material->level_count; k++)
            all += counts.count[k][code];
        if (all > 0)
            counts.used[counts.used_count++] = code;
    }
    return counts;
}

static double percent_of(const weft_material_level *level, long count)
{
    return 100.0 * (double)count / ((double)level->width * level->height);
}

static void draw_legend(weft_image *image, const weft_letters *letters, const weft_material *material,
                        const model_counts *counts, int top)
{
    for (int i = 0; i < counts->used_count; i++) {
        char name[WEFT_MODEL_NAME], line[WEFT_MODEL_NAME + 16];
        float rgb[3];
        int code = counts->used[i], y = top + 4 + i * LINE_HEIGHT;
        weft_model_print(weft_model_decode((uint8_t)code), name);
        snprintf(line, sizeof line, "%s: %.1f %%", name, percent_of(&material->level[0], counts->count[0][code]));
        weft_model_colour((uint8_t)code, rgb);
        fill_square(image, 4, y + 2, SWATCH, SWATCH, rgb);
        write_text(image, letters, 4 + SWATCH + 6, y + SWATCH + 1, line);
    }
}

weft_code weft_model_picture(const weft_material *material, weft_image *image, weft_error *error)
{
    const float ground[3] = {GROUND, GROUND, GROUND};
    if (!material->has_models)
        return weft_fail(error, WEFT_BAD_USAGE, "the material does not say which model its texels have");
    weft_mip_layout layout =
        weft_mip_layout_of(material->level[0].width, material->level[0].height, material->level_count, 0, 1);
    model_counts counts = count_models(material);
    int largest = layout.width > layout.height ? layout.width : layout.height;
    int scale = largest < WANTED_SIDE ? WANTED_SIDE / largest : 1, top = layout.height * scale;
    int width = layout.width * scale > LEGEND_WIDTH ? layout.width * scale : LEGEND_WIDTH;
    weft_letters letters;
    WEFT_TRY(weft_letters_bake(LETTER_SIZE, &letters, error));
    weft_code code = weft_image_create(width, top + 8 + counts.used_count * LINE_HEIGHT, image, error);
    if (code != WEFT_OK) {
        weft_letters_free(&letters);
        return code;
    }
    fill_square(image, 0, 0, image->width, image->height, ground);
    for (int k = 0; k < material->level_count; k++)
        draw_level(image, &material->level[k], layout.area[k], scale);
    draw_legend(image, &letters, material, &counts, top);
    weft_letters_free(&letters);
    return WEFT_OK;
}

static void write_numbers(weft_page *page, const weft_material *material)
{
    model_counts counts = count_models(material);
    static const char column[] = "<th scope=\"col\">%s</th>";
    fprintf(page->html, "<table>\n<tr>");
    fprintf(page->html, column, "level");
    fprintf(page->html, column, "texels");
    for (int i = 0; i < counts.used_count; i++) {
        char name[WEFT_MODEL_NAME];
        weft_model_print(weft_model_decode((uint8_t)counts.used[i]), name);
        fprintf(page->html, column, name);
    }
    fprintf(page->html, column, "relative RMSE");
    fprintf(page->html, "</tr>\n");
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *level = &material->level[k];
        fprintf(page->html, "<tr><td>%d</td><td>%d \u00d7 %d</td>", k, level->width, level->height);
        for (int i = 0; i < counts.used_count; i++)
            fprintf(page->html, "<td>%.1f %%</td>", percent_of(level, counts.count[k][counts.used[i]]));
        fprintf(page->html, "<td>%.2f %%</td></tr>\n", 100 * level->error.relative_rmse);
    }
    fprintf(page->html, "</table>\n");
}

weft_code weft_model_report_write(const char *folder, const weft_material *material, weft_error *error)
{
    weft_page page;
    weft_image image = {0};
    WEFT_TRY(weft_model_picture(material, &image, error));
    weft_code code = weft_page_begin(folder, "The model of each texel", &page, error);
    if (code == WEFT_OK) {
        code = weft_page_picture(&page, "models", &image, image.width,
                                 "Every level; the legend gives shares of level 0", error);
        if (code == WEFT_OK) {
            write_numbers(&page, material);
            code = weft_page_finish(&page, error);
        } else {
            weft_page_abandon(&page);
        }
    }
    weft_image_free(&image);
    return code;
}
