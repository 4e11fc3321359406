#include "bench/fetches.h"

#include "reflectance/relief/relief.h"

enum { LEVELS = 2, CORNERS = 3 /* of a triangle of directions */, BILINEAR = 4, TRILINEAR = 8 };

/* Eight texels of packed words and three entries of each table (player/texture/material_texture.h). */
static weft_fetches of_lobes(const weft_material *material)
{
    int texels = LEVELS * BILINEAR, words = 1 + (3 * material->lobe_count + 1) / 2;
    int entries = CORNERS * ((material->view_count > 0) + (material->light_count > 0));
    return (weft_fetches){texels * (words + entries), texels * (16 * words + 4 * entries)};
}

/* Coefficients of four components at once from two levels; their factors, four half floats, from two rows of view nodes
 * for each channel; three floors and a ceiling (player/draw/shaders/factorised.glsl). With opacity, three entries of T
 * at each of eight texels.
 */
static weft_fetches of_components(const weft_material *material)
{
    int groups = material->components->component_count / WEFT_COMPONENTS_GROUP, coefficients = LEVELS * groups,
        factors = 2 * 3 * groups;
    weft_fetches fetches = {coefficients + factors + 1, 4 * BILINEAR * coefficients + 8 * TRILINEAR * factors + 4};
    if (weft_material_has_holes(material)) {
        fetches.reads += CORNERS * LEVELS * BILINEAR;
        fetches.bytes += 4 * CORNERS * LEVELS * BILINEAR;
    }
    return fetches;
}

/* A march that takes all of its steps, in half floats, and of each of three views its slope and what it sees of the
 * point (reflectance/relief/relief.glsl). */
static weft_fetches of_march(void)
{
    int steps = 1 + WEFT_RELIEF_STEPS + WEFT_RELIEF_BISECTIONS;
    return (weft_fetches){steps + 2 * CORNERS, BILINEAR * steps * (int)sizeof(weft_half) + CORNERS * (8 + BILINEAR)};
}

/* The same coefficients, bounds and opacity at each of three places, with the factors of one view node. */
static weft_fetches of_components_through_heights(const weft_material *material)
{
    int groups = material->components->component_count / WEFT_COMPONENTS_GROUP, coefficients = LEVELS * groups,
        factors = 3 * groups, opacity = weft_material_has_holes(material) ? LEVELS * BILINEAR : 0;
    weft_fetches fetches = of_march();
    fetches.reads += CORNERS * (coefficients + factors + 2 + opacity);
    fetches.bytes += CORNERS * (4 * BILINEAR * coefficients + 8 * BILINEAR * factors + 4 + 16 + 4 * opacity);
    return fetches;
}

weft_fetches weft_fetches_of_material(const weft_material *material)
{
    if (!material->components)
        return of_lobes(material);
    return material->heights ? of_components_through_heights(material) : of_components(material);
}
