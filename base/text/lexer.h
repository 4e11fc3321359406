/* Tokens of weave files and stitch files. */
#ifndef WEFT_BASE_TEXT_LEXER_H
#define WEFT_BASE_TEXT_LEXER_H

#include "base/status.h"

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>

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

#endif
