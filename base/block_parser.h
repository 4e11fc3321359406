/* Blocks of key = value: the part of the grammar that weave files (docs/reference/weave-format.md) and stitch files
 * (docs/reference/stitch-format.md) share. Every function reports what it cannot read as weave_lexer_fail does. */
#ifndef WEFT_BASE_BLOCK_PARSER_H
#define WEFT_BASE_BLOCK_PARSER_H

#include "base/lexer.h"
#include "base/vector.h"

/* A value for a `$name` in a file: scalars use `value.r`. */
typedef struct weft_parameter {
    const char *name;
    weft_rgb value;
} weft_parameter;

typedef struct block_parser {
    weave_lexer lexer; /* started and ended by the owner */
    weft_error *error;
    const weft_parameter *parameters; /* values of `$name`s */
    int parameter_count;
} block_parser;

/* A key whose value is one number or a list of them. */
typedef struct block_field {
    const char *key;
    size_t offset; /* of its first double in the values */
    int count;     /* doubles: 1; 2, where one number stands for both; 3 for a colour or place */
    bool optional; /* unchanged where absent */
    double low, high;
} block_field;

#define block_fail(parser, ...) weave_lexer_fail(&(parser)->lexer, (parser)->error, __VA_ARGS__)

weft_code block_advance(block_parser *parser);

/* The failure "expected WANTED, found ..." at the current token. */
weft_code block_unexpected(block_parser *parser, const char *wanted);

/* Consumes the symbol. */
weft_code block_expect_symbol(block_parser *parser, char symbol);

/* After an item of a list: consumes ',' and sets *more, or leaves '}' to the caller. */
weft_code block_next_item(block_parser *parser, bool *more);

/* Sets the bits of `key` in *seen; fails where they are set already. The current token is the key. */
weft_code block_mark_seen(block_parser *parser, unsigned *seen, unsigned key);

/* The field named by the current token among `count`, or NULL. */
const block_field *block_find_field(const block_parser *parser, const block_field *fields, int count);

/* One number or `$name` in the range of the field. */
weft_code block_parse_number(block_parser *parser, const block_field *field, double *value);

/* The value of a field: one number, or `{ number, ... }`. */
weft_code block_parse_value(block_parser *parser, const block_field *field, double *value);

/* key = value, for one of `fields`; the current token is the key, whose bit in *seen is its index in `fields`. */
weft_code block_parse_field(block_parser *parser, const block_field *fields, const block_field *field, void *values,
                            unsigned *seen);

/* key = "text", terminated, for a buffer of `size` bytes; `key` is its bit in *seen. */
weft_code block_parse_name(block_parser *parser, char *name, size_t size, unsigned *seen, unsigned key);

/* Fails where a field that is not optional was not seen. */
weft_code block_check_complete(block_parser *parser, const block_field *fields, int count, unsigned seen);

/* The failure for a token that is no key of this block. */
weft_code block_unknown_key(block_parser *parser);

/* Room for one more element; doubles the array. */
weft_code block_grow(block_parser *parser, void **array, size_t count, size_t *capacity, size_t element, size_t limit,
                     const char *what);

#endif
