#include "compress/run/fitted.h"

#include "compress/run/mip_pyramid.h"

#include <stdlib.h>

static size_t texel_count(const weft_material_level *level)
{
    return (size_t)level->width * (size_t)level->height;
}

weft_code weft_fitted_create(weft_material *material, weft_fitted *fitted, weft_error *error)
{
    *fitted = (weft_fitted){.material = material};
    for (int k = 0; k < material->level_count; k++) {
        size_t texels = texel_count(&material->level[k]);
        fitted->sums[k] = calloc(texels, sizeof *fitted->sums[k]);
        if (!fitted->sums[k])
            return weft_fail_memory(error, "errors of texels", texels * sizeof *fitted->sums[k]);
        WEFT_TRY(weft_error_tally_create(&fitted->tally[k], error));
        WEFT_TRY(weft_error_tally_create(&fitted->block_tally[k], error));
    }
    return WEFT_OK;
}

void weft_fitted_free(weft_fitted *fitted)
{
    for (int k = 0; k < WEFT_MATERIAL_MAX_LEVELS; k++) {
        free(fitted->sums[k]);
        weft_error_tally_free(fitted->tally[k]);
        weft_error_tally_free(fitted->block_tally[k]);
    }
    *fitted = (weft_fitted){0};
}

/* ---- Records ---- */

static void transfer_texel(weft_fitted *fitted, int k, size_t texel, weft_record *record)
{
    const weft_material *material = fitted->material;
    const weft_material_level *level = &material->level[k];
    size_t texels = texel_count(level);
    weft_record_transfer(record, level->frame + 3 * texel, 3 * sizeof *level->frame);
    weft_record_transfer(record, level->diffuse + 4 * texel, 4 * sizeof *level->diffuse);
    for (size_t i = 0; i < 3 * (size_t)material->lobe_count; i++)
        weft_record_transfer(record, level->lobe + 4 * (i * texels + texel), 4 * sizeof *level->lobe);
    for (size_t view = 0; level->table && view < (size_t)material->view_count; view++)
        weft_record_transfer(record, level->table + 4 * (view * texels + texel), 4);
    weft_record_transfer(record, &fitted->sums[k][texel], sizeof fitted->sums[k][texel]);
}

static void save_tally(weft_error_tally *tally, weft_record *record)
{
    size_t count = weft_error_tally_entries(tally, NULL);
    uint32_t(*entry)[2] = malloc((count + 1) * sizeof *entry);
    record->failed = record->failed || !entry;
    if (!entry)
        return;
    weft_error_tally_entries(tally, entry);
    weft_record_transfer(record, &count, sizeof count);
    weft_record_transfer(record, entry, count * sizeof *entry);
    free(entry);
}

static void load_tally(weft_error_tally *tally, weft_record *record)
{
    size_t count = 0;
    uint32_t entry[1][2];
    weft_record_transfer(record, &count, sizeof count);
    for (size_t i = 0; i < count && !record->failed; i++) {
        weft_record_transfer(record, entry, sizeof entry);
        record->failed = record->failed || !weft_error_tally_add_entries(tally, entry, 1);
    }
}

void weft_fitted_transfer_block(weft_fitted *fitted, const weft_block_place *block, int finished, weft_record *record)
{
    for (int k = 0; k <= finished; k++) {
        weft_block_place own = weft_block_place_at(block, k);
        for (int y = own.y; y < own.y + own.height; y++) {
            for (int x = own.x; x < own.x + own.width; x++)
                transfer_texel(fitted, k, (size_t)y * (size_t)fitted->material->level[k].width + (size_t)x, record);
        }
        if (record->loading)
            load_tally(fitted->block_tally[k], record);
        else
            save_tally(fitted->block_tally[k], record);
    }
    weft_record_transfer(record, &fitted->block_counts, sizeof fitted->block_counts);
    weft_record_transfer(record, &fitted->block_masked, sizeof fitted->block_masked);
}

void weft_fitted_add_counts(weft_texel_counts *to, const weft_texel_counts *from)
{
    to->texels += from->texels;
    to->empty += from->empty;
}

void weft_fitted_end_block(weft_fitted *fitted)
{
    weft_fitted_add_counts(&fitted->counts, &fitted->block_counts);
    fitted->masked += fitted->block_masked;
    fitted->block_counts = (weft_texel_counts){0};
    fitted->block_masked = 0;
    for (int k = 0; k < fitted->material->level_count; k++)
        weft_error_tally_merge(fitted->tally[k], fitted->block_tally[k]);
}

void weft_fitted_finish(const weft_fitted *fitted)
{
    for (int k = 0; k < fitted->material->level_count; k++) {
        weft_material_level *level = &fitted->material->level[k];
        weft_error_sums all = {0};
        for (size_t texel = 0; texel < texel_count(level); texel++)
            weft_error_sums_add(&all, &fitted->sums[k][texel]);
        level->error = weft_error_tally_summarise(fitted->tally[k], &all);
    }
}
