/* Blocks of key = value, the part that weave and stitch files share. */
#include "base/block_parser.h"

#include <stdlib.h>
#include <string.h>

weft_code block_advance(block_parser *parser)
{
    return weave_lexer_advance(&parser->lexer, parser->error);
}

weft_code block_unexpected(block_parser *parser, const char *wanted)
{
    const weave_token *token = &parser->lexer.token;
    if (token->kind == WEAVE_END)
        return block_fail(parser, "expected %s, found the end of the file", wanted);
    return block_fail(parser, "expected %s, found '%.*s'", wanted, weave_token_shown(token), token->text);
}

weft_code block_expect_symbol(block_parser *parser, char symbol)
{
    char wanted[] = {'\'', symbol, '\'', '\0'};
    if (!weave_token_is_symbol(&parser->lexer.token, symbol))
        return block_unexpected(parser, wanted);
    return block_advance(parser);
}

weft_code block_next_item(block_parser *parser, bool *more)
{
    *more = weave_token_is_symbol(&parser->lexer.token, ',');
    if (*more)
        return block_advance(parser);
    if (!weave_token_is_symbol(&parser->lexer.token, '}'))
        return block_unexpected(parser, "',' or '}'");
    return WEFT_OK;
}

static const weft_parameter *find_parameter(const block_parser *parser)
{
    const weave_token *token = &parser->lexer.token;
    for (int i = 0; i < parser->parameter_count; i++) {
        const char *name = parser->parameters[i].name;
        if (strlen(name) == token->size && memcmp(name, token->text, token->size) == 0)
            return &parser->parameters[i];
    }
    return NULL;
}

static weft_code check_range(block_parser *parser, const block_field *field, double value)
{
    if (value >= field->low && value <= field->high)
        return WEFT_OK;
    return block_fail(parser, "%s = %g is outside [%g, %g]", field->key, value, field->low, field->high);
}

static weft_code parse_parameter(block_parser *parser, const block_field *field, double *values)
{
    const weft_parameter *parameter = find_parameter(parser);
    const weave_token *token = &parser->lexer.token;
    if (!parameter)
        return block_fail(parser, "no value was given for '$%.*s'", weave_token_shown(token), token->text);
    const double rgb[3] = {parameter->value.r, parameter->value.g, parameter->value.b};
    for (int i = 0; i < 3 && i < field->count; i++) {
        WEFT_TRY(check_range(parser, field, rgb[i]));
        values[i] = rgb[i];
    }
    return block_advance(parser);
}

weft_code block_parse_number(block_parser *parser, const block_field *field, double *value)
{
    const weave_token *token = &parser->lexer.token;
    if (token->kind == WEAVE_PARAMETER && field->count == 1)
        return parse_parameter(parser, field, value);
    if (token->kind != WEAVE_NUMBER)
        return block_unexpected(parser, "a number");
    WEFT_TRY(check_range(parser, field, token->number));
    *value = token->number;
    return block_advance(parser);
}

static weft_code parse_list(block_parser *parser, const block_field *field, double *values)
{
    block_field element = *field;
    element.count = 1;
    WEFT_TRY(block_expect_symbol(parser, '{'));
    for (int i = 0; i < field->count; i++) {
        if (i > 0)
            WEFT_TRY(block_expect_symbol(parser, ','));
        WEFT_TRY(block_parse_number(parser, &element, &values[i]));
    }
    return block_expect_symbol(parser, '}');
}

weft_code block_parse_value(block_parser *parser, const block_field *field, double *value)
{
    const weave_token *token = &parser->lexer.token;
    if (field->count == 1)
        return block_parse_number(parser, field, value);
    if (field->count == 3 && token->kind == WEAVE_PARAMETER)
        return parse_parameter(parser, field, value);
    if (field->count != 2 || token->kind != WEAVE_NUMBER)
        return parse_list(parser, field, value);
    WEFT_TRY(block_parse_number(parser, field, &value[0]));
    value[1] = value[0];
    return WEFT_OK;
}

weft_code block_mark_seen(block_parser *parser, unsigned *seen, unsigned key)
{
    const weave_token *token = &parser->lexer.token;
    if (*seen & key)
        return block_fail(parser, "'%.*s' is given twice", weave_token_shown(token), token->text);
    *seen |= key;
    return WEFT_OK;
}

const block_field *block_find_field(const block_parser *parser, const block_field *fields, int count)
{
    for (int i = 0; i < count; i++)
        if (weave_token_is_word(&parser->lexer.token, fields[i].key))
            return &fields[i];
    return NULL;
}

weft_code block_parse_field(block_parser *parser, const block_field *fields, const block_field *field, void *values,
                            unsigned *seen)
{
    WEFT_TRY(block_mark_seen(parser, seen, 1u << (field - fields)));
    WEFT_TRY(block_advance(parser));
    WEFT_TRY(block_expect_symbol(parser, '='));
    double *into = (double *)(void *)((char *)values + field->offset);
    return block_parse_value(parser, field, into);
}

weft_code block_check_complete(block_parser *parser, const block_field *fields, int count, unsigned seen)
{
    for (int i = 0; i < count; i++)
        if (!fields[i].optional && !(seen & 1u << i))
            return block_fail(parser, "'%s' is missing in the block that ends here", fields[i].key);
    return WEFT_OK;
}

weft_code block_unknown_key(block_parser *parser)
{
    const weave_token *token = &parser->lexer.token;
    if (token->kind != WEAVE_WORD)
        return block_unexpected(parser, "a key");
    return block_fail(parser, "unknown key '%.*s'", weave_token_shown(token), token->text);
}

weft_code block_grow(block_parser *parser, void **array, size_t count, size_t *capacity, size_t element, size_t limit,
                     const char *what)
{
    if (count < *capacity)
        return WEFT_OK;
    if (count >= limit)
        return block_fail(parser, "more than %zu %s", limit, what);
    size_t wanted = *capacity ? 2 * *capacity : 64;
    void *larger = realloc(*array, wanted * element);
    if (!larger)
        return weft_fail_memory(parser->error, what, wanted * element);
    *array = larger;
    *capacity = wanted;
    return WEFT_OK;
}

weft_code block_parse_name(block_parser *parser, char *name, size_t size, unsigned *seen, unsigned key)
{
    WEFT_TRY(block_mark_seen(parser, seen, key));
    WEFT_TRY(block_advance(parser));
    WEFT_TRY(block_expect_symbol(parser, '='));
    const weave_token *token = &parser->lexer.token;
    if (token->kind != WEAVE_STRING)
        return block_unexpected(parser, "a name in quotes");
    if (token->size >= size)
        return block_fail(parser, "name of %zu bytes, at most %zu", token->size, size - 1);
    memcpy(name, token->text, token->size);
    name[token->size] = '\0';
    return block_advance(parser);
}
