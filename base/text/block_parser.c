/* Blocks of key = value, the part that weave and stitch files share. */
#include "base/text/block_parser.h"

#include <stdlib.h>
#include <string.h>

weft_code weft_block_advance(weft_block_parser *parser)
{
    return weft_lexer_advance(&parser->lexer, parser->error);
}

weft_code weft_block_unexpected(weft_block_parser *parser, const char *wanted)
{
    const weft_token *token = &parser->lexer.token;
    if (token->kind == WEFT_TOKEN_END)
        return weft_block_fail(parser, "expected %s, found the end of the file", wanted);
    return weft_block_fail(parser, "expected %s, found '%.*s'", wanted, weft_token_shown(token), token->text);
}

weft_code weft_block_expect_symbol(weft_block_parser *parser, char symbol)
{
    char wanted[] = {'\'', symbol, '\'', '\0'};
    if (!weft_token_is_symbol(&parser->lexer.token, symbol))
        return weft_block_unexpected(parser, wanted);
    return weft_block_advance(parser);
}

weft_code weft_block_next_item(weft_block_parser *parser, bool *more)
{
    *more = weft_token_is_symbol(&parser->lexer.token, ',');
    if (*more)
        return weft_block_advance(parser);
    if (!weft_token_is_symbol(&parser->lexer.token, '}'))
        return weft_block_unexpected(parser, "',' or '}'");
    return WEFT_OK;
}

static const weft_parameter *find_parameter(const weft_block_parser *parser)
{
    const weft_token *token = &parser->lexer.token;
    for (int i = 0; i < parser->parameter_count; i++) {
        const char *name = parser->parameters[i].name;
        if (strlen(name) == token->size && memcmp(name, token->text, token->size) == 0)
            return &parser->parameters[i];
    }
    return NULL;
}

static weft_code check_range(weft_block_parser *parser, const weft_block_field *field, double value)
{
    if (value >= field->low && value <= field->high)
        return WEFT_OK;
    return weft_block_fail(parser, "%s = %g is outside [%g, %g]", field->key, value, field->low, field->high);
}

static weft_code parse_parameter(weft_block_parser *parser, const weft_block_field *field, double *values)
{
    const weft_parameter *parameter = find_parameter(parser);
    const weft_token *token = &parser->lexer.token;
    if (!parameter)
        return weft_block_fail(parser, "no value was given for '$%.*s'", weft_token_shown(token), token->text);
    const double rgb[3] = {parameter->value.r, parameter->value.g, parameter->value.b};
    for (int i = 0; i < 3 && i < field->count; i++) {
        WEFT_TRY(check_range(parser, field, rgb[i]));
        values[i] = rgb[i];
    }
    return weft_block_advance(parser);
}

weft_code weft_block_parse_number(weft_block_parser *parser, const weft_block_field *field, double *value)
{
    const weft_token *token = &parser->lexer.token;
    if (token->kind == WEFT_TOKEN_PARAMETER && field->count == 1)
        return parse_parameter(parser, field, value);
    if (token->kind != WEFT_TOKEN_NUMBER)
        return weft_block_unexpected(parser, "a number");
    WEFT_TRY(check_range(parser, field, token->number));
    *value = token->number;
    return weft_block_advance(parser);
}

static weft_code parse_list(weft_block_parser *parser, const weft_block_field *field, double *values)
{
    weft_block_field element = *field;
    element.count = 1;
    WEFT_TRY(weft_block_expect_symbol(parser, '{'));
    for (int i = 0; i < field->count; i++) {
        if (i > 0)
            WEFT_TRY(weft_block_expect_symbol(parser, ','));
        WEFT_TRY(weft_block_parse_number(parser, &element, &values[i]));
    }
    return weft_block_expect_symbol(parser, '}');
}

weft_code weft_block_parse_value(weft_block_parser *parser, const weft_block_field *field, double *value)
{
    const weft_token *token = &parser->lexer.token;
    if (field->count == 1)
        return weft_block_parse_number(parser, field, value);
    if (field->count == 3 && token->kind == WEFT_TOKEN_PARAMETER)
        return parse_parameter(parser, field, value);
    if (field->count != 2 || token->kind != WEFT_TOKEN_NUMBER)
        return parse_list(parser, field, value);
    WEFT_TRY(weft_block_parse_number(parser, field, &value[0]));
    value[1] = value[0];
    return WEFT_OK;
}

weft_code weft_block_mark_seen(weft_block_parser *parser, unsigned *seen, unsigned key)
{
    const weft_token *token = &parser->lexer.token;
    if (*seen & key)
        return weft_block_fail(parser, "'%.*s' is given twice", weft_token_shown(token), token->text);
    *seen |= key;
    return WEFT_OK;
}

const weft_block_field *weft_block_find_field(const weft_block_parser *parser, const weft_block_field *fields,
                                              int count)
{
    for (int i = 0; i < count; i++)
        if (weft_token_is_word(&parser->lexer.token, fields[i].key))
            return &fields[i];
    return NULL;
}

weft_code weft_block_parse_field(weft_block_parser *parser, const weft_block_field *fields,
                                 const weft_block_field *field, void *values, unsigned *seen)
{
    WEFT_TRY(weft_block_mark_seen(parser, seen, 1u << (field - fields)));
    WEFT_TRY(weft_block_advance(parser));
    WEFT_TRY(weft_block_expect_symbol(parser, '='));
    double *into = (double *)(void *)((char *)values + field->offset);
    return weft_block_parse_value(parser, field, into);
}

weft_code weft_block_check_complete(weft_block_parser *parser, const weft_block_field *fields, int count, unsigned seen)
{
    for (int i = 0; i < count; i++)
        if (!fields[i].optional && !(seen & 1u << i))
            return weft_block_fail(parser, "'%s' is missing in the block that ends here", fields[i].key);
    return WEFT_OK;
}

weft_code weft_block_unknown_key(weft_block_parser *parser)
{
    const weft_token *token = &parser->lexer.token;
    if (token->kind != WEFT_TOKEN_WORD)
        return weft_block_unexpected(parser, "a key");
    return weft_block_fail(parser, "unknown key '%.*s'", weft_token_shown(token), token->text);
}

weft_code weft_block_grow(weft_block_parser *parser, void **array, size_t count, size_t *capacity, size_t element,
                          size_t limit, const char *what)
{
    if (count < *capacity)
        return WEFT_OK;
    if (count >= limit)
        return weft_block_fail(parser, "more than %zu %s", limit, what);
    size_t wanted = *capacity ? 2 * *capacity : 64;
    void *larger = realloc(*array, wanted * element);
    if (!larger)
        return weft_fail_memory(parser->error, what, wanted * element);
    *array = larger;
    *capacity = wanted;
    return WEFT_OK;
}

weft_code weft_block_parse_name(weft_block_parser *parser, char *name, size_t size, unsigned *seen, unsigned key)
{
    WEFT_TRY(weft_block_mark_seen(parser, seen, key));
    WEFT_TRY(weft_block_advance(parser));
    WEFT_TRY(weft_block_expect_symbol(parser, '='));
    const weft_token *token = &parser->lexer.token;
    if (token->kind != WEFT_TOKEN_STRING)
        return weft_block_unexpected(parser, "a name in quotes");
    if (token->size >= size)
        return weft_block_fail(parser, "name of %zu bytes, at most %zu", token->size, size - 1);
    memcpy(name, token->text, token->size);
    name[token->size] = '\0';
    return weft_block_advance(parser);
}
