/* The price list as text, JSON and as comma-separated values. */
#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "compare/tradeoff/tradeoff.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- Text ---- */

void weft_tradeoff_print_held(const weft_tradeoff *tradeoff, char *text, size_t size)
{
    if (tradeoff->kind != WEFT_SPLIT_DIRECTIONS)
        snprintf(text, size, "%d of %d photographs%s", tradeoff->image_held_count, tradeoff->image_count,
                 tradeoff->kind == WEFT_SPLIT_EACH ? " in turn" : "");
    else if (tradeoff->view_held_count == 0 || tradeoff->light_held_count == 0)
        snprintf(text, size, "%d of %d %s", tradeoff->view_held_count + tradeoff->light_held_count,
                 tradeoff->view_held_count > 0 ? tradeoff->view_count : tradeoff->light_count,
                 tradeoff->view_held_count > 0 ? "views" : "lights");
    else
        snprintf(text, size, "%d of %d views and %d of %d lights", tradeoff->view_held_count, tradeoff->view_count,
                 tradeoff->light_held_count, tradeoff->light_count);
}

void weft_tradeoff_print_presets(const weft_tradeoff_row *row, char *text, size_t size)
{
    text[0] = 0;
    for (weft_preset preset = WEFT_PRESET_SMALL; preset < WEFT_PRESET_COUNT; preset++) {
        size_t used = strlen(text);
        if (row->is_chosen[preset])
            snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", weft_preset_name(preset));
    }
}

/* ---- JSON ---- */

static json_t *json_of_errors(const weft_error_summary error[WEFT_SAMPLE_KINDS])
{
    json_t *object = json_object();
    for (int kind = 0; kind < WEFT_SAMPLE_KINDS; kind++) {
        const weft_error_summary *e = &error[kind];
        if (e->count > 0)
            weft_json_put(&object, weft_sample_kind_name((weft_sample_kind)kind),
                          json_pack("{s:f, s:f, s:f, s:I}", "relative_rmse", e->relative_rmse, "median_relative_error",
                                    e->median_relative, "percentile80_relative_error", e->percentile80_relative,
                                    "values", (json_int_t)e->count));
    }
    return object;
}

json_t *weft_tradeoff_row_to_json(const weft_tradeoff_row *row)
{
    const weft_price *price = &row->price;
    const weft_held_error *m = &row->measured;
    char presets[64];
    weft_tradeoff_print_presets(row, presets, sizeof presets);
    json_t *object = json_pack("{s:s, s:s, s:s, s:i, s:f, s:f, s:f, s:f, s:s, s:b}", "model", row->model.name, "family",
                               weft_priced_family_name(row->model.family), "options", row->model.arguments,
                               "photographs", price->photograph_count, "bytes", price->bytes, "bits_a_texel",
                               price->bits_a_texel, "fit_seconds", price->fit_s, "evaluations_a_second",
                               price->evaluations_a_second, "preset", presets, "beaten", row->is_beaten);
    if (price->frame_ms > 0)
        weft_json_put(&object, "frame_ms", json_real(price->frame_ms));
    if (price->has_flicker)
        weft_json_put(&object, "flicker", json_real(price->flicker));
    weft_json_put(&object, "not_fitted", json_of_errors(m->held));
    weft_json_put(&object, "fitted", json_of_errors(m->fitted));
    weft_json_put(&object, "interval_width", json_real(m->interval_width));
    if (m->picture_count > 0)
        weft_json_put(&object, "pictures_not_fitted",
                      json_pack("{s:i, s:f, s:f, s:f}", "pictures", m->picture_count, "psnr_db", m->quality.psnr_db,
                                "ssim", m->quality.ssim, "flip", m->quality.flip));
    return object;
}

/* ---- CSV ---- */

/* No cell may hold a comma. */
static void print_word(const char *text, FILE *table)
{
    for (; *text; text++)
        fputc(*text == ',' ? ';' : *text, table);
    fputc(',', table);
}

static void print_row(const weft_tradeoff_row *row, FILE *table)
{
    const weft_price *price = &row->price;
    const weft_held_error *m = &row->measured;
    char presets[64];
    weft_tradeoff_print_presets(row, presets, sizeof presets);
    print_word(row->model.name, table);
    print_word(weft_priced_family_name(row->model.family), table);
    print_word(row->model.arguments, table);
    print_word(presets, table);
    fprintf(table, "%d,%.0f,%.4g,%.4g,%.4g,", price->photograph_count, price->bytes, price->bits_a_texel, price->fit_s,
            price->evaluations_a_second);
    if (price->frame_ms > 0)
        fprintf(table, "%.4g", price->frame_ms);
    for (int i = 0; i < 2 * WEFT_SAMPLE_KINDS; i++) {
        const weft_error_summary *e = i < WEFT_SAMPLE_KINDS ? &m->held[i] : &m->fitted[i - WEFT_SAMPLE_KINDS];
        fprintf(table, ",%.5g,%.5g,%.5g", e->relative_rmse, e->median_relative, e->percentile80_relative);
    }
    fprintf(table, ",%.5g,%.5g,%.5g,%.5g,", m->quality.psnr_db, m->quality.ssim, m->quality.flip, m->interval_width);
    if (price->has_flicker)
        fprintf(table, "%.4g", price->flicker);
    fputc('\n', table);
}

static void print_table(const weft_tradeoff *tradeoff, FILE *table)
{
    fputs("model,family,options,presets,photographs,bytes,bits_a_texel,fit_s,evaluations_a_second,frame_ms", table);
    for (int i = 0; i < 2 * WEFT_SAMPLE_KINDS; i++) {
        const char *of = i < WEFT_SAMPLE_KINDS ? "not_fitted" : "fitted";
        const char *kind = weft_sample_kind_name((weft_sample_kind)(i % WEFT_SAMPLE_KINDS));
        fprintf(table, ",%s_%s_relative_rmse,%s_%s_median,%s_%s_percentile80", of, kind, of, kind, of, kind);
    }
    fputs(",psnr_db,ssim,flip,interval_width,flicker", table);
    fputc('\n', table);
    for (int i = 0; i < tradeoff->row_count; i++)
        print_row(&tradeoff->row[i], table);
}

weft_code weft_tradeoff_write_csv(const weft_tradeoff *tradeoff, const char *path, weft_error *error)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *table = open_memstream(&bytes, &size);
    if (!table)
        return weft_fail_memory(error, "table", 0);
    print_table(tradeoff, table);
    weft_code code =
        fclose(table) == 0 ? weft_write_file(path, bytes, size, error) : weft_fail_memory(error, "table", size);
    free(bytes);
    return code;
}
