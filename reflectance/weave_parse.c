/* The grammar of a weave file (docs/weave-format.md). Blocks do not nest, so neither does the parser. */
#include "reflectance/weave_lexer.h"
#include "reflectance/weave_syntax.h"

#include <stdlib.h>
#include <string.h>

#define LARGE 1e6

/* Numbers of the weave block, as in the file. */
typedef struct weave_values {
    double tile_width, tile_height, alpha, beta, delta, highlight_width, warp_area, weft_area;
    double inclination_noise[4], fineness, period;
} weave_values;

/* Numbers of a yarn block, as in the file: degrees, tile units. */
typedef struct yarn_values {
    double psi_deg, umax_deg, kappa, width, length, center_u, center_v, kd[3], ks[3];
} yarn_values;

typedef struct weave_field {
    const char *key;
    size_t offset; /* of its first double in the values */
    int count;     /* doubles: 1, or 3 for a colour */
    bool optional; /* 0 where absent */
    double low, high;
} weave_field;

static const weave_field weave_fields[] = {
    {"tileWidth", offsetof(weave_values, tile_width), 1, false, 1, WEAVE_MAX_TILE_SIDE},
    {"tileHeight", offsetof(weave_values, tile_height), 1, false, 1, WEAVE_MAX_TILE_SIDE},
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
};

static const weave_field yarn_fields[] = {
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
    weave_lexer lexer;
    weft_error *error;
    const weft_weave_parameter *parameters;
    int parameter_count;
    weft_weave *weave;
    weave_values values;
    size_t cell_count, cell_capacity, yarn_capacity;
    weave_token pattern_at, largest_id_at; /* for messages that must wait for the end of the file */
    int largest_id;
} weave_parser;

static weft_code advance(weave_parser *parser)
{
    return weave_lexer_advance(&parser->lexer, parser->error);
}

#define fail_here(parser, ...) weave_lexer_fail(&(parser)->lexer, (parser)->error, __VA_ARGS__)

static weft_code unexpected(weave_parser *parser, const char *wanted)
{
    const weave_token *token = &parser->lexer.token;
    if (token->kind == WEAVE_END)
        return fail_here(parser, "expected %s, found the end of the file", wanted);
    return fail_here(parser, "expected %s, found '%.*s'", wanted, weave_token_shown(token), token->text);
}

static weft_code expect_symbol(weave_parser *parser, char symbol)
{
    char wanted[] = {'\'', symbol, '\'', '\0'};
    if (!weave_token_is_symbol(&parser->lexer.token, symbol))
        return unexpected(parser, wanted);
    return advance(parser);
}

/* After an item of a list: consumes ',' and sets *more, or leaves '}' to the caller. */
static weft_code next_item(weave_parser *parser, bool *more)
{
    *more = weave_token_is_symbol(&parser->lexer.token, ',');
    if (*more)
        return advance(parser);
    if (!weave_token_is_symbol(&parser->lexer.token, '}'))
        return unexpected(parser, "',' or '}'");
    return WEFT_OK;
}

static const weft_weave_parameter *find_parameter(const weave_parser *parser)
{
    const weave_token *token = &parser->lexer.token;
    for (int i = 0; i < parser->parameter_count; i++) {
        const char *name = parser->parameters[i].name;
        if (strlen(name) == token->size && memcmp(name, token->text, token->size) == 0)
            return &parser->parameters[i];
    }
    return NULL;
}

static weft_code check_range(weave_parser *parser, const weave_field *field, double value)
{
    if (value >= field->low && value <= field->high)
        return WEFT_OK;
    return fail_here(parser, "%s = %g is outside [%g, %g]", field->key, value, field->low, field->high);
}

static weft_code parse_parameter(weave_parser *parser, const weave_field *field, double *values)
{
    const weft_weave_parameter *parameter = find_parameter(parser);
    const weave_token *token = &parser->lexer.token;
    if (!parameter)
        return fail_here(parser, "no value was given for '$%.*s'", weave_token_shown(token), token->text);
    const double rgb[3] = {parameter->value.r, parameter->value.g, parameter->value.b};
    for (int i = 0; i < 3 && i < field->count; i++) {
        WEFT_TRY(check_range(parser, field, rgb[i]));
        values[i] = rgb[i];
    }
    return advance(parser);
}

static weft_code parse_number(weave_parser *parser, const weave_field *field, double *value)
{
    const weave_token *token = &parser->lexer.token;
    if (token->kind == WEAVE_PARAMETER && field->count == 1)
        return parse_parameter(parser, field, value);
    if (token->kind != WEAVE_NUMBER)
        return unexpected(parser, "a number");
    WEFT_TRY(check_range(parser, field, token->number));
    *value = token->number;
    return advance(parser);
}

static weft_code parse_colour(weave_parser *parser, const weave_field *field, double *rgb)
{
    if (parser->lexer.token.kind == WEAVE_PARAMETER)
        return parse_parameter(parser, field, rgb);
    WEFT_TRY(expect_symbol(parser, '{'));
    for (int i = 0; i < 3; i++) {
        if (i > 0)
            WEFT_TRY(expect_symbol(parser, ','));
        WEFT_TRY(parse_number(parser, field, &rgb[i]));
    }
    return expect_symbol(parser, '}');
}

static weft_code mark_seen(weave_parser *parser, unsigned *seen, unsigned key)
{
    const weave_token *token = &parser->lexer.token;
    if (*seen & key)
        return fail_here(parser, "'%.*s' is given twice", weave_token_shown(token), token->text);
    *seen |= key;
    return WEFT_OK;
}

/* The field named by the current token among `count`, or NULL. */
static const weave_field *find_field(const weave_parser *parser, const weave_field *fields, int count)
{
    for (int i = 0; i < count; i++)
        if (weave_token_is_word(&parser->lexer.token, fields[i].key))
            return &fields[i];
    return NULL;
}

/* key = value, for one of `fields`; the current token is the key. */
static weft_code parse_field(weave_parser *parser, const weave_field *fields, const weave_field *field, void *values,
                             unsigned *seen)
{
    WEFT_TRY(mark_seen(parser, seen, 1u << (field - fields)));
    WEFT_TRY(advance(parser));
    WEFT_TRY(expect_symbol(parser, '='));
    double *into = (double *)(void *)((char *)values + field->offset);
    return field->count == 3 ? parse_colour(parser, field, into) : parse_number(parser, field, into);
}

static weft_code check_complete(weave_parser *parser, const weave_field *fields, int count, unsigned seen)
{
    for (int i = 0; i < count; i++)
        if (!fields[i].optional && !(seen & 1u << i))
            return fail_here(parser, "'%s' is missing in the block that ends here", fields[i].key);
    return WEFT_OK;
}

static weft_code unknown_key(weave_parser *parser)
{
    const weave_token *token = &parser->lexer.token;
    if (token->kind != WEAVE_WORD)
        return unexpected(parser, "a key");
    return fail_here(parser, "unknown key '%.*s'", weave_token_shown(token), token->text);
}

/* Room for one more element; doubles the array. */
static weft_code grow(weave_parser *parser, void **array, size_t count, size_t *capacity, size_t element, size_t limit,
                      const char *what)
{
    if (count < *capacity)
        return WEFT_OK;
    if (count >= limit)
        return fail_here(parser, "more than %zu %s", limit, what);
    size_t wanted = *capacity ? 2 * *capacity : 64;
    void *larger = realloc(*array, wanted * element);
    if (!larger)
        return weft_fail_memory(parser->error, what, wanted * element);
    *array = larger;
    *capacity = wanted;
    return WEFT_OK;
}

static weft_code parse_pattern_cell(weave_parser *parser)
{
    static const weave_field id_field = {.key = "yarn id", .count = 1, .low = 1, .high = WEAVE_MAX_YARNS};
    weave_token token = parser->lexer.token;
    double id = 0;
    WEFT_TRY(grow(parser, (void **)&parser->weave->pattern, parser->cell_count, &parser->cell_capacity,
                  sizeof *parser->weave->pattern, WEAVE_MAX_CELLS, "cells in the pattern"));
    if (token.kind == WEAVE_NUMBER && token.number != (int)weft_clamp(token.number, 0, WEAVE_MAX_YARNS + 1))
        return fail_here(parser, "a yarn id is a whole number from 1 to %d", WEAVE_MAX_YARNS);
    WEFT_TRY(parse_number(parser, &id_field, &id));
    if (id > parser->largest_id) {
        parser->largest_id = (int)id;
        parser->largest_id_at = token;
    }
    parser->weave->pattern[parser->cell_count++] = (int)id - 1;
    return WEFT_OK;
}

static weft_code parse_pattern(weave_parser *parser, unsigned *seen)
{
    WEFT_TRY(mark_seen(parser, seen, SEEN_PATTERN));
    parser->pattern_at = parser->lexer.token;
    WEFT_TRY(advance(parser));
    WEFT_TRY(expect_symbol(parser, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_pattern_cell(parser));
        WEFT_TRY(next_item(parser, &more));
    }
    return expect_symbol(parser, '}');
}

static weft_code parse_name(weave_parser *parser, unsigned *seen)
{
    WEFT_TRY(mark_seen(parser, seen, SEEN_NAME));
    WEFT_TRY(advance(parser));
    WEFT_TRY(expect_symbol(parser, '='));
    const weave_token *token = &parser->lexer.token;
    if (token->kind != WEAVE_STRING)
        return unexpected(parser, "a name in quotes");
    if (token->size >= sizeof parser->weave->name)
        return fail_here(parser, "name of %zu bytes, at most %zu", token->size, sizeof parser->weave->name - 1);
    memcpy(parser->weave->name, token->text, token->size);
    parser->weave->name[token->size] = '\0';
    return advance(parser);
}

static weft_code parse_yarn_type(weave_parser *parser, bool *warp, unsigned *seen)
{
    WEFT_TRY(mark_seen(parser, seen, SEEN_TYPE));
    WEFT_TRY(advance(parser));
    WEFT_TRY(expect_symbol(parser, '='));
    *warp = weave_token_is_word(&parser->lexer.token, "warp");
    if (!*warp && !weave_token_is_word(&parser->lexer.token, "weft"))
        return unexpected(parser, "'warp' or 'weft'");
    return advance(parser);
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
    if (weave_token_is_word(&parser->lexer.token, "type"))
        return parse_yarn_type(parser, warp, seen);
    const weave_field *field = find_field(parser, yarn_fields, YARN_FIELD_COUNT);
    if (!field)
        return unknown_key(parser);
    return parse_field(parser, yarn_fields, field, values, seen);
}

static weft_code parse_yarn(weave_parser *parser)
{
    yarn_values values = {0};
    bool warp = false;
    unsigned seen = 0;
    weft_weave *weave = parser->weave;
    WEFT_TRY(grow(parser, (void **)&weave->yarn, (size_t)weave->yarn_count, &parser->yarn_capacity, sizeof *weave->yarn,
                  WEAVE_MAX_YARNS, "yarns"));
    WEFT_TRY(advance(parser));
    WEFT_TRY(expect_symbol(parser, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_yarn_item(parser, &values, &warp, &seen));
        WEFT_TRY(next_item(parser, &more));
    }
    if (!(seen & SEEN_TYPE))
        return fail_here(parser, "'type' is missing in the block that ends here");
    WEFT_TRY(check_complete(parser, yarn_fields, YARN_FIELD_COUNT, seen));
    store_yarn(&weave->yarn[weave->yarn_count++], &values, warp);
    return expect_symbol(parser, '}');
}

static weft_code parse_weave_item(weave_parser *parser, unsigned *seen)
{
    const weave_token *token = &parser->lexer.token;
    if (weave_token_is_word(token, "name"))
        return parse_name(parser, seen);
    if (weave_token_is_word(token, "pattern"))
        return parse_pattern(parser, seen);
    if (weave_token_is_word(token, "yarn"))
        return parse_yarn(parser);
    const weave_field *field = find_field(parser, weave_fields, WEAVE_FIELD_COUNT);
    if (!field)
        return unknown_key(parser);
    return parse_field(parser, weave_fields, field, &parser->values, seen);
}

static weft_code check_pattern(weave_parser *parser)
{
    const weave_values *values = &parser->values;
    if (values->tile_width != (int)values->tile_width || values->tile_height != (int)values->tile_height)
        return fail_here(parser, "the tile has %g x %g cells, not whole numbers", values->tile_width,
                         values->tile_height);
    size_t wanted = (size_t)values->tile_width * (size_t)values->tile_height;
    if (parser->cell_count != wanted) {
        parser->lexer.token = parser->pattern_at;
        return fail_here(parser, "the pattern has %zu cells, the tile %g x %g = %zu", parser->cell_count,
                         values->tile_width, values->tile_height, wanted);
    }
    if (parser->largest_id > parser->weave->yarn_count) {
        parser->lexer.token = parser->largest_id_at;
        return fail_here(parser, "yarn %d does not exist, there are only %d", parser->largest_id,
                         parser->weave->yarn_count);
    }
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
    for (int i = 0; i < 4; i++)
        weave->inclination_noise_deg[i] = (weft_real)values->inclination_noise[i];
    for (int i = 0; i < weave->yarn_count; i++) {
        weft_segment *segment = &weave->yarn[i].segment;
        segment->alpha = (weft_real)values->alpha;
        segment->beta = (weft_real)values->beta;
        segment->delta = (weft_real)values->delta;
        segment->highlight_width = (weft_real)values->highlight_width;
    }
}

static weft_code parse_weave(weave_parser *parser)
{
    unsigned seen = 0;
    if (!weave_token_is_word(&parser->lexer.token, "weave"))
        return unexpected(parser, "'weave'");
    WEFT_TRY(advance(parser));
    WEFT_TRY(expect_symbol(parser, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_weave_item(parser, &seen));
        WEFT_TRY(next_item(parser, &more));
    }
    WEFT_TRY(check_complete(parser, weave_fields, WEAVE_FIELD_COUNT, seen));
    if (!(seen & SEEN_PATTERN))
        return fail_here(parser, "'pattern' is missing in the block that ends here");
    WEFT_TRY(check_pattern(parser));
    WEFT_TRY(advance(parser));
    if (parser->lexer.token.kind != WEAVE_END)
        return unexpected(parser, "the end of the file");
    store_values(parser->weave, &parser->values);
    return WEFT_OK;
}

weft_code weave_parse_text(const char *text, const char *path, const weft_weave_parameter *parameters,
                           int parameter_count, weft_weave *weave, weft_error *error)
{
    *weave = (weft_weave){0};
    weave_parser parser = {
        .error = error, .parameters = parameters, .parameter_count = parameter_count, .weave = weave};
    weft_code code = weave_lexer_start(&parser.lexer, text, path, error);
    if (code == WEFT_OK)
        code = parse_weave(&parser);
    weave_lexer_end(&parser.lexer);
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
