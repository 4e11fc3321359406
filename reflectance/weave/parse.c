/* The grammar of a weave file (docs/reference/weave-format.md). Blocks do not nest, so neither does the parser. */
#include "base/text/block_parser.h"
#include "reflectance/weave/syntax.h"

#include <stdlib.h>
#include <string.h>

#define LARGE 1e6

enum { MAX_TILE_SIDE = 4096, MAX_CELLS = 1 << 20 };

/* Numbers of the weave block, as in the file. */
typedef struct weave_values {
    double tile_width, tile_height, alpha, beta, delta, highlight_width, warp_area, weft_area;
    double inclination_noise[4], fineness, period, frozen_radius;
    double cell_pitch_mm;
    weft_weave_layout layout;
} weave_values;

/* Numbers of a yarn block, as in the file: degrees, tile units. */
typedef struct yarn_values {
    double psi_deg, umax_deg, kappa, width, length, center_u, center_v, kd[3], ks[3];
} yarn_values;

static const weft_block_field weave_fields[] = {
    {"tileWidth", offsetof(weave_values, tile_width), 1, false, 1, MAX_TILE_SIDE},
    {"tileHeight", offsetof(weave_values, tile_height), 1, false, 1, MAX_TILE_SIDE},
    {"alpha", offsetof(weave_values, alpha), 1, false, 0, LARGE},
    {"beta", offsetof(weave_values, beta), 1, false, -LARGE, LARGE},
    {"ss", offsetof(weave_values, delta), 1, false, 0, 1},
    {"hWidth", offsetof(weave_values, highlight_width), 1, false, WEFT_SEGMENT_MIN_HIGHLIGHT_WIDTH, 1},
    {"warpArea", offsetof(weave_values, warp_area), 1, false, 0, LARGE},
    {"weftArea", offsetof(weave_values, weft_area), 1, false, 0, LARGE},
    {"dWarpUmaxOverDWarp", offsetof(weave_values, inclination_noise[0]), 1, true, -90, 90},
    {"dWarpUmaxOverDWeft", offsetof(weave_values, inclination_noise[1]), 1, true, -90, 90},
    {"dWeftUmaxOverDWarp", offsetof(weave_values, inclination_noise[2]), 1, true, -90, 90},
    {"dWeftUmaxOverDWeft", offsetof(weave_values, inclination_noise[3]), 1, true, -90, 90},
    {"fineness", offsetof(weave_values, fineness), 1, true, 0, LARGE},
    {"period", offsetof(weave_values, period), 1, true, 0, LARGE},
    {"frozenRadius", offsetof(weave_values, frozen_radius), 1, true, 0, 1},
    {"cellPitch", offsetof(weave_values, cell_pitch_mm), 1, true, 0, LARGE},
    {"tilesU", offsetof(weave_values, layout.tiles_u), 1, true, 0, LARGE},
    {"tilesV", offsetof(weave_values, layout.tiles_v), 1, true, 0, LARGE},
    {"cornerU", offsetof(weave_values, layout.corner_u), 1, true, -LARGE, LARGE},
    {"cornerV", offsetof(weave_values, layout.corner_v), 1, true, -LARGE, LARGE},
};

static const weft_block_field yarn_fields[] = {
    {"psi", offsetof(yarn_values, psi_deg), 1, false, -LARGE, LARGE},
    {"umax", offsetof(yarn_values, umax_deg), 1, false, -LARGE, LARGE},
    {"kappa", offsetof(yarn_values, kappa), 1, false, -LARGE, LARGE},
    {"width", offsetof(yarn_values, width), 1, false, 0, LARGE},
    {"length", offsetof(yarn_values, length), 1, false, 0, LARGE},
    {"centerU", offsetof(yarn_values, center_u), 1, false, -LARGE, LARGE},
    {"centerV", offsetof(yarn_values, center_v), 1, false, -LARGE, LARGE},
    {"kd", offsetof(yarn_values, kd), 3, false, 0, LARGE},
    {"ks", offsetof(yarn_values, ks), 3, false, 0, LARGE},
};

enum {
    WEAVE_FIELD_COUNT = sizeof weave_fields / sizeof *weave_fields,
    YARN_FIELD_COUNT = sizeof yarn_fields / sizeof *yarn_fields
};

/* Keys that are not numbers follow the fields in the mask of keys seen. */
enum { SEEN_NAME = 1 << WEAVE_FIELD_COUNT, SEEN_PATTERN = SEEN_NAME << 1, SEEN_TYPE = 1 << YARN_FIELD_COUNT };

typedef struct weave_parser {
    weft_block_parser block;
    weft_weave *weave;
    weave_values values;
    size_t cell_count, cell_capacity, yarn_capacity;
    weft_token pattern_at, largest_id_at; /* for messages that must wait for the end of the file */
    int largest_id;
} weave_parser;

static weft_code parse_pattern_cell(weave_parser *parser)
{
    static const weft_block_field id_field = {.key = "yarn id", .count = 1, .low = 1, .high = WEFT_WEAVE_MAX_YARNS};
    weft_token token = parser->block.lexer.token;
    double id = 0;
    WEFT_TRY(weft_block_grow(&parser->block, (void **)&parser->weave->pattern, parser->cell_count,
                             &parser->cell_capacity, sizeof *parser->weave->pattern, MAX_CELLS,
                             "cells in the pattern"));
    if (token.kind == WEFT_TOKEN_NUMBER && token.number != (int)weft_clamp(token.number, 0, WEFT_WEAVE_MAX_YARNS + 1))
        return weft_block_fail(&parser->block, "a yarn id is a whole number from 1 to %d", WEFT_WEAVE_MAX_YARNS);
    WEFT_TRY(weft_block_parse_number(&parser->block, &id_field, &id));
    if (id > parser->largest_id) {
        parser->largest_id = (int)id;
        parser->largest_id_at = token;
    }
    parser->weave->pattern[parser->cell_count++] = (int)id - 1;
    return WEFT_OK;
}

static weft_code parse_pattern(weave_parser *parser, unsigned *seen)
{
    WEFT_TRY(weft_block_mark_seen(&parser->block, seen, SEEN_PATTERN));
    parser->pattern_at = parser->block.lexer.token;
    WEFT_TRY(weft_block_advance(&parser->block));
    WEFT_TRY(weft_block_expect_symbol(&parser->block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_pattern_cell(parser));
        WEFT_TRY(weft_block_next_item(&parser->block, &more));
    }
    return weft_block_expect_symbol(&parser->block, '}');
}

static weft_code parse_yarn_type(weave_parser *parser, bool *warp, unsigned *seen)
{
    WEFT_TRY(weft_block_mark_seen(&parser->block, seen, SEEN_TYPE));
    WEFT_TRY(weft_block_advance(&parser->block));
    WEFT_TRY(weft_block_expect_symbol(&parser->block, '='));
    *warp = weft_token_is_word(&parser->block.lexer.token, "warp");
    if (!*warp && !weft_token_is_word(&parser->block.lexer.token, "weft"))
        return weft_block_unexpected(&parser->block, "'warp' or 'weft'");
    return weft_block_advance(&parser->block);
}

static void store_yarn(weft_yarn *yarn, const yarn_values *values, bool warp)
{
    *yarn = (weft_yarn){.warp = warp, .center_u = (weft_real)values->center_u, .center_v = (weft_real)values->center_v};
    yarn->segment = (weft_segment){.psi = (weft_real)(values->psi_deg * (WEFT_PI / 180)),
                                   .umax = (weft_real)(values->umax_deg * (WEFT_PI / 180)),
                                   .kappa = (weft_real)values->kappa,
                                   .width = (weft_real)values->width,
                                   .length = (weft_real)values->length};
    yarn->kd = (weft_rgb){(weft_real)values->kd[0], (weft_real)values->kd[1], (weft_real)values->kd[2]};
    yarn->ks = (weft_rgb){(weft_real)values->ks[0], (weft_real)values->ks[1], (weft_real)values->ks[2]};
}

static weft_code parse_yarn_item(weave_parser *parser, yarn_values *values, bool *warp, unsigned *seen)
{
    if (weft_token_is_word(&parser->block.lexer.token, "type"))
        return parse_yarn_type(parser, warp, seen);
    const weft_block_field *field = weft_block_find_field(&parser->block, yarn_fields, YARN_FIELD_COUNT);
    if (!field)
        return weft_block_unknown_key(&parser->block);
    return weft_block_parse_field(&parser->block, yarn_fields, field, values, seen);
}

static weft_code parse_yarn(weave_parser *parser)
{
    yarn_values values = {0};
    bool warp = false;
    unsigned seen = 0;
    weft_weave *weave = parser->weave;
    WEFT_TRY(weft_block_grow(&parser->block, (void **)&weave->yarn, (size_t)weave->yarn_count, &parser->yarn_capacity,
                             sizeof *weave->yarn, WEFT_WEAVE_MAX_YARNS, "yarns"));
    WEFT_TRY(weft_block_advance(&parser->block));
    WEFT_TRY(weft_block_expect_symbol(&parser->block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_yarn_item(parser, &values, &warp, &seen));
        WEFT_TRY(weft_block_next_item(&parser->block, &more));
    }
    if (!(seen & SEEN_TYPE))
        return weft_block_fail(&parser->block, "'type' is missing in the block that ends here");
    WEFT_TRY(weft_block_check_complete(&parser->block, yarn_fields, YARN_FIELD_COUNT, seen));
    store_yarn(&weave->yarn[weave->yarn_count++], &values, warp);
    return weft_block_expect_symbol(&parser->block, '}');
}

static weft_code parse_weave_item(weave_parser *parser, unsigned *seen)
{
    const weft_token *token = &parser->block.lexer.token;
    if (weft_token_is_word(token, "name"))
        return weft_block_parse_name(&parser->block, parser->weave->name, sizeof parser->weave->name, seen, SEEN_NAME);
    if (weft_token_is_word(token, "pattern"))
        return parse_pattern(parser, seen);
    if (weft_token_is_word(token, "yarn"))
        return parse_yarn(parser);
    const weft_block_field *field = weft_block_find_field(&parser->block, weave_fields, WEAVE_FIELD_COUNT);
    if (!field)
        return weft_block_unknown_key(&parser->block);
    return weft_block_parse_field(&parser->block, weave_fields, field, &parser->values, seen);
}

static weft_code check_pattern(weave_parser *parser)
{
    const weave_values *values = &parser->values;
    if (values->tile_width != (int)values->tile_width || values->tile_height != (int)values->tile_height)
        return weft_block_fail(&parser->block, "the tile has %g x %g cells, not whole numbers", values->tile_width,
                               values->tile_height);
    size_t wanted = (size_t)values->tile_width * (size_t)values->tile_height;
    if (parser->cell_count != wanted) {
        parser->block.lexer.token = parser->pattern_at;
        return weft_block_fail(&parser->block, "the pattern has %zu cells, the tile %g x %g = %zu", parser->cell_count,
                               values->tile_width, values->tile_height, wanted);
    }
    if (parser->largest_id > parser->weave->yarn_count) {
        parser->block.lexer.token = parser->largest_id_at;
        return weft_block_fail(&parser->block, "yarn %d does not exist, there are only %d", parser->largest_id,
                               parser->weave->yarn_count);
    }
    return WEFT_OK;
}

static weft_code check_layout(weave_parser *parser)
{
    const weft_weave_layout *layout = &parser->values.layout;
    if ((layout->tiles_u > 0) != (layout->tiles_v > 0))
        return weft_block_fail(&parser->block, "tilesU = %g and tilesV = %g: both or neither are above 0",
                               layout->tiles_u, layout->tiles_v);
    if (!(layout->tiles_u > 0) && (layout->corner_u != 0 || layout->corner_v != 0))
        return weft_block_fail(&parser->block, "cornerU and cornerV mean nothing without tilesU and tilesV");
    return WEFT_OK;
}

static void store_values(weft_weave *weave, const weave_values *values)
{
    weave->tile_width = (int)values->tile_width;
    weave->tile_height = (int)values->tile_height;
    weave->warp_area = (weft_real)values->warp_area;
    weave->weft_area = (weft_real)values->weft_area;
    weave->fineness = (weft_real)values->fineness;
    weave->period = (weft_real)values->period;
    weave->cell_pitch_mm = values->cell_pitch_mm;
    weave->layout = values->layout;
    for (int i = 0; i < 4; i++)
        weave->inclination_noise_deg[i] = (weft_real)values->inclination_noise[i];
    for (int i = 0; i < weave->yarn_count; i++) {
        weft_segment *segment = &weave->yarn[i].segment;
        segment->alpha = (weft_real)values->alpha;
        segment->beta = (weft_real)values->beta;
        segment->delta = (weft_real)values->delta;
        segment->highlight_width = (weft_real)values->highlight_width;
        segment->frozen_radius = values->frozen_radius > 0;
    }
}

static weft_code parse_weave(weave_parser *parser)
{
    unsigned seen = 0;
    if (!weft_token_is_word(&parser->block.lexer.token, "weave"))
        return weft_block_unexpected(&parser->block, "'weave'");
    WEFT_TRY(weft_block_advance(&parser->block));
    WEFT_TRY(weft_block_expect_symbol(&parser->block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_weave_item(parser, &seen));
        WEFT_TRY(weft_block_next_item(&parser->block, &more));
    }
    WEFT_TRY(weft_block_check_complete(&parser->block, weave_fields, WEAVE_FIELD_COUNT, seen));
    if (!(seen & SEEN_PATTERN))
        return weft_block_fail(&parser->block, "'pattern' is missing in the block that ends here");
    if (parser->values.frozen_radius != 0 && parser->values.frozen_radius != 1)
        return weft_block_fail(&parser->block, "frozenRadius = %g, must be 0 or 1", parser->values.frozen_radius);
    WEFT_TRY(check_layout(parser));
    WEFT_TRY(check_pattern(parser));
    WEFT_TRY(weft_block_advance(&parser->block));
    if (parser->block.lexer.token.kind != WEFT_TOKEN_END)
        return weft_block_unexpected(&parser->block, "the end of the file");
    store_values(parser->weave, &parser->values);
    return WEFT_OK;
}

weft_code weft_weave_parse_text(const char *text, const char *path, const weft_parameter *parameters,
                                int parameter_count, weft_weave *weave, weft_error *error)
{
    *weave = (weft_weave){0};
    weave_parser parser = {.block = {.error = error, .parameters = parameters, .parameter_count = parameter_count},
                           .weave = weave};
    weft_code code = weft_lexer_start(&parser.block.lexer, text, path, error);
    if (code == WEFT_OK)
        code = parse_weave(&parser);
    weft_lexer_end(&parser.block.lexer);
    if (code != WEFT_OK)
        weft_weave_free(weave);
    return code;
}

void weft_weave_free(weft_weave *weave)
{
    free(weave->pattern);
    free(weave->yarn);
    *weave = (weft_weave){0};
}
