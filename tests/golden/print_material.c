#include "reflectance/lafortune/lafortune.h"
#include "tests/golden/print.h"

static void print_directions(FILE *out, const char *name, const weft_vec3 *direction, int count)
{
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s %d:", name, i);
        print_vector(out, direction[i]);
        fputc('\n', out);
    }
}

static void print_half4(FILE *out, const weft_half value[4])
{
    for (int i = 0; i < 4; i++)
        fprintf(out, " %.9g", weft_float_of_half(value[i]));
    fputc('\n', out);
}

static void print_lobes(FILE *out, const weft_material *material, const weft_material_level *level, size_t texel)
{
    static const char *const channel[3] = {"red", "green", "blue"};
    size_t texels = (size_t)level->width * (size_t)level->height;
    weft_frame frame = weft_frame_decode(level->frame + 3 * texel);
    fprintf(out, "  normal:");
    print_vector(out, frame.normal);
    fprintf(out, " tangent:");
    print_vector(out, frame.tangent);
    fprintf(out, "\n  rho:");
    print_half4(out, level->diffuse + 4 * texel);
    for (size_t plane = 0; plane < 3 * (size_t)material->lobe_count; plane++) {
        fprintf(out, "  lobe %zu %s, C and N:", plane / 3, channel[plane % 3]);
        print_half4(out, level->lobe + 4 * (plane * texels + texel));
    }
}

/* `codes` of every direction: red, green, blue, opacity. */
static void print_table(FILE *out, const char *name, const uint8_t *table, int count, size_t texels, size_t texel)
{
    if (count == 0)
        return;
    fprintf(out, "  %s codes:", name);
    for (size_t i = 0; i < (size_t)count; i++) {
        const uint8_t *code = table + 4 * (i * texels + texel);
        fprintf(out, " %d %d %d %d,", code[0], code[1], code[2], code[3]);
    }
    fputc('\n', out);
}

static void print_texel(FILE *out, const weft_material *material, int k, size_t texel)
{
    const weft_material_level *level = &material->level[k];
    size_t width = (size_t)level->width, texels = width * (size_t)level->height;
    fprintf(out, "level %d texel %zu %zu\n", k, texel % width, texel / width);
    if (material->has_lobes)
        print_lobes(out, material, level, texel);
    print_table(out, "T", level->table, material->view_count, texels, texel);
    print_table(out, "S", level->light_table, material->light_count, texels, texel);
}

/* BRDF x pi and opacity. */
static void print_values(FILE *out, const weft_material *material, const weft_table_directions *directions, int k,
                         size_t texel)
{
    static const weft_vec3 light[3] = {{0, 0, 1}, {0.48, -0.36, 0.8}, {-0.64, 0.48, 0.6}};
    static const weft_vec3 view[3] = {{0.36, 0.48, 0.8}, {0.6, 0, 0.8}, {0.64, -0.6, 0.48}};
    size_t width = (size_t)material->level[k].width;
    for (int i = 0; i < 3; i++) {
        weft_rgba value =
            weft_material_texel(material, directions, k, (int)(texel % width), (int)(texel / width), light[i], view[i]);
        fprintf(out, "  pi f and opacity, pair %d: %.9g %.9g %.9g %.9g\n", i, value.r, value.g, value.b, value.a);
    }
}

static void print_level(FILE *out, const weft_material *material, const weft_table_directions *directions, int k)
{
    const weft_material_level *level = &material->level[k];
    const weft_error_summary *e = &level->error;
    fprintf(out, "level %d: %d x %d texels, errors %.9g %.9g %.9g %.9g %.9g\n", k, level->width, level->height,
            e->median_relative, e->percentile80_relative, e->rmse, e->relative_rmse, e->psnr_db);
    for (size_t texel = 0; texel < (size_t)level->width * (size_t)level->height; texel++) {
        print_texel(out, material, k, texel);
        print_values(out, material, directions, k, texel);
    }
}

static void print_heights(FILE *out, const weft_material_heights *heights)
{
    fprintf(out, "heights: %d x %d places, %d levels, %.9g x %.9g mm\n", heights->width, heights->height,
            heights->level_count, heights->size_mm[0], heights->size_mm[1]);
    for (int y = 0; y < heights->height; y++)
        for (int x = 0; x < heights->width; x++)
            fprintf(out, "  (%d, %d): %.9g mm\n", x, y, (double)weft_material_height_mm(heights, x, y));
}

static void print_seen(FILE *out, const weft_material_visibility *seen)
{
    fprintf(out, "seen: %d x %d cells, %d levels, %d finer and %d coarser are gone\n", seen->side, seen->side,
            seen->level_count, seen->finer_levels, seen->coarser_levels);
    for (int map = 0; map < WEFT_MATERIAL_VISIBILITY_PLACES + seen->level_count; map++)
        for (int row = 0; row < seen->side; row++) {
            fprintf(out, "  map %d row %d:", map, row);
            for (int column = 0; column < seen->side; column++)
                fprintf(out, " %d", weft_material_visibility_cells(seen, map)[row * seen->side + column]);
            fprintf(out, "\n");
        }
}

weft_code print_material(const char *path, FILE *out, weft_error *error)
{
    weft_material material;
    weft_table_directions directions;
    WEFT_TRY(weft_material_read(path, &material, error));
    weft_code code = weft_table_directions_create(&material, &directions, error);
    if (code == WEFT_OK) {
        fprintf(out, "lobes: %d levels: %d texel_pitch_mm: %.9g\n", material.lobe_count, material.level_count,
                material.texel_pitch_mm);
        fprintf(out, "metadata: %s\n", material.metadata);
        print_directions(out, "view", material.view, material.view_count);
        print_directions(out, "light", material.light, material.light_count);
        for (int k = 0; k < material.level_count; k++)
            print_level(out, &material, &directions, k);
        if (material.heights)
            print_heights(out, material.heights);
        if (material.visibility)
            print_seen(out, material.visibility);
        weft_table_directions_free(&directions);
    }
    weft_material_free(&material);
    return code;
}
