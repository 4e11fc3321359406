#include "compare/tradeoff/tradeoff.h"

#include "base/atomic_file.h"
#include "base/clock.h"
#include "btf/direction/direction.h"
#include "btf/material/metadata.h"
#include "compare/tradeoff/cloth.h"
#include "compare/tradeoff/frame_timer.h"
#include "compare/tradeoff/weight.h"
#include "compress/bard/predict.h"
#include "compress/compress.h"
#include "compress/hold_out/texel_subset.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EVALUATIONS_AT_ONCE = 64 };

static const double evaluating_s = 0.1, largest_theta_rad = 1.3;

struct weft_price_shop {
    weft_dataset *dataset; /* the whole */
    weft_dataset *block;   /* what is fitted: the whole where that is small */
    int side;
    double share; /* of the texels that are fitted */
    const char *scratch_path;
    const weft_progress *progress;
    char *material_path;
    weft_frame_timer *timer;
    bool is_fitted;
    weft_priced_model fitted_model;
    weft_material fitted;
    double fit_s;
};

/* ---- The shop ---- */

/* The middle of the dataset, without some images (left_out [image_count]; NULL: all). */
static weft_code write_block(weft_price_shop *shop, const uint8_t *left_out, weft_dataset **block, weft_error *error)
{
    weft_texel_subset subset;
    WEFT_TRY(weft_texel_subset_read(shop->dataset, WEFT_TEXEL_SUBSET_BLOCK, shop->side, &subset, error));
    uint8_t *none = left_out ? NULL : calloc((size_t)subset.layout.image_count, 1);
    weft_code code = left_out || none ? WEFT_OK : weft_fail_memory(error, "images", (size_t)subset.layout.image_count);
    if (code == WEFT_OK)
        code =
            weft_texel_subset_write_with_surface(&subset, left_out ? left_out : none, shop->scratch_path, block, error);
    free(none);
    weft_texel_subset_free(&subset);
    return code;
}

static long texels_of(const weft_dataset *dataset)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    return (long)layout->width * layout->height;
}

static weft_code prepare(weft_price_shop *shop, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(shop->dataset);
    if (asprintf(&shop->material_path, "%s.weft", shop->scratch_path) < 0) {
        shop->material_path = NULL;
        return weft_fail_memory(error, "path", strlen(shop->scratch_path));
    }
    if (layout->width > shop->side || layout->height > shop->side)
        WEFT_TRY(write_block(shop, NULL, &shop->block, error));
    shop->share = (double)texels_of(shop->block) / (double)texels_of(shop->dataset);
    return weft_frame_timer_open(&shop->timer, error);
}

weft_code weft_price_shop_open(weft_dataset *dataset, int side, const char *scratch_path, const weft_progress *progress,
                               weft_price_shop **result, weft_error *error)
{
    weft_price_shop *shop = calloc(1, sizeof *shop);
    if (!shop)
        return weft_fail_memory(error, "prices", sizeof *shop);
    shop->dataset = shop->block = dataset;
    shop->side = side;
    shop->scratch_path = scratch_path;
    shop->progress = progress;
    weft_code code = prepare(shop, error);
    if (code == WEFT_OK)
        *result = shop;
    else
        weft_price_shop_close(shop);
    return code;
}

void weft_price_shop_close(weft_price_shop *shop)
{
    if (!shop)
        return;
    weft_frame_timer_close(shop->timer);
    if (shop->block != shop->dataset)
        weft_dataset_close(shop->block);
    weft_material_free(&shop->fitted);
    free(shop->material_path);
    free(shop);
}

long weft_price_shop_texels(const weft_price_shop *shop)
{
    return texels_of(shop->block);
}

const char *weft_price_shop_why_not_drawn(const weft_price_shop *shop)
{
    return weft_frame_timer_why_not(shop->timer);
}

const char *weft_price_shop_renderer(const weft_price_shop *shop)
{
    return weft_frame_timer_renderer(shop->timer);
}

/* ---- Evaluating ---- */

/* An additive sequence (its steps are powers of the root of x^5 = x + 1) fills places and directions evenly. */
static weft_query query_of(long number)
{
    double value[4], step = 1;
    for (int i = 0; i < 4; i++) {
        step /= 1.1673039782614187;
        value[i] = fmod(0.5 + step * (double)number, 1);
    }
    weft_angles light = {largest_theta_rad * value[0], 2 * WEFT_PI * value[1]};
    weft_angles view = {largest_theta_rad * value[2], 2 * WEFT_PI * value[3]};
    return (weft_query){.light = weft_direction_of_angles(light),
                        .view = weft_direction_of_angles(view),
                        .has_place = true,
                        .u = fmod(value[0] + value[3], 1),
                        .v = fmod(value[1] + value[2], 1)};
}

/* At least some, then as many as a tenth of a second allows. */
static weft_code time_evaluations(weft_model *model, double *per_second, weft_error *error)
{
    long count = 0;
    weft_code code = WEFT_OK;
    double began = weft_now_s(), elapsed = 0;
    while (code == WEFT_OK && elapsed < evaluating_s) {
        for (int i = 0; i < EVALUATIONS_AT_ONCE && code == WEFT_OK; i++) {
            weft_query query = query_of(count++);
            weft_rgb brdf;
            code = weft_model_brdf(model, &query, &brdf, error);
        }
        elapsed = weft_now_s() - began;
    }
    *per_second = (double)count / elapsed;
    return code;
}

/* How fast the model in a file is evaluated, and how much it flickers. */
static weft_code evaluate(const char *path, bool through_heights, weft_price *price, weft_error *error)
{
    const weft_model_options options = {.flat = !through_heights};
    weft_model *model;
    WEFT_TRY(weft_model_open(path, &options, &model, error));
    weft_code code = time_evaluations(model, &price->evaluations_a_second, error);
    if (code == WEFT_OK)
        code = weft_flicker_measure(model, &price->flicker, error);
    price->has_flicker = code == WEFT_OK;
    weft_model_close(model);
    return code;
}

/* ---- Fitting ---- */

static weft_code fit_block(weft_price_shop *shop, const weft_priced_model *model, weft_dataset *block,
                           weft_error *error)
{
    weft_compress_report report;
    shop->is_fitted = false;
    weft_material_free(&shop->fitted);
    weft_compress_options options = model->options;
    options.heights = false; /* they are given afterwards */
    WEFT_TRY(weft_compress(block, &options, NULL, &shop->fitted, &report, error));
    shop->is_fitted = true;
    shop->fitted_model = *model;
    shop->fit_s = report.seconds;
    return WEFT_OK;
}

static weft_code fit(weft_price_shop *shop, const weft_priced_model *model, const uint8_t *left_out, weft_error *error)
{
    weft_dataset *some;
    if (shop->is_fitted && weft_priced_models_share_fit(model, &shop->fitted_model))
        return WEFT_OK;
    if (model->photographs == WEFT_PHOTOGRAPHS_ALL)
        return fit_block(shop, model, shop->block, error);
    WEFT_TRY(write_block(shop, left_out, &some, error));
    weft_code code = fit_block(shop, model, some, error);
    weft_dataset_close(some);
    return code;
}

/* ---- Prices ---- */

static weft_code price_material(weft_price_shop *shop, const weft_material *material, weft_price *price,
                                weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(shop->dataset);
    weft_weight weight;
    WEFT_TRY(weft_weight_of(material, &weight, error));
    price->bytes = weft_weight_scaled(&weight, layout->width, layout->height, material->level_count > 1);
    price->bits_a_texel = 8 * price->bytes / ((double)layout->width * layout->height);
    price->fit_s = shop->fit_s / shop->share;
    WEFT_TRY(weft_material_write(shop->material_path, material, error));
    weft_code code = evaluate(shop->material_path, true, price, error);
    unlink(shop->material_path);
    WEFT_TRY(code);
    return weft_frame_timer_of_material(shop->timer, material, &price->frame_ms, error);
}

/* That of the whole dataset, which a block of it does not have: it is the larger part of the metadata. */
static weft_code give_provenance(const weft_price_shop *shop, weft_material *material, weft_error *error)
{
    const char *provenance = weft_dataset_get_layout(shop->dataset)->provenance;
    return weft_material_put_metadata(material, "provenance", json_loads(provenance, 0, NULL), error);
}

static weft_code price_raw(weft_price_shop *shop, bool through_heights, weft_price *price, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(shop->dataset);
    price->bits_a_texel = 8.0 * 3 * sizeof(weft_half) * layout->image_count;
    price->bytes = price->bits_a_texel / 8 * layout->width * layout->height;
    WEFT_TRY(evaluate(weft_dataset_path(shop->dataset), through_heights, price, error));
    return weft_frame_timer_of_dataset(shop->timer, shop->block, through_heights, shop->progress, &price->frame_ms,
                                       error);
}

/* Of what nothing plays. The photographs of BARD are half floats, numbers of RTI bytes. */
static void price_by_size(const weft_price_shop *shop, const weft_priced_model *model, weft_price *price)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(shop->dataset);
    double texels = (double)layout->width * layout->height;
    if (model->family == WEFT_PRICED_BARD) {
        price->photograph_count = weft_bard_count_photographs(layout, NULL);
        price->bytes = 3 * sizeof(weft_half) * price->photograph_count * texels;
    }
    if (model->family == WEFT_PRICED_RTI)
        price->bytes = 3 * weft_rti_coefficients(model->rti, price->photograph_count) * texels;
    if (model->family == WEFT_PRICED_FACTORISED)
        price->bytes = weft_factorised_bytes(model->factorised, texels, price->photograph_count);
    price->bits_a_texel = 8 * price->bytes / texels;
}

static weft_code price_opened_cloth(weft_price_shop *shop, const char *given, weft_priced_cloth *cloth,
                                    weft_price *price, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(shop->dataset);
    WEFT_TRY(weft_priced_cloth_fit(cloth, shop->block, error));
    if (!cloth->is_threads)
        WEFT_TRY(weft_priced_cloth_write(cloth, shop->material_path, error));
    const char *path = cloth->is_threads ? given : shop->material_path;
    price->fit_s = cloth->fit_s;
    price->bytes = (double)weft_file_bytes(path);
    price->bits_a_texel = 8 * price->bytes / ((double)layout->width * layout->height);
    weft_code code = evaluate(path, false, price, error);
    unlink(shop->material_path);
    WEFT_TRY(code);
    return weft_frame_timer_of_cloth(shop->timer, cloth->is_threads ? NULL : &cloth->weave, &cloth->threads.cloth,
                                     &price->frame_ms, error);
}

static weft_code price_cloth(weft_price_shop *shop, const char *given, weft_price *price, weft_error *error)
{
    weft_priced_cloth cloth;
    weft_code code = weft_priced_cloth_open(given, &cloth, error);
    if (code == WEFT_OK)
        code = price_opened_cloth(shop, given, &cloth, price, error);
    weft_priced_cloth_free(&cloth);
    return code;
}

static weft_code price_model(weft_price_shop *shop, const weft_priced_model *model, const uint8_t *left_out,
                             weft_price *price, weft_error *error)
{
    if (model->family == WEFT_PRICED_RAW)
        return price_raw(shop, model->options.heights, price, error);
    if (model->family == WEFT_PRICED_CLOTH)
        return price_cloth(shop, model->cloth, price, error);
    if (!weft_priced_model_is_fit(model)) {
        price_by_size(shop, model, price);
        return WEFT_OK;
    }
    WEFT_TRY(fit(shop, model, left_out, error));
    weft_material_take_heights(&shop->fitted, NULL);
    if (model->options.heights)
        WEFT_TRY(weft_compress_take_heights(shop->block, &shop->fitted, error));
    WEFT_TRY(give_provenance(shop, &shop->fitted, error));
    return price_material(shop, &shop->fitted, price, error);
}

weft_code weft_price_ask(weft_price_shop *shop, const weft_priced_model *model, weft_price *price, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(shop->dataset);
    uint8_t *left_out = malloc((size_t)layout->image_count);
    if (!left_out)
        return weft_fail_memory(error, "images", (size_t)layout->image_count);
    *price = (weft_price){0};
    price->photograph_count = weft_photographs_leave_out(layout, model->photographs, left_out);
    weft_code code = price_model(shop, model, left_out, price, error);
    free(left_out);
    return code;
}
