/* The grammar of a stitch file (docs/reference/stitch-format.md). */
#include "base/text/block_parser.h"
#include "base/text/text_file.h"
#include "geometry/stitch/segment_grid.h"

#include <stdlib.h>
#include <string.h>

#define MAX_TILE_MM 1000.0
#define MAX_PLACE_MM 4000.0
#define MAX_TWIST 1e3
#define PERIOD_TOLERANCE 1e-6 /* of a tile */

/* Numbers of the stitch block, as in the file. */
typedef struct stitch_values {
    double tile[2], resolution, blend;
} stitch_values;

/* Numbers of a yarn block, as in the file. */
typedef struct yarn_values {
    double radius[2], plies, twist, fibre_twist, diffuse[3], specular[3], highlight_deg, refractive_index;
} yarn_values;

static const weft_block_field stitch_fields[] = {
    {"tile", offsetof(stitch_values, tile), 2, false, 1e-3, MAX_TILE_MM},
    {"resolution", offsetof(stitch_values, resolution), 1, false, 4, 1024},
    {"blend", offsetof(stitch_values, blend), 1, true, 0, MAX_TILE_MM},
};

static const weft_block_field yarn_fields[] = {
    {"radius", offsetof(yarn_values, radius), 2, false, 0, MAX_TILE_MM},
    {"plies", offsetof(yarn_values, plies), 1, true, 1, WEFT_STITCH_MAX_PLIES},
    {"twist", offsetof(yarn_values, twist), 1, true, -MAX_TWIST, MAX_TWIST},
    {"fibreTwist", offsetof(yarn_values, fibre_twist), 1, true, -MAX_TWIST, MAX_TWIST},
    {"diffuse", offsetof(yarn_values, diffuse), 3, false, 0, 1},
    {"specular", offsetof(yarn_values, specular), 3, true, 0, 1},
    {"highlight", offsetof(yarn_values, highlight_deg), 1, true, 1, 60},
    {"index", offsetof(yarn_values, refractive_index), 1, true, 1.01, 3},
};

enum {
    STITCH_FIELD_COUNT = sizeof stitch_fields / sizeof *stitch_fields,
    YARN_FIELD_COUNT = sizeof yarn_fields / sizeof *yarn_fields
};

/* Keys that are not numbers follow the fields in the mask of keys seen. */
enum { SEEN_NAME = 1 << STITCH_FIELD_COUNT, SEEN_POINTS = 1 << YARN_FIELD_COUNT, SEEN_COPIES = SEEN_POINTS << 1 };

typedef struct stitch_parser {
    weft_block_parser block;
    weft_stitch *stitch;
    stitch_values values;
    size_t yarn_capacity, point_total, copy_total;
} stitch_parser;

static weft_code parse_place(stitch_parser *parser, weft_vec3 *place)
{
    static const weft_block_field field = {.key = "coordinate", .count = 3, .low = -MAX_PLACE_MM, .high = MAX_PLACE_MM};
    double at[3];
    WEFT_TRY(weft_block_parse_value(&parser->block, &field, at));
    *place = weft_vec3_of(at[0], at[1], at[2]);
    return WEFT_OK;
}

static weft_code parse_point(stitch_parser *parser, weft_stitch_yarn *yarn, size_t capacity[2])
{
    weft_block_parser *block = &parser->block;
    size_t count = (size_t)yarn->point_count;
    if (parser->point_total++ >= WEFT_STITCH_MAX_POINTS)
        return weft_block_fail(block, "more than %d control points", WEFT_STITCH_MAX_POINTS);
    WEFT_TRY(weft_block_grow(block, (void **)&yarn->point, count, &capacity[0], sizeof *yarn->point,
                             WEFT_STITCH_MAX_POINTS, "control points"));
    WEFT_TRY(weft_block_grow(block, (void **)&yarn->place, count, &capacity[1], sizeof *yarn->place,
                             WEFT_STITCH_MAX_POINTS, "control points"));
    yarn->place[count] = (weft_text_place){block->lexer.token.line, block->lexer.token.column};
    WEFT_TRY(parse_place(parser, &yarn->point[count]));
    yarn->point_count++;
    return WEFT_OK;
}

static weft_code parse_points(stitch_parser *parser, weft_stitch_yarn *yarn, unsigned *seen)
{
    weft_block_parser *block = &parser->block;
    size_t capacity[2] = {0};
    WEFT_TRY(weft_block_mark_seen(block, seen, SEEN_POINTS));
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_point(parser, yarn, capacity));
        WEFT_TRY(weft_block_next_item(block, &more));
    }
    return weft_block_expect_symbol(block, '}');
}

static weft_code parse_copy(stitch_parser *parser, weft_stitch_yarn *yarn, size_t *capacity)
{
    if (parser->copy_total++ >= WEFT_STITCH_MAX_COPIES)
        return weft_block_fail(&parser->block, "more than %d copies", WEFT_STITCH_MAX_COPIES);
    WEFT_TRY(weft_block_grow(&parser->block, (void **)&yarn->copy, (size_t)yarn->copy_count, capacity,
                             sizeof *yarn->copy, WEFT_STITCH_MAX_COPIES, "copies"));
    WEFT_TRY(parse_place(parser, &yarn->copy[yarn->copy_count]));
    yarn->copy_count++;
    return WEFT_OK;
}

static weft_code parse_copies(stitch_parser *parser, weft_stitch_yarn *yarn, unsigned *seen)
{
    weft_block_parser *block = &parser->block;
    size_t capacity = 0;
    WEFT_TRY(weft_block_mark_seen(block, seen, SEEN_COPIES));
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_copy(parser, yarn, &capacity));
        WEFT_TRY(weft_block_next_item(block, &more));
    }
    return weft_block_expect_symbol(block, '}');
}

static weft_code parse_yarn_item(stitch_parser *parser, weft_stitch_yarn *yarn, yarn_values *values, unsigned *seen)
{
    weft_block_parser *block = &parser->block;
    if (weft_token_is_word(&block->lexer.token, "points"))
        return parse_points(parser, yarn, seen);
    if (weft_token_is_word(&block->lexer.token, "copies"))
        return parse_copies(parser, yarn, seen);
    const weft_block_field *field = weft_block_find_field(block, yarn_fields, YARN_FIELD_COUNT);
    if (!field)
        return weft_block_unknown_key(block);
    return weft_block_parse_field(block, yarn_fields, field, values, seen);
}

/* At the end of the block: what a single key cannot tell. */
static weft_code check_yarn(stitch_parser *parser, const weft_stitch_yarn *yarn, const yarn_values *values,
                            unsigned seen)
{
    weft_block_parser *block = &parser->block;
    WEFT_TRY(weft_block_check_complete(block, yarn_fields, YARN_FIELD_COUNT, seen));
    if (!(seen & SEEN_POINTS))
        return weft_block_fail(block, "'points' is missing in the block that ends here");
    if (yarn->point_count < 2)
        return weft_block_fail(block, "the yarn that ends here has 1 control point, at least 2 are needed");
    if (!(values->radius[0] > 0 && values->radius[1] > 0))
        return weft_block_fail(block, "the radius of the yarn that ends here is zero");
    if (values->plies != (int)values->plies)
        return weft_block_fail(block, "the yarn that ends here has %g plies, not a whole number", values->plies);
    for (int i = 0; i < 3; i++)
        if (values->diffuse[i] + values->specular[i] > 1)
            return weft_block_fail(block,
                                   "diffuse + specular of the yarn that ends here is %g, at most 1 can be reflected",
                                   values->diffuse[i] + values->specular[i]);
    return WEFT_OK;
}

static void store_yarn(weft_stitch_yarn *yarn, const yarn_values *values)
{
    yarn->radius_side = values->radius[0];
    yarn->radius_up = values->radius[1];
    yarn->plies = (int)values->plies;
    yarn->twist = values->twist;
    yarn->fibre_twist = values->fibre_twist;
    yarn->fibre = (weft_fibre){.diffuse = {values->diffuse[0], values->diffuse[1], values->diffuse[2]},
                               .specular = {values->specular[0], values->specular[1], values->specular[2]},
                               .highlight_rad = values->highlight_deg * (WEFT_PI / 180),
                               .refractive_index = values->refractive_index};
}

/* A yarn without a list of copies is there once. */
static weft_code add_copy_in_place(stitch_parser *parser, weft_stitch_yarn *yarn)
{
    size_t capacity = 0;
    if (yarn->copy_count > 0)
        return WEFT_OK;
    parser->copy_total++;
    WEFT_TRY(weft_block_grow(&parser->block, (void **)&yarn->copy, 0, &capacity, sizeof *yarn->copy,
                             WEFT_STITCH_MAX_COPIES, "copies"));
    yarn->copy[yarn->copy_count++] = (weft_vec3){0};
    return WEFT_OK;
}

static weft_code parse_yarn(stitch_parser *parser)
{
    yarn_values values = {.plies = 1, .highlight_deg = 15, .refractive_index = 1.55};
    unsigned seen = 0;
    weft_block_parser *block = &parser->block;
    weft_stitch *stitch = parser->stitch;
    WEFT_TRY(weft_block_grow(block, (void **)&stitch->yarn, (size_t)stitch->yarn_count, &parser->yarn_capacity,
                             sizeof *stitch->yarn, WEFT_STITCH_MAX_YARNS, "yarns"));
    weft_stitch_yarn *yarn = &stitch->yarn[stitch->yarn_count++];
    *yarn = (weft_stitch_yarn){0};
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_yarn_item(parser, yarn, &values, &seen));
        WEFT_TRY(weft_block_next_item(block, &more));
    }
    WEFT_TRY(check_yarn(parser, yarn, &values, seen));
    WEFT_TRY(add_copy_in_place(parser, yarn));
    store_yarn(yarn, &values);
    return weft_block_expect_symbol(block, '}');
}

static weft_code parse_stitch_item(stitch_parser *parser, unsigned *seen)
{
    weft_block_parser *block = &parser->block;
    if (weft_token_is_word(&block->lexer.token, "name"))
        return weft_block_parse_name(block, parser->stitch->name, sizeof parser->stitch->name, seen, SEEN_NAME);
    if (weft_token_is_word(&block->lexer.token, "yarn"))
        return parse_yarn(parser);
    const weft_block_field *field = weft_block_find_field(block, stitch_fields, STITCH_FIELD_COUNT);
    if (!field)
        return weft_block_unknown_key(block);
    return weft_block_parse_field(block, stitch_fields, field, &parser->values, seen);
}

/* Points the next message at a control point. */
static void point_at(stitch_parser *parser, const weft_stitch_yarn *yarn, int point)
{
    parser->block.lexer.token.line = yarn->place[point].line;
    parser->block.lexer.token.column = yarn->place[point].column;
}

static weft_code check_period(stitch_parser *parser, weft_stitch_yarn *yarn)
{
    const stitch_values *values = &parser->values;
    int last = yarn->point_count - 1;
    weft_vec3 step = weft_subtract(yarn->point[last], yarn->point[0]);
    double x = step.x / values->tile[0], y = step.y / values->tile[1];
    point_at(parser, yarn, last);
    if (fabs(x - round(x)) > PERIOD_TOLERANCE || fabs(y - round(y)) > PERIOD_TOLERANCE || step.z != 0)
        return weft_block_fail(
            &parser->block,
            "the yarn is not periodic: from its first to its last point it goes (%g, %g, %g) mm, not whole "
            "tiles of %g x %g mm",
            step.x, step.y, step.z, values->tile[0], values->tile[1]);
    yarn->tiles_x = (int)round(x);
    yarn->tiles_y = (int)round(y);
    for (int i = 0; i < last; i++) {
        point_at(parser, yarn, i + 1);
        if (!(weft_length(weft_subtract(yarn->point[i + 1], yarn->point[i])) > 1e-6 * values->tile[0]))
            return weft_block_fail(&parser->block, "two control points in one place");
    }
    return WEFT_OK;
}

static weft_code check_thickness(stitch_parser *parser, const weft_stitch_yarn *yarn)
{
    double cell = parser->values.tile[0] / parser->values.resolution;
    double radius = fmin(yarn->radius_side, yarn->radius_up);
    point_at(parser, yarn, 0);
    if (radius < 1.5 * cell)
        return weft_block_fail(
            &parser->block,
            "the radius %g mm of this yarn is less than 1.5 cells of %g mm: a higher resolution is needed", radius,
            cell);
    return WEFT_OK;
}

static weft_code check_stitch(stitch_parser *parser)
{
    weft_stitch *stitch = parser->stitch;
    const stitch_values *values = &parser->values;
    if (values->resolution != (int)values->resolution)
        return weft_block_fail(&parser->block, "resolution is %g, not a whole number", values->resolution);
    if (stitch->yarn_count == 0)
        return weft_block_fail(&parser->block, "there is no yarn");
    stitch->width = values->tile[0];
    stitch->height = values->tile[1];
    stitch->resolution = (int)values->resolution;
    stitch->blend = values->blend;
    for (int i = 0; i < stitch->yarn_count; i++) {
        WEFT_TRY(check_period(parser, &stitch->yarn[i]));
        WEFT_TRY(check_thickness(parser, &stitch->yarn[i]));
    }
    return WEFT_OK;
}

static weft_code parse_stitch(stitch_parser *parser)
{
    unsigned seen = 0;
    weft_block_parser *block = &parser->block;
    if (!weft_token_is_word(&block->lexer.token, "stitch"))
        return weft_block_unexpected(block, "'stitch'");
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_stitch_item(parser, &seen));
        WEFT_TRY(weft_block_next_item(block, &more));
    }
    WEFT_TRY(weft_block_check_complete(block, stitch_fields, STITCH_FIELD_COUNT, seen));
    WEFT_TRY(weft_block_advance(block));
    if (block->lexer.token.kind != WEFT_TOKEN_END)
        return weft_block_unexpected(block, "the end of the file");
    return check_stitch(parser);
}

weft_code weft_stitch_parse(const char *text, const char *path, weft_stitch *stitch, weft_error *error)
{
    *stitch = (weft_stitch){0};
    stitch_parser parser = {.block = {.error = error}, .stitch = stitch};
    weft_code code = weft_lexer_start(&parser.block.lexer, text, path, error);
    if (code == WEFT_OK)
        code = parse_stitch(&parser);
    weft_lexer_end(&parser.block.lexer);
    if (code == WEFT_OK)
        code = weft_stitch_check(stitch, path, error);
    if (code != WEFT_OK)
        weft_stitch_free(stitch);
    return code;
}

weft_code weft_stitch_read(const char *path, weft_stitch *stitch, weft_error *error)
{
    char *text;
    *stitch = (weft_stitch){0};
    WEFT_TRY(weft_text_file_read(path, &text, error));
    weft_code code = weft_stitch_parse(text, path, stitch, error);
    free(text);
    return code;
}

void weft_stitch_free(weft_stitch *stitch)
{
    for (int i = 0; i < stitch->yarn_count; i++) {
        free(stitch->yarn[i].point);
        free(stitch->yarn[i].place);
        free(stitch->yarn[i].copy);
    }
    free(stitch->yarn);
    *stitch = (weft_stitch){0};
}
