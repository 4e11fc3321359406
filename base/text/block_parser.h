/* Blocks of key = value: the part of the grammar that weave files (docs/reference/weave-format.md) and stitch files
 * (docs/reference/stitch-format.md) share. Every function reports what it cannot read as weft_lexer_fail does. */
#ifndef WEFT_BASE_TEXT_BLOCK_PARSER_H
#define WEFT_BASE_TEXT_BLOCK_PARSER_H

#include "base/status.h"
#include "base/vector.h"

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>

/* ---- Lexer ---- */

/* Tokens of weave files and stitch files. */

typedef enum weft_token_kind {
    WEFT_TOKEN_WORD,      /* key or yarn type */
    WEFT_TOKEN_NUMBER,    /* finite */
    WEFT_TOKEN_STRING,    /* text without its quotes */
    WEFT_TOKEN_PARAMETER, /* text of $name without the $ */
    WEFT_TOKEN_SYMBOL,    /* one of { } , = */
    WEFT_TOKEN_END
} weft_token_kind;

typedef struct weft_token {
    weft_token_kind kind;
    const char *text; /* into the file, `size` bytes, not terminated */
    size_t size;
    double number;
    int line, column; /* of its first character, from 1 */
} weft_token;

/* Reads tokens from a terminated text; `token` is the one not yet consumed. */
typedef struct weft_lexer {
    const char *path, *at, *line_start;
    int line;
    weft_token token;
    locale_t numbers; /* with a decimal point, whatever the locale of the program */
} weft_lexer;

/* Starts at the first token of `text`. Errors as weft_lexer_advance. weft_lexer_end follows in any case. */
weft_code weft_lexer_start(weft_lexer *lexer, const char *text, const char *path, weft_error *error);
void weft_lexer_end(weft_lexer *lexer);

/* Moves to the next token. Errors: WEFT_BAD_INPUT for a character, number, string or comment that is not one. */
weft_code weft_lexer_advance(weft_lexer *lexer, weft_error *error);

/* WEFT_BAD_INPUT "FILE:LINE:COLUMN: " and the message, at the current token. */
weft_code weft_lexer_fail(const weft_lexer *lexer, weft_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

bool weft_token_is_symbol(const weft_token *token, char symbol);
bool weft_token_is_word(const weft_token *token, const char *word);

/* At most this many bytes of a token appear in messages: the precision of "%.*s". */
int weft_token_shown(const weft_token *token);

typedef struct weft_block_parser {
    weft_lexer lexer; /* started and ended by the owner */
    weft_error *error;
    const weft_parameter *parameters; /* values of `$name`s */
    int parameter_count;
} weft_block_parser;

/* A key whose value is one number or a list of them. */
typedef struct weft_block_field {
    const char *key;
    size_t offset; /* of its first double in the values */
    int count;     /* doubles: 1; 2, where one number stands for both; 3 for a colour or place */
    bool optional; /* unchanged where absent */
    double low, high;
} weft_block_field;

#define weft_block_fail(parser, ...) weft_lexer_fail(&(parser)->lexer, (parser)->error, __VA_ARGS__)

weft_code weft_block_advance(weft_block_parser *parser);

/* The failure "expected WANTED, found ..." at the current token. */
weft_code weft_block_unexpected(weft_block_parser *parser, const char *wanted);

/* Consumes the symbol. */
weft_code weft_block_expect_symbol(weft_block_parser *parser, char symbol);

/* After an item of a list: consumes ',' and sets *more, or leaves '}' to the caller. */
weft_code weft_block_next_item(weft_block_parser *parser, bool *more);

/* Sets the bits of `key` in *seen; fails where they are set already. The current token is the key. */
weft_code weft_block_mark_seen(weft_block_parser *parser, unsigned *seen, unsigned key);

/* The field named by the current token among `count`, or NULL. */
const weft_block_field *weft_block_find_field(const weft_block_parser *parser, const weft_block_field *fields,
                                              int count);

/* One number or `$name` in the range of the field. */
weft_code weft_block_parse_number(weft_block_parser *parser, const weft_block_field *field, double *value);

/* The value of a field: one number, or `{ number, ... }`. */
weft_code weft_block_parse_value(weft_block_parser *parser, const weft_block_field *field, double *value);

/* key = value, for one of `fields`; the current token is the key, whose bit in *seen is its index in `fields`. */
weft_code weft_block_parse_field(weft_block_parser *parser, const weft_block_field *fields,
                                 const weft_block_field *field, void *values, unsigned *seen);

/* key = "text", terminated, for a buffer of `size` bytes; `key` is its bit in *seen. */
weft_code weft_block_parse_name(weft_block_parser *parser, char *name, size_t size, unsigned *seen, unsigned key);

/* Fails where a field that is not optional was not seen. */
weft_code weft_block_check_complete(weft_block_parser *parser, const weft_block_field *fields, int count,
                                    unsigned seen);

/* The failure for a token that is no key of this block. */
weft_code weft_block_unknown_key(weft_block_parser *parser);

/* Room for one more element; doubles the array. */
weft_code weft_block_grow(weft_block_parser *parser, void **array, size_t count, size_t *capacity, size_t element,
                          size_t limit, const char *what);

#endif
