#include "player/raw/plan.h"

enum { BORDER = 1 };

/* As few columns of tiles side by side as the layers allow. */
static weft_raw_tiles tiles_of(weft_raw_format format, int count, int most_layers)
{
    weft_raw_tiles tiles = {format, count, (count + most_layers - 1) / most_layers, 0};
    tiles.layers = count > 0 ? (count + tiles.columns - 1) / tiles.columns : 0;
    return tiles;
}

static size_t bytes_of(const weft_raw_plan *plan, int part, weft_raw_format format)
{
    const weft_raw_tiles *tiles = &plan->tiles[part];
    size_t blocks = (size_t)(plan->layout.width / WEFT_RAW_BLOCK) * (size_t)(plan->layout.height / WEFT_RAW_BLOCK);
    return blocks * (size_t)tiles->columns * (size_t)tiles->layers * weft_raw_block_bytes(format);
}

size_t weft_raw_plan_bytes(const weft_raw_plan *plan, weft_raw_format format)
{
    return bytes_of(plan, WEFT_RAW_SAMPLES, format) + bytes_of(plan, WEFT_RAW_OPACITY, WEFT_RAW_EIGHT_BITS);
}

static bool is_wanted(const weft_raw_limits *limits, weft_raw_format format)
{
    return limits->format == WEFT_RAW_FITTING ? format != WEFT_RAW_BC6H || limits->has_bc6h : limits->format == format;
}

static bool fits(const weft_raw_plan *plan, const weft_raw_limits *limits, weft_raw_format format)
{
    for (int part = 0; part < WEFT_RAW_PARTS; part++) {
        int columns = plan->tiles[part].columns;
        if (columns > 0 && plan->layout.width > limits->size / columns)
            return false;
    }
    bool is_free = format == WEFT_RAW_HALF && limits->format == WEFT_RAW_FITTING;
    return plan->layout.height <= limits->size &&
           weft_raw_plan_bytes(plan, format) <= (is_free ? limits->half_bytes : limits->bytes);
}

static bool choose_format(const weft_raw_limits *limits, weft_raw_plan *plan)
{
    for (int format = WEFT_RAW_HALF; format <= WEFT_RAW_BC6H; format++) {
        plan->tiles[WEFT_RAW_SAMPLES].format = (weft_raw_format)format;
        if (is_wanted(limits, (weft_raw_format)format) && fits(plan, limits, (weft_raw_format)format))
            return true;
    }
    return false;
}

weft_code weft_raw_plan_make(const weft_dataset_layout *layout, bool has_opacity, const char *path,
                             const weft_raw_limits *limits, weft_raw_plan *plan, weft_error *error)
{
    int count = weft_mip_level_count(layout->width, layout->height);
    int width = layout->width, height = layout->height;
    if (limits->format == WEFT_RAW_BC6H && !limits->has_bc6h)
        return weft_fail(error, WEFT_SYSTEM, "this graphics driver has no textures of BC6H");
    plan->tiles[WEFT_RAW_SAMPLES] = tiles_of(limits->format, layout->image_count, limits->layers);
    plan->tiles[WEFT_RAW_OPACITY] = tiles_of(WEFT_RAW_EIGHT_BITS, has_opacity ? layout->view_count : 0, limits->layers);
    for (int skipped = 0; skipped < count; skipped++) {
        plan->skipped_levels = skipped;
        plan->layout = weft_mip_layout_of(width, height, count - skipped, BORDER, WEFT_RAW_BLOCK);
        if (choose_format(limits, plan))
            return WEFT_OK;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' has too many images for graphics memory: %d", path,
                     layout->image_count);
}
