/* The grammar of a microcylinder file (docs/reference/microcylinder-format.md), made of the blocks of weave files. */
#include "base/text/block_parser.h"
#include "base/text/text_file.h"
#include "btf/direction/direction.h"
#include "reflectance/microcylinder/file.h"

#include <stdlib.h>

/* Numbers of a block as in the file: degrees. */
typedef struct cloth_values {
    double sigma_deg;
} cloth_values;

typedef struct thread_values {
    double samples, eta, gamma_s_deg, gamma_v_deg, kd, albedo[3], area;
} thread_values;

static const weft_block_field cloth_fields[] = {{"sigma", offsetof(cloth_values, sigma_deg), 1, false, 0.01, 1000}};

static const weft_block_field thread_fields[] = {
    {"samples", offsetof(thread_values, samples), 1, false, 1, WEFT_THREAD_MAX_SAMPLES},
    {"eta", offsetof(thread_values, eta), 1, false, 0.1, 100},
    {"gammaS", offsetof(thread_values, gamma_s_deg), 1, false, 0.01, 1000},
    {"gammaV", offsetof(thread_values, gamma_v_deg), 1, false, 0.01, 1000},
    {"kd", offsetof(thread_values, kd), 1, false, 0, 1},
    {"albedo", offsetof(thread_values, albedo), 3, false, 0, WEFT_THREAD_MAX_PARAMETER},
    {"area", offsetof(thread_values, area), 1, false, 0, 1},
};

static const weft_block_field tilt_field = {.key = "tilt", .count = 1, .low = -90, .high = 90};
static const weft_block_field length_field = {.key = "length", .count = 1, .low = 0, .high = 100};

enum {
    CLOTH_FIELD_COUNT = sizeof cloth_fields / sizeof *cloth_fields,
    THREAD_FIELD_COUNT = sizeof thread_fields / sizeof *thread_fields,
    SEEN_NAME = 1 << CLOTH_FIELD_COUNT,
    SEEN_AXIS = 1 << THREAD_FIELD_COUNT,
    SEEN_TILTS = SEEN_AXIS << 1,
    SEEN_LENGTHS = SEEN_TILTS << 1
};

typedef struct cloth_parser {
    weft_block_parser block;
    weft_microcylinder_description *description;
    int thread_count;
} cloth_parser;

/* key { number, ... } */
static weft_code parse_list(weft_block_parser *block, const weft_block_field *field,
                            weft_real list[WEFT_THREAD_MAX_POINTS], int *count)
{
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '{'));
    for (bool more = true; more;) {
        double value;
        if (*count == WEFT_THREAD_MAX_POINTS)
            return weft_block_fail(block, "more than %d control points", WEFT_THREAD_MAX_POINTS);
        WEFT_TRY(weft_block_parse_number(block, field, &value));
        list[(*count)++] = (weft_real)value;
        WEFT_TRY(weft_block_next_item(block, &more));
    }
    return weft_block_expect_symbol(block, '}');
}

static weft_code parse_axis(weft_block_parser *block, weft_thread_axis *axis)
{
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '='));
    bool y = weft_token_is_word(&block->lexer.token, "y");
    if (!y && !weft_token_is_word(&block->lexer.token, "x"))
        return weft_block_unexpected(block, "'x' or 'y'");
    *axis = y ? WEFT_AXIS_Y : WEFT_AXIS_X;
    return weft_block_advance(block);
}

static weft_code parse_thread_item(weft_block_parser *block, weft_cloth_thread *thread, thread_values *values,
                                   int *pieces, unsigned *seen)
{
    const weft_token *token = &block->lexer.token;
    const weft_block_field *field = weft_block_find_field(block, thread_fields, THREAD_FIELD_COUNT);
    if (field)
        return weft_block_parse_field(block, thread_fields, field, values, seen);
    if (weft_token_is_word(token, "axis")) {
        WEFT_TRY(weft_block_mark_seen(block, seen, SEEN_AXIS));
        return parse_axis(block, &thread->axis);
    }
    if (weft_token_is_word(token, "tilts")) {
        WEFT_TRY(weft_block_mark_seen(block, seen, SEEN_TILTS));
        return parse_list(block, &tilt_field, thread->tilt_rad, &thread->point_count);
    }
    if (weft_token_is_word(token, "lengths")) {
        WEFT_TRY(weft_block_mark_seen(block, seen, SEEN_LENGTHS));
        return parse_list(block, &length_field, thread->piece_length, pieces);
    }
    return weft_block_unknown_key(block);
}

static void store_thread(weft_cloth_thread *thread, const thread_values *values)
{
    for (int i = 0; i < thread->point_count; i++)
        thread->tilt_rad[i] = weft_rad_of_deg(thread->tilt_rad[i]);
    thread->sample_count = (int)values->samples;
    thread->area_share = (weft_real)values->area;
    thread->optics = (weft_thread_optics){
        .eta = (weft_real)values->eta,
        .gamma_s = weft_rad_of_deg((weft_real)values->gamma_s_deg),
        .gamma_v = weft_rad_of_deg((weft_real)values->gamma_v_deg),
        .kd = (weft_real)values->kd,
        .albedo = {(weft_real)values->albedo[0], (weft_real)values->albedo[1], (weft_real)values->albedo[2]}};
}

static weft_code check_thread(weft_block_parser *block, const weft_cloth_thread *thread, const thread_values *values,
                              int pieces, unsigned seen)
{
    WEFT_TRY(weft_block_check_complete(block, thread_fields, THREAD_FIELD_COUNT, seen));
    if (!(seen & SEEN_AXIS))
        return weft_block_fail(block, "'axis' is missing in the block that ends here");
    if (thread->point_count < 2 || pieces != thread->point_count - 1)
        return weft_block_fail(block,
                               "%d tilts and %d lengths: there must be 2 tilts at least and a length between each two",
                               thread->point_count, pieces);
    if (values->samples != (int)values->samples)
        return weft_block_fail(block, "samples = %g is no whole number", values->samples);
    return WEFT_OK;
}

static weft_code parse_thread(cloth_parser *parser)
{
    weft_block_parser *block = &parser->block;
    thread_values values = {0};
    unsigned seen = 0;
    int pieces = 0;
    if (parser->thread_count == WEFT_CLOTH_THREADS)
        return weft_block_fail(block, "a cloth has %d threads", WEFT_CLOTH_THREADS);
    weft_cloth_thread *thread = &parser->description->cloth.thread[parser->thread_count++];
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_thread_item(block, thread, &values, &pieces, &seen));
        WEFT_TRY(weft_block_next_item(block, &more));
    }
    WEFT_TRY(check_thread(block, thread, &values, pieces, seen));
    store_thread(thread, &values);
    return weft_block_expect_symbol(block, '}');
}

static weft_code parse_item(cloth_parser *parser, cloth_values *values, unsigned *seen)
{
    weft_block_parser *block = &parser->block;
    weft_microcylinder_description *description = parser->description;
    if (weft_token_is_word(&block->lexer.token, "name"))
        return weft_block_parse_name(block, description->name, sizeof description->name, seen, SEEN_NAME);
    if (weft_token_is_word(&block->lexer.token, "thread"))
        return parse_thread(parser);
    const weft_block_field *field = weft_block_find_field(block, cloth_fields, CLOTH_FIELD_COUNT);
    if (!field)
        return weft_block_unknown_key(block);
    return weft_block_parse_field(block, cloth_fields, field, values, seen);
}

/* The current token is the '}' that closes the cloth. */
static weft_code check_cloth(cloth_parser *parser)
{
    const weft_microcylinder_cloth *cloth = &parser->description->cloth;
    double area = cloth->thread[0].area_share + cloth->thread[1].area_share;
    if (parser->thread_count != WEFT_CLOTH_THREADS)
        return weft_block_fail(&parser->block, "a cloth has %d threads, this one %d", WEFT_CLOTH_THREADS,
                               parser->thread_count);
    if (!weft_microcylinder_admissible(cloth))
        return weft_block_fail(&parser->block,
                               "the model has no such cloth: areas that sum to %g, or threads of no length", area);
    return WEFT_OK;
}

static weft_code parse_cloth(cloth_parser *parser)
{
    weft_block_parser *block = &parser->block;
    cloth_values values = {0};
    unsigned seen = 0;
    if (!weft_token_is_word(&block->lexer.token, "microcylinder"))
        return weft_block_unexpected(block, "'microcylinder'");
    WEFT_TRY(weft_block_advance(block));
    WEFT_TRY(weft_block_expect_symbol(block, '{'));
    for (bool more = true; more;) {
        WEFT_TRY(parse_item(parser, &values, &seen));
        WEFT_TRY(weft_block_next_item(block, &more));
    }
    WEFT_TRY(weft_block_check_complete(block, cloth_fields, CLOTH_FIELD_COUNT, seen));
    parser->description->cloth.sigma = weft_rad_of_deg((weft_real)values.sigma_deg);
    WEFT_TRY(check_cloth(parser));
    WEFT_TRY(weft_block_advance(block));
    return block->lexer.token.kind == WEFT_TOKEN_END ? WEFT_OK : weft_block_unexpected(block, "the end of the file");
}

weft_code weft_microcylinder_parse(const char *text, const char *path, const weft_parameter *parameters,
                                   int parameter_count, weft_microcylinder_description *description, weft_error *error)
{
    *description = (weft_microcylinder_description){0};
    cloth_parser parser = {.block = {.error = error, .parameters = parameters, .parameter_count = parameter_count},
                           .description = description};
    weft_code code = weft_lexer_start(&parser.block.lexer, text, path, error);
    if (code == WEFT_OK)
        code = parse_cloth(&parser);
    weft_lexer_end(&parser.block.lexer);
    return code;
}

weft_code weft_microcylinder_read(const char *path, const weft_parameter *parameters, int parameter_count,
                                  weft_microcylinder_description *description, weft_error *error)
{
    char *text;
    WEFT_TRY(weft_text_file_read(path, &text, error));
    weft_code code = weft_microcylinder_parse(text, path, parameters, parameter_count, description, error);
    free(text);
    return code;
}
