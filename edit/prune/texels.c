#include "edit/prune/steps.h"

#include <stdlib.h>
#include <string.h>

/* ---- Levels ---- */

static bool is_empty(const weft_visibility *visibility, int k)
{
    return visibility->texel_count[k] == 0;
}

/* Texels stay as square as they are: sides that were halved unevenly do not. */
static bool keeps_proportions(const weft_visibility *visibility)
{
    return (long)visibility->width[0] * visibility->height[1] == (long)visibility->width[1] * visibility->height[0];
}

static void drop_finest(weft_visibility *visibility, weft_material *material)
{
    double width_mm = material->texel_pitch_mm * visibility->width[0];
    weft_material_drop_finest(material);
    free(visibility->texel[0]);
    visibility->level_count--;
    for (int k = 0; k < visibility->level_count; k++) {
        visibility->width[k] = visibility->width[k + 1];
        visibility->height[k] = visibility->height[k + 1];
        visibility->texel[k] = visibility->texel[k + 1];
        visibility->texel_count[k] = visibility->texel_count[k + 1];
    }
    visibility->texel[visibility->level_count] = NULL;
    visibility->level_low--;
    visibility->level_high--;
    material->texel_pitch_mm = width_mm / visibility->width[0];
}

/* ---- Texels ---- */

/* The texel of a row that is kept and nearest to a column; the row repeats. */
static int nearest_in_row(const uint8_t *kept, int width, int column)
{
    for (int away = 0; away <= width / 2; away++) {
        int left = (column - away + width) % width, right = (column + away) % width;
        if (kept[left])
            return left;
        if (kept[right])
            return right;
    }
    return column;
}

static bool has_any(const uint8_t *kept, int width)
{
    return memchr(kept, 1, (size_t)width) != NULL;
}

static int nearest_row(const uint8_t *kept, int width, int height, int row)
{
    for (int away = 0; away <= height / 2; away++) {
        int above = (row - away + height) % height, below = (row + away) % height;
        if (has_any(kept + (size_t)above * (size_t)width, width))
            return above;
        if (has_any(kept + (size_t)below * (size_t)width, width))
            return below;
    }
    return 0;
}

/* source [height][width]: where each texel comes from. A level of which nothing is kept repeats its first row. */
static void find_sources(const uint8_t *kept, int width, int height, size_t *source)
{
    for (int y = 0; y < height; y++) {
        int from = nearest_row(kept, width, height, y);
        const uint8_t *row = kept + (size_t)from * (size_t)width;
        for (int x = 0; x < width; x++)
            *source++ = (size_t)from * (size_t)width + (size_t)nearest_in_row(row, width, x);
    }
}

/* One plane; texels that are copied from are kept, and so never written. */
static void fill_plane(void *plane, size_t texel_bytes, const size_t *source, size_t count)
{
    uint8_t *bytes = plane;
    for (size_t i = 0; plane && i < count; i++)
        if (source[i] != i)
            memcpy(bytes + i * texel_bytes, bytes + source[i] * texel_bytes, texel_bytes);
}

static void fill_planes(void *planes, int plane_count, size_t texel_bytes, const size_t *source, size_t count)
{
    for (int i = 0; planes && i < plane_count; i++)
        fill_plane((uint8_t *)planes + (size_t)i * texel_bytes * count, texel_bytes, source, count);
}

static void fill_level(const weft_material *material, int k, const size_t *source)
{
    const weft_material_level *level = &material->level[k];
    size_t count = (size_t)level->width * (size_t)level->height;
    fill_plane(level->frame, 3 * sizeof *level->frame, source, count);
    fill_plane(level->diffuse, 4 * sizeof *level->diffuse, source, count);
    fill_planes(level->lobe, 3 * material->lobe_count, 4 * sizeof *level->lobe, source, count);
    fill_planes(level->table, material->view_count, 4, source, count);
    if (material->components)
        fill_planes(material->components->level[k].coefficient,
                    material->components->component_count / WEFT_COMPONENTS_GROUP, WEFT_COMPONENTS_GROUP, source,
                    count);
}

static weft_code fill(const weft_visibility *visibility, const weft_material *material, int k, weft_error *error)
{
    size_t count = (size_t)visibility->width[k] * (size_t)visibility->height[k];
    if (visibility->texel_count[k] == (long)count)
        return WEFT_OK;
    size_t *source = calloc(count, sizeof *source);
    if (!source)
        return weft_fail_memory(error, "texels", count * sizeof *source);
    find_sources(visibility->texel[k], visibility->width[k], visibility->height[k], source);
    fill_level(material, k, source);
    free(source);
    return WEFT_OK;
}

static void drop_coarsest(weft_visibility *visibility, weft_material *material)
{
    weft_material_drop_coarsest(material);
    free(visibility->texel[--visibility->level_count]);
    visibility->texel[visibility->level_count] = NULL;
}

weft_code weft_prune_texels(weft_visibility *visibility, weft_material *material, int *finer, int *coarser,
                            weft_error *error)
{
    *finer = *coarser = 0;
    while (visibility->level_count > 1 && is_empty(visibility, 0) && keeps_proportions(visibility)) {
        drop_finest(visibility, material);
        ++*finer;
    }
    while (visibility->level_count > 1 && is_empty(visibility, visibility->level_count - 1)) {
        drop_coarsest(visibility, material);
        ++*coarser;
    }
    for (int k = 0; k < visibility->level_count; k++)
        WEFT_TRY(fill(visibility, material, k, error));
    return WEFT_OK;
}

/* ---- Visibility ---- */

/* All texels that interpolation reads within a cell are kept. */
static bool is_kept(const weft_visibility *visibility, int k, int column, int row)
{
    int width = visibility->width[k], height = visibility->height[k], side = WEFT_VISIBILITY_SIDE;
    int left = (int)floor((double)column * width / side - 0.5), right = (int)floor((column + 1.0) * width / side - 0.5);
    int top = (int)floor((double)row * height / side - 0.5), bottom = (int)floor((row + 1.0) * height / side - 0.5);
    for (int y = top; y <= bottom + 1; y++)
        for (int x = left; x <= right + 1; x++)
            if (!visibility->texel[k][(size_t)((y + height) % height) * (size_t)width + (size_t)((x + width) % width)])
                return false;
    return true;
}

weft_code weft_prune_note_seen(const weft_visibility *visibility, int finer, int coarser, weft_material *material,
                               weft_error *error)
{
    weft_material_visibility *seen;
    WEFT_TRY(weft_material_visibility_create(WEFT_VISIBILITY_SIDE, visibility->level_count, &seen, error));
    seen->finer_levels = finer;
    seen->coarser_levels = coarser;
    memcpy(weft_material_visibility_cells(seen, WEFT_MATERIAL_VISIBILITY_VIEWS), visibility->view,
           sizeof visibility->view);
    memcpy(weft_material_visibility_cells(seen, WEFT_MATERIAL_VISIBILITY_LIGHTS), visibility->light,
           sizeof visibility->light);
    for (int k = 0; k < visibility->level_count; k++) {
        uint8_t *cell = weft_material_visibility_cells(seen, WEFT_MATERIAL_VISIBILITY_PLACES + k);
        for (int i = 0; i < WEFT_VISIBILITY_SIDE * WEFT_VISIBILITY_SIDE; i++)
            cell[i] = is_kept(visibility, k, i % WEFT_VISIBILITY_SIDE, i / WEFT_VISIBILITY_SIDE);
    }
    weft_material_take_visibility(material, seen);
    return WEFT_OK;
}
