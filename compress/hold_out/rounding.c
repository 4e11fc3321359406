#include "compress/hold_out/certify.h"

#include <stddef.h>

enum { LARGEST_WHOLE = 2048 }; /* that a half float holds exactly, with all below it */

/* +1 or -1. */
static int next_sign(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return *state >> 63 ? 1 : -1;
}

static int held(int value, int least, int most)
{
    return value < least ? least : value > most ? most : value;
}

/* The next finite half float of the same sign. */
static void move_halves(weft_half *half, size_t count, uint64_t *state)
{
    for (size_t i = 0; i < count; i++) {
        int magnitude = half[i] & 0x7fff, sign = half[i] & 0x8000;
        if (magnitude > 0)
            half[i] = (weft_half)(sign | held(magnitude + next_sign(state), 1, 0x7bff));
    }
}

/* Of values that are rounded to whole numbers. */
static void move_whole_numbers(weft_half *half, size_t count, uint64_t *state)
{
    for (size_t i = 0; i < count; i++) {
        int value = (int)weft_float_of_half(half[i]);
        half[i] = weft_half_of_float((float)held(value + next_sign(state), -LARGEST_WHOLE, LARGEST_WHOLE));
    }
}

static void move_bytes(uint8_t *code, size_t count, uint64_t *state)
{
    for (size_t i = 0; i < count; i++)
        code[i] = (uint8_t)held(code[i] + next_sign(state), 0, 255);
}

static void move_frames(int16_t *number, size_t count, uint64_t *state)
{
    for (size_t i = 0; i < count; i++)
        number[i] = (int16_t)(number[i] == 0 ? 0 : held(number[i] + next_sign(state), -32767, 32767));
}

/* How far apart the codes of components lie that were rounded (btf/material/component_rounding.h): step
 * [component_count]. */
static void find_code_steps(const weft_components *components, size_t texels, int step[WEFT_COMPONENTS_MAX])
{
    enum { LARGEST = WEFT_COMPONENTS_LARGEST_CODE };
    for (size_t k = 0; k < (size_t)components->component_count; k++) {
        const int8_t *code = components->level[0].coefficient +
                             k / WEFT_COMPONENTS_GROUP * WEFT_COMPONENTS_GROUP * texels + k % WEFT_COMPONENTS_GROUP;
        bool is_there[2 * LARGEST + 1] = {false};
        int last = -1, least = 2 * LARGEST;
        for (size_t i = 0; i < texels; i++)
            is_there[code[WEFT_COMPONENTS_GROUP * i] + LARGEST] = true;
        for (int c = 0; c <= 2 * LARGEST; c++) {
            if (is_there[c] && last >= 0 && c - last < least)
                least = c - last;
            last = is_there[c] ? c : last;
        }
        step[k] = least < 2 * LARGEST ? least : 1;
    }
}

static void move_coefficients(weft_components *components, size_t texels, uint64_t *state)
{
    int step[WEFT_COMPONENTS_MAX] = {0};
    int8_t *coefficient = components->level[0].coefficient;
    if (texels == 0)
        return;
    bool is_rounded = weft_components_have_differences(components);
    if (is_rounded)
        find_code_steps(components, texels, step);
    for (size_t i = 0; i < texels * (size_t)components->component_count; i++) {
        size_t layer = i / WEFT_COMPONENTS_GROUP / texels * WEFT_COMPONENTS_GROUP + i % WEFT_COMPONENTS_GROUP;
        int moved = coefficient[i] + next_sign(state) * (is_rounded ? step[layer] : 1);
        coefficient[i] = (int8_t)held(moved, -WEFT_COMPONENTS_LARGEST_CODE, WEFT_COMPONENTS_LARGEST_CODE);
    }
}

static void move_components(weft_components *components, size_t texels, uint64_t *state)
{
    size_t series = (size_t)components->component_count;
    move_coefficients(components, texels, state);
    if (weft_components_have_differences(components))
        move_whole_numbers(components->value, 3 * (size_t)components->image_count * series, state);
    else
        move_halves(components->value, 3 * (size_t)components->image_count * series, state);
}

void weft_material_move_by_steps(weft_material *material)
{
    weft_material_level *level = &material->level[0];
    size_t texels = (size_t)level->width * (size_t)level->height;
    uint64_t state = 1;
    if (material->has_lobes) {
        move_frames(level->frame, 3 * texels, &state);
        move_halves(level->diffuse, 4 * (1 + 3 * (size_t)material->lobe_count) * texels, &state);
    }
    if (level->table)
        move_bytes(level->table, 4 * (size_t)material->view_count * texels, &state);
    if (material->components)
        move_components(material->components, texels, &state);
}
